// Textures and colours over w in the scalar and the functional engine: against each other and against the golden.
#include "model/stages/surface.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "../scene_builder.hpp"
#include "model/engines/functional.hpp"
#include "model/engines/hardware.hpp"
#include "model/engines/scalar.hpp"
#include "model/golden/golden.hpp"
#include "model/host/primitive_stream.hpp"

namespace halfplane::surface_test {
namespace {

using test::Random;
using test::SceneBuilder;

Config with_colors(const std::string& name) {
  Config config = preset(name);
  config.color_format = ColorFormat::rgba8888;
  config.stamp_size = std::min(config.stamp_size, 2);
  return config;
}

Vertex corner(double x, double y, double u, double v, double w = 1, std::array<double, 4> rgba = {255, 255, 255, 255}) {
  Vertex vertex = test::at(x, y, 0.5, rgba);
  vertex.u = u;
  vertex.v = v;
  vertex.w = w;
  return vertex;
}

Texture pattern(TexturePattern kind, int width, int height, Mips mips = Mips::none) {
  return make_texture("t", pattern_image(kind, width, height), TextureFormat::rgba8888, mips);
}

std::array<int, 4> channels(const Framebuffer& frame, int x, int y) {
  std::array<int, 4> c{};
  for (int i = 0; i < 4; ++i)
    c[static_cast<std::size_t>(i)] = golden::stored_channel(frame.color[frame.at(x, y)], ColorFormat::rgba8888, i);
  return c;
}

/// The largest difference of a channel where both drew the same primitive.
int largest_difference(const Scene& scene, const Config& config) {
  RenderOptions options;
  options.want_ids = true;
  const Rendering model = render_scalar(scene, config, options);
  const golden::Image image = golden::render(scene, config);
  int largest = 0;
  for (int y = 0; y < scene.height; ++y)
    for (int x = 0; x < scene.width; ++x) {
      const auto plain = static_cast<std::size_t>(y * scene.width + x);
      if (model.ids[plain] < 0 || model.ids[plain] != image.ids[plain]) continue;
      const auto a = channels(model.frame, x, y), b = channels(image.frame, x, y);
      for (std::size_t c = 0; c < 4; ++c) largest = std::max(largest, std::abs(a[c] - b[c]));
    }
  return largest;
}

/// Whether both engines draw the same picture.
void expect_engines_agree(const Scene& scene, const Config& config, const std::string& what) {
  const Rendering scalar = render_scalar(scene, config, {}), functional = render_functional(scene, config, {});
  EXPECT_EQ(scalar.frame.color, functional.frame.color) << what;
  EXPECT_EQ(scalar.frame.depth, functional.frame.depth) << what;
}

// The texture viewport: half a texel from the sides, at every size and offset.
TEST(Surface, OneTexelAPixelIsTheImageItself) {
  for (const std::string name : {"tiny", "embedded", "full"})
    for (const TextureMag mag : {TextureMag::nearest, TextureMag::linear})
      for (int size = 1; size <= 16; size += name == "tiny" ? 1 : 3)
        for (int offset = 0; offset + size <= 16; offset += 5) {
          State state = SceneBuilder::window_state();
          state.texture = 0;
          state.texture_combine = TextureCombine::replace;
          state.texture_mag = mag;
          SceneBuilder builder(16, 16, state);
          const double a = offset, b = offset + size;
          builder.triangle(corner(a, a, 0, 0), corner(b, a, 1, 0), corner(a, b, 0, 1))
              .triangle(corner(b, a, 1, 0), corner(b, b, 1, 1), corner(a, b, 0, 1));
          builder.scene.textures.push_back(pattern(TexturePattern::gradient, size, size));
          const Rendering out = render_scalar(builder.scene, with_colors(name), {});
          for (int y = 0; y < size; ++y)
            for (int x = 0; x < size; ++x) {
              const auto c = channels(out.frame, offset + x, offset + y);
              const Texel texel = builder.scene.textures[0].texel(0, x, y);
              for (std::size_t i = 0; i < 4; ++i)
                ASSERT_LE(std::abs(c[i] - texel[i]), mag == TextureMag::nearest ? 0 : 2)
                    << name << " size " << size << " offset " << offset << " pixel " << x << ' ' << y;
            }
        }
}

/// A scene of a few triangles on the subpixel grid, w ratios up to 2^`octaves`.
Scene random_surfaces(Random& random, const State& state, Texture texture, int size, double octaves, double texels) {
  SceneBuilder builder(size, size, state);
  for (int n = 0; n < 3; ++n) {
    std::array<Vertex, 3> v;
    for (Vertex& at : v) {
      const double x = std::floor(random.between(0, 4 * size)) / 4, y = std::floor(random.between(0, 4 * size)) / 4;
      const double u = random.between(-texels, texels), s = random.between(-texels, texels);
      const double w = std::exp2(random.between(0, octaves)), red = random.index(256), green = random.index(256);
      at = corner(x, y, u / texture.width(), s / texture.height(), w, {red, green, 200, 255});
    }
    builder.triangle(v[0], v[1], v[2]);
  }
  builder.scene.textures.push_back(std::move(texture));
  return builder.scene;
}

// The gradient's red and green change by one a texel: an error of a sixteenth does not show.
TEST(Surface, SmoothTexturesAreWithinTwoCodesOfTheGolden) {
  Random random(1);
  for (const std::string name : {"embedded", "full"})
    for (const TextureMin min :
         {TextureMin::linear, TextureMin::linear_mipmap_nearest, TextureMin::linear_mipmap_linear})
      for (const TextureInterp interp : {TextureInterp::perspective, TextureInterp::affine})
        for (int n = 0; n < 20; ++n) {
          State state = SceneBuilder::window_state();
          state.texture = 0;
          state.texture_combine = TextureCombine::replace;
          state.texture_interp = interp;
          state.texture_mag = TextureMag::linear;
          state.texture_min = min;
          state.texture_wrap = {TextureWrap::mirror, TextureWrap::clamp};
          // A level is wrong by 0.1 at most: beside a border between two of them a whole one would show, and beside the
          // image's sides levels of large texels differ.
          state.texture_lod = {0, min == TextureMin::linear_mipmap_nearest ? 1.0 : 0.0,
                               min == TextureMin::linear_mipmap_nearest ? 1.0 : 2.0};
          const Scene scene =
              random_surfaces(random, state, pattern(TexturePattern::gradient, 256, 256, Mips::box), 48, 6, 200);
          EXPECT_LE(largest_difference(scene, with_colors(name)), 3) << name << ' ' << static_cast<int>(min);
        }
}

TEST(Surface, ColoursOverWAreWithinTwoCodesOfTheGolden) {
  Random random(2);
  State state = SceneBuilder::window_state();
  state.color_interp = ColorInterp::perspective;
  int affine = 0;
  for (int n = 0; n < 60; ++n) {
    Scene scene = random_surfaces(random, state, pattern(TexturePattern::grid, 8, 8), 48, 6, 8);
    EXPECT_LE(largest_difference(scene, with_colors("embedded")), 2);
    EXPECT_LE(largest_difference(scene, with_colors("full")), 2);
    const Rendering over_w = render_scalar(scene, with_colors("embedded"), {});
    scene.states[0].color_interp = ColorInterp::affine;
    affine += over_w.frame.color != render_scalar(scene, with_colors("embedded"), {}).frame.color ? 1 : 0;
  }
  EXPECT_GT(affine, 50);  // the state is looked at
}

TEST(Surface, BothEnginesDrawTheSamePicture) {
  Random random(3);
  for (const std::string name : {"tiny", "embedded", "full"})
    for (int n = 0; n < 60; ++n) {
      State state = SceneBuilder::window_state();
      state.depth_test = n % 2 == 0 ? DepthFunc::less : DepthFunc::lequal;
      if (random.index(4) != 0) state.texture = 0;
      state.color_interp = static_cast<ColorInterp>(random.index(2));
      state.texture_interp = static_cast<TextureInterp>(random.index(2));
      state.texture_min = static_cast<TextureMin>(random.index(6));
      state.texture_mag = static_cast<TextureMag>(random.index(2));
      for (TextureWrap& wrap : state.texture_wrap) wrap = static_cast<TextureWrap>(random.index(5));
      for (std::uint8_t& channel : state.texture_border) channel = static_cast<std::uint8_t>(random.index(256));
      state.texture_combine = static_cast<TextureCombine>(random.index(5));
      for (std::uint8_t& channel : state.texture_constant) channel = static_cast<std::uint8_t>(random.index(256));
      state.texture_lod[0] = random.between(-2, 2);
      const int width = 1 + random.index(40), height = 1 << random.index(6);
      const Mips mips = static_cast<Mips>(random.index(3));
      const Scene scene =
          random_surfaces(random, state, pattern(TexturePattern::grid, width, height, mips), 16, 10, 300);
      expect_engines_agree(scene, with_colors(name), name + " " + std::to_string(n));
      Config config = with_colors(name);
      config.color_format = ColorFormat::rgb565;
      expect_engines_agree(scene, config, name + " rgb565 " + std::to_string(n));
    }
}

// A texture with a border is one of four times its side with the border's colour around it: the same places in texels.
TEST(Surface, ABorderIsALargerImage) {
  Random random(4);
  int seen = 0;
  for (int n = 0; n < 60; ++n) {
    State state = SceneBuilder::window_state();
    state.texture = 0;
    state.texture_min = random.index(2) == 0 ? TextureMin::nearest : TextureMin::linear;
    state.texture_mag = static_cast<TextureMag>(random.index(2));
    state.texture_wrap = {TextureWrap::border, TextureWrap::border};
    for (std::uint8_t& channel : state.texture_border) channel = static_cast<std::uint8_t>(random.index(256));
    const int side = 1 << random.index(6);
    const Texture texture = pattern(TexturePattern::grid, side, side);
    Scene scene = random_surfaces(random, state, texture, 32, 6, 3 * side);
    for (Vertex& vertex : scene.vertices)
      for (double* place : {&vertex.u, &vertex.v}) *place = std::round(std::ldexp(*place, 20)) / (1 << 20);
    Scene larger = scene;
    TexelImage image{4 * side, 4 * side, {}};
    for (int y = 0; y < 4 * side; ++y)
      for (int x = 0; x < 4 * side; ++x) {
        const bool is_inside = x >= side && x < 2 * side && y >= side && y < 2 * side;
        image.texel.push_back(is_inside ? texture.texel(0, x - side, y - side) : state.texture_border);
      }
    larger.textures = {make_texture("larger", image, TextureFormat::rgba8888, Mips::none)};
    for (State& drawn : larger.states) drawn.texture_wrap = {TextureWrap::clamp, TextureWrap::clamp};
    for (Vertex& vertex : larger.vertices) {
      vertex.u = (vertex.u + 1) / 4;
      vertex.v = (vertex.v + 1) / 4;
    }
    const Config config = with_colors(n % 2 == 0 ? "embedded" : "full");
    EXPECT_EQ(render_scalar(scene, config, {}).frame.color, render_scalar(larger, config, {}).frame.color) << n;
    for (State& drawn : scene.states) drawn.texture_wrap = {TextureWrap::clamp, TextureWrap::clamp};
    seen += render_scalar(scene, config, {}).frame.color != render_scalar(larger, config, {}).frame.color ? 1 : 0;
  }
  EXPECT_GT(seen, 50);
}

// Clip space, a triangle from behind the eye: clipped pieces keep the texture.
TEST(Surface, AClippedTriangleKeepsItsTexture) {
  State state;
  state.texture = 0;
  state.texture_combine = TextureCombine::replace;
  state.texture_mag = TextureMag::linear;
  state.texture_min = TextureMin::linear_mipmap_linear;
  SceneBuilder builder(64, 64, state);
  const auto ground = [](double x, double z, double u, double v) {
    Vertex vertex = test::clip_at(x, -1, (50.5 * z - 50) / 49.5, z);
    vertex.u = u;
    vertex.v = v;
    return vertex;
  };
  builder.triangle(ground(-40, -10, 0, 0), ground(40, -10, 1, 0), ground(0, 45, 0.5, 1));
  builder.scene.textures.push_back(pattern(TexturePattern::gradient, 256, 256, Mips::box));
  EXPECT_LE(largest_difference(builder.scene, with_colors("full")), 6);  // the cut vertices are snapped
  expect_engines_agree(builder.scene, with_colors("full"), "clipped");
}

TEST(Surface, WhatAnEngineDoesNotHaveIsSaidInOneLine) {
  State state = SceneBuilder::window_state();
  state.texture = 0;
  SceneBuilder builder(8, 8, state);
  builder.triangle(corner(0, 0, 0, 0), corner(8, 0, 1, 0), corner(0, 8, 0, 1, -1));
  builder.scene.textures.push_back(pattern(TexturePattern::grid, 8, 8));
  const auto message = [](auto&& call) -> std::string {
    try {
      call();
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  const Scene& scene = builder.scene;
  const Config config = preset("tiny");
  for (std::size_t corner_behind = 0; corner_behind < 3; ++corner_behind) {
    Scene behind = scene;
    for (std::size_t i = 0; i < 3; ++i) behind.vertices[i].w = i == corner_behind ? -1 : 1;
    EXPECT_NE(message([&] { (void)render_scalar(behind, config, {}); }).find("w <= 0"), std::string::npos);
  }
  EXPECT_NE(message([&] { (void)render_functional(scene, config, {}); }).find("w <= 0"), std::string::npos);
  EXPECT_NE(message([&] { HostStream(scene, config); }).find("state texture"), std::string::npos);
  State in_clip_space;
  in_clip_space.texture = 0;
  SceneBuilder clip(8, 8, in_clip_space);
  clip.triangle(test::clip_at(0, 0, 0, 1), test::clip_at(1, 0, 0, 1), test::clip_at(0, 1, 0, 1));
  clip.scene.textures = scene.textures;
  RenderOptions homogeneous;
  homogeneous.rules.clipping = Clipping::homogeneous;
  EXPECT_NE(message([&] {
              (void)render_scalar(clip.scene, config, homogeneous);
            }).find("clipping homogeneous has no textures"),
            std::string::npos);
  State as_lines;
  as_lines.color_interp = ColorInterp::perspective;
  as_lines.polygon_mode = PolygonMode::line;
  SceneBuilder line(8, 8, as_lines);
  line.triangle(test::clip_at(0, 0, 0, 1), test::clip_at(1, 0, 0, 1), test::clip_at(0, 1, 0, 1));
  EXPECT_NE(message([&] { (void)render_scalar(line.scene, config, {}); }).find("lines and points"), std::string::npos);
}

// Affine coordinates want no w: any is taken.
TEST(Surface, FormatsFollowTheirSettings) {
  EXPECT_EQ(perspective_format(preset("embedded")).coordinate.narrow_bits, 17);
  EXPECT_EQ(perspective_format(preset("tiny")).coordinate.fraction_bits, 6);
  EXPECT_EQ(perspective_format(preset("full")).q_bits, 26);
  EXPECT_EQ(perspective_format(preset("tiny")).color.bits, 16);
}

// As captures may have them: beyond the needs of any place on a texture, and beyond the range of their products.
TEST(Surface, CoordinatesOfAnySizeAreDrawn) {
  for (const double far : {1e17, 1e30, 1e300})
    for (const int size : {32, 33}) {
      State state = SceneBuilder::window_state();
      state.texture = 0;
      state.texture_min = TextureMin::linear_mipmap_linear;
      SceneBuilder builder(16, 16, state);
      builder.triangle(corner(1, 1, far, 0), corner(15, 2, -far, far, 1e-6), corner(3, 15, 0.7 * far, -far, 1e6));
      builder.scene.textures.push_back(pattern(TexturePattern::grid, size, size, Mips::box));
      expect_engines_agree(builder.scene, with_colors("embedded"), std::to_string(far));
      EXPECT_GT(golden::render(builder.scene, with_colors("embedded")).counters.written, 50U);
    }
}

}  // namespace
}  // namespace halfplane::surface_test
