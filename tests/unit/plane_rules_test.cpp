// The faults of docs/numerics.md: each makes the error that the page says, by the formula that it gives; without them the
// same scenes keep every bound.
#include "model/study/plane_rules.hpp"
#include "halfplane_paths.hpp"
#include "model/stages/cull.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <ostream>

#include "../triangle_families.hpp"
#include "model/capture/capture.hpp"
#include "model/engines/scalar.hpp"
#include "model/golden/exact.hpp"
#include "sim/study/compare/compare.hpp"

namespace halfplane::plane_rules_test {
namespace {

using test::Random;

constexpr StudyRules kUsual{};
constexpr StudyRules kTwoReciprocals{.gradients = Gradients::two_reciprocals};
constexpr StudyRules kTruncated{.gradients = Gradients::truncated};
constexpr StudyRules kSaturate{.accumulator = Accumulator::saturate};

std::array<SnappedVertex, 3> canonical_of(const Triangle& t) {
  return canonical(t.v, signed_area(t.v[0], t.v[1], t.v[2]));
}

TriangleSetup setup_by(const Triangle& triangle, const StudyRules& rules, const Config& config, const Widths& widths) {
  TriangleSetup setup = setup_triangle(triangle, config, widths, {0, 0, config.target_width, config.target_height});
  if (setup.area > 0) set_planes(setup, canonical_of(triangle), rules, config, widths);
  return setup;
}

bool same_plane(const Plane& a, const Plane& b) {
  return a.value == b.value && a.step_x == b.step_x && a.step_y == b.step_y;
}

/// A long thin triangle over pixels 0...63: both ends up to `reach` pixels away, 1 to 3 pixels high, steep across.
Triangle sliver(Random& random, const Config& config, int reach) {
  const auto subpixels = [&config](double pixels) {
    return static_cast<std::int32_t>(std::lround(std::ldexp(pixels, config.subpixel_bits)));
  };
  const double slope = random.between(0.3, 1), left = random.between(-reach, -1), right = random.between(65, reach);
  const double height = random.between(1, 3), y = random.between(-10, 30);
  const auto top = static_cast<std::uint32_t>((std::uint64_t{1} << config.depth_bits) - 1);
  Triangle t;
  t.v[0] = {subpixels(left), subpixels(y + slope * left), top / 50, {}};
  t.v[1] = {subpixels(right), subpixels(y + slope * right), top / 50, {}};
  t.v[2] = {subpixels(right), subpixels(y + slope * right + height), top, {}};
  return t;
}

/// A pixel centre's offset from v0, in pixels, and the true gradients per pixel: the symbols of docs/numerics.md.
struct Point {
  double dx, dy, gx, gy;
};

Point point_of(const Triangle& triangle, int x, int y, int grid_bits) {
  const auto v = canonical_of(triangle);
  const double scale = std::ldexp(1.0, grid_bits);
  const auto plane = [&](int px, int py) {
    const exact::Rational z = exact::depth_at(triangle, px, py, grid_bits);
    return static_cast<double>(z.numerator) / static_cast<double>(z.denominator);
  };
  return {x + 0.5 - v[0].x / scale, y + 0.5 - v[0].y / scale, plane(x + 1, y) - plane(x, y),
          plane(x, y + 1) - plane(x, y)};
}

/// Before storage, against the exact plane.
double depth_error(const Triangle& triangle, const TriangleSetup& setup, const StudyRules& rules, const Config& config,
                   const Widths& widths, int x, int y) {
  const exact::Rational z = exact::depth_at(triangle, x, y, widths.grid_bits);
  const Interpolated value = interpolate_by_rules(setup, rules, widths, x, y);
  return std::ldexp(static_cast<double>(value.unrounded[kDepthPlane]), -config.local_guard_bits) -
         static_cast<double>(z.numerator) / static_cast<double>(z.denominator);
}

/// Calls visit(triangle, x, y) for the covered samples of 300 slivers, in the first 64 x 64 pixels.
template <class Visit>
void for_each_sliver_sample(const Config& config, int reach, Visit&& visit) {
  const Widths widths = derive_widths(config);
  Random random(8);
  for (int k = 0; k < 300; ++k) {
    const Triangle triangle = sliver(random, config, reach);
    if (signed_area(triangle.v[0], triangle.v[1], triangle.v[2]) == 0) continue;
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 64; ++x)
        if (exact::covers(triangle, x, y, widths.grid_bits)) visit(triangle, x, y);
  }
}

TEST(PlaneRules, UsualOnesGiveThePlanesAndValuesOfTheStagesBitForBit) {
  for (const auto name : {"tiny", "embedded", "full"}) {
    const Config config = preset(name);
    const Widths widths = derive_widths(config);
    test::Generator generator(config, 16, 16, 3);
    int compared = 0;
    for (int k = 0; k < 800; ++k) {
      const auto v = generator.triangle(k % test::Generator::kFamilies);
      Triangle t;
      for (std::size_t i = 0; i < 3; ++i) {
        const double scale = std::ldexp(1.0, widths.grid_bits), top = std::ldexp(1.0, config.depth_bits) - 1;
        t.v[i] = {static_cast<std::int32_t>(snap(v[i].x, scale)),
                  static_cast<std::int32_t>(snap(v[i].y, scale)),
                  {static_cast<std::uint32_t>(snap(v[i].z, top))}};
        for (std::size_t c = 0; c < 4; ++c) t.v[i].code[kColorPlane + c] = static_cast<std::uint8_t>(v[i].rgba[c]);
      }
      const TriangleSetup usual = setup_triangle(t, config, widths, {0, 0, config.target_width, config.target_height});
      if (usual.is_empty()) continue;
      const TriangleSetup made = setup_by(t, kUsual, config, widths);
      for (std::size_t p = 0; p < kMaxPlanes; ++p)
        ASSERT_TRUE(same_plane(usual.plane[p], made.plane[p])) << name << " " << k;
      EXPECT_EQ(interpolate_by_rules(made, kUsual, widths, 5, 9).code, interpolate_at(usual, widths, 5, 9).code);
      ++compared;
    }
    EXPECT_GT(compared, 300) << name;
  }
}

TEST(PlaneRules, SaturateChangesNothingWhereNoPlaneLeavesItsRegister) {
  const Config config = preset("embedded");
  const Widths widths = derive_widths(config);
  Triangle t;  // its vertex of the right angle is the first tile's: every anchor of its box lies between its depths
  t.v = {{{16, 16, {3000, 9, 200, 80, 0}}, {1600, 16, {40000, 200, 9, 80, 0}}, {16, 1400, {20000, 99, 99, 0, 255}}}};
  const TriangleSetup wrap = setup_by(t, kUsual, config, widths), saturate = setup_by(t, kSaturate, config, widths);
  ASSERT_TRUE(same_plane(wrap.plane[kDepthPlane], saturate.plane[kDepthPlane]));
  for (int y = 1; y < 40; ++y)
    for (int x = 1; x < 50; ++x) {
      const Interpolated a = interpolate_at(wrap, widths, x, y),
                         b = interpolate_by_rules(saturate, kSaturate, widths, x, y);
      ASSERT_EQ(a.unrounded[kDepthPlane], b.unrounded[kDepthPlane]) << x << ", " << y;
      ASSERT_EQ(a.code, b.code);
    }
}

TEST(PlaneRules, TwoReciprocalsErrByTheGradientsTimesTheDistanceAndOneDoesNot) {
  for (const auto name : {"embedded", "full"}) {
    const Config config = preset(name);
    const Widths widths = derive_widths(config);
    const double unit = std::ldexp(2.0, -config.depth_bits - config.reciprocal_extra_bits);  // 2^(1-r)
    const double rest = depth_error_bound(config) - 0.5;
    double worst_two = 0, worst_one = 0;
    for_each_sliver_sample(config, 1500, [&](const Triangle& t, int x, int y) {
      const Point p = point_of(t, x, y, widths.grid_bits);
      const double two =
          std::abs(depth_error(t, setup_by(t, kTwoReciprocals, config, widths), kTwoReciprocals, config, widths, x, y));
      const double one = std::abs(depth_error(t, setup_by(t, kUsual, config, widths), kUsual, config, widths, x, y));
      EXPECT_LE(two, unit * (std::abs(p.gx * p.dx) + std::abs(p.gy * p.dy)) + rest);
      worst_two = std::max(worst_two, two);
      worst_one = std::max(worst_one, one);
    });
    EXPECT_GT(worst_two, 30) << name;
    EXPECT_LE(worst_one, rest) << name;
    RecordProperty(std::string(name) + "_two_reciprocals", std::to_string(worst_two));
    RecordProperty(std::string(name) + "_one_reciprocal", std::to_string(worst_one));
  }
}

TEST(PlaneRules, TruncatedGradientsFallShortByAtMostALastPlacePerPixelAndNeverExceed) {
  const Config config = preset("embedded");
  const Widths widths = derive_widths(config);
  const double place = std::ldexp(1.0, -config.local_guard_bits), reciprocal = std::ldexp(1.0, -4) + place;
  double lowest = 0;
  Random random(5);
  for (int k = 0; k < 200; ++k) {  // walls of the whole screen, from its left top corner
    Triangle t;
    const auto code = [&random] { return static_cast<std::uint32_t>(random.index(65536)); };
    t.v[0] = {0, 0, code(), {}};
    t.v[1] = {16 * (800 + random.index(400)), 0, code(), {}};
    t.v[2] = {0, 16 * (500 + random.index(400)), code(), {}};
    const TriangleSetup setup = setup_by(t, kTruncated, config, widths);
    for (int i = 1; i < 8; ++i) {
      const int x = 50 * i, y = 30 * i;
      const double error = depth_error(t, setup, kTruncated, config, widths, x, y);
      EXPECT_LE(error, reciprocal);
      EXPECT_GE(error, -place * (x + 0.5 + y + 0.5) - reciprocal);
      lowest = std::min(lowest, error);
    }
  }
  EXPECT_LT(lowest, -6) << "of " << place * (350 + 210);
}

TEST(PlaneRules, NothingIsTruncatedWhereAProductHasFewerFractionBitsThanAreKept) {
  Config config = preset("embedded");
  config.depth_bits = 8;
  config.subpixel_bits = 8;
  config.local_guard_bits = 12;
  ASSERT_NO_THROW(validate(config));
  const Widths widths = derive_widths(config);
  Triangle t;  // its area is 1, and its reciprocal exact
  t.v[0] = {130, 130, {3}};
  t.v[1] = {131, 130, {90}};
  t.v[2] = {130, 131, {7}};
  const TriangleSetup usual = setup_by(t, kUsual, config, widths), truncated = setup_by(t, kTruncated, config, widths);
  EXPECT_EQ(truncated.plane[kDepthPlane].step_x, usual.plane[kDepthPlane].step_x);
  EXPECT_EQ(truncated.plane[kDepthPlane].step_y, usual.plane[kDepthPlane].step_y);
  EXPECT_EQ(usual.plane[kDepthPlane].step_x, std::int64_t{87} << widths.plane_fraction);
}

/// A scene of the page by some rules; it is never the coverage or the storage that is at fault.
Comparison compare_page(const std::string& scene, const StudyRules& rules) {
  CompareOptions options;
  options.rules = rules;
  Comparison c =
      compare(read_capture_file(HALFPLANE_SOURCE_DIR "/docs/numerics/" + scene + ".hpt"), preset("embedded"), options);
  EXPECT_EQ(c.oracle.mismatches, 0u) << scene;
  EXPECT_EQ(c.stage_mismatches, 0u) << scene;
  return c;
}

struct PageFault {
  const char* scene;
  StudyRules rules;
  double depth_lsb;             // the fault errs by more
  std::uint64_t other_visible;  // and shows the wrong surface in more samples
};

/// CTest names a case after its parameter; without this, after its bytes.
void PrintTo(const PageFault& fault, std::ostream* out) { *out << fault.scene; }

class PageFaults : public testing::TestWithParam<PageFault> {};

TEST_P(PageFaults, BreakTheDepthBoundWhereTheUsualRulesKeepIt) {
  const PageFault& fault = GetParam();
  const Config config = preset("embedded");
  const Comparison right = compare_page(fault.scene, kUsual), wrong = compare_page(fault.scene, fault.rules);
  EXPECT_TRUE(broken_bounds(right, config).empty());
  EXPECT_LE(right.datapath.max, depth_error_bound(config));
  EXPECT_EQ(right.other_visible, 0u);
  EXPECT_FALSE(broken_bounds(wrong, config).empty());
  EXPECT_GT(wrong.datapath.max, fault.depth_lsb);
  EXPECT_GT(wrong.other_visible, fault.other_visible);
  EXPECT_EQ(wrong.coverage.missing + wrong.coverage.extra, 0u);  // planes do not affect coverage
}

INSTANTIATE_TEST_SUITE_P(Page, PageFaults,
                         testing::Values(PageFault{"bands", kTwoReciprocals, 10, 500},
                                         PageFault{"posters", kTruncated, 3, 2000},
                                         PageFault{"funnel", kSaturate, 10000, 500}),
                         [](const auto& test) { return std::string(test.param.scene); });

TEST(PageFaultsOfTheSnap, SamplesThatDifferGrowAsSubpixelBitsFallAndAllLieNearAnEdge) {
  const Scene scene = read_capture_file(HALFPLANE_SOURCE_DIR "/docs/numerics/wheel.hpt");
  Config config = preset("embedded");
  std::uint64_t before = 0;
  for (const int bits : {8, 4, 2, 0}) {
    config.subpixel_bits = bits;
    const Comparison c = compare(scene, config);
    const std::uint64_t differ = c.coverage.missing + c.coverage.extra;
    EXPECT_GT(differ, before) << bits;
    EXPECT_EQ(c.coverage.near_edge, differ) << bits;
    EXPECT_EQ(c.oracle.mismatches, 0u) << bits;
    before = differ;
  }
  EXPECT_GT(before, 200u);
}

TEST(PlaneRules, SaturatedPlanesAreTheSameByEveryTraversal) {
  const Scene scene = read_capture_file(HALFPLANE_SOURCE_DIR "/docs/numerics/funnel.hpt");
  RenderOptions options;
  options.rules = kSaturate;
  const Rendering tiled = render_scalar(scene, preset("embedded"), options);
  EXPECT_NE(tiled.frame.depth, render_scalar(scene, preset("embedded")).frame.depth);
  for (const Traversal traversal : {Traversal::bbox, Traversal::scanline, Traversal::brute}) {
    options.rules.traversal = traversal;
    const Rendering other = render_scalar(scene, preset("embedded"), options);
    EXPECT_EQ(other.frame.depth, tiled.frame.depth) << name_of(traversal);
    EXPECT_EQ(other.frame.color, tiled.frame.color) << name_of(traversal);
  }
}

}  // namespace
}  // namespace halfplane::plane_rules_test
