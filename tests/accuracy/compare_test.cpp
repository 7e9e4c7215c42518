// The comparison itself: its figures add up, and engines that are wrong are caught.
#include "sim/study/compare/compare.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "../scene_builder.hpp"
#include "model/engines/functional.hpp"
#include "sim/study/compare/eye_depth.hpp"

namespace halfplane {
namespace {

using test::at;
using test::clip_at;
using test::SceneBuilder;

constexpr std::array<double, 4> kRed{250, 10, 3, 255}, kGreen{5, 240, 90, 200}, kBlue{17, 33, 251, 100};

/// One slanted, shaded triangle over most of a 32 x 32 target.
Scene one_triangle() {
  SceneBuilder builder(32, 32);
  builder.triangle(at(1.3, 2.1, 0.1, kRed), at(30.7, 4.9, 0.9, kGreen), at(7.7, 29.3, 0.4, kBlue));
  return builder.scene;
}

/// A perspective plane that runs from w = 2 at the bottom to w = 50 at the top; near 1, far 100.
Scene perspective_plane() {
  State state;
  state.depth_test = DepthFunc::always;
  SceneBuilder builder(48, 48, state);
  const auto vertex = [](double x, double y, double w, const std::array<double, 4>& rgba) {
    return clip_at(x * w, y * w, (101.0 * w - 200.0) / 99.0, w, rgba);
  };
  const Vertex a = vertex(-0.9, -0.9, 2, kRed), b = vertex(0.9, -0.9, 2, kGreen), c = vertex(0.9, 0.9, 50, kBlue),
               d = vertex(-0.9, 0.9, 50, kRed);
  builder.triangle(a, b, c).triangle(a, c, d);
  return builder.scene;
}

/// The real engine with something done to what it says.
CompareOptions with_engine(std::function<void(Rendering&)> damage,
                           std::function<bool(CoverageTap&, std::uint32_t, int, int, TileMask&)> tap = {}) {
  CompareOptions options;
  options.engine = [damage, tap](const Scene& scene, const Config& config, const RenderOptions& asked) {
    RenderOptions changed = asked;
    CoverageTap original = asked.coverage_tap;
    if (tap) {
      changed.coverage_tap = [&original, &tap](std::uint32_t triangle, int x, int y, const TileMask& mask) {
        TileMask copy = mask;
        if (tap(original, triangle, x, y, copy)) original(triangle, x, y, copy);
      };
    }
    Rendering rendering = render_functional(scene, config, changed);
    if (damage) damage(rendering);
    return rendering;
  };
  return options;
}

bool is_exact_sum(const ErrorParts& p) { return p.total.sum == p.snap.sum + p.interpolation.sum + p.storage.sum; }

TEST(Compare, CleanSceneBreaksNoBoundInAnyPreset) {
  for (const auto name : {"embedded", "full"}) {
    SCOPED_TRACE(name);
    const Config config = preset(name);
    for (const Scene& scene : {one_triangle(), perspective_plane()}) {
      const Comparison c = compare(scene, config);
      EXPECT_TRUE(broken_bounds(c, config).empty()) << broken_bounds(c, config).front();
      EXPECT_GT(c.compared_pixels, 300u);
      EXPECT_GT(c.oracle.samples, c.compared_pixels);
      EXPECT_EQ(c.depth_lsb.count, c.compared_pixels);
    }
  }
}

TEST(Compare, PartsSumToTheTotalExactly) {
  for (const Scene& scene : {one_triangle(), perspective_plane()}) {
    const Comparison c = compare(scene, preset("embedded"));
    EXPECT_TRUE(is_exact_sum(c.parts));
    EXPECT_TRUE(is_exact_sum(c.color_parts));
    EXPECT_GT(c.parts.snap.max, 0);
    EXPECT_GT(c.parts.interpolation.max, 0);
    EXPECT_GT(c.parts.storage.max, 0);
    EXPECT_LE(c.color_parts.storage.max, 1);
  }
}

TEST(Compare, TotalIsStoredCodeMinusGoldenDepth) {
  const Comparison c = compare(one_triangle(), preset("embedded"));
  int128 sum = 0;
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 32; ++x) {
      const auto p = static_cast<std::size_t>(y * 32 + x);
      const bool compared = c.rendering.ids[p] == 0 && c.golden.ids[p] == 0;
      EXPECT_EQ(std::isnan(c.depth_error_lsb[p]), !compared);
      if (!compared) continue;
      const std::int64_t d = std::int64_t{c.rendering.frame.depth[c.rendering.frame.at(x, y)]} << 20;
      const std::int64_t error = d - static_cast<std::int64_t>(std::floor(c.golden.depth[p] * 1048576 + 0.5));
      EXPECT_NEAR(c.depth_error_lsb[p], std::ldexp(static_cast<double>(error), -20), 1e-4);
      sum += error;
    }
  }
  EXPECT_TRUE(sum == c.parts.total.sum);
  EXPECT_NEAR(c.depth_lsb.mean * static_cast<double>(c.depth_lsb.count), std::ldexp(static_cast<double>(sum), -20),
              1e-6);
}

TEST(Compare, StatisticsOfAHandfulOfErrors) {
  ErrorSet errors;
  for (int i = 0; i < 999; ++i) errors.add(i % 2 == 0 ? 1 : -1);
  errors.add(-9);
  const ErrorStats stats = errors.stats();
  EXPECT_EQ(stats.count, 1000u);
  EXPECT_EQ(stats.max, 9);
  EXPECT_EQ(stats.p999, 1);
  EXPECT_DOUBLE_EQ(stats.mean, -0.008);
  EXPECT_DOUBLE_EQ(stats.rms, std::sqrt((999 + 81) / 1000.0));
}

TEST(Compare, AffineColorOfAPerspectivePlaneCostsSomethingAndOfAFlatOneNothing) {
  EXPECT_GT(compare(perspective_plane(), preset("full")).affine.max, 5);
  EXPECT_EQ(compare(one_triangle(), preset("full")).affine.max, 0);
}

TEST(Compare, EyeDepthInvertsTheProjection) {
  golden::Outline outline;
  const auto window_z = [](double w) { return 100.0 / 99.0 * (1 - 1 / w); };
  const std::array<double, 3> w{2, 10, 70};
  for (std::size_t i = 0; i < 3; ++i) {
    outline.inverse_w[i] = 1 / w[i];
    outline.z[i] = window_z(w[i]);
  }
  const auto mappings = fit_eye_mappings(std::array{outline}, 1);
  ASSERT_TRUE(mappings[0]);
  EXPECT_NEAR(mappings[0]->eye_depth(window_z(33)).value(), 33, 1e-9);
  EXPECT_FALSE(mappings[0]->eye_depth(100.0 / 99.0));  // infinitely far
  outline.z[1] += 0.001;                               // of another projection
  EXPECT_FALSE(fit_eye_mappings(std::array{outline}, 1)[0]);
}

TEST(Compare, EyeErrorIsTheFirstOrderFigureAndAbsentInWindowSpace) {
  const Comparison c = compare(perspective_plane(), preset("full"));
  ASSERT_TRUE(c.depth_eye);
  // dw = w^2 (f - n) / (f n) per unit of z: at w = 50, 2475; no pixel lies farther.
  EXPECT_GT(c.depth_eye->max, 2475 * 0.2 / 16777215);
  EXPECT_LT(c.depth_eye->max, 2475 * c.depth_lsb.max / 16777215 * 1.01);
  EXPECT_FALSE(compare(one_triangle(), preset("full")).depth_eye);
}

TEST(Compare, SnapErrorsLieNearAnEdge) {
  Config config = preset("embedded");
  set(config, "subpixel.bits", "0");
  const Comparison c = compare(one_triangle(), config);
  EXPECT_GT(c.coverage.missing + c.coverage.extra, 0u);
  EXPECT_EQ(c.coverage.near_edge, c.coverage.missing + c.coverage.extra);
  EXPECT_EQ(c.oracle.mismatches, 0u);
}

TEST(Compare, EmptySceneIsSeenToHaveComparedNothing) {
  const Comparison c = compare(SceneBuilder(8, 8).scene, preset("embedded"));
  EXPECT_EQ(c.compared_pixels, 0u);
  EXPECT_EQ(c.oracle.samples, 0u);
  EXPECT_EQ(c.depth_lsb.count, 0u);
  EXPECT_EQ(broken_bounds(c, preset("embedded")).size(), 1u) << "a comparison that compared nothing has not passed";
}

TEST(Compare, TriangleThatCoversNoSampleIsNoPassEither) {
  SceneBuilder builder(8, 8);
  builder.triangle(at(-40, -40), at(40, -40), at(-40, 39));  // its box holds the target, its inside does not
  EXPECT_EQ(broken_bounds(compare(builder.scene, preset("embedded")), preset("embedded")).size(), 1u);
}

TEST(CompareMustFail, DepthPlaneShiftedByTwoLsbIsReported) {
  const Config config = preset("embedded");
  const Comparison c = compare(one_triangle(), config, with_engine([](Rendering& r) {
                                 for (int y = 0; y < r.frame.height; ++y)
                                   for (int x = 0; x < r.frame.width; ++x)
                                     if (r.ids[static_cast<std::size_t>(y * r.frame.width + x)] == 0)
                                       r.frame.depth[r.frame.at(x, y)] += 2;
                               }));
  EXPECT_GT(c.datapath.max, 1.5);
  EXPECT_NEAR(c.datapath.mean, 2, 0.1);
  EXPECT_EQ(c.stage_mismatches, c.datapath.count);
  EXPECT_GE(broken_bounds(c, config).size(), 2u);
}

TEST(CompareMustFail, OneWrongColorCodeIsReported) {
  const Config config = preset("full");
  const Comparison c =
      compare(one_triangle(), config, with_engine([](Rendering& r) { r.frame.color[r.frame.at(10, 10)] ^= 2u << 8; }));
  EXPECT_EQ(c.stage_mismatches, 1u);
  EXPECT_GT(c.color_datapath.max, 1);
  EXPECT_EQ(broken_bounds(c, config).size(), 2u);
}

TEST(CompareMustFail, OneDroppedSampleIsReportedWithItsPlace) {
  const Config config = preset("embedded");
  const auto drop = [](CoverageTap&, std::uint32_t, int tile_x, int tile_y, TileMask& mask) {
    if (tile_x == 1 && tile_y == 1) mask[3] &= ~(1U << 2);  // pixel (10, 11)
    return true;
  };
  const Comparison c =
      compare(one_triangle(), config, with_engine([](Rendering& r) { r.count[11 * 32 + 10] = 0; }, drop));
  EXPECT_EQ(c.oracle.mismatches, 1u);
  ASSERT_TRUE(c.oracle.first);
  EXPECT_EQ(c.oracle.first->x, 10);
  EXPECT_EQ(c.oracle.first->y, 11);
  EXPECT_TRUE(c.oracle.first->oracle_covers);
  EXPECT_EQ(c.coverage.missing, compare(one_triangle(), config).coverage.missing + 1);
  EXPECT_EQ(c.coverage_class[11 * 32 + 10], CoverageClass::missing);
  EXPECT_EQ(broken_bounds(c, config).size(), 1u);
}

TEST(CompareMustFail, TileNeverVisitedCountsAllItsSamples) {
  const auto skip = [](CoverageTap&, std::uint32_t, int tile_x, int tile_y, TileMask&) {
    return !(tile_x == 1 && tile_y == 1);  // pixels 8...15 both ways: wholly inside the triangle
  };
  EXPECT_EQ(compare(one_triangle(), preset("embedded"), with_engine({}, skip)).oracle.mismatches, 64u);
}

TEST(CompareMustFail, TileVisitedTwiceIsReported) {
  const auto repeat = [](CoverageTap& original, std::uint32_t triangle, int tile_x, int tile_y, TileMask& mask) {
    if (tile_x == 1 && tile_y == 1) original(triangle, tile_x, tile_y, mask);
    return true;
  };
  EXPECT_EQ(compare(one_triangle(), preset("embedded"), with_engine({}, repeat)).oracle.mismatches, 64u);
}

TEST(CompareMustFail, SampleBeyondTheTargetIsReported) {
  SceneBuilder builder(12, 12);
  builder.triangle(at(-20, -20), at(50, -20), at(-20, 50));
  const auto widen = [](CoverageTap&, std::uint32_t, int tile_x, int, TileMask& mask) {
    if (tile_x == 1) mask[0] |= 1U << 4;  // column 12 of a target 12 wide
    return true;
  };
  EXPECT_EQ(compare(builder.scene, preset("embedded"), with_engine({}, widen)).oracle.mismatches, 2u);
}

TEST(CompareMustFail, AnotherTriangleInFrontIsNotComparedButCounted) {
  SceneBuilder builder(16, 16);
  builder.triangle(at(0, 0, 0.2), at(40, 0, 0.2), at(0, 40, 0.2))
      .triangle(at(0, 0, 0.6), at(40, 0, 0.6), at(0, 40, 0.6));
  const Comparison c = compare(builder.scene, preset("embedded"), with_engine([](Rendering& r) {
                                 r.ids[5] = r.visible[5] = 0;
                                 r.frame.depth[5] = 13107;  // 0.2
                               }));
  EXPECT_EQ(c.other_visible, 1u);
  EXPECT_EQ(c.compared_pixels, 255u);
  EXPECT_EQ(c.coverage_class[5], CoverageClass::other);
  EXPECT_TRUE(std::isnan(c.depth_error_lsb[5]));
}

}  // namespace
}  // namespace halfplane
