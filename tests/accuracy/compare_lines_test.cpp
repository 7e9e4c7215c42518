// Tests of the comparison for lines and points: figures that must be zero are zero, the snap explains differences from
// the golden, and wrong engines are caught.
#include <gtest/gtest.h>

#include <cmath>

#include "../scene_builder.hpp"
#include "model/engines/functional.hpp"
#include "sim/study/compare/compare.hpp"

namespace halfplane::compare_lines_test {
namespace {

using test::at;
using test::clip_at;
using test::Random;
using test::SceneBuilder;

constexpr int kWidth = 48, kHeight = 44;

/// The real engine with modified output: `tap` may change a pixel, or drop it (false).
CompareOptions with_engine(std::function<bool(std::uint32_t primitive, int& x, int& y)> tap,
                           std::function<void(Rendering&)> damage = {}) {
  CompareOptions options;
  options.engine = [tap, damage](const Scene& scene, const Config& config, const RenderOptions& asked) {
    RenderOptions changed = asked;
    changed.pixel_tap = [&asked, &tap](std::uint32_t primitive, int x, int y) {
      if (!tap || tap(primitive, x, y)) asked.pixel_tap(primitive, x, y);
    };
    Rendering rendering = render_functional(scene, config, changed);
    if (damage) damage(rendering);
    return rendering;
  };
  return options;
}

/// Random lines, strips, loops and points. `grid`: coordinates per pixel; 0: anywhere.
Scene random_scene(std::uint32_t seed, int grid) {
  Random random(seed);
  Scene scene = SceneBuilder(kWidth, kHeight).scene;
  for (int d = 0; d < 6; ++d) {
    State state = SceneBuilder::window_state();
    state.line_rule = static_cast<LineRule>(random.index(3));
    if (random.index(2) == 0) state.line_last = random.index(2) == 0;
    state.point_size = grid == 0 ? random.between(1, 7) : 1 + random.index(5 * grid) / static_cast<double>(grid);
    if (d % 2 == 1) state.line_width = 1 + random.index(12) / 2.0;
    if (d % 3 == 1) state.point_shape = PointShape::round;
    state.depth_write = random.index(4) != 0;
    state.color_write = random.index(4) != 0;
    if (random.index(3) == 0) state.scissor = Rect{random.index(20), random.index(20), 1 + random.index(25), 17};
    scene.states.push_back(state);
    const std::size_t first = scene.indices.size();
    for (int i = 3 + random.index(5); i > 0; --i) {
      scene.indices.push_back(static_cast<std::uint32_t>(scene.vertices.size()));
      const auto coordinate = [&] {
        const double v = random.between(-8, kWidth + 8);
        return grid == 0 ? v : std::floor(v * grid) / grid;
      };
      const double x = coordinate(), y = coordinate(), z = random.index(65536) / 65535.0;
      const auto channel = [&] { return static_cast<double>(random.index(256)); };
      scene.vertices.push_back(at(x, y, z, {channel(), channel(), channel(), channel()}));
      if (random.index(8) == 0) scene.indices.push_back(kRestart);
    }
    scene.commands.push_back(Draw{static_cast<std::uint32_t>(scene.states.size() - 1), 0,
                                  static_cast<Topology>(3 + random.index(4)), first, scene.indices.size() - first, 0});
  }
  return scene;
}

TEST(CompareLines, VerticesOnTheGridDifferFromTheGoldenInNoPixelAndHoldEveryBound) {
  for (const auto name : {"embedded", "full"}) {
    const Config config = preset(name);
    std::uint64_t compared = 0;
    double worst = 0;
    for (std::uint32_t seed = 1; seed <= 60; ++seed) {
      SCOPED_TRACE(std::string(name) + ", seed " + std::to_string(seed));
      const Comparison c = compare(random_scene(seed, 1 << config.subpixel_bits), config);
      EXPECT_EQ(c.coverage.missing + c.coverage.extra, 0u);
      EXPECT_EQ(c.other_visible, 0u);
      EXPECT_EQ(c.oracle.mismatches, 0u);
      EXPECT_EQ(c.stage_mismatches, 0u);
      EXPECT_TRUE(broken_bounds(c, config).empty()) << broken_bounds(c, config).front();
      if (config.depth_bits == 16) {  // then z lies on the grid too; the grid of the parts is 2^-20
        EXPECT_LE(c.parts.snap.max, 2e-6);
      }
      EXPECT_GT(c.oracle.samples, c.compared_pixels);
      compared += c.compared_pixels;
      worst = std::max(worst, c.line_datapath.max);
    }
    EXPECT_GT(compared, 10000u);
    EXPECT_GT(worst, 0.4);
    RecordProperty(std::string(name) + "_depth", std::to_string(worst));
  }
}

TEST(CompareLines, VerticesAnywhereDifferOnlyWhereTheSnapMayDecide) {
  for (const int subpixel_bits : {0, 2, 4, 8}) {
    Config config = preset("full");
    config.subpixel_bits = subpixel_bits;
    std::uint64_t differences = 0, covered = 0, near = 0;
    for (std::uint32_t seed = 1; seed <= 150; ++seed) {
      SCOPED_TRACE("S = " + std::to_string(subpixel_bits) + ", seed " + std::to_string(seed));
      const Comparison c = compare(random_scene(seed, 0), config);
      EXPECT_EQ(c.coverage.near_edge, c.coverage.missing + c.coverage.extra);
      EXPECT_TRUE(broken_bounds(c, config).empty()) << broken_bounds(c, config).front();
      differences += c.coverage.missing + c.coverage.extra;
      near += c.coverage.near_edge;
      covered += c.rendering.counters.covered;
    }
    EXPECT_GT(differences, 0u);
    RecordProperty("S" + std::to_string(subpixel_bits),
                   std::to_string(differences) + " of " + std::to_string(covered) + ", near " + std::to_string(near));
    if (subpixel_bits == 8) {
      EXPECT_LT(differences, covered / 100);
    }
  }
}

/// Draws of every topology, polygon mode and state at one of five depths each, on the 1/16 pixel grid.
Scene random_state_scene(std::uint32_t seed) {
  Random random(seed);
  Scene scene = SceneBuilder(kWidth, kHeight).scene;
  for (int d = 0; d < 20; ++d) {
    scene.states.push_back(random_state(SceneBuilder::window_state(),
                                        without_operations(states_but({"space", "smooth"})), chooser(random)));
    // The corners of a rectangle do not lie on the grid.
    if (scene.states.back().line_rule == LineRule::rectangle) scene.states.back().line_rule = LineRule::diamond;
    const double z = random.index(6) / 5.0;  // equal depths meet often
    const std::size_t first = scene.indices.size();
    for (int i = 3 + random.index(6); i > 0; --i) {
      scene.indices.push_back(static_cast<std::uint32_t>(scene.vertices.size()));
      const double x = random.index(64 * 16) / 16.0 - 8, y = random.index(60 * 16) / 16.0 - 8;
      const auto channel = [&] { return static_cast<double>(random.index(256)); };
      scene.vertices.push_back(at(x, y, z, {channel(), channel(), channel(), channel()}));
      if (random.index(8) == 0) scene.indices.push_back(kRestart);
    }
    scene.commands.push_back(Draw{static_cast<std::uint32_t>(scene.states.size() - 1), 0,
                                  static_cast<Topology>(random.index(7)), first, scene.indices.size() - first, 0});
  }
  return scene;
}

TEST(CompareLines, ModelAndGoldenShowTheSamePictureInEveryPolygonModeAndState) {
  const Config config = preset("embedded");
  std::uint64_t compared = 0, lines = 0, points = 0;
  for (std::uint32_t seed = 1; seed <= 150; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Scene scene = random_state_scene(seed);
    const Comparison c = compare(scene, config);
    ASSERT_EQ(c.rendering.count, c.golden.count);
    ASSERT_EQ(c.rendering.ids, c.golden.ids);
    EXPECT_EQ(c.rendering.counters.primitives_in, c.golden.counters.primitives_in);
    EXPECT_EQ(c.rendering.counters.depth_passed, c.golden.counters.depth_passed);
    EXPECT_EQ(c.rendering.counters.written, c.golden.counters.written);
    EXPECT_LE(c.depth_lsb.max, 1e-5);
    EXPECT_LE(c.color_lsb.max, 1);
    EXPECT_TRUE(broken_bounds(c, config).empty()) << broken_bounds(c, config).front();
    compared += c.compared_pixels;
    lines += c.rendering.lines.size();
    points += c.rendering.points.size();
  }
  EXPECT_GT(compared, 40000u);
  EXPECT_GT(lines, 3000u);
  EXPECT_GT(points, 1000u);
}

/// Lines, points and triangles in every mode that cross every plane, with w of both signs.
Scene random_clip_scene(std::uint32_t seed) {
  Random random(seed);
  Scene scene = SceneBuilder(kWidth, kHeight).scene;
  for (int d = 0; d < 6; ++d) {
    State state;
    state.depth_test = DepthFunc::always;
    state.clip_z = static_cast<ClipZ>(random.index(2));
    if (random.index(2) == 0) state.viewport = Viewport{random.between(-9, 9), random.between(-9, 9), 31.5, 47.25};
    if (random.index(3) == 0) state.depth_range = {random.unit(), random.unit()};
    if (random.index(4) == 0) state.cull = Cull::back;
    state.polygon_mode = static_cast<PolygonMode>(1 + random.index(2));
    state.line_rule = static_cast<LineRule>(random.index(4));
    state.point_size = 1 + random.index(5);
    state.point_clip = static_cast<PointClip>(random.index(2));
    if (d % 2 == 1) state.line_width = 1 + random.index(4);
    if (d % 3 == 1) state.point_shape = PointShape::round;
    scene.states.push_back(state);
    const std::size_t first = scene.indices.size();
    for (int i = 0; i < 6; ++i) {
      scene.indices.push_back(static_cast<std::uint32_t>(scene.vertices.size()));
      const double size = std::pow(10.0, random.between(-1, 1));
      const double w = random.between(-1, 3) * size, x = random.between(-2, 2) * size, y = random.between(-2, 2) * size;
      const double z = random.between(-1.5, 1.5) * size;
      scene.vertices.push_back(clip_at(x, y, z, w, {random.unit() * 255, 90, 250 * random.unit(), 255}));
    }
    scene.commands.push_back(Draw{static_cast<std::uint32_t>(scene.states.size() - 1), 0,
                                  static_cast<Topology>(random.index(7)), first, 6, 0});
  }
  return scene;
}

TEST(CompareLines, ClippedPrimitivesDifferFromTheGoldenOnlyWhereTheSnapMayDecide) {
  Config config = preset("full");
  config.depth_bits = 10;  // an LSB is large against the snap: only the depth mapping remains
  std::uint64_t clipped = 0, compared = 0, far_off = 0, differences = 0;
  for (std::uint32_t seed = 1; seed <= 400; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Comparison c = compare(random_clip_scene(seed), config);
    EXPECT_EQ(c.oracle.mismatches, 0u);
    EXPECT_EQ(c.coverage.near_edge, c.coverage.missing + c.coverage.extra);
    EXPECT_EQ(c.stage_mismatches, 0u);
    EXPECT_LE(c.line_datapath.max, line_depth_error_bound(config));
    clipped += c.rendering.counters.clipped;
    compared += c.compared_pixels;
    differences += c.coverage.missing + c.coverage.extra;
    for (const float error : c.depth_error_lsb) far_off += std::abs(error) > 2.0F ? 1 : 0;  // false for NaN
  }
  RecordProperty("figures", std::to_string(clipped) + " clipped, " + std::to_string(compared) + " pixels, " +
                                std::to_string(differences) + " differ, " + std::to_string(far_off) + " far off");
  EXPECT_GT(clipped, 400u);
  EXPECT_GT(compared, 50000u);
  EXPECT_LT(static_cast<double>(far_off), 0.002 * static_cast<double>(compared));
}

TEST(CompareLines, PolygonOffsetOfSlopedTrianglesDiffersByItsRoundingAndTheSnapOfDepthOnly) {
  double worst = 0, worst_offset = 0;
  for (std::uint32_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    State state = SceneBuilder::window_state();
    state.polygon_mode = static_cast<PolygonMode>(seed % 3);
    state.polygon_offset = {random.between(-2, 2), random.between(-9, 9)};
    SceneBuilder builder(kWidth, kHeight, state);
    // On the grid, at least 20 pixels high and wide, its depths away from both ends of the range.
    const auto vertex = [&random](double x, double y) {
      const double right = random.index(12 * 16) / 16.0, down = random.index(12 * 16) / 16.0;
      return at(x + right, y + down, random.between(0.4, 0.6));
    };
    const Vertex a = vertex(2, 2), b = vertex(34, 3);
    builder.triangle(a, b, vertex(18, 32));
    const Comparison c = compare(builder.scene, preset("embedded"));
    EXPECT_TRUE(broken_bounds(c, preset("embedded")).empty());
    worst = std::max(worst, c.depth_lsb.max);
    state.polygon_offset = {0, 0};
    builder.scene.states[0] = state;
    const Comparison plain = compare(builder.scene, preset("embedded"));
    for (std::size_t p = 0; p < c.golden.depth.size(); ++p)
      worst_offset = std::max(worst_offset, std::abs(c.golden.depth[p] - plain.golden.depth[p]));
  }
  RecordProperty("worst", std::to_string(worst));
  EXPECT_GT(worst_offset, 500);
  EXPECT_GT(worst, 0.7);
  // 0.66 for the code, 1/2 each for the snap of z and the rounding of o, and 2 slopes with errors of 0.1 per pixel.
  EXPECT_LT(worst, 2);
}

/// A line and a point, far apart, on the grid.
Scene line_and_point(LineRule rule) {
  State state = SceneBuilder::window_state();
  state.line_rule = rule;
  state.point_size = 3;
  SceneBuilder builder(kWidth, kHeight, state);
  Scene& scene = builder.scene;
  scene.vertices = {at(3.25, 4.5, 0.1), at(40.5, 19.75, 0.8), at(10.5, 30.5, 0.5)};
  scene.indices = {0, 1, 2};
  scene.commands.push_back(Draw{0, 0, Topology::lines, 0, 2, 0});
  scene.commands.push_back(Draw{0, 0, Topology::points, 2, 1, 0});
  return scene;
}

std::size_t index_of(int x, int y) { return static_cast<std::size_t>(y * kWidth + x); }

TEST(CompareLinesMustFail, EverythingOnePixelLowerIsSeenByTheOracleAndIsNotExplainedByTheSnap) {
  for (const auto rule : {LineRule::midpoint, LineRule::diamond}) {
    const auto lower = [](std::uint32_t, int&, int& y) { return ++y, true; };
    const auto damage = [](Rendering& r) {
      for (int y = kHeight - 1; y > 0; --y)
        for (int x = 0; x < kWidth; ++x) r.count[index_of(x, y)] = r.count[index_of(x, y - 1)];
    };
    const Comparison c = compare(line_and_point(rule), preset("embedded"), with_engine(lower, damage));
    EXPECT_GT(c.oracle.mismatches, 60u);
    EXPECT_GT(c.coverage.missing, 30u);
    EXPECT_EQ(c.coverage.missing, c.coverage.extra);
    EXPECT_LT(c.coverage.near_edge, c.coverage.missing / 2);
    EXPECT_FALSE(broken_bounds(c, preset("embedded")).empty());
  }
}

TEST(CompareLinesMustFail, OnePixelTooFewIsReportedWithItsPlace) {
  const auto drop = [](std::uint32_t, int& x, int&) { return x != 20; };
  const auto damage = [](Rendering& r) {
    for (int y = 0; y < kHeight; ++y) r.count[index_of(20, y)] = 0;
  };
  const Comparison c = compare(line_and_point(LineRule::bresenham), preset("embedded"), with_engine(drop, damage));
  EXPECT_EQ(c.oracle.mismatches, 1u);
  ASSERT_TRUE(c.oracle.first);
  EXPECT_EQ(c.oracle.first->x, 20);
  EXPECT_EQ(c.oracle.first->primitive, 0u);
  EXPECT_TRUE(c.oracle.first->oracle_covers);
  EXPECT_EQ(c.coverage.missing, 1u);
  EXPECT_EQ(c.coverage.near_edge, 0u);
}

TEST(CompareLinesMustFail, PixelDrawnTwiceByOneLineIsReported) {
  const auto repeat = [last_y = 0](std::uint32_t, int& x, int& y) mutable {
    if (x == 20) x = 19, y = last_y;
    last_y = y;
    return true;
  };
  EXPECT_EQ(compare(line_and_point(LineRule::diamond), preset("embedded"), with_engine(repeat)).oracle.mismatches, 2u);
}

TEST(CompareLinesMustFail, PointOnePixelToTheRightIsReported) {
  const auto shift = [](std::uint32_t primitive, int& x, int&) { return x += primitive == 1 ? 1 : 0, true; };
  EXPECT_EQ(compare(line_and_point(LineRule::diamond), preset("embedded"), with_engine(shift)).oracle.mismatches, 6u);
}

TEST(CompareLinesMustFail, WrongDepthOrColorCodeIsReported) {
  const Config config = preset("embedded");
  const auto change = [](auto Framebuffer::*plane, std::uint32_t bits) {
    return with_engine({}, [plane, bits](Rendering& r) {
      for (int y = 0; y < kHeight; ++y)
        if (r.visible[index_of(20, y)] == -2) (r.frame.*plane)[r.frame.at(20, y)] ^= bits;
    });
  };
  const Comparison depth = compare(line_and_point(LineRule::diamond), config, change(&Framebuffer::depth, 2));
  EXPECT_EQ(depth.stage_mismatches, 1u);
  EXPECT_GT(depth.line_datapath.max, 1.3);
  EXPECT_EQ(broken_bounds(depth, config).size(), 2u);
  const Comparison color = compare(line_and_point(LineRule::diamond), config, change(&Framebuffer::color, 8));
  EXPECT_EQ(color.stage_mismatches, 1u);
  EXPECT_GT(color.color_datapath.max, 5);
}

TEST(CompareLinesMustFail, PixelOwnedByALineThatDoesNotCoverItIsReported) {
  const auto steal = [](Rendering& r) {
    r.visible[5] = -2;
    r.ids[5] = 0;
  };
  EXPECT_EQ(compare(line_and_point(LineRule::diamond), preset("embedded"), with_engine({}, steal)).stage_mismatches,
            1u);
}

}  // namespace
}  // namespace halfplane::compare_lines_test
