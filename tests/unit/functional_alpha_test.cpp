// Blends whose source is opaque or transparent by its texels, in the functional engine against the scalar engine, on every
// instruction set of this machine.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>

#include "../functional_case.hpp"
#include "../scene_builder.hpp"
#include "model/engines/functional/frame_renderer.hpp"
#include "sim/scene/random_state.hpp"

namespace halfplane::functional_alpha_test {
namespace {

using test::expect_all_same;
using test::Random;
using test::SceneBuilder;

constexpr int kSide = 64;
constexpr BlendFactors kOver{BlendFactor::src_alpha, BlendFactor::one_minus_src_alpha, BlendFactor::src_alpha,
                             BlendFactor::one_minus_src_alpha};

/// Texels of any colour; the alpha of each is alpha_at(x, y).
template <class AlphaAt>
Texture texture_of(Random& random, const AlphaAt& alpha_at) {
  TexelImage image{kSide, kSide, {}};
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const auto channel = [&random] { return static_cast<std::uint8_t>(random.index(256)); };
      image.texel.push_back({channel(), channel(), channel(), static_cast<std::uint8_t>(alpha_at(x, y))});
    }
  return make_texture("t", image, TextureFormat::rgba8888, Mips::none);
}

/// Triangles of all sizes upon each other, some pixels wide and as large as the target.
Scene scene_of(Random& random, const State& state, Texture texture, double alpha) {
  SceneBuilder builder(150, 100);
  Scene& scene = builder.scene;
  scene.textures.push_back(std::move(texture));
  scene.states.push_back(state);
  for (int n = 0; n < 60; ++n) {
    const double size = std::array{5.0, 15.0, 40.0, 200.0}[static_cast<std::size_t>(random.index(4))];
    const double left = random.between(-8, 150), top = random.between(-8, 100);
    for (int corner = 0; corner < 3; ++corner) {
      Vertex vertex =
          test::at(std::floor(left + size * random.unit()), std::floor(top + size * random.unit()), random.unit());
      vertex.w = std::exp2(random.between(0, 2));
      vertex.u = random.between(-1, 2);
      vertex.v = random.between(-1, 2);
      for (double& channel : vertex.rgba) channel = random.index(256);
      vertex.rgba[3] = alpha;
      scene.indices.push_back(static_cast<std::uint32_t>(scene.vertices.size()));
      scene.vertices.push_back(vertex);
    }
  }
  scene.commands.push_back(
      Draw{static_cast<std::uint32_t>(scene.states.size() - 1), 0, Topology::triangles, 0, scene.indices.size(), 0});
  return scene;
}

State blended(Random& random, BlendFactors blend) {
  State state = SceneBuilder::window_state();
  state.texture = 0;
  state.texture_min = random.index(2) == 0 ? TextureMin::linear : TextureMin::nearest;
  state.texture_mag = state.texture_min == TextureMin::linear ? TextureMag::linear : TextureMag::nearest;
  state.color_interp = static_cast<ColorInterp>(random.index(2));
  state.blend = blend;
  return state;
}

Config config_of(const char* name) {
  Config config = preset(name);
  config.color_format = ColorFormat::rgba8888;
  config.stamp_size = std::min(config.stamp_size, 2);
  return config;
}

TEST(FunctionalAlpha, OpaqueTexelsReplaceWhereTheyDecide) {
  Random random(1);
  for (const TextureCombine combine : {TextureCombine::modulate, TextureCombine::replace, TextureCombine::decal,
                                       TextureCombine::blend, TextureCombine::add})
    for (const TextureWrap wrap : {TextureWrap::repeat, TextureWrap::border})
      for (const double alpha : {255.0, 200.0})
        for (const int lowest : {255, 254}) {
          SCOPED_TRACE("combine " + std::to_string(static_cast<int>(combine)) + ", wrap " +
                       std::to_string(static_cast<int>(wrap)) + ", alpha " + std::to_string(alpha) + ", texels from " +
                       std::to_string(lowest));
          State state = blended(random, kOver);
          state.texture_combine = combine;
          state.texture_wrap[1] = wrap;
          const auto alpha_at = [&](int x, int y) { return x == 9 && y == 40 ? lowest : 255; };
          const Scene scene = scene_of(random, state, texture_of(random, alpha_at), alpha);
          const Config config = config_of("full");
          expect_all_same(scene, config);
          const bool is_known = combine == TextureCombine::decal || (lowest == 255 && wrap == TextureWrap::repeat);
          const bool is_opaque = alpha == 255 || combine == TextureCombine::replace;
          const Counters counters = render_functional(scene, config).counters;
          EXPECT_EQ(counters.skipped.opaque_blends, is_known && is_opaque ? counters.depth_passed : 0);
        }
}

TEST(FunctionalAlpha, TransparentTexelsDrawNothingWhereTheBlendKeepsWhatIsStored) {
  const auto with = [](BlendFactor src, BlendFactor dst) { return BlendFactors{src, dst, src, dst}; };
  struct Case {
    BlendFactors blend;
    bool keeps;
  };
  for (const Case& one : {Case{kOver, true}, Case{with(BlendFactor::src_alpha, BlendFactor::one), true},
                          Case{with(BlendFactor::one, BlendFactor::one_minus_src_alpha), false},
                          Case{with(BlendFactor::src_alpha, BlendFactor::zero), false},
                          Case{with(BlendFactor::src_alpha, BlendFactor::src_alpha), false}})
    for (const char* name : {"embedded", "full"}) {
      std::uint64_t tiles = 0, without = 0;
      for (std::uint32_t seed = 1; seed <= 4; ++seed) {
        SCOPED_TRACE(std::string(name) + ", seed " + std::to_string(seed));
        Random random(seed);
        State state = blended(random, one.blend);
        state.texture_combine = seed % 2 == 0 ? TextureCombine::modulate : TextureCombine::replace;
        state.depth_test = DepthFunc::always;
        const auto alpha_at = [&](int x, int y) { return (x / 32 + y / 32) % 2 == 0 ? 0 : random.index(256); };
        const Scene scene = scene_of(random, state, texture_of(random, alpha_at), 200);
        const Config config = config_of(name);
        expect_all_same(scene, config);
        RenderOptions off;
        off.skip.alpha_tiles = false;
        tiles += render_functional(scene, config).counters.skipped.alpha_tiles;
        without += render_functional(scene, config, off).counters.skipped.alpha_tiles;
      }
      EXPECT_EQ(tiles > 0, one.keeps);
      EXPECT_EQ(without, 0U);
    }
}

/// Small triangles with operations, textured and plain ones by turns, side by side and over each other: their pixels wait.
TEST(FunctionalAlpha, OperatedTrianglesWithAndWithoutTexturesAreTheSameOnEveryPath) {
  for (std::uint32_t seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    SceneBuilder builder(150, 100);
    Scene& scene = builder.scene;
    scene.textures.push_back(texture_of(random, [&random](int, int) { return random.index(256); }));
    const StateRows rows = states_named({"alpha_test", "blend", "blend_equation", "color_mask", "dither"});
    for (std::uint32_t n = 0; n < 24; ++n) {
      State state = random_state(SceneBuilder::window_state(), rows, chooser(random));
      if (!state.blend) state.blend = BlendFactors{BlendFactor::src_alpha, BlendFactor::one};
      state.depth_write = random.index(2) == 0;
      state.depth_test = random.index(2) == 0 ? DepthFunc::always : DepthFunc::lequal;
      if (n % 2 == 0) state.texture = 0;
      scene.states.push_back(state);
      const double size = seed % 2 == 0 ? 3 : 12;
      for (int i = 0; i < 40; ++i) {
        const double left = random.between(-8, 150), top = random.between(-8, 100);
        const auto corner = [&] {
          Vertex v = test::at(left + size * random.unit(), top + size * random.unit(), random.unit());
          v.u = random.unit();
          v.v = random.unit();
          for (double& channel : v.rgba) channel = random.index(256);
          return v;
        };
        builder.triangle(corner(), corner(), corner());
      }
    }
    for (const ColorFormat format : {ColorFormat::rgba8888, ColorFormat::rgb565}) {
      Config config = preset(seed % 3 == 0 ? "full" : "embedded");
      config.color_format = format;
      expect_all_same(scene, config);
    }
  }
}

}  // namespace
}  // namespace halfplane::functional_alpha_test
