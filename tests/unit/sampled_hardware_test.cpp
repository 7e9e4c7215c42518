// Several samples a pixel in hardware: its packets and its cycle engine draw the specification's picture, sample by sample.
#include <gtest/gtest.h>

#include "../tier.hpp"
#include "model/capture/capture.hpp"
#include "model/engines/cycle/cycle_model.hpp"
#include "model/engines/functional.hpp"
#include "model/engines/hardware.hpp"
#include "model/engines/scalar.hpp"
#include "model/stages/stencil_packets.hpp"
#include "model/timing/memory.hpp"
#include "sim/cosim/random_scene.hpp"
#include "sim/cosim/specification.hpp"
#include "sim/scene/builtin.hpp"
#include "sim/scene/random.hpp"
#include "sim/show/image/framebuffer_files.hpp"
#include "sim/show/report/hardware.hpp"

namespace halfplane::sampled_hardware_test {
namespace {

Config hardware(std::string_view name, int samples, std::string_view pattern = "standard", bool has_units = false) {
  Config config = preset(name);
  config.msaa_samples = samples;
  config.msaa_pattern = parse_sample_pattern(pattern);
  while (config.stamp_size * config.stamp_size * samples > 64) config.stamp_size /= 2;
  if (has_units) {
    config.cache_kind = CacheKind::blocks;
    config.blend_lanes = 4;
    config.alpha_units = config.dither_units = 1;
    config.stencil_bits = 8;
  }
  validate(config);
  return config;
}

Config textured(Config config) {
  config.texture_unit = TextureUnitKind::bilinear;
  return config;
}

/// The configurations of the tests: both framebuffers, every number of samples, all units, patterns of another kind.
std::vector<Config> sampled_hardware() {
  std::vector<Config> configs{hardware("tiny", 2), hardware("tiny", 8)};
  for (const int samples : {2, 4, 8}) configs.push_back(hardware("embedded", samples));
  for (const int samples : {2, 4, 8}) configs.push_back(hardware("full", samples));
  configs.push_back(hardware("embedded", 4, "standard", true));
  configs.push_back(hardware("full", 4, "standard", true));
  configs.push_back(hardware("embedded", 2, "0,0;0.99609375,0.99609375", true));
  for (const bool has_units : {false, true})
    configs.push_back(textured(hardware("embedded", 4, "standard", has_units)));
  configs.push_back(textured(hardware("tiny", 2, "standard", true)));
  configs.back().perspective_colors = 1;
  configs.push_back(textured(hardware("embedded", 8, "standard", true)));
  configs.back().texture_lanes = 4;
  configs.back().fog_units = configs.back().shade_units = 1;
  for (const Config& config : configs) validate(config);
  return configs;
}

Config compressed(Config config) {
  config.cache_kind = CacheKind::blocks;
  config.compress_units = 1;
  validate(config);
  return config;
}

/// The subset for tests of blocks with one colour a pixel: wide ports and narrow ones, stamps of one pixel and of a
/// block.
std::vector<Config> compressed_hardware() {
  std::vector<Config> configs{compressed(hardware("tiny", 2)),
                              compressed(hardware("embedded", 4)),
                              compressed(hardware("embedded", 2, "0,0;0.99609375,0.99609375", true)),
                              compressed(hardware("embedded", 4, "standard", true)),
                              compressed(hardware("full", 4)),
                              compressed(textured(hardware("embedded", 8, "standard", true)))};
  configs.push_back(configs[1]);
  configs.back().stamp_size = 1;
  configs.back().memory_port_bits = 16;
  configs.push_back(configs[3]);
  configs.back().memory_port_bits = 512;
  configs.back().frame_clears = FrameClears::flags;
  configs.push_back(configs[3]);
  configs.back().frame_order = FrameOrder::bins;
  configs.back().frame_store = FrameStore::color;
  for (const Config& config : configs) validate(config);
  return configs;
}

/// Where depths stay on the chip.
void expect_color(const Framebuffer& a, const Framebuffer& b) {
  ASSERT_EQ(a.color, b.color);
  ASSERT_EQ(a.samples.size(), b.samples.size());
  for (std::size_t k = 0; k < a.samples.size(); ++k) ASSERT_EQ(a.samples[k].color, b.samples[k].color);
}

void expect_same(const Framebuffer& a, const Framebuffer& b, const Config& config) {
  ASSERT_EQ(a.color, b.color);
  ASSERT_EQ(a.depth, b.depth);
  if (has_stencil(config)) {
    ASSERT_EQ(a.stencil, b.stencil);
  }
  ASSERT_EQ(a.samples.size(), b.samples.size());
  for (std::size_t k = 0; k < a.samples.size(); ++k) {
    SCOPED_TRACE("sample " + std::to_string(k));
    expect_same(a.samples[k], b.samples[k], config);
  }
}

void expect_the_specifications(const std::vector<Config>& configs) {
  for (const Config& config : configs)
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
      SCOPED_TRACE(label(config) + ", seed " + std::to_string(seed));
      const Scene scene = random_scene(config, seed, 40);
      const Rendering scalar = render_scalar(scene, config), hardware = render_hardware(scene, config);
      {
        SCOPED_TRACE("packets against the specification");
        expect_color(hardware.frame, scalar.frame);
        if (config.frame_store == FrameStore::all) expect_same(hardware.frame, scalar.frame, config);
      }
      const auto memory = make_memory({}, config);
      const CycleRendering cycle = render_cycle(scene, config, *memory);
      expect_color(cycle.rendering.frame, hardware.frame);
      if (config.frame_store == FrameStore::all) expect_same(cycle.rendering.frame, hardware.frame, config);
      const Counters &a = hardware.counters, &b = cycle.rendering.counters;
      EXPECT_EQ(a.covered, b.covered);
      EXPECT_EQ(a.depth_passed, b.depth_passed);
      EXPECT_EQ(a.alpha_killed, b.alpha_killed);
      EXPECT_EQ(a.written, b.written);
      EXPECT_EQ(a.samples_tested, b.samples_tested);
      EXPECT_EQ(a.tiles_visited, b.tiles_visited);
      EXPECT_EQ(a.skipped.tiles_hiz, b.skipped.tiles_hiz);
      EXPECT_EQ(a.written, scalar.counters.written);
    }
}

TEST(SampledHardware, DrawsTheSpecificationsSamplesInRandomScenes) { expect_the_specifications(sampled_hardware()); }
TEST(SampledHardware, DrawsThemWithOneColourAPixelInMemory) { expect_the_specifications(compressed_hardware()); }

// Where centres are not covered, planes over w were others in the software engines: one random capture of a hundred.
TEST(SampledHardware, SurfacesAreTheSpecificationsInRandomConfigurations) {
  Random random(51);
  std::map<std::string, int> drawn;
  int count = 0;
  for (const int most = test::cases(80, 4000); count < most;) {
    const Config config = random_shading_config(random);
    const std::uint64_t seed = random.next();
    SCOPED_TRACE(label(config, " --set ") + ", seed " + std::to_string(seed));
    ASSERT_EQ(difference_from_specification(random_scene(config, seed, 60), config), "");
    ++count;
    ++drawn[config.preset + " " + std::to_string(config.msaa_samples)];
  }
  EXPECT_EQ(drawn.size(), 9u);
}

// A disagreement is reduced to its cause. The fault: a model that is one off at a pixel, as soon as something is drawn
// there.
TEST(SampledHardware, ADisagreementWithTheSpecificationIsReduced) {
  const Config config = preset("embedded");
  const PictureOf faulty = [](const Scene& scene, const Config& with) {
    Framebuffer frame = hardware_picture(scene, with);
    if (frame.width <= 20 || frame.height <= 20) return frame;
    const std::size_t at = frame.at(20, 20);
    if (frame.depth[at] != 0xffff) frame.color[at] ^= 1;
    return frame;
  };
  std::optional<Reduced> reduced;
  for (std::uint64_t seed = 1; !reduced && seed < 50; ++seed)
    reduced = reduce(random_scene(config, seed, 40), config, {}, specification_test(config, faulty));
  ASSERT_TRUE(reduced);
  EXPECT_EQ(reduced->primitives_after, 1U);
  EXPECT_NE(reduced->mismatch.hint.find("colour of pixel (20, 20): the model has"), std::string::npos)
      << reduced->mismatch.hint;
}

// The reference picture is from an independent integer model of docs/spec.md.
TEST(SampledHardware, PlanesOverWGainTheirNarrowedStepsAtASample) {
  const Scene scene = read_capture(
      "halfplane 1\ntarget 40 31\ntexture t inline rgba5551 2 1\ntexels 0000ffff\nspace window\n"
      "state texture t\nstate texture_min linear\nstate texture_mag linear\n"
      "v 16.016383127235365 1413.125 0.75 21.85564922064044 255 183 255 203 254.60086901479087 1.7711040752218477\n"
      "v 31.59375 32.03125 0.9637720605711171 0.001 40 152 255 128 0.5 0.5\n"
      "v 1.5 1.5 0.9637720605711171 4.0 68 254 228 254 0.5 0.5\n"
      "v 1.5 12.5 0.9637720605711171 1.0 128 149 244 254 0.5 0.5\nts 0 1 2 3\n",
      "case");
  Config config = preset("embedded");
  config.msaa_samples = config.stamp_size = 2;
  config.color_format = ColorFormat::rgba8888;
  config.texture_unit = TextureUnitKind::bilinear;
  for (const Rendering& rendering :
       {render_scalar(scene, config), render_functional(scene, config, {}), render_hardware(scene, config)})
    EXPECT_EQ(color_hash(rendering.frame, config.color_format), "74b6410f4c0221f9");
}

/// Most blocks of a scene have no edge in them, or only edges between equal colours.
TEST(SampledHardware, OneColourAPixelMovesFewerBytesInProgramOrder) {
  for (const char* name : {"teapot", "city"})
    for (const FrameClears clears : {FrameClears::resolve, FrameClears::flags}) {
      Config single = preset("embedded");
      single.frame_clears = clears;
      Config sampled = single;
      sampled.msaa_samples = 4;
      const auto bytes = [&](const Config& config) {
        const auto memory = make_memory({}, config);
        return traffic(render_cycle(make_builtin(name, 640, 480, {}, 1), config, *memory).run, config).total();
      };
      const auto all = bytes(sampled), fewer = bytes(compressed(sampled));
      EXPECT_LT(fewer, all) << name;
      EXPECT_LE(fewer, (clears == FrameClears::resolve ? 3.1 : 4.2) * static_cast<double>(bytes(single))) << name;
    }
}

/// The same with a unit that takes means.
Config with_resolve(Config config) {
  config.cache_kind = CacheKind::blocks;
  config.frame_order = FrameOrder::bins;
  config.frame_store = FrameStore::color;
  config.resolve_units = 1;
  validate(config);
  return config;
}

TEST(SampledHardware, StoresTheMeanOfAPixelsSamples) {
  for (Config config : sampled_hardware()) {
    config = with_resolve(config);
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
      SCOPED_TRACE(label(config) + ", seed " + std::to_string(seed));
      const Scene scene = random_scene(config, seed, 40);
      const Rendering scalar = render_scalar(scene, config), hardware = render_hardware(scene, config);
      EXPECT_EQ(hardware.frame.color, scalar.frame.color);
      EXPECT_TRUE(hardware.frame.samples.empty());
      const auto memory = make_memory({}, config);
      EXPECT_EQ(render_cycle(scene, config, *memory).rendering.frame.color, scalar.frame.color);
    }
  }
}

/// For a frame in bins, a chip that resolves to means moves the bytes of one sample a pixel; blocks with a covered
/// sample but no covered centre add slightly.
TEST(SampledHardware, MeansMoveAsManyBytesAsOneSample) {
  for (const char* name : {"teapot", "city"}) {
    Config single = preset("embedded");
    single.frame_order = FrameOrder::bins;
    single.frame_store = FrameStore::color;
    for (const FrameClears clears : {FrameClears::resolve, FrameClears::flags}) {
      single.frame_clears = clears;
      const auto bytes = [&](const Config& config) {
        const auto memory = make_memory({}, config);
        return traffic(render_cycle(make_builtin(name, 320, 240, {}, 1), config, *memory).run, config).total();
      };
      Config sampled = single;
      sampled.msaa_samples = 4;
      EXPECT_LE(bytes(with_resolve(sampled)), 1.1 * static_cast<double>(bytes(single))) << name;
    }
  }
}

TEST(SampledHardware, MeansWantFramesWhoseBlocksLeaveOnce) {
  Config config = hardware("embedded", 4);
  config.resolve_units = 1;
  EXPECT_THROW(validate(config), InputError);  // in program order
  config = with_resolve(hardware("embedded", 4));
  config.msaa_samples = 1;
  EXPECT_THROW(validate(config), InputError);
  Scene scene = random_scene(with_resolve(hardware("embedded", 4)), 1, 40);
  scene.commands.emplace_back(Clear{.depth = 1.0});
  EXPECT_THROW((void)render_hardware(scene, with_resolve(hardware("embedded", 4))), InputError);
}

}  // namespace
}  // namespace halfplane::sampled_hardware_test
