// Images that stand upright, in the functional engine's lanes against the scalar engine, on every instruction set of this
// machine.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "../functional_case.hpp"
#include "../surface_case.hpp"
#include "model/engines/functional/frame_renderer.hpp"
#include "sim/scene/random_state.hpp"

namespace halfplane::functional_upright_test {
namespace {

using test::kHeight;
using test::kWidth;
using test::Random;
using test::SceneBuilder;

/// Rectangles as of menus and 2D: w is constant, u runs along the rows and v along the columns, either of them backwards
/// or not, from an eighth of a texel to eight texels a pixel, at any quarter of a pixel; one in six is turned.
void add_images(Scene& scene, Random& random, int count) {
  const std::size_t first = scene.indices.size();
  const Texture& texture = scene.textures[*scene.states.back().texture];
  for (int n = 0; n < count; ++n) {
    const std::array<double, 2> size{std::exp2(random.between(0, 8)), std::exp2(random.between(0, 8))};
    std::array<std::array<double, 2>, 2> at{}, to{};  // by axis: the place in the window; the coordinate
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const double pixels = axis == 0 ? kWidth : kHeight, texels = axis == 0 ? texture.width() : texture.height();
      const double start = std::floor(4 * random.between(-20, pixels)) / 4, from = random.between(-2, 2);
      const double scale = random.index(3) == 0 ? 1 : std::exp2(random.between(-3, 3));
      at[axis] = {start, start + std::ceil(4 * size[axis]) / 4};
      to[axis] = {from, from + (at[axis][1] - at[axis][0]) * scale / texels};
      if (random.index(2) == 0) std::swap(to[axis][0], to[axis][1]);
    }
    const double w = std::exp2(random.between(0, 6)), z = random.unit();
    const bool is_turned = random.index(6) == 0, has_one_color = random.index(2) == 0;
    std::array<double, 4> color{};
    for (const std::size_t corner : {0U, 1U, 2U, 2U, 1U, 3U}) {
      const std::size_t right = corner & 1, below = corner >> 1;
      Vertex vertex = test::at(at[0][right], at[1][below], z);
      vertex.w = w;
      vertex.u = to[0][is_turned ? below : right];
      vertex.v = to[1][is_turned ? right : below];
      if (corner == 0 || !has_one_color)
        for (double& channel : color) channel = random.index(256);
      std::copy(color.begin(), color.end(), std::begin(vertex.rgba));
      scene.indices.push_back(static_cast<std::uint32_t>(scene.vertices.size()));
      scene.vertices.push_back(vertex);
    }
  }
  scene.commands.push_back(Draw{static_cast<std::uint32_t>(scene.states.size() - 1), 0, Topology::triangles, first,
                                scene.indices.size() - first, 0});
}

TEST(FunctionalUpright, ImagesAreTheSameOnEveryPath) {
  for (const char* name : {"embedded", "full", "small"})
    for (std::uint32_t seed = 1; seed <= 20; ++seed) {
      SCOPED_TRACE(std::string(name) + ", seed " + std::to_string(seed));
      Random random(seed);
      SceneBuilder builder(kWidth, kHeight);
      Scene& scene = builder.scene;
      const StateRows rows = states_named({"alpha_test", "blend", "color_mask", "fog"});
      for (int draw = 0; draw < 8; ++draw) {
        State state = test::random_surface(random);
        if (random.index(3) != 0) state.texture_mag = TextureMag::linear;
        if (random.index(2) == 0) state.texture_min = TextureMin::linear_mipmap_linear;
        if (random.index(2) == 0) state = random_state(state, rows, chooser(random));
        state.depth_test = DepthFunc::always;
        state.texture = static_cast<std::uint32_t>(scene.textures.size());
        const int width = random.index(8) == 0 ? 24 : 1 << random.index(8);
        scene.textures.push_back(test::noise(random, width, 1 << random.index(8),
                                             static_cast<TextureFormat>(random.index(6)),
                                             static_cast<Mips>(random.index(3))));
        scene.states.push_back(state);
        add_images(scene, random, 3);
      }
      Config config = test::with_colors(name);
      if (seed % 4 == 0) config.color_format = ColorFormat::rgb565;
      EXPECT_TRUE(functional::is_supported(scene, config, {}));
      test::expect_all_same(scene, config);
    }
}

}  // namespace
}  // namespace halfplane::functional_upright_test
