// Depth quantization measured in the pipeline: errors under their bounds and close to them, surfaces that keep their
// order at the predicted separation and lose it at half of it, suggestions that hold when tried.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "../tier.hpp"
#include "sim/scene/builtin.hpp"
#include "sim/scene/mesh_scene.hpp"
#include "sim/study/depth/answers.hpp"
#include "sim/study/depth/measure.hpp"
#include "sim/study/depth/two_planes.hpp"

namespace halfplane::depth_measure_test {
namespace {

constexpr std::array kMappings{DepthMapping::std,    DepthMapping::rev, DepthMapping::stdinf,
                               DepthMapping::revinf, DepthMapping::w,   DepthMapping::log};

DepthVariant variant(DepthMapping mapping, std::string_view format, DepthPlanes planes,
                     std::string_view config = "embedded") {
  return make_variant(preset(config), mapping, parse_depth_format(format), planes);
}

TEST(DepthMeasure, ErrorsStayUnderTheirBoundAndComeCloseToIt) {
  const Scene scenes[] = {make_builtin("teapot", 200, 150, {}, 1), make_builtin("knot", 200, 150, {}, 1)};
  for (const DepthMapping mapping : kMappings)
    for (const auto format : {"u12", "u16", "bins14", "f16", "uf4.12", "u24"}) {
      double share = 0;
      for (const Scene& scene : scenes) {
        const DepthMeasurement m = measure_depth(scene, variant(mapping, format, {0.5, 100}));
        SCOPED_TRACE(variant(mapping, format, {0.5, 100}).name());
        EXPECT_GT(m.fragments, 5000U);
        EXPECT_EQ(m.stage_mismatches, 0U);
        EXPECT_LE(m.worst_share, 1.0);
        EXPECT_NEAR(m.snap.mean + m.interpolation.mean + m.storage.mean, m.total.mean, 1e-9);
        share = std::max(share, m.worst_share);
      }
      EXPECT_GE(share, 0.8) << variant(mapping, format, {0.5, 100}).name();
    }
}

/// The fights of two surfaces at `part` of the predicted separation.
DepthOrder tried(const DepthVariant& v, double z, const SurfaceView& view, double part) {
  MeasureOptions options;
  options.wants_errors = false;
  return measure_depth(two_planes(DepthBound(v), z, view, part, 3), v, options).order;
}

TEST(DepthMeasure, PlanesAtThePredictedSeparationNeverFightAndAtHalfOfItTheyDo) {
  struct Place {
    DepthPlanes planes;
    double z;
  };
  int tries = 0, number = 0;
  for (const char* config : {"embedded", "full"})
    for (const DepthMapping mapping : kMappings)
      for (const auto format : {"u12", "u16", "bins16", "f16", "uf4.12"})
        for (const Place& place : {Place{{1, 1000}, 3.0}, {{1, 1000}, 40.0}, {{0.1, 50}, 20.0}})
          for (const double slope : {0.0, 0.5, 3.0}) {
            if (number++ % 4 != 0 && !test::runs_all()) continue;  // every day a quarter, with each value of each
            const DepthVariant v = variant(mapping, format, place.planes, config);
            const SurfaceView view{slope, 45, 240, 180};
            const double separation = surface_separation(DepthBound(v), place.z, view).total();
            SCOPED_TRACE(v.name() + ", " + config + ", z " + std::to_string(place.z) + ", slope " +
                         std::to_string(slope) + ", separation " + std::to_string(separation));
            if (separation > 0.1 * place.z) continue;  // resolution is low there: no room beyond the surfaces
            const DepthOrder whole = tried(v, place.z, view, 1);
            ++tries;
            EXPECT_GT(whole.pairs, 2000U);
            EXPECT_EQ(whole.fights(), 0U);
            EXPECT_GT(tried(v, place.z, view, 0.5).fights(), 0U);
          }
  EXPECT_GT(tries, test::cases(75, 300));
}

TEST(DepthMeasure, FightsFallWithBitsAndWithSubpixelBits) {
  const Scene scene = make_builtin("coplanar", 160, 120, {}, 1);
  const auto sweeps =
      sweep_depth(scene, preset("embedded"), {DepthMapping::std, DepthMapping::w}, 20, *scene.planes, 1, {});
  ASSERT_EQ(sweeps.size(), 2U);
  for (const DepthSweep& sweep : sweeps)
    for (const auto& line : sweep.lines) {
      SCOPED_TRACE(sweep.what + ", " + line.name);
      ASSERT_GE(line.rate.size(), 4U);
      EXPECT_LT(line.rate.back(), 0.7 * line.rate.front());
      for (const double rate : line.rate) EXPECT_LT(rate, 1);
    }
}

TEST(DepthMeasure, AnswersHoldWhenTried) {
  const Scene scene = make_builtin("coplanar", 160, 120, {}, 1);
  const DepthVariant base = variant(DepthMapping::std, "u12", {0.01, 100});
  const DepthMeasurement measured = measure_depth(scene, base);
  const auto trials = try_changes(scene, base, measured, 1, {});
  ASSERT_GE(trials.size(), 5U);
  bool has_near = false;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    const DepthMeasurement again = measure_depth(scene, trials[i].variant);
    EXPECT_EQ(again.order.fights(), trials[i].result.order.fights()) << trials[i].what;
    EXPECT_EQ(again.total.rms, trials[i].result.total.rms) << trials[i].what;
    EXPECT_LE(trials[0].result.order.fights(), again.order.fights()) << trials[i].what;
    if (trials[i].variant.config.subpixel_bits == base.config.subpixel_bits) {
      EXPECT_EQ(again.fragments, measured.fragments) << trials[i].what;  // nothing is clipped
    }
    has_near |= trials[i].options.starts_with("--near");
  }
  EXPECT_TRUE(has_near);
  const auto answers = depth_answers(base, measured, trials);
  ASSERT_EQ(answers.size(), 3U);
  EXPECT_NE(answers[1].find(trials[0].options), std::string::npos);
  // The near plane was absurd: at equal storage the best trial moves it away from 0.01.
  EXPECT_LT(trials[0].result.order.fights(), measured.order.fights() / 2);
}

TEST(DepthMeasure, ThreadsDoNotChangeWhatIsMeasured) {
  const Scene scene = make_builtin("teapot", 120, 90, {}, 1);
  const std::vector<DepthVariant> variants{variant(DepthMapping::std, "u12", {1, 100}),
                                           variant(DepthMapping::w, "u12", {1, 100}),
                                           variant(DepthMapping::rev, "f16", {1, 100})};
  const auto one = measure_depths(scene, variants, {}, 1), three = measure_depths(scene, variants, {}, 3);
  for (std::size_t i = 0; i < variants.size(); ++i) {
    EXPECT_EQ(one[i].total.rms, three[i].total.rms);
    EXPECT_EQ(one[i].order.fights(), three[i].order.fights());
  }
}

TEST(DepthMeasure, RefusesScenesWhoseEyeDepthItDoesNotKnow) {
  const auto refused = [](auto&& change) {
    Scene scene = make_builtin("teapot", 32, 32, {}, 1);
    change(scene);
    EXPECT_THROW((void)measure_depth(scene, variant(DepthMapping::std, "u16", {1, 100})), InputError);
  };
  refused([](Scene& s) { s.states[0].polygon_offset = {1, 1}; });
  refused([](Scene& s) { s.states[0].depth_range = {0.25, 1}; });
  refused([](Scene& s) { s.states[0].space = Space::window; });
  // Surfaces of different frames, or before and after a clear, never meet.
  refused([](Scene& s) {
    s.commands.emplace_back(EndFrame{});
    s.commands.push_back(s.commands[1]);
  });
  refused([](Scene& s) {
    s.commands.push_back(Clear{0, {}, 1.0});
    s.commands.push_back(s.commands[1]);
  });
}

// On a floor that ends just above a row of pixel centres the snapped triangle covers samples where the true one, extended,
// is behind the eye: they have no eye depth.
TEST(DepthMeasure, SamplesThatOnlyTheSnapCoversHaveNoEyeDepth) {
  constexpr double kHeight = 0.01, kFar = 999, kScale = 2.414, kAspect = 320.0 / 240;
  Scene scene = cleared_scene(320, 240);
  scene.planes = {1.0, 1000.0};
  const double climb = (1 - 2 * 100.52 / 240) / kScale + kHeight / kFar;  // far edge at y = 100.52
  for (const auto& [x, z] : {std::pair{-0.5, 1.2}, {0.5, 1.2}, {0.5, kFar}, {-0.5, kFar}})
    scene.vertices.push_back({x * z * kScale / kAspect, (climb * z - kHeight) * kScale, 0, z});
  scene.indices = {0, 1, 2, 0, 2, 3};
  scene.commands.push_back(Draw{0, 0, Topology::triangles, 0, 6, 0});
  const DepthMeasurement m = measure_depth(scene, variant(DepthMapping::std, "u16", {1, 1000}));
  EXPECT_GT(m.beyond, 0U);
  EXPECT_GT(m.eye_min, 0);
  EXPECT_GT(m.fragments, 300U);
  EXPECT_LE(m.worst_share, 1);
}

}  // namespace
}  // namespace halfplane::depth_measure_test
