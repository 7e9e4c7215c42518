// Several samples a pixel: the pattern, a triangle at a sample, the engines' samples, and the resolved picture.
#include "model/stages/multisample.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "../scene_builder.hpp"
#include "model/engines/functional.hpp"
#include "model/engines/scalar.hpp"
#include "model/engines/tapped_fragment.hpp"
#include "model/engines/target.hpp"
#include "model/generate/raster_pkg.hpp"
#include "model/golden/exact.hpp"
#include "model/golden/golden.hpp"
#include "model/host/primitive_stream.hpp"
#include "model/stages/fragment_ops.hpp"
#include "model/stages/resolve.hpp"
#include "sim/cosim/random_scene.hpp"
#include "sim/scene/builtin.hpp"
#include "sim/scene/random_state.hpp"
#include "sim/study/compare/compare.hpp"
#include "sim/study/compare/fragment_judge.hpp"
#include "sim/study/stress/unit.hpp"

namespace halfplane::multisample_test {
namespace {

Config sampled(std::string_view name, int samples, std::string_view pattern = "standard") {
  Config config = preset(name);
  config.msaa_samples = samples;
  config.msaa_pattern = parse_sample_pattern(pattern);
  while (config.stamp_size * config.stamp_size * samples > 64) config.stamp_size /= 2;
  validate(config);
  return config;
}

/// The patterns that most tests run over: standard ones, at the centre and on a grid finer than the vertices' grid.
std::vector<Config> sampled_configs() {
  std::vector<Config> configs;
  for (const char* name : {"tiny", "embedded", "full"})
    for (const int samples : {2, 4, 8}) configs.push_back(sampled(name, samples));
  configs.push_back(sampled("tiny", 2, "0,0;0.99609375,0.99609375"));
  configs.push_back(sampled("embedded", 4, "0.5,0.5;0.0078125,0.25;0.25,0.9921875;0.75,0.75"));
  Config whole = sampled("tiny", 4);
  whole.subpixel_bits = 0;
  configs.push_back(whole);
  return configs;
}

std::string refusal(const Config& config) {
  try {
    validate(config);
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

/// Triangles large and small, lines and points of all states, as the configuration takes them.
Scene random_samples(const Config& config, std::uint64_t seed) {
  Config plain = config;
  plain.msaa_samples = 1;
  plain.msaa_pattern = {};
  Scene scene = random_scene(plain, seed, 40);
  stress::Random random(seed);
  for (State& state : scene.states)
    if (random.index(3) != 0)
      state = random_state(state,
                           states_named({"sample_mask", "alpha_to_coverage", "blend", "color_mask", "stencil",
                                         "stencil_back", "dither", "alpha_test"}),
                           chooser(random));
  return scene;
}

void expect_same_samples(const Framebuffer& a, const Framebuffer& b) {
  ASSERT_EQ(a.depth, b.depth);
  ASSERT_EQ(a.color, b.color);
  ASSERT_EQ(a.stencil, b.stencil);
  ASSERT_EQ(a.samples.size(), b.samples.size());
  for (std::size_t k = 0; k < a.samples.size(); ++k) {
    SCOPED_TRACE("sample " + std::to_string(k));
    expect_same_samples(a.samples[k], b.samples[k]);
  }
}

TEST(SamplePattern, StandardPlacesAreThoseOfDirect3DAndVulkan) {
  EXPECT_EQ(to_string(resolved_pattern({}, 1)), "0.5,0.5");
  EXPECT_EQ(to_string(resolved_pattern({}, 2)), "0.75,0.75;0.25,0.25");
  EXPECT_EQ(to_string(resolved_pattern({}, 4)), "0.375,0.125;0.875,0.375;0.125,0.625;0.625,0.875");
  EXPECT_EQ(to_string(resolved_pattern({}, 8)),
            "0.5625,0.3125;0.4375,0.6875;0.8125,0.5625;0.3125,0.1875;0.1875,0.8125;0.0625,0.4375;0.6875,0.9375;"
            "0.9375,0.0625");
  for (const int samples : {2, 4, 8})
    EXPECT_EQ(pattern_bits(resolved_pattern({}, samples)), std::countr_zero(2U * static_cast<unsigned>(samples)));
}

TEST(SamplePattern, ReadsBackWhatItWritesAndRefusesWhatIsNoPlace) {
  for (const char* text : {"standard", "0,0;0.99609375,0.5", "0.5,0.5"})
    EXPECT_EQ(to_string(parse_sample_pattern(text)), text);
  for (const char* bad : {"", "0.5", "0.5,", "0.5;0.5", "1,0", "-0.25,0", "0.001,0", "0,0;", "0,0;;1,1", "x,y", "nan,0",
                          "0,0;0,0;0,0;0,0;0,0;0,0;0,0;0,0;0,0"})
    EXPECT_THROW((void)parse_sample_pattern(bad), InputError) << bad;
}

TEST(SamplePattern, ConfigurationsThatNoStampOrPatternFitsAreRefusedByName) {
  Config config = preset("full");
  config.msaa_samples = 8;
  EXPECT_NE(refusal(config).find("stamp.size"), std::string::npos);
  config.msaa_samples = 4;
  EXPECT_EQ(refusal(config), "");
  config.msaa_samples = 3;
  EXPECT_NE(refusal(config).find("msaa.samples"), std::string::npos);
  config.msaa_samples = 2;
  config.msaa_pattern = parse_sample_pattern("0.5,0.5");
  EXPECT_NE(refusal(config).find("msaa.pattern has 1"), std::string::npos);
  config.msaa_samples = 1;
  EXPECT_NE(refusal(config).find("msaa.pattern"), std::string::npos);
}

TEST(SamplePattern, HardwareWithASerialSetupRefusesSeveralSamplesByName) {
  const auto expect_refused = [](auto&& work) {
    try {
      work();
      FAIL() << "not refused";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("msaa.samples"), std::string::npos) << error.what();
    }
  };
  const Scene scene = make_builtin("triangle", 32, 32, {}, 1);
  const Config serial = sampled("small", 2);
  expect_refused([&] { check_hardware_scene(scene, serial); });
  expect_refused([&] { (void)raster_pkg(serial); });
  const Config config = sampled("embedded", 4);
  check_hardware_scene(scene, config);
  RenderOptions options;
  options.rules.traversal = Traversal::bbox;
  expect_refused([&] { (void)render_scalar(scene, config, options); });
}

TEST(Multisample, ASetupAtASampleHasTheEdgesOfTheMovedTriangleAndItsPlanesButForRoundings) {
  stress::Random random(7);
  for (const Config& config : sampled_configs()) {
    SCOPED_TRACE(label(config));
    const Widths widths = derive_widths(config);
    const int scale = 1 << (widths.grid_bits - config.subpixel_bits), reach = config.guard_band / 2;
    for (int n = 0; n < 300; ++n) {
      Triangle t;
      for (SnappedVertex& v : t.v) {
        v.x = static_cast<std::int32_t>(random.integer(-reach, reach) * (scale << config.subpixel_bits) +
                                        random.index(1 << config.subpixel_bits) * scale);
        v.y = static_cast<std::int32_t>(random.integer(-reach, reach) * (scale << config.subpixel_bits) +
                                        random.index(1 << config.subpixel_bits) * scale);
        for (std::size_t p = 0; p < static_cast<std::size_t>(widths.affine_planes); ++p)
          v.code[p] = static_cast<std::uint32_t>(random.next() & ((1ULL << widths.of_plane(p).code.bits) - 1));
      }
      const TriangleSetup setup = setup_triangle(t, config, widths);
      if (setup.is_empty()) continue;
      for (int k = 0; k < config.msaa_samples; ++k) {
        const SampleOffset o = widths.sample_offset[static_cast<std::size_t>(k)];
        const TriangleSetup at = setup_at_sample(setup, o, widths);
        const Triangle moved = moved_to_sample(t, o);
        const TriangleSetup expected = setup_triangle(moved, config, widths);
        const int x = setup.left + random.index(64), y = setup.top + random.index(64), shift = widths.tile_shift;
        EXPECT_EQ(edges_at_tile(at, x >> shift, y >> shift, widths),
                  edges_at_tile(expected, x >> shift, y >> shift, widths));
        for (std::size_t p = 0; p < static_cast<std::size_t>(widths.affine_planes); ++p)
          // The moved triangle's anchor is rounded once; here the steps to the sample are, and their sum.
          EXPECT_LE(std::abs(plane_at(at, p, widths, x, y).unrounded - plane_at(expected, p, widths, x, y).unrounded),
                    2);
      }
    }
  }
}

TEST(Multisample, EverySampleOfRandomScenesIsTheExactOraclesAndItsDepthWithinTheBound) {
  for (const Config& plain : sampled_configs())
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      const Scene scene = random_samples(plain, seed);
      const Config config = with_alpha(plain, scene);
      SCOPED_TRACE(label(config) + ", seed " + std::to_string(seed));
      FragmentJudge judge(scene, config);
      RenderOptions options;
      options.fragment_tap = [&judge](const TappedFragment& fragment) { judge.add(fragment); };
      const FragmentVerdict verdict = judge.finish(render_scalar(scene, config, options));
      EXPECT_GT(verdict.coverage.samples, 100U);
      const auto broken = broken_fragment_bounds(verdict, config);
      EXPECT_TRUE(broken.empty()) << broken.front();
    }
}

TEST(MultisampleMustFail, TheJudgeNoticesAnotherSamplesCoverageDepthAndPlaceOfColour) {
  const Config config = sampled("embedded", 4);
  const Scene scene = make_builtin("teapot", 80, 60, {}, 1);
  const auto broken_by = [&](auto&& damage) {
    FragmentJudge judge(scene, config);
    RenderOptions options;
    options.fragment_tap = [&](TappedFragment fragment) {
      damage(fragment);
      judge.add(fragment);
    };
    return broken_fragment_bounds(judge.finish(render_scalar(scene, config, options)), config);
  };
  const Widths widths = derive_widths(config);
  EXPECT_TRUE(broken_by([](TappedFragment&) {}).empty());
  EXPECT_FALSE(broken_by([](TappedFragment& f) { f.sample = f.sample % 4 < 2 ? 1 - f.sample : f.sample; }).empty());
  EXPECT_FALSE(broken_by([](TappedFragment& f) { f.shaded_at = kAtCentre; }).empty());
  EXPECT_FALSE(broken_by([&](TappedFragment& f) {  // the depth of the centre
                 f.plane[kDepthPlane] =
                     plane_at(setup_triangle(*f.triangle, config, widths), kDepthPlane, widths, f.x, f.y);
               })
                   .empty());
}

TEST(Multisample, TheFunctionalEngineDrawsTheStagesBits) {
  for (const Config& config : sampled_configs())
    for (std::uint64_t seed = 11; seed <= 14; ++seed)
      for (const bool skips : {true, false}) {
        SCOPED_TRACE(label(config) + ", seed " + std::to_string(seed));
        const Scene scene = random_samples(config, seed);
        RenderOptions options;
        options.want_count = options.want_ids = options.want_triangles = true;
        if (!skips) options.skip = skip_none();
        const Rendering fast = render_functional(scene, config, options),
                        scalar = render_scalar(scene, config, options);
        expect_same_samples(fast.frame, scalar.frame);
        EXPECT_EQ(fast.count, scalar.count);
        EXPECT_EQ(fast.ids, scalar.ids);
        EXPECT_EQ(fast.visible, scalar.visible);
        EXPECT_EQ(fast.counters.covered, scalar.counters.covered);
        EXPECT_EQ(fast.counters.depth_passed, scalar.counters.depth_passed);
        EXPECT_EQ(fast.counters.alpha_killed, scalar.counters.alpha_killed);
        EXPECT_EQ(fast.counters.written, scalar.counters.written);
        EXPECT_EQ(fast.counters.samples_tested, scalar.counters.samples_tested);
      }
}

TEST(Multisample, SurfacesAreTheSameInBothEnginesAndWithinTheirBounds) {
  const Config config = sampled("embedded", 4);
  for (const char* name : {"layers_nearest:8", "layers_linear:8"}) {
    SCOPED_TRACE(name);
    const Scene scene = make_builtin(name, 96, 64, {}, 1);
    expect_same_samples(render_functional(scene, config).frame, render_scalar(scene, config).frame);
    const Comparison c = compare(scene, config);
    EXPECT_TRUE(broken_bounds(c, config).empty()) << broken_bounds(c, config).front();
    EXPECT_TRUE(c.texture.has_value());
  }
}

TEST(Multisample, ASharedEdgeIsDrawnOnceAtEverySample) {
  stress::Random random(3);
  for (const Config& config : sampled_configs())
    for (int n = 0; n < 20; ++n) {
      SCOPED_TRACE(label(config));
      // Four triangles round a random point, over all of the target and beyond.
      SceneBuilder builder(16, 16, SceneBuilder::window_state());
      const double step = std::ldexp(1.0, -config.subpixel_bits);
      const auto inside = [&] { return std::floor(random.between(0, 16) / step) * step; };
      const Vertex middle{.x = inside(), .y = inside(), .z = 0.5};
      const auto corner = [](double x, double y) { return Vertex{.x = x, .y = y, .z = 0.5}; };
      const std::array corners{corner(-3, -3), corner(19, -3), corner(19, 19), corner(-3, 19)};
      for (std::size_t i = 0; i < 4; ++i) builder.triangle(corners[i], corners[(i + 1) % 4], middle);
      RenderOptions options;
      options.want_count = true;
      const Rendering rendering = render_functional(builder.scene, config, options);
      for (const std::uint32_t count : rendering.count)
        ASSERT_EQ(count, static_cast<std::uint32_t>(config.msaa_samples));
    }
}

TEST(Multisample, AllSamplesAtTheCentreGiveThePictureOfOne) {
  const Config many = sampled("embedded", 2, "0.5,0.5;0.5,0.5");
  for (const char* name : {"teapot", "city", "layers_leaves:8"}) {
    const Scene scene = make_builtin(name, 120, 90, {}, 1);
    const Rendering one = render_functional(scene, preset("embedded")), two = render_functional(scene, many);
    EXPECT_EQ(two.frame.color, one.frame.color) << name;
    EXPECT_EQ(two.frame.depth, one.frame.depth) << name;
    EXPECT_EQ(two.counters.written, 2 * one.counters.written) << name;
  }
}

TEST(Multisample, StatesOfSamplesDoNothingToAPixelOfOne) {
  Scene scene = make_builtin("teapot", 80, 60, {}, 1);
  const Rendering plain = render_functional(scene, preset("embedded"));
  for (State& state : scene.states) {
    state.sample_mask = 0;
    state.alpha_to_coverage = true;
  }
  for (Vertex& v : scene.vertices) v.rgba[3] = 0;
  EXPECT_EQ(render_functional(scene, preset("embedded")).frame.color, plain.frame.color);
  EXPECT_EQ(render_scalar(scene, preset("embedded")).frame.color, plain.frame.color);
  check_hardware_scene(scene, preset("embedded"));
}

/// A white triangle over all of a target.
SceneBuilder over_all(const State& state, double alpha = 255) {
  SceneBuilder builder(16, 16, state);
  const auto at = [alpha](double x, double y) {
    return Vertex{.x = x, .y = y, .z = 0.25, .rgba = {255, 255, 255, alpha}};
  };
  builder.triangle(at(-4, -4), at(40, -4), at(-4, 40));
  return builder;
}

TEST(Multisample, TheSampleMaskAndAlphaChooseSamples) {
  Config config = sampled("embedded", 4);
  config.color_format = ColorFormat::rgba8888;
  const auto drawn = [&config](const Scene& scene) {
    unsigned samples = 0;
    const Rendering rendering = render_functional(scene, config);
    for (std::size_t k = 0; k < 4; ++k) samples |= (rendering.frame.samples[k].color[0] & 255U) == 255 ? 1U << k : 0U;
    EXPECT_EQ(rendering.frame.color[0] & 255U, (255U * static_cast<unsigned>(std::popcount(samples)) + 2) / 4);
    EXPECT_EQ(rendering.frame.color, golden::render(scene, config).frame.color);
    return samples;
  };
  State state = SceneBuilder::window_state();
  EXPECT_EQ(drawn(over_all(state).scene), 15U);
  for (const std::uint32_t mask : {0U, 1U, 6U, 15U, 255U}) {
    state.sample_mask = mask;
    EXPECT_EQ(drawn(over_all(state).scene), mask & 15U);
  }
  state.sample_mask.reset();
  state.alpha_to_coverage = true;
  for (int alpha = 0; alpha < 256; ++alpha) {
    const int count = static_cast<int>(std::floor(alpha / 255.0 * 4 + 0.5));
    EXPECT_EQ(samples_of_alpha<std::uint32_t>(static_cast<std::uint32_t>(alpha), 4), static_cast<std::uint32_t>(count));
    if (alpha % 17 != 0) continue;
    EXPECT_EQ(drawn(over_all(state, alpha).scene), (1U << count) - 1) << alpha;
  }
  state.sample_mask = 5;
  EXPECT_EQ(drawn(over_all(state, 128).scene), 1U);  // two by alpha, of which the mask keeps one
}

TEST(Multisample, LinesAndPointsCoverAllSamples) {
  const Config config = sampled("embedded", 4);
  for (const char* name : {"wires"}) {
    const Scene scene = make_builtin(name, 80, 60, {}, 1);
    const Rendering many = render_functional(scene, config), one = render_functional(scene, preset("embedded"));
    EXPECT_EQ(many.frame.color, one.frame.color) << name;
    EXPECT_EQ(many.counters.covered, 4 * one.counters.covered) << name;
    const Comparison c = compare(scene, config);
    EXPECT_TRUE(broken_bounds(c, config).empty()) << broken_bounds(c, config).front();
  }
}

TEST(Resolve, IsTheMeanOfEachChannelRounded) {
  stress::Random random(5);
  for (const ColorFormat format : {ColorFormat::rgb565, ColorFormat::rgba8888})
    for (const int samples : {2, 4, 8})
      for (int n = 0; n < 2000; ++n) {
        std::array<std::uint32_t, 8> color{};
        for (std::uint32_t& c : color)
          c = static_cast<std::uint32_t>(random.next()) & (format == ColorFormat::rgb565 ? 0xFFFFU : ~0U);
        const std::uint32_t mean =
            mean_color(format, samples, [&](int k) { return color[static_cast<std::size_t>(k)]; });
        for (int c = 0; c < golden::channel_count(format); ++c) {
          double sum = 0;
          for (int k = 0; k < samples; ++k)
            sum += golden::stored_channel(color[static_cast<std::size_t>(k)], format, c);
          ASSERT_EQ(golden::stored_channel(mean, format, c), static_cast<int>(std::floor(sum / samples + 0.5)));
        }
      }
}

TEST(Resolve, ATargetThatStaysKeepsItsSamples) {
  const Config config = sampled("embedded", 4);
  const Scene scene = make_builtin("teapot", 64, 48, {}, 1);
  Target target(config, 64, 48, scene.planes);
  (void)target.draw(scene);
  EXPECT_EQ(target.frame().color, render_functional(scene, config).frame.color);
  std::vector<std::uint32_t> depth(64 * 48);
  std::vector<std::uint16_t> color(64 * 48);
  const PixelMemory memory{color.data(), 128, depth.data(), 256};
  target.copy_to(memory);
  const std::uint32_t before = target.frame().color[target.frame().at(32, 24)];
  target.copy_from(memory);
  (void)target.draw(State{}, Topology::triangles, std::vector<Vertex>{});
  EXPECT_EQ(target.frame().color[target.frame().at(32, 24)], before);
  RenderOptions options;
  const Framebuffer other(64, 48, 8);  // of one sample
  options.onto = &other;
  EXPECT_THROW((void)render_functional(scene, config, options), InputError);
}

TEST(CompareSamples, CleanScenesBreakNoBoundAndShowBetterEdges) {
  const Scene scene = make_builtin("teapot", 160, 120, {}, 1);
  for (const int samples : {2, 4, 8}) {
    const Config config = sampled("embedded", samples);
    const Comparison c = compare(scene, config);
    EXPECT_TRUE(broken_bounds(c, config).empty()) << broken_bounds(c, config).front();
    EXPECT_EQ(c.oracle.mismatches, 0U);
    EXPECT_EQ(c.stage_mismatches, 0U);
    EXPECT_GT(c.compared_pixels, 1000U * static_cast<unsigned>(samples));
    EXPECT_GT(c.color_lsb.count, 1000U);
    EXPECT_LT(c.color_lsb.rms, 1);
  }
}

TEST(CompareSamplesMustFail, ADamagedSampleAndAWrongMeanAreReported) {
  const Config config = sampled("embedded", 4);
  const Scene scene = make_builtin("teapot", 64, 48, {}, 1);
  const auto broken_by = [&](const std::function<void(Rendering&)>& damage) {
    CompareOptions options;
    options.engine = [&damage](const Scene& s, const Config& c, const RenderOptions& asked) {
      Rendering rendering = render_functional(s, c, asked);
      damage(rendering);
      return rendering;
    };
    return broken_bounds(compare(scene, config, options), config);
  };
  const std::size_t at = Framebuffer(64, 48, 8).at(32, 24);
  EXPECT_TRUE(broken_by([](Rendering&) {}).empty());
  EXPECT_FALSE(broken_by([at](Rendering& r) { ++r.frame.samples[2].depth[at]; }).empty());
  EXPECT_FALSE(broken_by([at](Rendering& r) { r.frame.samples[3].color[at] ^= 1; }).empty());
  EXPECT_FALSE(broken_by([at](Rendering& r) { r.frame.color[at] ^= 1; }).empty());
  EXPECT_FALSE(broken_by([at](Rendering& r) { r.frame.depth[at] ^= 1; }).empty());
}

}  // namespace
}  // namespace halfplane::multisample_test
