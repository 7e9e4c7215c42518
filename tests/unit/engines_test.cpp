// The functional engine against the stages, and both against themselves with work skipped.
#include <gtest/gtest.h>

#include "../scene_builder.hpp"
#include "model/capture/capture.hpp"
#include "model/engines/functional.hpp"
#include "model/engines/hardware.hpp"
#include "model/engines/scalar.hpp"
#include "sim/scene/builtin.hpp"

namespace halfplane::engines_test {
namespace {

using test::at;
using test::Random;
using test::SceneBuilder;

/// Overlapping triangles of all sizes and states in window space.
Scene random_scene(std::uint32_t seed, int width, int height) {
  Random random(seed);
  SceneBuilder builder(width, height);
  const double band = width < 16 ? 31.0 : 100.0;  // tiny's guard band is 32
  for (int n = 0; n < 60; ++n) {
    if (n % 6 == 0)
      builder.with_state(
          random_state(SceneBuilder::window_state(), states_but({"space", "pixel_center", "origin"}), chooser(random)));
    const double reach = std::exp2(random.between(-3, 6));
    const double x = random.between(0, width), y = random.between(0, height);
    std::array<Vertex, 3> v;
    for (auto& vertex : v) {
      const double dx = random.between(-reach, reach), dy = random.between(-reach, reach);
      vertex = at(std::clamp(x + dx, -31.0, band), std::clamp(y + dy, -31.0, band), random.unit());
      for (auto& channel : vertex.rgba) channel = random.between(0, 255);
    }
    builder.triangle(v[0], v[1], v[2]);
  }
  return builder.scene;
}

RenderOptions everything() {
  RenderOptions options;
  options.want_count = options.want_ids = options.want_triangles = true;
  return options;
}

void expect_same_image(const Rendering& a, const Rendering& b) {
  EXPECT_EQ(a.frame.depth, b.frame.depth);
  EXPECT_EQ(a.frame.color, b.frame.color);
  EXPECT_EQ(a.count, b.count);
  EXPECT_EQ(a.ids, b.ids);
  EXPECT_EQ(a.counters.depth_passed, b.counters.depth_passed);
  EXPECT_EQ(a.counters.written, b.counters.written);
  EXPECT_EQ(a.counters.primitives_in, b.counters.primitives_in);
  EXPECT_EQ(a.counters.drawn, b.counters.drawn);
  EXPECT_EQ(a.counters.culled, b.counters.culled);
  EXPECT_EQ(a.counters.clipped, b.counters.clipped);
}

/// A rectangle of 5 by 3 pixels whose corners are centres counted from integers, a line along its diagonal and a point.
std::string on_integer_centres(std::string_view origin) {
  return "halfplane 1\ntarget 16 16\nclear color 0 0 0 255 depth 1\nspace window\nstate pixel_center integer\nstate "
         "origin " +
         std::string(origin) +
         "\nv 3 4 0.5 1 255 0 0 255\nv 8 4 0.5 1 255 0 0 255\nv 8 7 0.5 1 255 0 0 255\nv 3 7 0.5 1 255 0 0 255\n"
         "v 10 10 0.5 1 0 255 0 255\nv 14 12 0.5 1 0 255 0 255\nv 1 2 0.5 1 0 0 255 255\n"
         "state cull none\nt 0 1 2\nt 0 2 3\nl 4 5\np 6\n";
}

TEST(Engines, IntegerCentresStayCentresWherePixelsAreNotDivided) {
  for (const std::string_view origin : {"top_left", "bottom_left"}) {
    const Scene scene = read_capture(on_integer_centres(origin), "integers");
    Config config = preset("embedded");
    config.color_format = ColorFormat::rgba8888;
    const Rendering divided = render_functional(scene, config);
    config.subpixel_bits = 0;
    const Rendering whole = render_functional(scene, config);
    EXPECT_EQ(whole.frame.color, divided.frame.color) << origin;
    EXPECT_EQ(render_scalar(scene, config).frame.color, whole.frame.color) << origin;
    EXPECT_EQ(render_hardware(scene, config).frame.color, whole.frame.color) << origin;
    int red = 0, green = 0;
    for (const std::uint32_t code : whole.frame.color) {
      red += code == 0xff0000ff ? 1 : 0;
      green += code == 0xff00ff00 ? 1 : 0;
    }
    EXPECT_EQ(red, 5 * 3) << "left and one of the level edges belong to it";
    EXPECT_EQ(green, 4) << "without its last pixel";
    const auto at_point = whole.frame.at(1, origin == "top_left" ? 2 : 13);
    EXPECT_EQ(whole.frame.color[at_point], 0xffff0000u) << origin;
  }
}

/// A triangle just beyond the right or the lower edge of a viewport, which lies `beyond` subpixels from pixel centres.
Scene beside_a_viewport(double beyond, bool is_below) {
  const double edge = 10.5 + beyond / 16, step = 1.0 / 1024;
  State state;
  state.viewport = Viewport{0, 0, edge, edge};
  test::SceneBuilder builder(24, 24, state);
  const auto at = [&](double along, double across) {  // pixels; clip coordinates of a vertex with w = 1
    const double x = 2 * along / edge - 1, y = 1 - 2 * across / edge;
    Vertex v;
    v.x = is_below ? 2 * across / edge - 1 : x;
    v.y = is_below ? 1 - 2 * along / edge : y;
    return v;
  };
  builder.triangle(at(edge + step, 2), at(edge + 5, 5), at(edge + step, 9));
  return builder.scene;
}

TEST(Engines, WhatSnapsToAPixelInsideOfTheViewportIsDrawnWhateverIsSkipped) {
  const Config config = preset("embedded");
  for (const bool is_below : {false, true})
    for (const double beyond : {0.25, 0.45, 0.75}) {
      SCOPED_TRACE(std::to_string(beyond) + (is_below ? ", below" : ", to the right"));
      const Scene scene = beside_a_viewport(beyond, is_below);
      RenderOptions without;
      without.skip = skip_none();
      const Rendering all = render_scalar(scene, config, without);
      EXPECT_EQ(all.counters.written, beyond < 0.5 ? 7u : 0u) << "half a subpixel is the end of it";
      for (const Rendering& rendering : {render_scalar(scene, config), render_functional(scene, config),
                                         render_functional(scene, config, without)}) {
        EXPECT_EQ(rendering.frame.color, all.frame.color);
        EXPECT_EQ(rendering.frame.depth, all.frame.depth);
      }
    }
}

TEST(Engines, FunctionalEqualsScalarOnRandomScenesOfEveryPresetAndTile) {
  std::uint64_t written = 0;
  for (std::uint32_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Config config = preset(preset_names()[seed % 3]);
    config.tile_size = 4 << seed / 3 % 4;
    config.stamp_size = 1 << seed % 3;
    if (seed % 5 == 0) config.depth_bits = 32;  // 64-bit lanes
    if (config.tile_size == 32) config.local_guard_bits = 7;
    const bool is_tiny = config.preset == "tiny";
    const Scene scene = random_scene(seed, is_tiny ? 15 : 61, is_tiny ? 13 : 47);
    const Rendering functional = render_functional(scene, config, everything());
    const Rendering scalar = render_scalar(scene, config, everything());
    expect_same_image(functional, scalar);
    EXPECT_EQ(functional.visible, scalar.visible);
    EXPECT_EQ(functional.counters.covered, scalar.counters.covered);
    EXPECT_EQ(functional.counters.samples_tested, scalar.counters.samples_tested);
    EXPECT_EQ(functional.counters.skipped.fragments_early_z, scalar.counters.skipped.fragments_early_z);
    EXPECT_EQ(functional.counters.skipped.tiles_outside, scalar.counters.skipped.tiles_outside);
    EXPECT_EQ(functional.counters.skipped.trivially_accepted, scalar.counters.skipped.trivially_accepted);
    written += functional.counters.written;
  }
  EXPECT_GT(written, 10000u);
}

TEST(Engines, FunctionalEqualsScalarOnBuiltinScenes) {
  for (const char* name : {"triangle", "teapot:4", "city:40", "knot:48", "coplanar", "slivers:60", "walk"}) {
    SCOPED_TRACE(name);
    const Scene scene = make_builtin(name, 160, 120, {}, 1);
    const Config config = preset("embedded");
    expect_same_image(render_functional(scene, config, everything()), render_scalar(scene, config, everything()));
  }
}

const Skip kSkipNothing = skip_none();

TEST(Skip, EachSwitchLeavesTheImageAloneAndItsCounterShowsTheWorkSaved) {
  const Scene scene = make_builtin("walk", 320, 240, {}, 1);
  const Config config = preset("embedded");
  RenderOptions options = everything();
  options.skip = kSkipNothing;
  const Rendering none = render_functional(scene, config, options);
  EXPECT_EQ(none.counters.skipped.frustum + none.counters.skipped.empty + none.counters.skipped.tiles_outside +
                none.counters.skipped.trivially_accepted + none.counters.skipped.fragments_early_z,
            0u);
  struct Case {
    const char* name;
    bool Skip::*member;
    std::uint64_t (*count)(const Counters&);
  };
  const Case cases[] = {
      {"frustum", &Skip::frustum, [](const Counters& c) { return c.skipped.frustum; }},
      {"tiles_outside", &Skip::tiles_outside, [](const Counters& c) { return c.skipped.tiles_outside; }},
      {"trivially_accepted", &Skip::trivially_accepted,
       [](const Counters& c) { return c.skipped.trivially_accepted; }}};
  for (const Case& skip : cases) {
    SCOPED_TRACE(skip.name);
    options.skip = kSkipNothing;
    options.skip.*skip.member = true;
    const Rendering one = render_functional(scene, config, options);
    expect_same_image(one, none);
    EXPECT_GT(skip.count(one.counters), 0u);
  }
  options.skip = {};
  const Rendering all = render_functional(scene, config, options);
  expect_same_image(all, none);
  EXPECT_LT(all.counters.samples_tested, none.counters.samples_tested / 2);
}

TEST(Skip, EmptyAndEarlyDepthSaveWorkWhereThereIsSome) {
  // A dense teapot: many triangles without a sample, many fragments behind others.
  const Scene scene = make_builtin("teapot:40", 120, 90, {}, 1);
  const Config config = preset("embedded");
  RenderOptions options = everything();
  const Rendering all = render_functional(scene, config, options);
  options.skip = kSkipNothing;
  const Rendering none = render_functional(scene, config, options);
  expect_same_image(all, none);
  EXPECT_GT(all.counters.skipped.empty, 1000u);
  EXPECT_GT(all.counters.skipped.fragments_early_z, 1000u);
  EXPECT_LT(all.counters.tiles_visited, none.counters.tiles_visited + 1);
}

TEST(Engines, TranslationByWholeTilesMovesTheImageBitForBit) {
  const Config config = preset("embedded");
  Random random(21);
  for (int n = 0; n < 50; ++n) {
    SceneBuilder here(96, 96), there(96, 96);
    std::array<Vertex, 3> v;
    for (auto& vertex : v) {
      const double x = random.between(1, 60), y = random.between(1, 60);
      vertex = at(x, y, random.unit());
      for (auto& channel : vertex.rgba) channel = random.between(0, 255);
    }
    here.triangle(v[0], v[1], v[2]);
    for (auto& vertex : v) {
      vertex.x += 24;
      vertex.y += 32;
    }
    there.triangle(v[0], v[1], v[2]);
    const Rendering a = render_functional(here.scene, config), b = render_functional(there.scene, config);
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 64; ++x) {
        ASSERT_EQ(a.frame.depth[a.frame.at(x, y)], b.frame.depth[b.frame.at(x + 24, y + 32)]) << n;
        ASSERT_EQ(a.frame.color[a.frame.at(x, y)], b.frame.color[b.frame.at(x + 24, y + 32)]) << n;
      }
  }
}

TEST(Engines, WindowVertexOutsideTheGuardBandIsReportedNotMoved) {
  const Config config = preset("tiny");
  const auto drawn_with = [&](double x, double z) {
    SceneBuilder builder(16, 16);
    builder.triangle(at(x, 1, z), at(5, 9), at(1, 9));
    return render_functional(builder.scene, config).counters.drawn;
  };
  EXPECT_EQ(drawn_with(-32, 0.5), 1u);
  EXPECT_EQ(drawn_with(31.75, 0.5), 1u);
  EXPECT_THROW((void)drawn_with(31.875, 0.5), InputError);  // snaps to 32
  EXPECT_THROW((void)drawn_with(-32.25, 0.5), InputError);
  EXPECT_THROW((void)drawn_with(1e300, 0.5), InputError);
  EXPECT_THROW((void)drawn_with(5, 1.1), InputError);
  EXPECT_THROW((void)drawn_with(5, -0.1), InputError);
}

TEST(Engines, WhatTheEngineDoesNotHaveIsNamed) {
  SceneBuilder builder(16, 16);
  State state = SceneBuilder::window_state();
  state.color_interp = ColorInterp::perspective;
  state.polygon_mode = PolygonMode::line;
  builder.with_state(state).triangle(at(1, 1), at(9, 1), at(1, 9));
  try {
    (void)render_functional(builder.scene, preset("embedded"));
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("color_interp perspective"), std::string::npos);
  }
}

TEST(Engines, ClipCoordinatesBeyondThePrecisionOfADoubleAreRefusedNotDrawnWrong) {
  const auto covered_with = [](double size) {
    SceneBuilder builder(64, 48, State());
    builder.triangle(test::clip_at(size, 0, 0, 1), test::clip_at(0, size, 0, 1), test::clip_at(-size, -size, 0, 1));
    return render_functional(builder.scene, preset("embedded")).counters.covered;
  };
  EXPECT_EQ(covered_with(1e9), 64u * 48u);
  EXPECT_THROW((void)covered_with(1e20), InputError);
  EXPECT_THROW((void)covered_with(1e306), InputError);
}

TEST(Engines, BothRefuseAnInvalidConfiguration) {
  Config config;
  config.tile_size = 0;
  const Scene scene = SceneBuilder(8, 8).scene;
  EXPECT_THROW((void)render_functional(scene, config), InputError);
  EXPECT_THROW((void)render_scalar(scene, config), InputError);
}

// The golden draws three pixels of it. One of 40,000 such had a corner that the program itself had cut 0.002 pixels outside.
TEST(Engines, ACornerThatTheClipperRoundsOutOfTheGuardBandIsOnItsBorder) {
  const Scene scene = read_capture(
      "halfplane 1\ntarget 16 16\n"
      "v 3.8848831263828816e-07 -3.510037437943299e-07 1.1609329471181735e-06 -5.155110394473423e-06\n"
      "v -204.2553592437494 317.08618782150154 -1276.382921277757 1001.7115690340133\n"
      "v -0.1543629653230717 0.14469632534883003 0.7722145815094605\nspace clip\nt 0 1 2\n",
      "corner");
  const Config config = preset("full");
  EXPECT_EQ(render_scalar(scene, config).counters.covered, 3u);
  EXPECT_EQ(render_functional(scene, config).counters.covered, 3u);
  EXPECT_EQ(render_hardware(scene, config).counters.covered, 3u);
}

// A triangle left of the view is cut by the near plane, at coordinates too large for a pixel of precision.
TEST(Engines, WhatMayBeSkippedDoesNotDecideWhatIsAccepted) {
  const auto scene = [](double x) {
    const std::string at = std::to_string(x);
    return read_capture("halfplane 1\ntarget 64 64\nclear color 0 0 0 255 depth 1\nv " + at + " 0 0 1e-12\nv " + at +
                            " 1 0 1e-12\nv " + at + " 0 -1 -1\nt 0 1 2\n",
                        "beside");
  };
  RenderOptions none;
  none.skip.frustum = false;
  for (const RenderOptions& options : {RenderOptions{}, none}) {
    EXPECT_EQ(render_scalar(scene(-1e9), preset("embedded"), options).counters.covered, 0u);
    EXPECT_EQ(render_functional(scene(-1e9), preset("embedded"), options).counters.covered, 0u);
  }
}

TEST(Engines, ATargetAsWideAsTheGuardBandLosesNoColumnToTheClipper) {
  for (const int subpixel_bits : {2, 4, 8}) {
    Config config = preset("embedded");
    config.guard_band = config.target_width = config.target_height = 64;
    config.subpixel_bits = subpixel_bits;
    SceneBuilder builder(64, 64, State{});
    using test::clip_at;
    builder.triangle(clip_at(-50, 50, 0, 1), clip_at(50, 50, 0, 1), clip_at(-50, -50, 0, 1));  // cut by every side
    builder.triangle(clip_at(50, 50, 0, 1), clip_at(50, -50, 0, 1), clip_at(-50, -50, 0, 1));
    for (const Rendering& r :
         {render_scalar(builder.scene, config, everything()), render_functional(builder.scene, config, everything())}) {
      EXPECT_EQ(r.counters.covered, 64u * 64u) << subpixel_bits;
      EXPECT_EQ(r.count, std::vector<std::uint32_t>(std::size_t{64} * 64, 1)) << subpixel_bits;
    }
  }
}

TEST(Engines, SceneWithoutAClearStartsFarAndBlack) {
  SceneBuilder builder(9, 5);
  builder.scene.commands.clear();
  const Rendering r = render_functional(builder.scene, preset("embedded"), everything());
  EXPECT_EQ(r.frame.depth[0], 65535u);
  EXPECT_EQ(r.frame.color[0], 0u);
  EXPECT_EQ(r.ids[0], -1);
}

}  // namespace
}  // namespace halfplane::engines_test
