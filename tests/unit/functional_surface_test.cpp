// Textures and colours over w in the functional engine's lanes against the scalar engine, on every instruction set of this
// machine.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "../functional_case.hpp"
#include "../scene_builder.hpp"
#include "../surface_case.hpp"
#include "model/engines/functional/frame_renderer.hpp"
#include "model/engines/functional/surface_constants.hpp"
#include "sim/scene/builtin.hpp"
#include "sim/scene/random_state.hpp"

namespace halfplane::functional_surface_test {
namespace {

using test::expect_all_same;
using test::kHeight;
using test::kWidth;
using test::kWraps;
using test::noise;
using test::Random;
using test::random_surface;
using test::SceneBuilder;
using test::with_colors;

/// Triangles of any size, `count` of about `size` pixels, w ratios to 2^`octaves`, coordinates to +-`texels`.
void add_triangles(Scene& scene, Random& random, int count, double size, double octaves, double texels) {
  const std::size_t first = scene.indices.size();
  const State& state = scene.states.back();
  const double side = state.texture ? scene.textures[*state.texture].width() : 1;
  for (int n = 0; n < count; ++n) {
    const double left = random.between(-8, kWidth), top = random.between(-8, kHeight);
    for (int corner = 0; corner < 3; ++corner) {
      const double x = std::floor(4 * (left + size * random.unit())) / 4,
                   y = std::floor(4 * (top + size * random.unit())) / 4;
      Vertex vertex = test::at(x, y, random.unit());
      vertex.w = std::exp2(random.between(0, octaves));
      vertex.u = random.between(-texels, texels) / side;
      vertex.v = random.between(-texels, texels) / side;
      if (random.index(3) != 0)
        for (double& channel : vertex.rgba) channel = random.index(256);
      scene.indices.push_back(static_cast<std::uint32_t>(scene.vertices.size()));
      scene.vertices.push_back(vertex);
    }
  }
  scene.commands.push_back(Draw{static_cast<std::uint32_t>(scene.states.size() - 1), 0, Topology::triangles, first,
                                scene.indices.size() - first, 0});
}

/// Draws with surfaces, and one in four without.
Scene random_surfaces(std::uint32_t seed, int draws) {
  Random random(seed);
  SceneBuilder builder(kWidth, kHeight);
  Scene& scene = builder.scene;
  for (int n = 0; n < draws; ++n) {
    State state = random_surface(random);
    if (random.index(4) == 0) state.color_interp = ColorInterp::affine;
    if (random.index(4) != 0) {
      const bool is_odd = random.index(5) == 0;
      const int width = is_odd ? 1 + random.index(40) : 1 << random.index(7), height = 1 << random.index(7);
      const auto format = static_cast<TextureFormat>(random.index(6));
      const auto mips = static_cast<Mips>(random.index(3));
      state.texture = static_cast<std::uint32_t>(scene.textures.size());
      scene.textures.push_back(noise(random, width, height, format, mips));
    }
    scene.states.push_back(state);
    constexpr std::array kSizes{2.0, 7.0, 17.0, 31.0, 90.0, 200.0};
    const double size = kSizes[static_cast<std::size_t>(random.index(6))];
    const int count = size < 40 ? 40 : 3;
    add_triangles(scene, random, count, size, random.index(3) * 5.0, std::exp2(random.between(0, 12)));
  }
  return scene;
}

TEST(FunctionalSurface, RandomSurfacesAreTheSameOnEveryPath) {
  for (const char* name : {"embedded", "full", "small"})
    for (std::uint32_t seed = 1; seed <= 12; ++seed) {
      SCOPED_TRACE(std::string(name) + ", seed " + std::to_string(seed));
      const Scene scene = random_surfaces(seed, 12);
      for (const ColorFormat format : {ColorFormat::rgba8888, ColorFormat::rgb565}) {
        Config config = with_colors(name);
        config.color_format = format;
        EXPECT_TRUE(functional::is_supported(scene, config, {}));
        expect_all_same(scene, config);
      }
    }
}

TEST(FunctionalSurface, FragmentOperationsOnSurfacesAreTheSameOnEveryPath) {
  std::uint64_t killed = 0;
  for (const char* name : {"embedded", "full"})
    for (std::uint32_t seed = 1; seed <= 10; ++seed) {
      SCOPED_TRACE(std::string(name) + ", seed " + std::to_string(seed));
      Scene scene = random_surfaces(seed, 12);
      Random random(seed + 50);
      StateRows rows = states_named({"alpha_test", "blend", "blend_equation", "blend_color", "color_mask", "dither",
                                     "fog", "fog_color", "stencil"});
      if (seed % 3 == 0) rows.pop_back();
      for (State& state : scene.states) state = random_state(state, rows, chooser(random));
      for (const ColorFormat format : {ColorFormat::rgba8888, ColorFormat::rgb565}) {
        Config config = with_colors(name);
        config.color_format = format;
        EXPECT_TRUE(functional::is_supported(scene, config, {}));
        expect_all_same(scene, config);
        killed += render_scalar(scene, config).counters.alpha_killed;
      }
    }
  EXPECT_GT(killed, 1000U);
}

/// Patches of texels that are clear or not: then whole tiles pass an alpha test, and whole tiles fail.
TEST(FunctionalSurface, AlphaOfPatchesIsTheSameOnEveryPath) {
  std::uint64_t tiles = 0, without = 0;
  for (const char* name : {"small", "embedded", "full"})
    for (std::uint32_t seed = 1; seed <= 24; ++seed) {
      SCOPED_TRACE(std::string(name) + ", seed " + std::to_string(seed));
      Random random(seed);
      SceneBuilder builder(kWidth, kHeight);
      const int patch = 1 << random.index(5), width = 1 << random.index(8), height = 1 << random.index(8);
      Texture texture = noise(random, width, height, TextureFormat::rgba8888, Mips::none);
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
          std::uint32_t& code = texture.level[0].code[static_cast<std::size_t>(y * width + x)];
          code = (code & ~255U) | ((x / patch + y / patch) % 2 == 0 ? 255U - seed : seed);  // A
        }
      builder.scene.textures.push_back(texture);
      State state = random_surface(random);
      state.texture = 0;
      state.texture_min = random.index(2) == 0 ? TextureMin::linear : TextureMin::nearest;
      state.texture_mag = state.texture_min == TextureMin::linear ? TextureMag::linear : TextureMag::nearest;
      state.alpha_test = {random.index(2) == 0 ? DepthFunc::gequal : DepthFunc::less, 128};
      state.depth_write = random.index(2) == 0;
      state.color_write = seed % 3 != 0;
      if (seed % 5 == 0) state.fog = Fog{};
      builder.scene.states.push_back(state);
      add_triangles(builder.scene, random, 12, 200, random.index(3) * 3.0, std::exp2(random.between(0, 9)));
      const Config config = with_colors(name);
      expect_all_same(builder.scene, config);
      RenderOptions off;
      off.skip.alpha_tiles = false;
      tiles += render_functional(builder.scene, config).counters.skipped.alpha_tiles;
      without += render_functional(builder.scene, config, off).counters.skipped.alpha_tiles;
    }
  EXPECT_GT(tiles, 500U);
  EXPECT_EQ(without, 0U);
}

TEST(TexelBlocks, AlphaRangesHoldEveryTexel) {
  std::uint64_t exact = 0, all = 0;
  for (std::uint32_t seed = 1; seed <= 400; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const std::array<int, 2> side{1 << random.index(7), 1 << random.index(7)};
    const Texture texture = noise(random, side[0], side[1], TextureFormat::rgba8888, Mips::none);
    TexelBlocks texels(texture);
    texels.add_alpha_ranges();
    texels.add_alpha_quads();
    ASSERT_NE(texels.alpha_ranges(), nullptr);
    std::array<TextureWrap, 2> wrap;
    std::array<std::int32_t, 2> low, high;
    for (std::size_t axis = 0; axis < 2; ++axis) {
      wrap[axis] = std::array{TextureWrap::repeat, TextureWrap::clamp, TextureWrap::mirror}[random.index(3)];
      low[axis] = static_cast<std::int32_t>(random.between(-300, 300));
      high[axis] = low[axis] + static_cast<std::int32_t>(std::exp2(random.between(0, 8))) - 1;
    }
    const auto wrapped = [&](std::int32_t i, std::size_t axis) {
      const int n = side[axis];
      if (wrap[axis] == TextureWrap::clamp) return std::clamp(i, 0, n - 1);
      if (wrap[axis] == TextureWrap::repeat) return ((i % n) + n) % n;
      const int rest = ((i % (2 * n)) + 2 * n) % (2 * n);
      return rest < n ? rest : 2 * n - 1 - rest;
    };
    std::uint8_t least = 255, most = 0;
    for (std::int32_t y = low[1]; y <= high[1]; ++y)
      for (std::int32_t x = low[0]; x <= high[0]; ++x) {
        const std::uint8_t alpha = texture.texel(0, wrapped(x, 0), wrapped(y, 1))[3];
        least = std::min(least, alpha);
        most = std::max(most, alpha);
      }
    const auto range = texels.alpha_ranges()->range(low, high, wrap);
    EXPECT_LE(range.low, least);
    EXPECT_GE(range.high, most);
    exact += range.low == least && range.high == most ? 1U : 0U;
    ++all;
  }
  EXPECT_GT(exact, all / 5);
}

/// Every number of bits that a configuration may give to 1/w and its reciprocal.
TEST(FunctionalSurface, EveryPrecisionIsTheSameOnEveryPath) {
  std::uint32_t seed = 100;
  for (const int bits : {12, 16, 19, 22, 26})
    for (const int mantissa_bits : {8, 12, 15, 16, 17, 18, 19, 20}) {
      Config config = with_colors("embedded");
      config.perspective_bits = bits;
      config.perspective_mantissa_bits = mantissa_bits;
      SCOPED_TRACE("perspective.bits " + std::to_string(bits) + ", mantissa_bits " + std::to_string(mantissa_bits) +
                   ", seed " + std::to_string(seed));
      Scene scene = random_surfaces(seed++, 6);
      Random random(seed);
      for (State& state : scene.states)
        state = random_state(state, states_named({"fog", "fog_color"}), chooser(random));
      expect_all_same(scene, config);
    }
}

TEST(FunctionalSurface, TheSmallestAndTheLargestTexturesAreTheSameOnEveryPath) {
  for (const auto& [width, height] : {std::pair{1, 1}, {1, 64}, {64, 1}, {2, 2}, {4096, 4}, {4, 4096}, {3, 5}})
    for (const TextureWrap wrap : kWraps)
      for (int min = 0; min < 6; ++min) {
        SCOPED_TRACE(std::to_string(width) + "x" + std::to_string(height) + ", wrap " +
                     std::to_string(static_cast<int>(wrap)) + ", min " + std::to_string(min));
        Random random(static_cast<std::uint32_t>(width + 7 * height + min));
        SceneBuilder builder(kWidth, kHeight);
        State state = SceneBuilder::window_state();
        state.texture = 0;
        state.texture_wrap = {wrap, wrap};
        state.texture_border = {200, 40, 90, 130};
        state.texture_min = static_cast<TextureMin>(min);
        state.texture_mag = TextureMag::linear;
        builder.scene.states.push_back(state);
        builder.scene.textures.push_back(noise(random, width, height, TextureFormat::rgba8888, Mips::box));
        for (const double texels : {1.0, 100.0, 5000.0, 3e6}) add_triangles(builder.scene, random, 4, 90, 6, texels);
        expect_all_same(builder.scene, with_colors("full"));
      }
}

/// Small triangles, which are set up sixteen at a time: coordinates from a texel to more than 32 bits count, and vertices
/// behind each other by more than Q tells apart, so that some lanes are left to the stages.
TEST(FunctionalSurface, SmallTrianglesOfEveryReachAreTheSameOnEveryPath) {
  std::uint32_t seed = 300;
  for (const char* name : {"small", "embedded", "full"})
    for (const TextureWrap wrap : kWraps)
      for (const TextureMin min : {TextureMin::nearest, TextureMin::linear, TextureMin::linear_mipmap_linear}) {
        SCOPED_TRACE(std::string(name) + ", wrap " + std::to_string(static_cast<int>(wrap)) + ", min " +
                     std::to_string(static_cast<int>(min)) + ", seed " + std::to_string(seed));
        Random random(seed++);
        SceneBuilder builder(kWidth, kHeight);
        State state = SceneBuilder::window_state();
        state.texture = 0;
        state.texture_wrap = {wrap, wrap};
        state.texture_border = {200, 40, 90, 130};
        state.texture_min = min;
        state.texture_mag = min == TextureMin::nearest ? TextureMag::nearest : TextureMag::linear;
        builder.scene.textures.push_back(noise(random, 64, 16, TextureFormat::rgba8888, Mips::box));
        for (const TextureInterp interp : {TextureInterp::perspective, TextureInterp::affine}) {
          state.texture_interp = interp;
          builder.scene.states.push_back(state);
          for (const double texels : {0.01, 30.0, 5000.0, 3e6, 1e8, 1e11})
            for (const double octaves : {0.0, 3.0, 60.0, 600.0})
              add_triangles(builder.scene, random, 12, 2 + 4 * random.index(5), octaves, texels);
        }
        expect_all_same(builder.scene, with_colors(name));
      }
}

/// More triangles of a pixel or two in each bin than there are numbers for.
TEST(FunctionalSurface, MoreSurfacesThanNumbersAreTheSameOnEveryPath) {
  Random random(7);
  SceneBuilder builder(kWidth, kHeight);
  State state = SceneBuilder::window_state();
  state.texture = 0;
  builder.scene.states.push_back(state);
  builder.scene.textures.push_back(noise(random, 32, 32, TextureFormat::rgb565, Mips::none));
  add_triangles(builder.scene, random, 60000, 3, 2, 40);
  expect_all_same(builder.scene, with_colors("embedded"));
}

/// Meshes: shared vertices, clip space, triangles that the near plane and the guard band cut, back faces culled.
TEST(FunctionalSurface, TexturedMeshesAreTheSameOnEveryPath) {
  for (const char* name : {"teapot:6", "ball:30", "walk", "blocks:60", "dust:4000", "layers_linear:12"})
    for (std::uint32_t seed = 1; seed <= 2; ++seed) {
      SCOPED_TRACE(std::string(name) + ", seed " + std::to_string(seed));
      Random random(seed);
      Scene scene = make_builtin(name, kWidth, kHeight, {}, 1);
      scene.textures.assign(1, noise(random, 64, 32, TextureFormat::rgba4444, Mips::box));
      for (Vertex& v : scene.vertices) {
        v.u = random.between(-2, 2);
        v.v = random.between(-2, 2);
      }
      for (State& state : scene.states) {
        const State surface = random_surface(random);
        state.texture = 0;
        state.color_interp = surface.color_interp;
        state.texture_min = surface.texture_min;
        state.texture_mag = surface.texture_mag;
        state.texture_wrap = surface.texture_wrap;
        state.texture_border = surface.texture_border;
        state.texture_combine = surface.texture_combine;
        state.texture_constant = surface.texture_constant;
      }
      EXPECT_TRUE(functional::is_supported(scene, with_colors("embedded"), {}));
      expect_all_same(scene, with_colors("embedded"));
    }
}

/// A mesh around the eye beside textured triangles in window coordinates: its vertices behind the eye are the clipper's.
TEST(FunctionalSurface, VerticesBehindTheEyeBesideWindowCoordinatesAreTheSameOnEveryPath) {
  Random random(3);
  Scene scene = make_builtin("walk", kWidth, kHeight, {}, 1);
  ASSERT_TRUE(std::ranges::any_of(scene.vertices, [](const Vertex& v) { return v.w <= 0; }));
  scene.textures.push_back(noise(random, 32, 32, TextureFormat::rgb565, Mips::none));
  State state = SceneBuilder::window_state();
  state.texture = static_cast<std::uint32_t>(scene.textures.size() - 1);
  scene.states.push_back(state);
  add_triangles(scene, random, 50, 40, 1, 40);
  EXPECT_TRUE(functional::is_supported(scene, with_colors("embedded"), {}));
  expect_all_same(scene, with_colors("embedded"));
  scene.vertices.back().w = -1;
  EXPECT_FALSE(functional::is_supported(scene, with_colors("embedded"), {}));
}

/// The comparison fails where it must: a row of texels that differ, and eight bits less in a reciprocal.
TEST(FunctionalSurfaceMustFail, WrongTexelsAndShorterReciprocalsAreSeen) {
  const Config config = with_colors("embedded");
  const Scene scene = make_builtin("layers_nearest:4", kWidth, kHeight, {}, 1);
  const Rendering scalar = render_scalar(scene, config);
  EXPECT_EQ(render_functional(scene, config).frame.color, scalar.frame.color);
  Scene changed = scene;
  for (std::size_t x = 0; x < 256; ++x) changed.textures[0].level[0].code[std::size_t{256} * 40 + x] ^= 1U << 31;  // R
  EXPECT_NE(render_functional(changed, config).frame.color, scalar.frame.color);
  Config shorter = config;
  shorter.perspective_mantissa_bits = 10;
  EXPECT_NE(render_functional(scene, shorter).frame.color, scalar.frame.color);
}

/// The first three vertices of a scene as a slice of the draw, and their record.
functional::Slice slice_of(const DrawContext& context, const Config& config) {
  functional::Slice slice;
  slice.context = &context;
  for (std::uint32_t i = 0; i < 3; ++i) {
    const Vertex& v = context.scene.vertices[i];
    const WindowPosition at = window_position(v, context.state, kHeight);
    slice.vertices.push_back(functional::row_of(snap_vertex(at, v, config, {"", 0, i})));
    slice.own_surface.push_back(surface_row(v.w, v.u, v.v));
  }
  slice.surface = slice.own_surface.data();
  return slice;
}
functional::Record first_record() {
  functional::Record record;
  record.v = {0, 1, 2};
  return record;
}

functional::SurfaceConstants constants_of(const Scene& scene, const Config& config, const TexelBlocks* texels) {
  const Widths widths = derive_widths(config);
  const PreparedScene prepared(scene);
  const functional::FrameContext frame{prepared, config, widths, {}, 0, 0};
  const DrawContext context(scene, config, std::get<Draw>(scene.commands.back()), 0);
  const functional::Slice slice = slice_of(context, config);
  return {functional::StageSurface(frame, slice, first_record(), kAtCentre, true), frame, texels};
}

/// coordinates_margin(): the coordinates of a covered tile's pixels lie between its corners' coordinates, plus this
/// margin.
TEST(FunctionalSurface, CoordinatesOfATileLieBetweenThoseOfItsCorners) {
  double nearest_to_margin = 0;
  int tiles = 0;
  for (const char* name : {"small", "embedded", "full"})
    for (std::uint32_t seed = 1; seed <= 60; ++seed) {
      SCOPED_TRACE(std::string(name) + ", seed " + std::to_string(seed));
      Random random(seed);
      SceneBuilder builder(kWidth, kHeight);
      State state = SceneBuilder::window_state();
      state.texture = 0;
      builder.scene.states.push_back(state);
      builder.scene.textures.push_back(noise(random, 64, 64, TextureFormat::rgba8888, Mips::none));
      add_triangles(builder.scene, random, 1, 200, random.between(0, 10), std::exp2(random.between(0, 12)));
      const Config config = with_colors(name);
      const Widths widths = derive_widths(config);
      const PreparedScene prepared(builder.scene);
      const functional::FrameContext frame{prepared, config, widths, {}, 0, 0};
      const DrawContext context(builder.scene, config, std::get<Draw>(builder.scene.commands.back()), 0);
      const functional::Slice slice = slice_of(context, config);
      const functional::StageSurface stage(frame, slice, first_record(), kAtCentre, true);
      const Surface& surface = stage.surface;
      const Framebuffer drawn = render_scalar(builder.scene, config).frame;
      const std::uint32_t nothing = render_scalar(SceneBuilder(kWidth, kHeight).scene, config).frame.depth.front();
      const auto is_covered = [&](int x, int y) { return drawn.depth[drawn.at(x, y)] != nothing; };
      for (int top = 0; top + 8 <= kHeight; top += 8)
        for (int left = 0; left + 8 <= kWidth; left += 8) {
          if (!is_covered(left, top) || !is_covered(left + 7, top) || !is_covered(left, top + 7) ||
              !is_covered(left + 7, top + 7))
            continue;
          ++tiles;
          for (std::size_t axis = 0; axis < 2; ++axis) {
            const auto at = [&](int x, int y) { return surface.at(x, y).coordinate[axis]; };
            const auto [low, high] =
                std::minmax({at(left, top), at(left + 7, top), at(left, top + 7), at(left + 7, top + 7)});
            const double margin =
                functional::coordinates_margin(surface.coordinate(axis).over_w.reach, surface.format()) / 256.0;
            for (int i = 0; i < 64; ++i) {
              const double u = at(left + i % 8, top + i / 8), off = std::max(low - u, u - high);
              EXPECT_LE(off, margin);
              nearest_to_margin = std::max(nearest_to_margin, off / margin);
            }
          }
        }
    }
  EXPECT_GT(tiles, 300);
  RecordProperty("nearest_to_margin", std::to_string(nearest_to_margin));
}

TEST(FunctionalSurface, WhatIsUsualIsDrawnInLanes) {
  int in_lanes = 0, narrow = 0;
  for (std::uint32_t seed = 1; seed <= 200; ++seed) {
    Random random(seed);
    SceneBuilder builder(kWidth, kHeight);
    State state = SceneBuilder::window_state();
    state.texture = 0;
    if (seed % 2 == 0) state.fog = Fog{};
    builder.scene.states.push_back(state);
    builder.scene.textures.push_back(noise(random, 64, 64, TextureFormat::rgba8888, Mips::none));
    add_triangles(builder.scene, random, 1, 200, 10, 500);
    const TexelBlocks texels(builder.scene.textures.front());
    in_lanes += constants_of(builder.scene, with_colors("embedded"), &texels).are_in_lanes ? 1 : 0;
    narrow += constants_of(builder.scene, with_colors("full"), &texels).are_in_lanes ? 1 : 0;
  }
  EXPECT_EQ(in_lanes, 200);
  EXPECT_EQ(narrow, 200);
}

TEST(FunctionalSurface, SmallTrianglesOfUsualDrawsAreSetUpInLanes) {
  const auto is_in_lanes = [](const char* name, int width, const std::function<void(State&)>& change) {
    Random random(1);
    SceneBuilder builder(kWidth, kHeight);
    State state = SceneBuilder::window_state();
    state.texture = 0;
    change(state);
    builder.scene.states.push_back(state);
    builder.scene.textures.push_back(noise(random, width, 64, TextureFormat::rgba8888, Mips::none));
    add_triangles(builder.scene, random, 1, 5, 1, 50);
    const Config config = with_colors(name);
    const Widths widths = derive_widths(config);
    const PreparedScene prepared(builder.scene);
    const functional::FrameContext frame{prepared, config, widths, {}, 0, 0};
    const DrawContext context(builder.scene, config, std::get<Draw>(builder.scene.commands.back()), 0);
    return functional::SurfaceStyle(frame, context).is_in_lanes;
  };
  const auto keep = [](State&) {};
  const auto over_w = [](State& s) { s.color_interp = ColorInterp::perspective; };
  for (const char* name : {"tiny", "small", "embedded", "full"}) {
    EXPECT_TRUE(is_in_lanes(name, 64, keep)) << name;
    EXPECT_TRUE(is_in_lanes(name, 64, over_w)) << name;
  }
  EXPECT_FALSE(is_in_lanes("embedded", 60, keep));
  EXPECT_FALSE(is_in_lanes("embedded", 64, [&](State& s) { over_w(s), s.texture_interp = TextureInterp::affine; }));
  EXPECT_FALSE(is_in_lanes("embedded", 64, [](State& s) { s.fog = Fog{}; }));
}

}  // namespace
}  // namespace halfplane::functional_surface_test
