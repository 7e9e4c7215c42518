// The functional engine's fast path against the scalar engine: image and program-order counters, whatever the thread
// count, the instruction set and the skips.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>

#include "../functional_case.hpp"
#include "../scene_builder.hpp"
#include "model/engines/functional/frame_renderer.hpp"
#include "sim/cosim/random_scene.hpp"
#include "sim/scene/builtin.hpp"
#include "sim/scene/depth_mapping.hpp"
#include "sim/scene/random_state.hpp"

namespace halfplane::functional_test {
namespace {

using test::expect_all_same;
using test::expect_same;

Config config_of(const char* name, int depth_bits) {
  Config config = preset(name);
  config.depth_bits = depth_bits;
  return config;
}

TEST(Functional, EveryKernelIsThisMachines) { EXPECT_STREQ(functional::available_kernels().back()->name, "portable"); }

TEST(Functional, BuiltinScenesAreTheSameOnEveryPath) {
  for (const Builtin& builtin : builtin_scenes()) {
    SCOPED_TRACE(builtin.name);
    expect_all_same(make_builtin(builtin.name, 200, 150, {}, 1), preset("embedded"));
    expect_all_same(make_builtin(builtin.name, 131, 77, {}, 1), config_of("full", 24));
  }
}

TEST(Functional, WorkScenesAreTheSameOnEveryPath) {
  for (const char* name : {"layers:24", "layers_front:24", "ball:40", "blocks:150", "scratches:800", "dust:30000",
                           "objects:64", "hidden:20", "shell"}) {
    SCOPED_TRACE(name);
    const Scene scene = make_builtin(name, 192, 130, {}, 1);
    expect_all_same(scene, config_of("embedded", 16));
    expect_all_same(scene, config_of("embedded", 24));
  }
}

/// Triangles, lines and points of one random scene, all of which take this test and these masks.
Scene with_fragments(const Config& config, std::uint64_t seed, DepthFunc func, bool depth_write, bool color_write) {
  Scene scene = random_scene(config, seed, 120);
  for (State& state : scene.states) {
    state.depth_test = func;
    state.depth_write = depth_write;
    state.color_write = color_write;
  }
  return scene;
}

TEST(Functional, EveryDepthTestAndMaskIsTheSameWithOpaqueAndWithGeneralFragments) {
  std::uint64_t seed = 1;
  for (const char* name : {"embedded", "full"})
    for (const DepthFunc func : {DepthFunc::never, DepthFunc::less, DepthFunc::lequal, DepthFunc::equal,
                                 DepthFunc::greater, DepthFunc::gequal, DepthFunc::notequal, DepthFunc::always})
      for (const bool depth_write : {false, true})
        for (const bool color_write : {false, true}) {
          SCOPED_TRACE(std::string(name) + ", seed " + std::to_string(seed) + ", test " +
                       std::to_string(static_cast<int>(func)) + (depth_write ? ", depth" : "") +
                       (color_write ? ", colour" : ""));
          const Config config = preset(name);
          expect_all_same(with_fragments(config, seed++, func, depth_write, color_write), config);
        }
}

TEST(Functional, GeneralFragmentsLeaveNothingOutAndTakeNoTileWhole) {
  const Scene scene = make_builtin("layers:24", 192, 130, {}, 1);
  FunctionalEngine engine(preset("embedded"));
  RenderOptions options;
  const Counters opaque = engine.render(scene, options).counters;
  options.general_fragments = true;
  const Counters general = engine.render(scene, options).counters;
  EXPECT_GT(opaque.skipped.trivially_accepted, 0U);
  EXPECT_GT(opaque.skipped.attributes, 0U);
  EXPECT_EQ(general.skipped.trivially_accepted, 0U);
  EXPECT_EQ(general.skipped.attributes, 0U);
  EXPECT_EQ(general.skipped.tiles_hiz, 0U);
  EXPECT_EQ(general.depth_passed, opaque.depth_passed);
}

TEST(Functional, ReversedDepthIsTheSameOnEveryPath) {
  Config config = preset("embedded");
  config.depth_mapping = DepthMapping::rev;
  for (const char* name : {"city", "ball:30", "blocks:60"}) {
    SCOPED_TRACE(name);
    expect_all_same(in_depth_mapping(make_builtin(name, 160, 120, {}, 1), config.depth_mapping), config);
  }
}

TEST(Functional, RandomScenesAreTheSameOnEveryPath) {
  for (const char* name : {"tiny", "embedded", "small", "full"})
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      SCOPED_TRACE(std::string(name) + ", seed " + std::to_string(seed));
      const Config config = preset(name);
      expect_all_same(random_scene(config, seed, 300), config);
    }
}

/// Triangles of all sizes, lines and points whose states take any fragment operations.
TEST(Functional, EveryFragmentOperationIsTheSameOnEveryPath) {
  std::uint64_t written = 0, killed = 0;
  for (const char* name : {"tiny", "embedded", "full"})
    for (const bool has_alpha : {false, true})
      for (std::uint64_t seed = 1; seed <= 12; ++seed) {
        Config config = preset(name);
        config.color_format = has_alpha ? ColorFormat::rgba8888 : ColorFormat::rgb565;
        SCOPED_TRACE(std::string(name) + (has_alpha ? " rgba8888" : " rgb565") + ", seed " + std::to_string(seed));
        Scene scene = random_scene(config, seed, 300);
        test::Random random(static_cast<std::uint32_t>(seed));
        const StateRows rows = seed % 3 == 0 ? states_named({"alpha_test", "blend", "blend_equation", "blend_color",
                                                             "color_mask", "stencil", "stencil_back", "dither"})
                               : seed % 3 == 1
                                   ? states_named({"blend", "blend_equation", "blend_color", "color_mask", "dither"})
                                   : states_named({"alpha_test", "blend"});
        for (State& state : scene.states) state = random_state(state, rows, chooser(random));
        for (Vertex& vertex : scene.vertices) vertex.rgba[3] = random.index(256);
        expect_all_same(scene, config);
        const Counters counters = render_functional(scene, config).counters;
        written += counters.written;
        killed += counters.alpha_killed;
      }
  EXPECT_GT(written, 10000U);
  EXPECT_GT(killed, 1000U);
}

/// Triangles of all sizes, textured or not, lines and dots under logic operations.
TEST(Functional, EveryLogicOperationIsTheSameOnEveryPath) {
  std::size_t draws = 0;
  for (const char* settings :
       {"tiny", "embedded", "embedded color.format=rgba8888", "embedded texture.unit=bilinear", "full msaa.samples=4"})
    for (std::uint64_t seed = 21; seed <= 26; ++seed) {
      const Config config = labelled(settings);
      SCOPED_TRACE(std::string(settings) + ", seed " + std::to_string(seed));
      Scene scene = random_scene(config, seed, 300);
      test::Random random(static_cast<std::uint32_t>(seed));
      const StateRows rows = states_named({"color_mask", "dither", "alpha_test", "stencil"});
      for (State& state : scene.states) {
        if (seed % 3 == 0) state = random_state(state, rows, chooser(random));
        state.logic_op = static_cast<LogicOp>(draws++ % 16);
      }
      for (Vertex& vertex : scene.vertices) vertex.rgba[3] = random.index(256);
      expect_all_same(scene, config);
    }
  EXPECT_GT(draws, 16 * 15U);
}

/// Lines show their front, whatever the triangle before them showed; a clear leaves the padding of the target alone.
TEST(Functional, LinesBehindATriangleThatShowsItsBackTakeTheFrontOfTheStencil) {
  State state = test::SceneBuilder::window_state();
  state.depth_test = DepthFunc::always;
  state.stencil = Stencil{.reference = 3, .passes = StencilOp::replace};
  state.stencil_back = Stencil{.reference = 9, .passes = StencilOp::replace};
  for (const FrontFace front : {FrontFace::ccw, FrontFace::cw}) {
    state.front = front;
    test::SceneBuilder builder(53, 45, state);
    Scene& scene = builder.scene;
    scene.commands.insert(scene.commands.begin(), Clear{0, {}, {}, std::uint8_t{5}});
    builder.triangle(test::at(2, 2, 0.5), test::at(40, 4, 0.5), test::at(5, 40, 0.5));
    for (const auto& [x, y] : {std::pair{1.0, 30.0}, {50.0, 31.0}, {20.0, 1.0}, {22.0, 44.0}}) {
      scene.indices.push_back(static_cast<std::uint32_t>(scene.vertices.size()));
      scene.vertices.push_back(test::at(x, y, 0.25));
    }
    const auto drawn = static_cast<std::uint32_t>(scene.states.size() - 1);
    scene.commands.push_back(Draw{drawn, 0, Topology::lines, scene.indices.size() - 4, 4, 0});
    expect_all_same(scene, preset("embedded"));
    const Rendering rendering = render_functional(scene, preset("embedded"));
    EXPECT_EQ(rendering.frame.stencil[rendering.frame.at(45, 30)], 3) << "on the line alone";
    EXPECT_EQ(rendering.frame.stencil[rendering.frame.at(52, 44)], 5) << "cleared";
  }
}

/// The blend that most draws ask for has a way of its own.
TEST(Functional, LayersOfGlassAreTheSameOnEveryPath) {
  for (const auto format : {ColorFormat::rgb565, ColorFormat::rgba8888}) {
    Config config = preset("embedded");
    config.color_format = format;
    Scene scene = make_builtin("layers:24", 192, 130, {}, 1);
    for (State& state : scene.states) {
      state.blend = BlendFactors{BlendFactor::src_alpha, BlendFactor::one_minus_src_alpha, BlendFactor::src_alpha,
                                 BlendFactor::one_minus_src_alpha};
      state.depth_write = false;
    }
    for (std::size_t i = 0; i < scene.vertices.size(); ++i)
      scene.vertices[i].rgba[3] = static_cast<double>(i * 37 % 256);
    expect_all_same(scene, config);
  }
}

/// The layers of a built-in scene, blended by alpha; `alpha` of vertex i.
template <class Alpha>
Scene glass_of(const char* name, bool writes_depth, Alpha&& alpha) {
  Scene scene = make_builtin(name, 192, 130, {}, 1);
  for (State& state : scene.states) {
    state.blend = BlendFactors{BlendFactor::src_alpha, BlendFactor::one_minus_src_alpha, BlendFactor::one,
                               BlendFactor::one_minus_src_alpha};
    state.depth_write = writes_depth;
  }
  for (std::size_t i = 0; i < scene.vertices.size(); ++i) scene.vertices[i].rgba[3] = alpha(i);
  return scene;
}

Config config_with(ColorFormat format, int depth_bits = 16) {
  Config config = config_of("embedded", depth_bits);
  config.color_format = format;
  return config;
}

/// Large triangles, small ones and lines, some of glass, some opaque, some of both, some with a texture: waiting colours must
/// be there when another primitive needs them. More layers than wait at a time.
TEST(Functional, LayersThatWaitAreThereForWhateverComesNext) {
  for (std::uint32_t seed = 1; seed <= 8; ++seed)
    for (const auto format : {ColorFormat::rgb565, ColorFormat::rgba8888}) {
      SCOPED_TRACE("seed " + std::to_string(seed) + (format == ColorFormat::rgb565 ? ", rgb565" : ", rgba8888"));
      test::Random random(seed);
      Scene scene = glass_of("layers_nearest:60", seed % 2 == 0, [&](std::size_t i) {
        return i / 3 % 4 == 0 ? 255.0 : static_cast<double>(random.index(256));
      });
      const State textured = scene.states[0];
      State glass = textured;
      glass.texture.reset();
      State plain = glass;
      plain.blend.reset();
      plain.depth_write = true;
      scene.states = {glass, plain, textured};
      for (State& state : scene.states) state.depth_test = seed % 3 == 0 ? DepthFunc::always : DepthFunc::lequal;
      const Draw whole = std::get<Draw>(scene.commands.back());
      scene.commands.pop_back();
      for (std::size_t first = 0; first < whole.count;) {
        Draw draw = whole;
        draw.first = first;
        draw.count = std::min<std::size_t>(3 * (1 + static_cast<std::size_t>(random.index(25))), whole.count - first);
        draw.state = std::array<std::uint32_t, 6>{0, 0, 0, 1, 2, 0}[static_cast<std::size_t>(random.index(6))];
        if (random.index(5) == 0) draw.topology = Topology::lines, draw.count -= draw.count % 2;
        first += draw.count;
        scene.commands.emplace_back(draw);
      }
      expect_all_same(scene, config_with(format, seed % 4 < 2 ? 16 : 24));
    }
}

TEST(Functional, SmallTrianglesOfGlassAreTheSameOnEveryPath) {
  for (const char* name : {"ball:40", "dust:20000", "teapot"})
    for (const auto format : {ColorFormat::rgb565, ColorFormat::rgba8888})
      for (const bool writes_depth : {false, true}) {
        SCOPED_TRACE(std::string(name) + (format == ColorFormat::rgb565 ? ", rgb565" : ", rgba8888"));
        const auto alpha = [](std::size_t i) { return i % 5 == 0 ? 255.0 : static_cast<double>(i * 37 % 256); };
        expect_all_same(glass_of(name, writes_depth, alpha), config_with(format));
      }
}

/// Known bounds of a triangle's alpha, and of a tile's, may allow skipping the alpha test.
TEST(Functional, EveryAlphaTestOfAlphaThatFadesIsTheSameOnEveryPath) {
  for (const DepthFunc func : {DepthFunc::never, DepthFunc::less, DepthFunc::lequal, DepthFunc::equal,
                               DepthFunc::greater, DepthFunc::gequal, DepthFunc::notequal})
    for (const bool blends : {false, true}) {
      SCOPED_TRACE("test " + std::to_string(static_cast<int>(func)) + (blends ? ", blended" : ""));
      Scene scene = glass_of("layers:24", !blends, [](std::size_t i) {
        return std::array{0.0, 100.0, 255.0, 128.0, 128.0, 128.0, 255.0, 255.0, 255.0, 200.0, 129.0, 127.0}[i % 12];
      });
      for (State& state : scene.states) {
        state.alpha_test = {func, 128};
        if (!blends) state.blend.reset();
      }
      expect_all_same(scene, config_with(ColorFormat::rgba8888));
    }
}

/// Large, small and tiny triangles, textured or not, blended ones and lines.
TEST(Functional, DitheredDrawsLeaveOutWhatOthersLeaveOut) {
  const Config config = config_with(ColorFormat::rgb565);
  for (const char* name : {"layers:24", "layers_glass:24", "layers_linear:6", "ball:40", "ball_linear:40", "dust:20000",
                           "scratches:200", "city"}) {
    SCOPED_TRACE(name);
    const Scene plain = make_builtin(name, 192, 130, {}, 1);
    Scene dithered = plain;
    for (State& state : dithered.states) state.dither = true;
    expect_all_same(dithered, config);
    const Rendering with = render_functional(dithered, config), without = render_functional(plain, config);
    EXPECT_NE(with.frame.color, without.frame.color);
    const Counters::Skipped &of = with.counters.skipped, &expected = without.counters.skipped;
    EXPECT_EQ(of.attributes, expected.attributes);
    EXPECT_EQ(of.trivially_accepted, expected.trivially_accepted);
    EXPECT_EQ(of.tiles_hiz, expected.tiles_hiz);
    EXPECT_EQ(of.operations_early_z, expected.operations_early_z);
  }
}

TEST(Functional, BlendsOfOpaqueTrianglesAreDrawnAsIfNothingWereBlended) {
  const Config config = config_with(ColorFormat::rgba8888);
  const Scene glass = glass_of("layers:24", true, [](std::size_t) { return 255.0; });
  Scene plain = glass;
  for (State& state : plain.states) state.blend.reset();
  const Rendering blended = render_functional(glass, config), opaque = render_functional(plain, config);
  expect_same(blended, opaque);
  EXPECT_GT(opaque.counters.skipped.attributes, 0U);
  EXPECT_EQ(blended.counters.skipped.attributes, opaque.counters.skipped.attributes) << "tiles are taken, colours wait";
  EXPECT_EQ(blended.counters.skipped.trivially_accepted, opaque.counters.skipped.trivially_accepted);
  EXPECT_EQ(blended.counters.skipped.opaque_blends, blended.counters.depth_passed);
  EXPECT_EQ(opaque.counters.skipped.opaque_blends, 0U);
  // One vertex of another alpha, and the triangle blends.
  Scene almost = glass;
  for (std::size_t i = 0; i < almost.vertices.size(); i += 3) almost.vertices[i].rgba[3] = 254;
  EXPECT_EQ(render_functional(almost, config).counters.skipped.opaque_blends, 0U);
}

TEST(Functional, TheWidestReciprocalsAreTheSameOnEveryPath) {
  for (const int extra : {3, 5, 6}) {
    Config config = config_of("full", 24);
    config.reciprocal_extra_bits = extra;
    SCOPED_TRACE("reciprocal of " + std::to_string(24 + extra) + " bits");
    for (const char* name : {"ball:24", "dust:3000", "blocks:30"})
      expect_all_same(make_builtin(name, 128, 96, {}, 1), config);
  }
}

/// Hard places of lines: on borders of bins, tiles, pixels and rows, along the axes and the diagonals, shorter than a
/// pixel, over the whole depth range; wide, fogged and flat ones, too. `step`: pixels between the coordinates' neighbours.
Scene hard_lines(std::uint32_t seed, int width, int height, double step) {
  test::Random random(seed);
  test::SceneBuilder builder(width, height);
  const auto near = [&](int size) {
    constexpr std::array kGrids{64.0, 8.0, 1.0, 0.5};
    const double grid = kGrids[static_cast<std::size_t>(random.index(4))];
    return std::floor(random.between(0, size) / grid) * grid + (random.index(5) - 2) * step;
  };
  Scene& scene = builder.scene;
  for (int n = 0; n < 12; ++n) {
    State state = test::SceneBuilder::window_state();
    state.depth_test = random.index(2) == 0 ? DepthFunc::always : DepthFunc::less;
    state.line_rule =
        std::array{LineRule::diamond, LineRule::midpoint, LineRule::bresenham}[static_cast<std::size_t>(n % 3)];
    if (n >= 9) state.line_width = n - 7;  // the others go through the host's geometry, too, with fog
    if (n >= 6 && n < 9) state.fog = Fog{FogKind::linear, 0, 2};
    if (n % 2 == 0) state.shade = Shade::flat;
    scene.states.push_back(state);
    scene.commands.push_back(
        Draw{static_cast<std::uint32_t>(scene.states.size() - 1), 0, Topology::lines, scene.indices.size(), 60, 0});
    for (int line = 0; line < 30; ++line) {
      const double x = near(width), y = near(height), by = random.index(2) == 0 ? 1.5 * random.unit() : near(100);
      const std::array<std::array<double, 2>, 6> ways{
          {{by, 0}, {0, by}, {by, by}, {by, -by}, {by, near(70)}, {step, 0}}};
      const auto& way = ways[static_cast<std::size_t>(random.index(6))];
      const double sign = random.index(2) == 0 ? 1 : -1;
      for (const Vertex& v :
           {test::at(x, y, random.unit()), test::at(x + sign * way[0], y + sign * way[1], random.unit())}) {
        scene.indices.push_back(static_cast<std::uint32_t>(scene.vertices.size()));
        scene.vertices.push_back(v);
        for (double& channel : scene.vertices.back().rgba) channel = random.index(256);
      }
    }
  }
  return scene;
}

TEST(Functional, LinesOnBordersAndShorterThanAPixelAreTheSameOnEveryPath) {
  for (const auto& [name, depth_bits, subpixel_bits] :
       {std::tuple{"embedded", 16, 4}, {"embedded", 18, 0}, {"embedded", 24, 1}, {"small", 16, 2}, {"full", 24, 8}})
    for (std::uint32_t seed = 1; seed <= 6; ++seed) {
      Config config = config_of(name, depth_bits);
      config.subpixel_bits = subpixel_bits;
      SCOPED_TRACE(std::string(name) + ", depth.bits " + std::to_string(depth_bits) + ", seed " + std::to_string(seed));
      expect_all_same(hard_lines(seed, 200, 150, std::ldexp(1.0, -subpixel_bits)), config);
    }
}

/// Triangles of every way through the raster, in runs of a few and of many of one size: pixels, tiles and bins wide, with
/// corners on and beside their borders, with each depth test.
Scene triangles_of_all_sizes(std::uint32_t seed, int width, int height, double step) {
  test::Random random(seed);
  test::SceneBuilder builder(width, height);
  Scene& scene = builder.scene;
  constexpr std::array kTests{DepthFunc::less,     DepthFunc::lequal, DepthFunc::greater, DepthFunc::less,
                              DepthFunc::notequal, DepthFunc::less,   DepthFunc::gequal,  DepthFunc::always};
  for (const DepthFunc depth_test : kTests) {
    State state = test::SceneBuilder::window_state();
    state.depth_test = depth_test;
    state.depth_write = random.index(4) != 0;
    state.color_write = random.index(4) != 0;
    state.shade = random.index(4) == 0 ? Shade::flat : state.shade;
    scene.states.push_back(state);
    const std::size_t first = scene.indices.size();
    for (int run = 0; run < 12; ++run) {
      constexpr std::array kSizes{2.0, 7.0, 17.0, 24.0, 31.0, 33.0, 90.0};
      const double size = kSizes[static_cast<std::size_t>(random.index(7))];
      const int count = random.index(3) == 0 ? 40 : 1 + random.index(5);
      for (int n = 0; n < count; ++n) {
        const double x = random.between(-8, width), y = random.between(-8, height);
        for (int corner = 0; corner < 3; ++corner) {
          const double grid = random.index(3) == 0 ? 8.0 : step;
          const double vx = std::floor((x + size * random.unit()) / grid) * grid,
                       vy = std::floor((y + size * random.unit()) / grid) * grid;
          scene.indices.push_back(static_cast<std::uint32_t>(scene.vertices.size()));
          scene.vertices.push_back(test::at(vx, vy, random.index(4) == 0 ? 0.5 : random.unit()));
          for (double& channel : scene.vertices.back().rgba) channel = random.index(256);
        }
      }
    }
    scene.commands.push_back(Draw{static_cast<std::uint32_t>(scene.states.size() - 1), 0, Topology::triangles, first,
                                  scene.indices.size() - first, 0});
  }
  return scene;
}

TEST(Functional, TrianglesOfAllSizesAreTheSameOnEveryPath) {
  for (const auto& [name, depth_bits, subpixel_bits] : {std::tuple{"embedded", 16, 4},
                                                        {"embedded", 16, 0},
                                                        {"embedded", 24, 3},
                                                        {"small", 16, 2},
                                                        {"full", 24, 8},
                                                        {"full", 16, 12},
                                                        {"full", 25, 10}})
    for (std::uint32_t seed = 1; seed <= 4; ++seed) {
      Config config = config_of(name, depth_bits);
      config.subpixel_bits = subpixel_bits;
      config.target_width = config.target_height = 256;
      config.guard_band = std::min(config.guard_band, 1024);
      SCOPED_TRACE(std::string(name) + ", depth.bits " + std::to_string(depth_bits) + ", subpixel.bits " +
                   std::to_string(subpixel_bits) + ", seed " + std::to_string(seed));
      const Scene scene = triangles_of_all_sizes(seed, 200, 150, std::ldexp(1.0, -subpixel_bits));
      EXPECT_TRUE(functional::is_supported(scene, config, {}));
      expect_all_same(scene, config);
    }
}

/// Where the lanes of depths change, and with depths at both ends of the codes: a third of the vertices.
TEST(Functional, DepthsOfAboutSixteenBitsAreTheSameOnEveryPath) {
  for (const char* name : {"embedded", "full"})
    for (const int depth_bits : {12, 14, 15, 16, 17, 18})
      for (std::uint32_t seed = 1; seed <= 2; ++seed) {
        Config config = config_of(name, depth_bits);
        config.target_width = config.target_height = 256;
        config.guard_band = std::min(config.guard_band, 1024);
        SCOPED_TRACE(std::string(name) + ", depth.bits " + std::to_string(depth_bits) + ", seed " +
                     std::to_string(seed));
        Scene scene = triangles_of_all_sizes(seed, 200, 150, std::ldexp(1.0, -config.subpixel_bits));
        for (Vertex& v : scene.vertices) v.z = std::clamp(1.5 * v.z - 0.25, 0.0, 1.0);
        EXPECT_TRUE(functional::is_supported(scene, config, {}));
        expect_all_same(scene, config);
      }
}

TEST(Functional, ClearsThatNobodyDrewOnAreCountedByTileOfTheTarget) {
  Scene scene = make_builtin("triangle", 20, 9, {}, 1);  // three by two tiles
  scene.commands.pop_back();
  const Config config = preset("embedded");
  EXPECT_EQ(render_functional(scene, config).counters.skipped.clear, 12u) << "the empty target's and the scene's own";
  scene.commands.push_back(scene.commands.front());
  EXPECT_EQ(render_functional(scene, config).counters.skipped.clear, 18u);
}

TEST(Functional, AnObjectBehindIsRefusedAllTheSame) {
  Scene scene = make_builtin("hidden:6", 160, 120, {}, 1);
  const Config config = preset("embedded");
  EXPECT_GT(render_functional(scene, config).counters.skipped.objects_hiz, 3u);
  scene.vertices[scene.indices.back()].y = 2e300;
  EXPECT_THROW((void)render_scalar(scene, config), InputError);
  EXPECT_THROW((void)render_functional(scene, config), InputError);
}

/// One kind of skipping at a time leaves the image alone, on a scene where it finds something to skip.
TEST(Functional, EachSwitchLeavesTheImageAloneAndItsCounterShowsTheWorkSaved) {
  struct Case {
    const char* name;
    const char* scene;
    bool Skip::*member;
    std::uint64_t (*count)(const Counters&);
  };
  const Case cases[] = {
      {"frustum", "walk", &Skip::frustum, [](const Counters& c) { return c.skipped.frustum; }},
      {"backface", "ball:40", &Skip::backface, [](const Counters& c) { return c.skipped.backface; }},
      {"empty", "teapot:40", &Skip::empty, [](const Counters& c) { return c.skipped.empty; }},
      {"no_sample", "dust:100000", &Skip::no_sample, [](const Counters& c) { return c.skipped.no_sample; }},
      {"objects_hiz", "hidden:20", &Skip::objects_hiz, [](const Counters& c) { return c.skipped.objects_hiz; }},
      {"tiles_hiz", "layers_front:20", &Skip::tiles_hiz, [](const Counters& c) { return c.skipped.tiles_hiz; }},
      {"tiles_outside", "slivers", &Skip::tiles_outside, [](const Counters& c) { return c.skipped.tiles_outside; }},
      {"trivially_accepted", "layers:20", &Skip::trivially_accepted,
       [](const Counters& c) { return c.skipped.trivially_accepted; }},
      {"attributes", "layers:20", &Skip::attributes, [](const Counters& c) { return c.skipped.attributes; }},
      {"clear", "teapot", &Skip::clear, [](const Counters& c) { return c.skipped.clear; }}};
  const Config config = preset("embedded");
  for (const Case& one : cases) {
    SCOPED_TRACE(one.name);
    const Scene scene = make_builtin(one.scene, 200, 150, {}, 1);
    const Rendering scalar = render_scalar(scene, config);
    RenderOptions without;
    without.skip.*one.member = false;
    const Rendering all = render_functional(scene, config), off = render_functional(scene, config, without);
    expect_same(all, scalar);
    expect_same(off, scalar);
    EXPECT_GT(one.count(all.counters), 0u);
    RenderOptions alone;
    alone.skip = skip_none();
    alone.skip.*one.member = true;
    expect_same(render_functional(scene, config, alone), scalar);
  }
}

/// The same of draws with operations.
TEST(Functional, EachSwitchOfOperationsLeavesTheImageAloneAndItsCounterShowsTheWorkSaved) {
  const auto glass = [](std::size_t i) { return 85 + static_cast<double>(i * 37 % 86); };
  Scene behind = glass_of("layers_front:24", false, glass);
  State wall = behind.states[0];
  wall.blend.reset();
  wall.depth_write = true;
  behind.states.push_back(wall);
  Draw rest = std::get<Draw>(behind.commands.back());
  auto& first = std::get<Draw>(behind.commands.back());
  first.count = 6;
  first.state = 1;
  rest.first += 6;
  rest.count -= 6;
  behind.commands.emplace_back(rest);
  Scene faint = glass_of("layers:24", true, [](std::size_t i) { return 127.5 * static_cast<double>(i % 3); });
  for (State& state : faint.states) state.alpha_test = {DepthFunc::gequal, 128};
  const Scene opaque = glass_of("layers:24", true, [](std::size_t) { return 255.0; });
  Scene masked = glass_of("layers:24", true, glass);
  for (State& state : masked.states) state.color_mask = {false, false, false, false};
  struct Case {
    const char* name;
    const Scene& scene;
  };
  for (const Case& one : {Case{"operations_early_z", behind}, Case{"alpha_tiles", faint}, Case{"opaque_blends", opaque},
                          Case{"masked_draws", masked}}) {
    SCOPED_TRACE(one.name);
    const SkipName& name =
        *std::ranges::find_if(kSkipNames, [&](const SkipName& entry) { return std::string(entry.name) == one.name; });
    for (const auto format : {ColorFormat::rgb565, ColorFormat::rgba8888}) {
      const Config config = config_with(format);
      const Rendering scalar = render_scalar(one.scene, config);
      RenderOptions off, alone;
      off.skip.*name.member = false;
      alone.skip = skip_none();
      alone.skip.*name.member = true;
      const Rendering all = render_functional(one.scene, config), without = render_functional(one.scene, config, off);
      expect_same(all, scalar);
      expect_same(without, scalar);
      expect_same(render_functional(one.scene, config, alone), scalar);
      EXPECT_GT(all.counters.skipped.*name.counter, 0U);
      EXPECT_EQ(without.counters.skipped.*name.counter, 0U);
    }
  }
}

TEST(Functional, AnEngineForgetsTheFrameBefore) {
  const Config config = preset("embedded");
  FunctionalEngine engine(config);
  for (const char* name : {"teapot", "triangle", "city", "star", "teapot", "layers:8"}) {
    SCOPED_TRACE(name);
    const Scene scene = make_builtin(name, 160, 120, {}, 1);
    expect_same(engine.render(scene), render_scalar(scene, config));
  }
  const Scene small = make_builtin("teapot", 61, 43, {}, 1);
  expect_same(engine.render(small), render_scalar(small, config));
}

TEST(Functional, TheFirstErrorIsReportedWhateverTheThreads) {
  Scene scene = make_builtin("dust:20000", 160, 120, {}, 1);
  scene.vertices[scene.indices[scene.indices.size() - 1]].x = 1e301;
  scene.vertices[scene.indices[scene.indices.size() / 2]].x = 1e302;
  const Config config = preset("embedded");
  std::string expected;
  try {
    (void)render_scalar(scene, config);
  } catch (const InputError& error) {
    expected = error.what();
  }
  ASSERT_FALSE(expected.empty());
  for (const int threads : {1, 4}) {
    RenderOptions options;
    options.threads = threads;
    try {
      (void)render_functional(scene, config, options);
      FAIL() << "nothing was refused";
    } catch (const InputError& error) {
      EXPECT_EQ(error.what(), expected);
    }
  }
}

}  // namespace
}  // namespace halfplane::functional_test
