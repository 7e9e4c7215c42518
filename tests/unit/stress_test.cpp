// The stress suite itself: that its oracles are right, that a fault makes it fail, and that a run can be repeated.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "model/engines/scalar.hpp"
#include "model/engines/tapped_fragment.hpp"
#include "model/golden/exact.hpp"
#include "sim/study/stress/check.hpp"
#include "sim/study/stress/grid.hpp"
#include "sim/study/stress/run.hpp"
#include "sim/study/stress/search.hpp"
#include "sim/study/stress/shapes.hpp"
#include "sim/study/stress/triangle_families.hpp"

namespace halfplane::stress::stress_test {
namespace {

std::vector<CaseResult> run_one(std::string_view name, const Engine& engine, std::uint64_t unit) {
  RunOptions options;
  options.names = {std::string(name)};
  options.engine = engine;
  options.unit = unit;
  return run_cases(options);
}

TEST(CaseList, TheListIsCompleteAndEveryNameIsItsOwn) {
  std::set<std::string_view> names;
  std::set<std::string> items;
  for (const Case& c : cases()) {
    EXPECT_TRUE(names.insert(c.name).second) << c.name;
    items.insert(std::string(c.item));
  }
  for (int item = 1; item <= 24; ++item) EXPECT_TRUE(items.contains(std::to_string(item))) << item;
  for (int item = 1; item <= 12; ++item) EXPECT_TRUE(items.contains("t" + std::to_string(item))) << item;
}

/// An engine that reports each surface as modified by `damage`, and draws unchanged.
Engine with_surfaces(std::function<void(SurfaceSample&)> damage) {
  return [damage](const Scene& scene, const Config& config, const RenderOptions& asked) {
    RenderOptions changed = asked;
    if (asked.fragment_tap)
      changed.fragment_tap = [&asked, &damage](const TappedFragment& fragment) {
        TappedFragment copy = fragment;
        if (copy.surface) damage(*copy.surface);
        asked.fragment_tap(copy);
      };
    return draw(scene, config, changed);
  };
}

/// The properties that fail in the first units of each textured case.
void expect_textured_failures(const Engine& engine, std::string_view property) {
  for (const Case& c : cases()) {
    if (!c.item.starts_with('t')) continue;
    const auto failed = [&](std::uint64_t unit) {
      const Tally tally = run_one(c.name, engine, unit)[0].tally;
      return tally.failures > 0 && tally.first->property == property;
    };
    bool is_found = false;
    for (std::uint64_t unit = 0; unit < 12 && !is_found; ++unit) is_found = failed(unit);
    EXPECT_TRUE(is_found) << c.name;
  }
}

TEST(SuiteMustFail, ACoordinateFarFromItsPlaceFailsEveryTexturedCase) {
  expect_textured_failures(with_surfaces([](SurfaceSample& s) { s.coordinate[1] += 3000; }), "coordinate");
}

TEST(SuiteMustFail, ALevelOfDetailOffByAQuarterFailsEveryTexturedCase) {
  expect_textured_failures(with_surfaces([](SurfaceSample& s) { s.lod += 60; }), "level");
}

TEST(SuiteMustFail, ATexelOffByTwoCodesFailsEveryTexturedCase) {
  expect_textured_failures(
      with_surfaces([](SurfaceSample& s) { s.texel[0] = static_cast<std::uint8_t>(s.texel[0] ^ 2); }), "filter");
}

TEST(SuiteMustFail, AnotherPictureThanTheFragmentsFailsEveryTexturedCase) {
  const Engine engine = [](const Scene& scene, const Config& config, const RenderOptions& asked) {
    Rendering rendering = draw(scene, config, asked);
    if (!asked.fragment_tap) rendering.frame.color[rendering.frame.at(3, 3)] ^= 1;
    return rendering;
  };
  expect_textured_failures(engine, "image");
}

TEST(ConfigurationGrid, HoldsThePresetsAndTheRangesAndIsLegalThroughout) {
  std::set<int> subpixel, depth, stamp, tile, guard, reciprocal;
  for (std::uint64_t i = 0; i < grid().size() + 200; ++i) {
    const Config config = config_of(i);
    EXPECT_NO_THROW(validate(config)) << label(config);
    EXPECT_EQ(config, config_of(i));
    if (i >= grid().size()) continue;
    subpixel.insert(config.subpixel_bits);
    depth.insert(config.depth_bits);
    stamp.insert(config.stamp_size);
    tile.insert(config.tile_size);
    guard.insert(config.local_guard_bits);
    reciprocal.insert(config.reciprocal_extra_bits);
  }
  EXPECT_EQ(subpixel.size(), 9U);
  EXPECT_EQ(depth.size(), 25U);
  EXPECT_EQ(stamp.size(), 4U);
  EXPECT_EQ(tile.size(), 4U);
  EXPECT_GE(guard.size(), 8U);
  EXPECT_GE(reciprocal.size(), 9U);
  for (const std::string_view name : preset_names())
    EXPECT_NE(std::find(grid().begin(), grid().end(), preset(name)), grid().end()) << name;
}

TEST(SuiteOracle, ThePolygonRuleAgreesWithTheTriangleOracle) {
  Tally tally;
  const Engine engine = draw;
  for (std::uint64_t n = 0; n < 300; ++n) {
    const Config config = config_of(n % grid().size());
    Unit unit(config, n, n, engine, tally);
    Triangle triangle;
    Corner corner;
    const int shift = unit.widths.grid_bits - config.subpixel_bits;
    for (std::size_t i = 0; i < 3; ++i) {
      corner[i] = random_point(unit, 12, 12, 2);
      if (unit.random.coin()) corner[i].x = corner[i].x / unit.pixel() * unit.pixel() + unit.pixel() / 2;
      triangle.v[i].x = static_cast<std::int32_t>(corner[i].x << shift);
      triangle.v[i].y = static_cast<std::int32_t>(corner[i].y << shift);
    }
    for (int y = -1; y < 13; ++y)
      for (int x = -1; x < 13; ++x)
        ASSERT_EQ(triangle_covers(corner, x, y, config.subpixel_bits),
                  exact::covers(triangle, x, y, unit.widths.grid_bits))
            << label(config) << ' ' << x << ", " << y;
  }
}

TEST(SuiteOracle, NarrowAndWideArithmeticAgree) {
  // The same triangle and samples near the origin and, in wide arithmetic, far from it.
  Random random(5);
  for (int n = 0; n < 500; ++n) {
    Triangle near, far;
    constexpr std::int32_t kAway = 1 << 29;
    for (std::size_t i = 0; i < 3; ++i) {
      near.v[i] = {static_cast<std::int32_t>(random.integer(0, 200)),
                   static_cast<std::int32_t>(random.integer(0, 200)),
                   static_cast<std::uint32_t>(random.integer(0, 0xffffffff)),
                   {}};
      far.v[i] = near.v[i];
      far.v[i].x += kAway;
      far.v[i].y += kAway;
    }
    const exact::TriangleOracle a(near, 4), b(far, 4);
    for (int y = 0; y < 13; ++y)
      for (int x = 0; x < 13; ++x) {
        const int away = kAway >> 4;
        ASSERT_EQ(a.covers(x, y), b.covers(x + away, y + away));
        if (!a.covers(x, y)) continue;
        const exact::Rational p = a.depth_at(x, y), q = b.depth_at(x + away, y + away);
        EXPECT_TRUE(p.numerator == q.numerator && p.denominator == q.denominator);
      }
  }
}

TEST(SuiteOracle, DelaunayTrianglesHaveNoPointInsideTheirCircle) {
  Random random(9);
  std::set<Point> points;
  for (int i = 0; i < 60; ++i) {
    const std::int64_t x = random.integer(1, 30);
    points.insert({x, random.integer(1, 30)});
  }
  const Mesh mesh = delaunay({0, 0}, {31, 31}, points);
  EXPECT_EQ(mesh.size(), 2 * points.size() + 2);
  std::int64_t area = 0;
  for (const Corner& t : mesh) {
    EXPECT_GT(doubled_area(t[0], t[1], t[2]), 0);
    area += doubled_area(t[0], t[1], t[2]);
    // Centre and squared radius of the circumcircle, both times the doubled area.
    const Point &a = t[0], &b = t[1], &c = t[2];
    const double d = 2.0 * static_cast<double>(doubled_area(a, b, c));
    const auto norm = [](Point p) { return static_cast<double>(p.x * p.x + p.y * p.y); };
    const double x = (norm(a) * static_cast<double>(b.y - c.y) + norm(b) * static_cast<double>(c.y - a.y) +
                      norm(c) * static_cast<double>(a.y - b.y)) /
                     d;
    const double y = (norm(a) * static_cast<double>(c.x - b.x) + norm(b) * static_cast<double>(a.x - c.x) +
                      norm(c) * static_cast<double>(b.x - a.x)) /
                     d;
    const auto distance = [&](Point p) {
      return std::hypot(static_cast<double>(p.x) - x, static_cast<double>(p.y) - y);
    };
    for (const Point& p : points) EXPECT_GE(distance(p), distance(a) - 1e-9);
  }
  EXPECT_EQ(area, 2 * 31 * 31);
}

TEST(IndependentChecker, MeasuresAnErrorThatIsPutIn) {
  const Config config = preset("embedded");
  const Scene scene = single(32, 32, {at(1, 1, 0.25), at(30, 2, 0.25), at(3, 29, 0.25)});
  EXPECT_EQ(measured_depth_error(scene, config, draw), 0.0);
  const Engine off_by_three = [](const Scene& s, const Config& c, const RenderOptions& options) {
    Rendering r = draw(s, c, options);
    r.frame.depth[r.frame.at(8, 8)] += 3;
    return r;
  };
  EXPECT_EQ(measured_depth_error(scene, config, off_by_three), 3.0);
  Scene clip_space = scene;
  clip_space.states[0].space = Space::clip;
  EXPECT_FALSE(measured_depth_error(clip_space, config, draw).has_value()) << "it says so when it cannot judge";
}

TEST(AdversarialSearch, ClimbsAboveItsStartAndReportsWhatTheStagesHave) {
  Tally tally;
  const Engine engine = draw;
  const Config config = preset("tiny");
  double start = 0, end = 0;
  for (std::uint64_t n = 0; n < 12; ++n) {
    Unit unit(config, n, n, engine, tally);
    const Found found = climb(unit, Objective::depth, 400);
    EXPECT_GE(found.error, found.start);
    std::uint64_t samples = 0;
    EXPECT_EQ(found.error, search_error(found.triangle, Objective::depth, config, unit.widths, samples));
    EXPECT_LE(found.error, depth_error_bound(config));
    start += found.start;
    end += found.error;
  }
  EXPECT_GT(end, start + 0.1) << "a search that never climbs finds nothing";
}

TEST(MeanBias, MeanAndStandardErrorAreThoseOfTheClusters) {
  constexpr std::int64_t kLsb = std::int64_t{1} << 20;
  BiasSums sums;
  sums.add_triangle(2 * kLsb, 2);   // two fragments of +1
  sums.add_triangle(-2 * kLsb, 2);  // two of -1
  EXPECT_EQ(sums.mean(), 0);
  EXPECT_NEAR(sums.standard_error(), std::sqrt(8.0) / 4, 1e-12);
}

/// Engines with a fault, each of which some check of every case that draws must see.
Engine inclusive_edges() {
  return [](const Scene& scene, const Config& config, const RenderOptions& options) {
    RenderOptions other = options;
    other.rules.fill_rule = FillRule::inclusive;
    return render_scalar(scene, config, other);
  };
}
Engine one_pixel_wrong() {
  return [](const Scene& scene, const Config& config, const RenderOptions& options) {
    Rendering r = draw(scene, config, options);
    const auto p = static_cast<std::size_t>(scene.height / 2 * scene.width + scene.width / 2);
    const std::size_t at = r.frame.at(scene.width / 2, scene.height / 2);
    if (p < r.count.size()) r.count[p] += 1;
    r.frame.depth[at] ^= 2;
    return r;
  };
}
Engine every_depth_one_more() {
  return [](const Scene& scene, const Config& config, const RenderOptions& options) {
    Rendering r = draw(scene, config, options);
    for (std::uint32_t& code : r.frame.depth) ++code;
    return r;
  };
}
Engine colors_turned() {
  return [](const Scene& scene, const Config& config, const RenderOptions& options) {
    Rendering r = draw(scene, config, options);
    for (std::uint32_t& code : r.frame.color) code ^= 0x8;
    return r;
  };
}
/// Lines and points: a pixel too few is reported.
Engine lost_line_pixel() {
  return [](const Scene& scene, const Config& config, const RenderOptions& options) {
    RenderOptions other = options;
    bool is_lost = false;
    if (options.pixel_tap)
      other.pixel_tap = [&](std::uint32_t primitive, int x, int y) {
        if (is_lost) options.pixel_tap(primitive, x, y);
        is_lost = true;
      };
    return draw(scene, config, other);
  };
}

/// Fragments whose planes are one LSB too large before the operations, of an engine that stores the right ones.
Engine fragments_one_more(std::size_t plane) {
  return [plane](const Scene& scene, const Config& config, const RenderOptions& options) {
    RenderOptions other = options;
    if (options.fragment_tap)
      other.fragment_tap = [&](const TappedFragment& fragment) {
        TappedFragment copy = fragment;
        copy.plane[plane].unrounded += std::int64_t{1} << fragment.guard_bits;
        options.fragment_tap(copy);
      };
    return draw(scene, config, other);
  };
}

/// Whether one of a few units of the case fails with the engine; without it none may.
bool is_caught(std::string_view name, const Engine& engine) {
  for (std::uint64_t unit = 0; unit < 8; ++unit)
    if (run_one(name, engine, unit).front().tally.failures > 0) return true;
  return false;
}

TEST(SuiteMustFail, EveryCaseThatDrawsSeesAFaultOfTheEngine) {
  // Searches that check stages alone, or draw with engines of their own.
  const std::set<std::string_view> without_engine{"cancellation",
                                                  "separation",
                                                  "lines_octants",
                                                  "lines_random",
                                                  "lines_long",
                                                  "polylines",
                                                  "full_guard_band",
                                                  "subpixel_sweep",
                                                  "depth_sweep",
                                                  "fill_rules",
                                                  "adversarial_interpolation",
                                                  "delaunay_large"};
  for (const Case& c : cases()) {
    if (without_engine.contains(c.name)) continue;
    SCOPED_TRACE(c.name);
    const Engine fault = c.name == "wires"                                     ? lost_line_pixel()
                         : c.name == "adversarial_color" || c.name == "layers" ? colors_turned()
                         : c.name == "unit_area_slivers"
                             ? every_depth_one_more()  // they cover few pixels, and not the judged one
                             : one_pixel_wrong();
    EXPECT_TRUE(is_caught(c.name, fault));
  }
}

TEST(SuiteMustFail, AnInclusiveFillRuleIsSeenByEveryMesh) {
  for (const auto name : {"pixel_centres", "fans", "delaunay", "t_junctions", "close_edges"})
    EXPECT_TRUE(is_caught(name, inclusive_edges())) << name;
}

TEST(SuiteMustFail, DepthAndColourThatAreOffAreSeenAndTheSearchNoticesThatItReportsAnotherError) {
  for (const auto name : {"steep_planes", "mean_bias", "adversarial_depth"})
    EXPECT_TRUE(is_caught(name, every_depth_one_more())) << name;
  for (const auto name : {"random_families", "adversarial_color"})
    EXPECT_TRUE(is_caught(name, colors_turned())) << name;
}

TEST(SuiteMustFail, AFragmentThatIsOffBeforeTheOperationsIsSeen) {
  for (const std::size_t plane : {0, 2})
    for (const auto name : {"fans", "steep_planes", "closed_meshes"}) {
      EXPECT_TRUE(is_caught(name, fragments_one_more(plane))) << name;
      const Tally tally = run_one(name, fragments_one_more(plane), 0).front().tally;
      ASSERT_TRUE(tally.first) << name;
      EXPECT_EQ(tally.first->property, "fragments");
    }
}

TEST(SuiteMustFail, AnExceptionIsAFailureThatNamesItsUnit) {
  const Engine broken = [](const Scene&, const Config&, const RenderOptions&) -> Rendering {
    throw std::runtime_error("no engine today");
  };
  const Tally tally = run_one("fans", broken, 3).front().tally;
  ASSERT_TRUE(tally.first.has_value());
  EXPECT_EQ(tally.first->what, "no engine today");
  EXPECT_EQ(tally.first->place.unit, 3U);
}

// The worst depth of another fill rule is measured again by that rule: this unit covers a worse sample by it.
TEST(Stress, AWorstErrorIsMeasuredByTheFillRuleThatItWasFoundWith) {
  RunOptions options;
  options.seed = 3;
  options.names = {"fill_rules"};
  options.unit = 102;
  const auto results = run_cases(options);
  ASSERT_EQ(results.size(), 1u);
  EXPECT_EQ(results[0].tally.failures, 0u);
  ASSERT_TRUE(results[0].tally.worst.contains("depth"));
  EXPECT_NE(results[0].tally.worst.at("depth").place.rule, FillRule::top_left);
}

TEST(SuiteRun, TheSameWhateverTheNumberOfThreads) {
  RunOptions options;
  options.names = {"fans", "mean_bias", "t_junctions"};
  options.config = preset("tiny");
  const auto one = run_cases(options);
  options.threads = 3;
  const auto three = run_cases(options);
  ASSERT_EQ(one.size(), three.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    const Tally &a = one[i].tally, &b = three[i].tally;
    EXPECT_EQ(a.triangles, b.triangles);
    EXPECT_EQ(a.checks, b.checks);
    EXPECT_EQ(a.failures, 0U);
    ASSERT_EQ(a.worst.size(), b.worst.size());
    for (const auto& [property, worst] : a.worst) {
      EXPECT_EQ(worst.value, b.worst.at(property).value) << property;
      EXPECT_EQ(worst.place.unit, b.worst.at(property).place.unit) << property;
    }
  }
}

}  // namespace
}  // namespace halfplane::stress::stress_test
