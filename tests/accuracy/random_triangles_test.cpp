// Random and stressful triangles through the engine, checked against the oracle: no coverage mismatch anywhere, depth
// and colour within their bounds. Every failure prints the seed that repeats it.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numeric>

#include "../triangle_families.hpp"
#include "model/engines/functional.hpp"
#include "model/golden/exact.hpp"
#include "model/widths.hpp"
#include "sim/study/compare/compare.hpp"

namespace halfplane::random_triangles_test {
namespace {

using test::at;
using test::Generator;
using test::Random;
using test::SceneBuilder;

/// Totals over all scenes of one run.
struct Tally {
  std::uint64_t triangles = 0, on_edge = 0, samples = 0, owned = 0, depth_count = 0;
  double depth_max = 0, color_max = 0, depth_sum = 0, bias_sum = 0, color_sum = 0, color_bias_sum = 0;
  std::uint64_t color_count = 0;

  void add(const Comparison& c, const Config& config) {
    const int grid_bits = derive_widths(config).grid_bits;
    for (const Triangle& t : c.rendering.triangles) on_edge += has_sample_on_border(t, c.golden, grid_bits) ? 1 : 0;
    samples += c.oracle.samples;
    const auto n = static_cast<double>(c.datapath.count), m = static_cast<double>(c.color_datapath.count);
    depth_count += c.datapath.count;
    color_count += c.color_datapath.count;
    depth_max = std::max(depth_max, c.datapath.max);
    color_max = std::max(color_max, c.color_datapath.max);
    depth_sum += c.datapath.mean * n;
    bias_sum += c.datapath_bias.mean * n;
    color_sum += c.color_datapath.mean * m;
    color_bias_sum += c.color_datapath_bias.mean * m;
  }

  static bool has_sample_on_border(const Triangle& t, const golden::Image& target, int grid_bits) {
    for (int y = 0; y < target.height; ++y)
      for (int x = 0; x < target.width; ++x)
        if (exact::is_on_border(t, x, y, grid_bits)) return true;
    return false;
  }

  void expect_bounds() const {
    EXPECT_GT(depth_count, 0u);
    EXPECT_LE(depth_max, 0.75);
    EXPECT_LT(std::abs(depth_sum / static_cast<double>(depth_count)), 0.05);
    EXPECT_LT(std::abs(bias_sum / static_cast<double>(depth_count)), 0.05);
    EXPECT_LE(color_max, 1);
    EXPECT_LT(std::abs(color_sum / static_cast<double>(color_count)), 0.05);
  }

  /// Measured figures, for the XML report.
  void record() const {
    const auto text = [](double v) { return std::to_string(v); };
    testing::Test::RecordProperty("triangles", std::to_string(triangles));
    testing::Test::RecordProperty("samples", std::to_string(samples));
    testing::Test::RecordProperty("on_edge", std::to_string(on_edge));
    testing::Test::RecordProperty("depth_max_lsb", text(depth_max));
    testing::Test::RecordProperty("depth_mean_lsb", text(depth_sum / static_cast<double>(depth_count)));
    testing::Test::RecordProperty("depth_bias_lsb", text(bias_sum / static_cast<double>(depth_count)));
    testing::Test::RecordProperty("color_max_lsb", text(color_max));
    testing::Test::RecordProperty("color_mean_lsb", text(color_sum / static_cast<double>(color_count)));
  }
};

/// Triangles of all families in scenes of sixteen.
Tally run_random(const Config& config, int width, int height, int scenes, std::uint32_t first_seed) {
  Tally tally;
  for (int i = 0; i < scenes; ++i) {
    const std::uint32_t seed = first_seed + static_cast<std::uint32_t>(i);
    SCOPED_TRACE("preset " + config.preset + ", seed " + std::to_string(seed));
    Generator generator(config, width, height, seed);
    SceneBuilder builder(width, height);
    for (int k = 0; k < 16; ++k) {
      const auto v = generator.triangle(k % Generator::kFamilies);
      builder.triangle(v[0], v[1], v[2]);
    }
    const Comparison c = compare(builder.scene, config);
    EXPECT_EQ(c.oracle.mismatches, 0u);
    EXPECT_EQ(c.stage_mismatches, 0u);
    EXPECT_LE(c.datapath.max, 0.75);
    tally.triangles += 16;
    tally.add(c, config);
    if (testing::Test::HasFailure()) break;
  }
  tally.record();
  return tally;
}

TEST(RandomTriangles, TinyPresetMatchesTheOracle) {
  const Tally tally = run_random(preset("tiny"), 16, 16, 400, 1000);
  tally.expect_bounds();
  EXPECT_GE(tally.on_edge * 10, tally.triangles * 3);
}

TEST(RandomTriangles, EmbeddedPresetMatchesTheOracle) {
  const Tally tally = run_random(preset("embedded"), 45, 31, 400, 2000);
  tally.expect_bounds();
  EXPECT_GE(tally.on_edge * 10, tally.triangles * 3);
}

TEST(RandomTriangles, FullPresetMatchesTheOracle) {
  const Tally tally = run_random(preset("full"), 45, 31, 400, 3000);
  tally.expect_bounds();
  EXPECT_GE(tally.on_edge * 10, tally.triangles * 3);
}

TEST(RandomTriangles, LargeTargetIsWithinBoundsFarFromTheFirstTile) {
  // Slivers and guard-band triangles over a whole screen: the longest steps between tiles.
  for (const auto name : {"embedded", "full"}) {
    Config config = preset(name);
    Generator generator(config, 1600, 900, 77);
    SceneBuilder builder(1600, 900);
    for (int k = 0; k < 24; ++k) {
      const auto v = generator.triangle(k % 3 == 0 ? 0 : 2 + k % 4);
      builder.triangle(v[0], v[1], v[2]);
    }
    SCOPED_TRACE(config.preset + ", seed 77");
    const Comparison c = compare(builder.scene, config);
    EXPECT_TRUE(broken_bounds(c, config).empty()) << broken_bounds(c, config).front();
    EXPECT_GT(c.datapath.count, 100000u);
  }
}

TEST(RandomTriangles, AllSixVertexOrdersGiveEqualBuffers) {
  for (const auto name : {"tiny", "embedded", "full"}) {
    const Config config = preset(name);
    for (std::uint32_t seed = 1; seed <= 40; ++seed) {
      SCOPED_TRACE(config.preset + ", seed " + std::to_string(seed));
      Generator generator(config, 16, 16, seed);
      const auto v = generator.triangle(static_cast<int>(seed) % Generator::kFamilies);
      std::array<std::size_t, 3> order{0, 1, 2};
      std::optional<Rendering> first;
      do {
        SceneBuilder builder(16, 16);
        builder.triangle(v[order[0]], v[order[1]], v[order[2]]);
        const Rendering r = render_functional(builder.scene, config);
        if (!first) first = r;
        EXPECT_EQ(r.frame.depth, first->frame.depth);
        EXPECT_EQ(r.frame.color, first->frame.color);
      } while (std::next_permutation(order.begin(), order.end()));
    }
  }
}

/// 128 well-shaped triangles side by side, vertices off every subpixel grid.
Scene jittered_grid(std::uint32_t seed) {
  Random random(seed);
  std::vector<Vertex> grid;
  for (int j = 0; j <= 8; ++j) {
    for (int i = 0; i <= 8; ++i) {
      const double x = 8 * i + random.between(-2.5, 2.5), y = 8 * j + random.between(-2.5, 2.5);
      grid.push_back(at(x, y, random.unit()));
    }
  }
  SceneBuilder builder(64, 64);
  for (std::size_t k = 0; k < 72; ++k) {
    if (k % 9 == 8) continue;
    builder.triangle(grid[k], grid[k + 1], grid[k + 9]).triangle(grid[k + 9], grid[k + 1], grid[k + 10]);
  }
  return builder.scene;
}

TEST(RandomTriangles, EverySubpixelWidthMatchesTheOracleAndHalvesTheSnapError) {
  double previous = 0;
  for (int bits = 0; bits <= 8; ++bits) {
    Config config = preset("full");  // 24 bits of depth: the snap of x and y dominates at every width
    config.subpixel_bits = bits;
    SCOPED_TRACE("subpixel.bits " + std::to_string(bits) + ", seed 5");
    const Comparison c = compare(jittered_grid(5), config);
    EXPECT_EQ(c.oracle.mismatches, 0u);
    EXPECT_LE(c.datapath.max, 0.75);
    EXPECT_GT(c.compared_pixels, 3000u);
    if (bits > 0) {
      EXPECT_GT(c.parts.snap.rms, 0.4 * previous);  // 0.5, apart from the scatter of 81 vertices
      EXPECT_LT(c.parts.snap.rms, 0.6 * previous);
    }
    previous = c.parts.snap.rms;
    Tally tally = run_random(config, 24, 24, 8, 100);
    tally.expect_bounds();
  }
}

TEST(RandomTriangles, EveryDepthWidthStaysWithinBoundsInItsOwnLsb) {
  for (int bits = 8; bits <= 32; ++bits) {
    Config config = preset("embedded");
    config.depth_bits = bits;
    ASSERT_NO_THROW(validate(config));
    SCOPED_TRACE("depth.bits " + std::to_string(bits));
    Tally tally = run_random(config, 24, 24, 8, 200);
    EXPECT_LE(tally.depth_max, 0.75);
    EXPECT_GT(tally.depth_max, 0.3);  // an LSB of the requested width, not of a wider one
  }
}

/// Soak: fresh seeds for HALFPLANE_SOAK seconds, a few otherwise. The first seed is printed; every failure prints its
/// own.
TEST(StressRandomTriangles, FreshSeedsMeetTheBoundsInEveryPreset) {
  const char* soak = std::getenv("HALFPLANE_SOAK");
  const double seconds = soak == nullptr ? 6 : std::atof(soak);
  const auto start = std::chrono::steady_clock::now();
  const auto elapsed = [&start] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  const std::uint32_t first = soak == nullptr ? 100000 : std::random_device()();
  std::uint64_t triangles = 0;
  for (std::uint32_t seed = first; elapsed() < seconds && !HasFailure(); seed += 60)
    for (const char* name : {"tiny", "embedded", "full"}) {
      const int width = name == std::string("tiny") ? 16 : 61, height = name == std::string("tiny") ? 16 : 43;
      triangles += run_random(preset(name), width, height, 20, seed).triangles;
    }
  std::printf("seeds from %u: %llu triangles\n", first, static_cast<unsigned long long>(triangles));
  EXPECT_GT(triangles, 0u);
}

}  // namespace
}  // namespace halfplane::random_triangles_test
