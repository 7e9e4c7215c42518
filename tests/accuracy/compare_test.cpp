// Tests of the comparison itself: its figures add up, and wrong engines are caught.
#include "sim/study/compare/compare.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "../scene_builder.hpp"
#include "model/engines/functional.hpp"
#include "model/engines/scalar.hpp"
#include "model/engines/tapped_fragment.hpp"
#include "sim/study/compare/eye_depth.hpp"

namespace halfplane::compare_test {
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

/// The real engine with modified output.
CompareOptions with_engine(std::function<void(Rendering&)> damage,
                           std::function<bool(CoverageTap&, std::uint32_t, int, int, TileMask&)> tap = {}) {
  CompareOptions options;
  options.engine = [damage, tap](const Scene& scene, const Config& config, const RenderOptions& asked) {
    RenderOptions changed = asked;
    CoverageTap original = asked.coverage_tap;
    if (tap) {
      changed.coverage_tap = [&original, &tap](std::uint32_t triangle, int x, int y, const TileMask& mask, int sample) {
        TileMask copy = mask;
        if (tap(original, triangle, x, y, copy)) original(triangle, x, y, copy, sample);
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
  outline.z[1] += 0.001;                               // outline of another projection
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
  builder.triangle(at(-40, -40), at(40, -40), at(-40, 39));  // only its box contains the target
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
    if (tile_x == 1 && tile_y == 1) original(triangle, tile_x, tile_y, mask, 0);
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

// --- before and in the fragment operations ---

/// The specification with modified fragments.
CompareOptions with_fragments(std::function<void(TappedFragment&)> damage) {
  CompareOptions options;
  options.specification = [damage](const Scene& scene, const Config& config, const RenderOptions& asked) {
    RenderOptions changed = asked;
    changed.fragment_tap = [&](const TappedFragment& fragment) {
      TappedFragment copy = fragment;
      damage(copy);
      asked.fragment_tap(copy);
    };
    return render_scalar(scene, config, changed);
  };
  return options;
}

bool blames_fragments(const std::vector<std::string>& broken) {
  return std::any_of(broken.begin(), broken.end(), [](const auto& line) { return line.starts_with("fragments: "); });
}

/// A triangle, a line and a point that do not touch.
Scene one_of_each() {
  SceneBuilder builder(32, 32);
  builder.triangle(at(1.3, 2.1, 0.1, kRed), at(30.7, 4.9, 0.9, kGreen), at(7.7, 20.3, 0.4, kBlue));
  Scene& scene = builder.scene;
  const std::size_t first = scene.indices.size();
  for (const Vertex& v : {at(2.5, 28.5, 0.2, kRed), at(20.5, 25.5, 0.7, kBlue), at(28.5, 28.5, 0.5, kGreen)}) {
    scene.indices.push_back(static_cast<std::uint32_t>(scene.vertices.size()));
    scene.vertices.push_back(v);
  }
  scene.commands.push_back(Draw{0, 0, Topology::lines, first, 2, 0});
  scene.commands.push_back(Draw{0, 0, Topology::points, first + 2, 1, 0});
  return scene;
}

TEST(CompareMustFail, APlaneOffByOneLsbBeforeTheOperationsIsBlamedOnTheFragmentsAlone) {
  for (const auto name : {"embedded", "full"}) {
    const Config config = preset(name);
    for (const auto kind : {PrimitiveKind::triangle, PrimitiveKind::line, PrimitiveKind::point})
      for (std::size_t plane = 0; plane < judged_planes(config).size(); ++plane) {
        SCOPED_TRACE(std::string(name) + ", kind " + std::to_string(static_cast<int>(kind)) + ", plane " +
                     std::to_string(plane));
        const Comparison c = compare(one_of_each(), config, with_fragments([&](TappedFragment& f) {
                                       if (f.kind == kind) ++f.plane[plane].code;
                                     }));
        const auto broken = broken_bounds(c, config);
        if (kind == PrimitiveKind::point) {
          EXPECT_EQ(c.fragments.planes[plane].worst_of_lines, 1);  // exact but for the fault: at a colour's bound
        } else {
          ASSERT_EQ(broken.size(), 1u);
          EXPECT_TRUE(broken[0].starts_with("fragments: " + std::string(judged_planes(config)[plane].name)))
              << broken[0];
        }
        EXPECT_EQ(c.stage_mismatches, 0u);
        EXPECT_EQ(c.fragments.coverage.mismatches, 0u);
      }
  }
}

TEST(CompareMustFail, AnUnroundedPlaneOffByOneLsbIsBlamedOnTheFragments) {
  const Config config = preset("embedded");
  const Comparison c =
      compare(one_of_each(), config,
              with_fragments([](TappedFragment& f) { f.plane[2].unrounded += std::int64_t{1} << f.guard_bits; }));
  EXPECT_TRUE(blames_fragments(broken_bounds(c, config)));
  EXPECT_GT(c.fragments.planes[2].worst_unrounded, 0.9);
  EXPECT_LT(c.fragments.planes[1].worst_unrounded, 0.5);
}

TEST(CompareMustFail, AFragmentOnePixelAsideIsBlamedOnTheFragments) {
  const Config config = preset("embedded");
  for (const auto& [x, y] : {std::pair{10, 11}, {8, 27}, {28, 28}}) {  // pixels of the triangle, the line, the point
    std::uint64_t moved = 0;
    const auto move = [&, x = x, y = y](TappedFragment& f) {
      if (f.x == x && f.y == y) ++f.x, ++moved;
    };
    const Comparison c = compare(one_of_each(), config, with_fragments(move));
    ASSERT_EQ(moved, 1u) << x << ", " << y;
    EXPECT_EQ(c.fragments.coverage.mismatches,
              2u);  // one pixel lacks the fragment, one has it twice or wrongly
    EXPECT_EQ(c.oracle.mismatches, 0u);
    EXPECT_TRUE(blames_fragments(broken_bounds(c, config)));
  }
}

/// The engine of `options` draws with a depth function other than the scene's.
Engine with_depth_test(Engine engine, DepthFunc func) {
  return [engine, func](const Scene& scene, const Config& config, const RenderOptions& options) {
    Scene other = scene;
    for (State& state : other.states) state.depth_test = func;
    return engine(other, config, options);
  };
}
/// The engine of `options` truncates a channel where the pack rounds it, and swaps nothing.
Engine with_truncated_pack(Engine engine) {
  return [engine](const Scene& scene, const Config& config, const RenderOptions& options) {
    RenderOptions changed = options;
    std::vector<std::array<std::uint32_t, 4>> code(static_cast<std::size_t>(scene.width * scene.height));
    Rendering rendering = engine(scene, config, changed);
    RenderOptions taps;
    taps.fragment_tap = [&](const TappedFragment& f) {
      for (std::size_t c = 0; c < 4; ++c)
        code[static_cast<std::size_t>(f.y * scene.width + f.x)][c] = f.plane[c + 1].code;
    };
    const Rendering made = render_scalar(scene, config, taps);
    for (int y = 0; y < scene.height; ++y)
      for (int x = 0; x < scene.width; ++x) {
        const auto& c = code[static_cast<std::size_t>(y * scene.width + x)];
        if (c[0] + c[1] + c[2] != 0)
          rendering.frame.color[rendering.frame.at(x, y)] =
              c[0] * 31 / 256 << 11 | c[1] * 63 / 256 << 5 | c[2] * 31 / 256;
      }
    return rendering;
  };
}

/// Two triangles of equal depth and different colours; less shows the first.
Scene equal_depths() {
  State state = SceneBuilder::window_state();
  state.depth_test = DepthFunc::less;
  SceneBuilder builder(16, 16, state);
  builder.triangle(at(0, 0, 0.5, kRed), at(40, 0, 0.5, kRed), at(0, 40, 0.5, kRed))
      .triangle(at(0, 0, 0.5, kBlue), at(40, 0, 0.5, kBlue), at(0, 40, 0.5, kBlue));
  return builder.scene;
}

TEST(CompareMustFail, AWrongDepthFunctionIsBlamedOnTheFramebufferAndNotOnTheFragments) {
  const Config config = preset("embedded");
  EXPECT_TRUE(broken_bounds(compare(equal_depths(), config), config).empty());
  for (const bool is_in_both : {false, true}) {
    CompareOptions options;
    options.engine = with_depth_test(render_functional, DepthFunc::lequal);
    // The golden's own operations find the fault even when the specification has it as well.
    if (is_in_both) options.specification = with_depth_test(render_scalar, DepthFunc::lequal);
    const Comparison c = compare(equal_depths(), config, options);
    EXPECT_GE(c.stage_mismatches, 256u);
    const auto broken = broken_bounds(c, config);
    EXPECT_FALSE(broken.empty());
    EXPECT_FALSE(blames_fragments(broken)) << broken.front();
    EXPECT_GT(c.color_datapath.max, 20);
  }
}

TEST(CompareMustFail, AWrongPackIsBlamedOnTheFramebufferAndNotOnTheFragments) {
  const Config config = preset("embedded");
  EXPECT_TRUE(broken_bounds(compare(one_of_each(), config), config).empty());
  for (const bool is_in_both : {false, true}) {
    CompareOptions options;
    options.engine = with_truncated_pack(render_functional);
    if (is_in_both) options.specification = with_truncated_pack(render_scalar);
    const Comparison c = compare(one_of_each(), config, options);
    const auto broken = broken_bounds(c, config);
    ASSERT_FALSE(broken.empty());
    EXPECT_FALSE(blames_fragments(broken)) << broken.front();
    EXPECT_GT(c.color_datapath.max, 1);
    EXPECT_EQ(c.stage_mismatches > 0, !is_in_both);
    EXPECT_LT(c.fragments.planes[1].worst, 0.7);
  }
}

TEST(Compare, FragmentsAreJudgedHiddenOnesToo) {
  const Config config = preset("embedded");
  const Comparison c = compare(equal_depths(), config);
  EXPECT_EQ(c.fragments.fragments, 512u);
  EXPECT_EQ(c.fragments.coverage.mismatches, 0u);
  EXPECT_GE(c.fragments.coverage.samples, 512u);
  EXPECT_EQ(c.fragments.planes.size(), 4u);
  const Comparison of_all = compare(one_of_each(), config);
  EXPECT_EQ(of_all.fragments.fragments, of_all.rendering.counters.covered);
  EXPECT_GT(of_all.fragments.planes[0].worst, 0.4);
  EXPECT_GT(of_all.fragments.planes[0].worst_of_lines, 0.3);
}

}  // namespace
}  // namespace halfplane::compare_test
