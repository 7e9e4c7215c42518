// The derived widths, tried: no intermediate leaves its range, and a range with a bit less is caught.
#include <gtest/gtest.h>

#include <sstream>

#include "model/capture/capture.hpp"
#include "model/engines/scalar.hpp"
#include "sim/scene/builtin.hpp"
#include "sim/scene/scene_builder.hpp"
#include "sim/study/compare/compare.hpp"
#include "sim/study/compare/surface_oracle.hpp"
#include "sim/study/widths/smallest.hpp"
#include "sim/study/widths/study.hpp"

namespace halfplane::widths_test {
namespace {

constexpr std::uint64_t kSeed = 20240229;

std::string text(int128 value) { return std::to_string(static_cast<double>(value)); }

bool is_legal(const Config& config) {
  try {
    validate(config);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

/// Random probes and each `stride`-th extreme one through one observer; every value inside its derived range.
void expect_within(const Config& config, int random_probes, std::size_t stride = 1) {
  WidthObserver observer(config);
  ProbeMaker maker(config, kSeed);
  for (int i = 0; i < random_probes; ++i) observer.observe(maker.random());
  const auto extremes = extreme_probes(config);
  for (std::size_t i = 0; i < extremes.size(); i += stride) observer.observe(extremes[i]);
  const auto all = observer.widths().all();
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Seen& seen = observer.seen()[i];
    const Interval range = value_range(*all[i], observer.widths(), config);
    EXPECT_EQ(seen.count != 0, observer.is_observed(i)) << all[i]->name << " in " << label(config);
    if (seen.count == 0) continue;
    EXPECT_TRUE(seen.lo >= range.lo && seen.hi <= range.hi)
        << all[i]->name << " in " << label(config) << ": " << text(seen.lo) << "..." << text(seen.hi) << ", derived "
        << text(range.lo) << "..." << text(range.hi) << ", seed " << kSeed;
  }
}

TEST(WidthStudy, NoIntermediateLeavesItsDerivedRangeInThePresets) {
  for (const auto name : preset_names()) expect_within(preset(name), 2000);
}

TEST(WidthStudy, NoIntermediateLeavesItsDerivedRangeInAnyConfiguration) {
  constexpr std::array depth_bits{8, 32, 12, 24, 16, 31, 20};
  constexpr std::array local_bits{12, 8, 10, 9, 11};
  int tried = 0;
  for (int subpixel_bits = 0; subpixel_bits <= 8; ++subpixel_bits)
    for (const int tile : {4, 8, 16, 32})
      for (const int band : {16, 32, 1 << 16}) {
        const auto n = static_cast<std::size_t>(tried);
        Config config = preset("tiny");
        config.subpixel_bits = subpixel_bits;
        config.tile_size = tile;
        config.stamp_size = 1 << n % 3;
        config.guard_band = band;
        config.target_width = band >> n % 2;
        config.target_height = std::min(band, 16384) - static_cast<int>(n % 5);
        config.target_width = std::min(config.target_width, 16384);
        config.depth_bits = depth_bits[n % depth_bits.size()];
        config.local_guard_bits = local_bits[n % local_bits.size()];
        config.reciprocal_extra_bits = 3 + static_cast<int>(n % 10);
        config.color_format = n % 2 == 0 ? ColorFormat::rgba8888 : ColorFormat::rgb565;
        if (!is_legal(config)) continue;
        expect_within(config, 40, 8);
        ++tried;
      }
  EXPECT_GT(tried, 60);
}

/// A short study of the smallest preset.
const WidthStudy& tiny_study() {
  static const WidthStudy study = [] {
    WidthStudyOptions options;
    options.seed = kSeed;
    options.samples = 2000;
    options.climb_steps = 200;
    return study_widths(preset("tiny"), options);
  }();
  return study;
}

TEST(WidthStudy, EachWidthWithOneBitLessIsOverflowedByTheInputThatIsNamed) {
  const Config config = preset("tiny");
  int overflows = 0;
  for (std::size_t i = 0; i < tiny_study().rows.size(); ++i) {
    const WidthRow& row = tiny_study().rows[i];
    EXPECT_TRUE(row.is_within()) << row.width.name;
    EXPECT_EQ(row.overflows.has_value(), row.seen.count != 0 && row.spare_bits() == 0) << row.width.name;
    if (!row.overflows) continue;
    ++overflows;
    WidthObserver observer(config);
    observer.observe(row.overflows->probe);
    const Seen& seen = observer.seen()[i];
    EXPECT_TRUE(row.overflows->value == seen.lo || row.overflows->value == seen.hi) << row.width.name;
    // The broken twin: the same row with a bit less is told from a good one.
    WidthRow twin = row;
    --twin.width.bits;
    if (row.width.is_modular) continue;  // no single value is too large there
    const int128 end = int128{1} << (twin.width.bits - (row.width.is_signed ? 1 : 0));
    twin.range = {row.width.is_signed ? -end : 0, end - 1};
    EXPECT_FALSE(twin.is_within()) << row.width.name;
    EXPECT_TRUE(row.overflows->value < twin.range.lo || row.overflows->value > twin.range.hi) << row.width.name;
  }
  EXPECT_GT(overflows, 30);
}

TEST(WidthStudy, RangesThatAreAttainedAreTightAndSpareBitsAreWhereTheErrorBoundSaysSo) {
  const auto row = [](std::string_view name) {
    for (const WidthRow& r : tiny_study().rows)
      if (r.width.name == name) return r;
    throw std::logic_error(std::string(name));
  };
  for (const char* name : {"coordinate", "delta", "edge product", "area", "depth numerator", "color numerator",
                           "reciprocal", "depth product", "color product", "line product", "line stay", "line move"})
    EXPECT_TRUE(row(name).attains_lo() && row(name).attains_hi()) << name;
  // Before storage the error is below 1/2, so the sign bit of a modular plane tells nothing apart at covered samples.
  for (const char* name : {"depth plane", "color plane", "local depth", "local color"})
    EXPECT_EQ(row(name).spare_bits(), 1) << name;
  EXPECT_FALSE(row("counter").is_observed);
}

TEST(WidthStudy, TheSameSeedSeesTheSameAndAnotherDoesNot) {
  WidthStudyOptions options;
  options.samples = 300;
  options.climb_steps = 20;
  const auto values = [&options] {
    std::vector<std::string> list;
    for (const WidthRow& row : study_widths(preset("tiny"), options).rows)
      list.push_back(text(row.seen.lo) + " " + text(row.seen.hi));
    return list;
  };
  const auto first = values();
  EXPECT_EQ(values(), first);
  options.seed = 2;
  EXPECT_NE(values(), first);
}

TEST(WidthStudy, BitsAreCountedInTwosComplementOrAsResidues) {
  EXPECT_EQ(bits_needed({-8, 7}, true, false), 4);
  EXPECT_EQ(bits_needed({-9, 7}, true, false), 5);
  EXPECT_EQ(bits_needed({0, 8}, true, false), 5);
  EXPECT_EQ(bits_needed({0, 8}, false, false), 4);
  EXPECT_EQ(bits_needed({0, 0}, false, false), 1);
  EXPECT_EQ(bits_needed({-1, 14}, true, true), 4);
  EXPECT_EQ(bits_needed({-1, 15}, true, true), 5);
}

TEST(WidthStudy, CapturesSnapBackToTheProbe) {
  for (const char* name : {"tiny", "embedded", "full"})
    for (const int subpixel_bits : {0, 1, preset(name).subpixel_bits}) {
      Config config = preset(name);
      config.subpixel_bits = subpixel_bits;
      config.target_width = config.target_height = 16;
      ProbeMaker maker(config, kSeed);
      int drawn = 0;
      for (int i = 0; i < 60; ++i) {
        const Probe probe = maker.random();
        std::ostringstream written;
        write_capture(probe_scene(probe, config), written);
        RenderOptions options;
        options.want_triangles = true;
        options.skip = skip_none();
        const Rendering rendering = render_scalar(read_capture(written.str(), "probe.hpt"), config, options);
        for (const Triangle& triangle : rendering.triangles) {
          EXPECT_EQ(triangle.v, probe.v) << name << " S=" << subpixel_bits << ", probe " << i << ", seed " << kSeed;
          ++drawn;
        }
        for (const auto& line : rendering.lines) {
          EXPECT_TRUE(line.start == probe.v[0] && line.end == probe.v[1]) << name << ", probe " << i;
          ++drawn;
        }
      }
      EXPECT_GT(drawn, 20);
    }
}

// ----------------------------------------------------------------------------------------------------------- over w

TEST(ProvenOverW, IsWhereTheBoundReachesTheError) {
  for (const std::string name : {"embedded", "full"}) {
    const PerspectiveFormat format = perspective_format(preset(name));
    for (const double texels : {256.0, 1024.0}) {
      const double ratio = *proven_w_ratio(texels, format, 8);
      EXPECT_LE(over_w_bound(texels, ratio, format, format.coordinate, 8), kProvenTexels);
      EXPECT_GT(over_w_bound(texels, ratio * 1.0001, format, format.coordinate, 8), kProvenTexels);
    }
  }
  EXPECT_GT(*proven_w_ratio(1024, perspective_format(preset("embedded")), 8), 64);  // the contract's guarantee
  EXPECT_GT(*proven_w_ratio(1024, perspective_format(preset("full")), 8), 1024);
  EXPECT_FALSE(proven_w_ratio(256, perspective_format(preset("tiny")), 8));
}

// ---------------------------------------------------------------------------------------------- smallest configuration

Scene small_scene(const char* name) { return make_builtin(name, 16, 16, {}, 1); }

double depth_error(const Scene& scene, const Config& config) {
  const Comparison c = compare(scene, config);
  return std::max(c.datapath.max, c.line_datapath.max) / (std::ldexp(1.0, config.depth_bits) - 1);
}

TEST(SmallestConfiguration, IsTheCheapestOfAllThatKeepTheDepthBound) {
  const Scene scene = small_scene("teapot:2");
  const Config start = preset("tiny");
  ErrorBounds bounds;
  Config fine = start;
  fine.local_guard_bits = fine.reciprocal_extra_bits = 7;
  bounds.depth = depth_error(scene, fine);
  const Smallest smallest = find_smallest({scene}, start, bounds);
  ASSERT_TRUE(smallest.found);
  const Config& found = smallest.found->config;
  EXPECT_TRUE(is_legal(found));
  EXPECT_LE(depth_error(scene, found), *bounds.depth);
  EXPECT_EQ(found.subpixel_bits, start.subpixel_bits);
  const long cost = hardware_bits(found).total();
  EXPECT_LE(cost, hardware_bits(start).total());
  int cheaper = 0;
  for (int bits = 8; bits <= found.depth_bits + 1; ++bits)
    for (const int local : {4, 5, 6, 7, 9, 12})
      for (const int extra : {2, 3, 4, 5, 8, 12})
        for (const int band : {16, 32}) {
          Config other = start;
          other.depth_bits = bits;
          other.local_guard_bits = local;
          other.reciprocal_extra_bits = extra;
          other.guard_band = band;
          if (!is_legal(other) || hardware_bits(other).total() >= cost) continue;
          ++cheaper;
          EXPECT_GT(depth_error(scene, other), *bounds.depth) << label(other);
        }
  EXPECT_GT(cheaper, 0);
}

TEST(SmallestConfiguration, SavesSubpixelBitsOnlyAsFarAsCoverageAllows) {
  const Scene scene = small_scene("teapot:2");
  const Config start = preset("tiny");
  const auto missed = [&scene](int subpixel_bits) {
    Config config = preset("tiny");
    config.subpixel_bits = subpixel_bits;
    const Comparison c = compare(scene, config);
    return c.coverage.missing + c.coverage.extra;
  };
  ErrorBounds bounds;
  bounds.coverage = missed(3);
  const Smallest smallest = find_smallest({scene}, start, bounds);
  ASSERT_TRUE(smallest.found);
  EXPECT_LE(missed(smallest.found->config.subpixel_bits), *bounds.coverage);
  EXPECT_LE(smallest.found->config.subpixel_bits, 3);
  EXPECT_EQ(smallest.found->config.depth_bits, start.depth_bits) << "no bound speaks of depth";
  for (const OneLess& less : smallest.one_less) {
    if (less.key == "subpixel.bits" && less.value > 0) {
      EXPECT_NE(less.broken.find("coverage"), std::string::npos) << less.broken;
    }
    if (less.key == "depth.bits") {
      EXPECT_TRUE(less.is_fixed);
    }
  }
}

TEST(SmallestConfiguration, SeveralScenesAreAllKeptAndAnImpossibleBoundIsSaidToBeSo) {
  const std::vector<Scene> scenes{small_scene("triangle"), small_scene("wires:2")};
  ErrorBounds bounds;
  bounds.depth = 1.2 / 255;
  bounds.color = 0.8;
  const Smallest both = find_smallest(scenes, preset("tiny"), bounds);
  ASSERT_TRUE(both.found);
  EXPECT_EQ(both.found->scenes.size(), 2U);
  EXPECT_LE(both.found->worst().depth, *bounds.depth);
  EXPECT_LE(both.found->worst().color, *bounds.color);
  for (const Scene& scene : scenes)
    EXPECT_GE(hardware_bits(both.found->config).total(),
              hardware_bits(find_smallest({scene}, preset("tiny"), bounds).found->config).total());
  bounds.depth = 1e-13;
  const Smallest none = find_smallest(scenes, preset("tiny"), bounds);
  EXPECT_FALSE(none.found);
  EXPECT_NE(none.widest.broken.find("depth"), std::string::npos) << none.widest.broken;
}

/// A textured triangle with w from 1 to 8.
Scene textured_scene() {
  State state = SceneBuilder::window_state();
  state.texture = 0;
  SceneBuilder builder(16, 16, state);
  std::array<Vertex, 3> v{at(1, 1), at(15, 2), at(3, 15)};
  for (std::size_t i = 0; i < 3; ++i) {
    v[i].w = i == 0 ? 1 : 8;
    v[i].u = static_cast<double>(i);
    v[i].v = i == 1 ? 2 : -1;
  }
  builder.triangle(v[0], v[1], v[2]);
  builder.scene.textures.push_back(
      make_texture("t", pattern_image(TexturePattern::grid, 32, 32), TextureFormat::rgba8888, Mips::none));
  return builder.scene;
}

TEST(Smallest, TheCacheIsCountedAsWhatALineOfItHolds) {
  EXPECT_EQ(hardware_bits(preset("embedded")).tiles, 256 * 4 * 4 * (16 + 16)) << "blocks of 4x4 pixels";
  EXPECT_EQ(hardware_bits(preset("tiny")).tiles, 2 * 8 * 8 * (8 + 16)) << "whole tiles";
}

TEST(SmallestConfiguration, BitsOverWAreThoseThatATextureNeeds) {
  const Scene scene = textured_scene();
  ErrorBounds bounds;
  bounds.texture = 1.0 / 32;
  const Config start = preset("tiny");
  const Smallest smallest = find_smallest({scene}, start, bounds);
  ASSERT_TRUE(smallest.found);
  const Config& found = smallest.found->config;
  const auto error = [&scene](Config config, int bits, int mantissa) {
    config.perspective_bits += bits;
    config.perspective_mantissa_bits += mantissa;
    return compare(scene, config).texture->coordinate.max;
  };
  EXPECT_LE(error(found, 0, 0), *bounds.texture);
  EXPECT_GT(error(found, -1, 0), *bounds.texture);
  EXPECT_GT(error(found, 0, -1), *bounds.texture);
  EXPECT_EQ(found.depth_bits, start.depth_bits);
  EXPECT_GT(hardware_bits(found, true).over_w, 0);
  EXPECT_EQ(hardware_bits(found).over_w, 0);
  EXPECT_EQ(smallest.one_less.size(), 7u);
  bounds.color = 1;  // no colour of it is over w: the bits are the texture's alone
  EXPECT_EQ(find_smallest({scene}, start, bounds).found->config.perspective_bits, found.perspective_bits);
  EXPECT_THROW((void)find_smallest({small_scene("triangle")}, start, bounds), InputError);
}

}  // namespace
}  // namespace halfplane::widths_test
