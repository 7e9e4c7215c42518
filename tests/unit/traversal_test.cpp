// Study rules: four traversals find the same samples, by every fill rule; each rule agrees with docs/rules.md.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "../triangle_families.hpp"
#include "model/engines/functional.hpp"
#include "model/engines/scalar.hpp"
#include "model/study/traversal.hpp"
#include "sim/scene/builtin.hpp"
#include "sim/study/compare/compare.hpp"
#include "sim/study/compare/double_draws.hpp"

namespace halfplane::traversal_test {
namespace {

using test::at;
using test::clip_at;
using test::Generator;
using test::Random;
using test::SceneBuilder;

constexpr std::array kTraversals{Traversal::tiled, Traversal::bbox, Traversal::scanline, Traversal::brute};
constexpr std::array kFillRules{FillRule::top_left, FillRule::offset_point, FillRule::inclusive, FillRule::exclusive};

Rendering render_by(const Scene& scene, const Config& config, Traversal traversal, FillRule rule) {
  RenderOptions options;
  options.want_count = options.want_ids = true;
  options.rules = {traversal, rule};
  return render_scalar(scene, config, options);
}

std::uint64_t draws(const Rendering& r) { return std::accumulate(r.count.begin(), r.count.end(), std::uint64_t{0}); }

void expect_same(const Rendering& a, const Rendering& b) {
  EXPECT_EQ(a.frame.color, b.frame.color);
  EXPECT_EQ(a.frame.depth, b.frame.depth);
  EXPECT_EQ(a.ids, b.ids);
  EXPECT_EQ(a.count, b.count);
  EXPECT_EQ(a.counters.covered, b.counters.covered);
  EXPECT_EQ(a.counters.depth_passed, b.counters.depth_passed);
  EXPECT_EQ(a.counters.written, b.counters.written);
}

/// Renders `scene` by every traversal and rule; returns the samples that are covered by top_left.
std::uint64_t expect_equal_buffers(const Scene& scene, const Config& config) {
  expect_same(render_functional(scene, config,
                                [] {
                                  RenderOptions options;
                                  options.want_count = options.want_ids = true;
                                  return options;
                                }()),
              render_by(scene, config, Traversal::tiled, FillRule::top_left));
  std::uint64_t covered = 0;
  for (const FillRule rule : kFillRules) {
    const Rendering tiled = render_by(scene, config, Traversal::tiled, rule);
    if (rule == FillRule::top_left) covered = tiled.counters.covered;
    for (const Traversal traversal : {Traversal::bbox, Traversal::scanline, Traversal::brute}) {
      SCOPED_TRACE(std::string(name_of(traversal)) + ", " + std::string(name_of(rule)));
      expect_same(tiled, render_by(scene, config, traversal, rule));
    }
  }
  return covered;
}

/// Sixteen triangles of all families, with states and a scissor that change.
Scene random_scene(const Config& config, int width, int height, std::uint32_t seed) {
  Generator generator(config, width, height, seed);
  SceneBuilder builder(width, height);
  for (int k = 0; k < 16; ++k) {
    if (k % 4 == 0 && seed % 2 == 0) {
      State state = SceneBuilder::window_state();
      state.depth_test = static_cast<DepthFunc>((seed / 2 + static_cast<std::uint32_t>(k)) % 8);
      if (k % 8 == 0) state.scissor = Rect{k - 3, k / 2 - 1, 7 + k, 11};
      builder.with_state(state);
    }
    const auto v = generator.triangle((k + static_cast<int>(seed)) % Generator::kFamilies);
    builder.triangle(v[0], v[1], v[2]);
  }
  return builder.scene;
}

/// Fans round a pixel centre, a corner and an edge point; right-triangle pairs on centres; edges 1 subpixel apart.
std::vector<Scene> stress_scenes(const Config& config) {
  std::vector<Scene> scenes;
  const double reach = config.guard_band - 20.0;
  for (const auto& hub : {std::array{16.5, 16.5}, {16.0, 16.0}, {16.5, 16.0}})
    for (const int blades : {3, 4, 5, 8, 17, 64}) {
      SceneBuilder builder(32, 32);
      const auto rim = [&](int i) {
        const double angle = 2 * 3.14159265358979323846 * (i % blades) / blades;
        return at(hub[0] + reach * std::cos(angle), hub[1] + reach * std::sin(angle), (i % 3) / 3.0);
      };
      for (int i = 0; i < blades; ++i) builder.triangle(at(hub[0], hub[1]), rim(i), rim(i + 1));
      scenes.push_back(builder.scene);
    }
  SceneBuilder pairs(32, 32);
  for (int i = 0; i < 12; ++i) {
    const double x = i + 0.5, y = 2 * i + 0.5, w = 3 + i, h = 9;
    pairs.triangle(at(x, y), at(x + w, y), at(x, y + h)).triangle(at(x, y + h), at(x + w, y), at(x + w, y + h));
  }
  scenes.push_back(pairs.scene);
  SceneBuilder apart(32, 32);
  const double subpixel = std::ldexp(1.0, -config.subpixel_bits);
  for (int i = 0; i < 8; ++i) {
    const double x = 2.5 + i * subpixel;
    apart.triangle(at(x, 0.5), at(30.5, i + 0.5), at(x, 31.5)).triangle(at(x, 31.5), at(x - 2, 7), at(x, 0.5));
  }
  scenes.push_back(apart.scene);
  const double g = config.guard_band - 1.0;  // corners of the guard band
  SceneBuilder corners(32, 32);
  corners.triangle(at(-g, -g), at(g, -g), at(-g, g)).triangle(at(-g, g), at(g, -g), at(g, g));
  corners.triangle(at(-g, -g), at(g, g), at(-g, -g + 1)).triangle(at(g, -g), at(-g, g), at(16.5, 16.5));
  scenes.push_back(corners.scene);
  return scenes;
}

/// A shuffled mesh on the half-pixel grid: samples on edges and vertices everywhere.
Scene tie_mesh(int cells, std::uint32_t seed) {
  Random random(seed);
  SceneBuilder builder(4 * cells, 4 * cells);
  std::vector<Vertex> grid;
  for (int j = 0; j <= cells; ++j)
    for (int i = 0; i <= cells; ++i) {
      const double dx = 0.5 * (random.index(3) - 1), dy = 0.5 * (random.index(3) - 1);
      grid.push_back(at(5 * i - 2.5 + dx, 5 * j - 2.5 + dy, random.unit()));
    }
  for (int j = 0; j < cells; ++j)
    for (int i = 0; i < cells; ++i) {
      const auto k = static_cast<std::size_t>(j * (cells + 1) + i), row = static_cast<std::size_t>(cells + 1);
      if (random.index(2) == 0)
        builder.triangle(grid[k], grid[k + 1], grid[k + row]).triangle(grid[k + row + 1], grid[k + 1], grid[k + row]);
      else
        builder.triangle(grid[k], grid[k + row + 1], grid[k + row]).triangle(grid[k], grid[k + 1], grid[k + row + 1]);
    }
  return builder.scene;
}

TEST(Traversals, AllFourGiveEqualBuffersOnRandomTrianglesOfEveryPreset) {
  for (const auto name : {"tiny", "embedded", "full"}) {
    const Config config = preset(name);
    std::uint64_t covered = 0;
    for (std::uint32_t seed = 1; seed <= 40; ++seed) {
      SCOPED_TRACE(config.preset + ", seed " + std::to_string(seed));
      covered += expect_equal_buffers(random_scene(config, 15, 13, seed), config);
    }
    EXPECT_GT(covered, 5000u) << name;
  }
}

TEST(Traversals, AllFourGiveEqualBuffersAtEverySubpixelWidthAndTile) {
  for (int bits = 0; bits <= 8; ++bits) {
    Config config = preset("full");
    config.subpixel_bits = bits;
    config.tile_size = 4 << bits % 3;
    SCOPED_TRACE("subpixel.bits " + std::to_string(bits));
    for (const std::uint32_t seed : {7U, 8U})
      EXPECT_GT(expect_equal_buffers(random_scene(config, 33, 29, seed), config), 0u);
  }
}

TEST(Traversals, AllFourGiveEqualBuffersOnTheStressList) {
  for (const auto name : {"embedded", "full"}) {
    const Config config = preset(name);
    const auto scenes = stress_scenes(config);
    for (std::size_t i = 0; i < scenes.size(); ++i) {
      SCOPED_TRACE(config.preset + ", stress scene " + std::to_string(i));
      EXPECT_GT(expect_equal_buffers(scenes[i], config), 0u);
    }
  }
  EXPECT_GT(expect_equal_buffers(tie_mesh(20, 3), preset("embedded")), 5000u);
}

TEST(Traversals, AllFourGiveEqualBuffersOfClippedScenesAndOfTargetsOfOnePixelToAnOddViewport) {
  const Config config = preset("embedded");
  for (const char* name : {"walk", "teapot", "slivers", "city"}) {
    SCOPED_TRACE(name);
    EXPECT_GT(expect_equal_buffers(make_builtin(name, 61, 47, {}, 3), config), 100u);
  }
  for (const int size : {1, 2, 9}) {
    State state;
    state.depth_test = DepthFunc::always;
    state.viewport = Viewport{-0.5, 0.25, size + 1.25, size - 0.25};
    SceneBuilder builder(size, size, state);
    builder.triangle(clip_at(-3, -1, 0, 1), clip_at(1, -1, 0.5, 1), clip_at(0, 9, 0, 2));
    builder.triangle(clip_at(-30, -1, -9, -1), clip_at(1, 1, 0.5, 1), clip_at(0, -9, 0, 2));
    EXPECT_GT(expect_equal_buffers(builder.scene, config), 0u) << size;
  }
}

TEST(Traversals, ScanlineIsExactOverTheLargestTargetAndGuardBand) {
  const Config config = preset("full");
  SceneBuilder builder(4096, 1024);
  builder.triangle(at(-8191, -8191), at(8191, 1023.5), at(8190.99609375, 1023.75));  // a sliver of 16,000 px
  builder.triangle(at(0.5, 0.5), at(4095.5, 1.5), at(0.5, 1023.5));                  // slope 1/4095
  builder.triangle(at(4095.5, 0.5), at(0.5, 1023.5), at(4095.5, 1023.5, 0.1));
  const Rendering brute = render_by(builder.scene, config, Traversal::brute, FillRule::top_left);
  expect_same(brute, render_by(builder.scene, config, Traversal::scanline, FillRule::top_left));
  EXPECT_GT(brute.counters.covered, 4000000u);
}

TEST(Traversals, EveryTraversalAndRuleEqualsTheExactOracleThroughItsTap) {
  std::uint64_t samples = 0;
  for (const Traversal traversal : kTraversals)
    for (const FillRule rule : kFillRules)
      for (std::uint32_t seed = 50; seed < 60; ++seed) {
        SCOPED_TRACE(std::string(name_of(traversal)) + ", " + std::string(name_of(rule)) + ", seed " +
                     std::to_string(seed));
        const Config config = preset(seed % 2 == 0 ? "embedded" : "tiny");
        CompareOptions options;
        options.rules = {traversal, rule};
        const Comparison c = compare(random_scene(config, 16, 15, seed), config, options);
        EXPECT_EQ(c.oracle.mismatches, 0u);
        EXPECT_EQ(c.stage_mismatches, 0u);
        EXPECT_LE(c.datapath.max, 0.75);
        EXPECT_LE(c.color_datapath.max, 0.75);
        samples += c.oracle.samples;
      }
  EXPECT_GT(samples, 50000u);
}

TEST(TraversalsMustFail, OracleOfOneRuleRejectsTheCoverageOfAnother) {
  for (const FillRule rule : {FillRule::offset_point, FillRule::inclusive}) {
    CompareOptions options;
    options.engine = [rule](const Scene& scene, const Config& config, const RenderOptions& asked) {
      RenderOptions other = asked;
      other.rules.fill_rule = rule;
      return render_scalar(scene, config, other);
    };
    EXPECT_GT(compare(tie_mesh(6, 1), preset("embedded"), options).oracle.mismatches, 10u) << name_of(rule);
  }
}

TEST(Traversals, SamplesTestedAreTheTargetTheBoxOrTheSpans) {
  const Config config = preset("embedded");
  SceneBuilder builder(40, 30);
  builder.triangle(at(2.5, 3.5), at(22.5, 3.5), at(2.5, 13.5)).triangle(at(30, 29), at(38, 21), at(39, 29));
  const auto tested = [&](Traversal traversal) {
    const Rendering r = render_by(builder.scene, config, traversal, FillRule::top_left);
    EXPECT_EQ(r.counters.tiles_visited > 0, traversal == Traversal::tiled);
    return std::pair{r.counters.samples_tested, r.counters.covered};
  };
  EXPECT_EQ(tested(Traversal::brute).first, 2u * 40u * 30u);
  EXPECT_EQ(tested(Traversal::bbox).first, 21u * 11u + 9u * 8u);
  EXPECT_EQ(tested(Traversal::scanline).first, tested(Traversal::scanline).second);
  EXPECT_LT(tested(Traversal::tiled).first, tested(Traversal::brute).first);

  RenderOptions everything;  // brute also tests the target for triangles outside it
  everything.rules.traversal = Traversal::brute;
  everything.skip = {false, false, false, false, false};
  builder.triangle(at(-9, 2), at(-3, 2), at(-9, 8));
  EXPECT_EQ(render_scalar(builder.scene, config, everything).counters.samples_tested, 3u * 40u * 30u);
}

/// Two triangles that share the edge from `a` to `b`; the second vertex order is turned when `turned` is set.
Scene shared_edge(const Vertex& a, const Vertex& b, const Vertex& c, const Vertex& d, bool turned) {
  SceneBuilder builder(24, 24);
  builder.triangle(a, b, c);
  turned ? builder.triangle(a, b, d) : builder.triangle(b, a, d);
  return builder.scene;
}

std::uint32_t count_at(const Rendering& r, int x, int y) { return r.count[static_cast<std::size_t>(24 * y + x)]; }

TEST(FillRules, SharedEdgeThroughTheOffsetPointIsDrawnByNeitherTriangle) {
  const Config config = preset("embedded");
  for (const bool turned : {false, true}) {
    const Scene scene = shared_edge(at(2, 2), at(20, 20), at(20, 2), at(2, 20), turned);  // x = y, through (-1, -1)
    const Rendering lost = render_by(scene, config, Traversal::tiled, FillRule::offset_point);
    const Rendering kept = render_by(scene, config, Traversal::tiled, FillRule::top_left);
    for (int i = 2; i < 20; ++i) {
      EXPECT_EQ(count_at(lost, i, i), 0u) << i;
      EXPECT_EQ(count_at(kept, i, i), 1u) << i;
    }
    EXPECT_EQ(draws(lost), draws(kept) - 18);
  }
}

TEST(FillRules, OffsetPointDrawsEveryOtherSharedEdgeOnce) {
  const Config config = preset("embedded");
  std::uint64_t ties = 0;
  for (int k = 0; k < 12; ++k) {  // edges from a centre to a centre, none of them through (-1, -1)
    const Vertex a = at(2.5, 3.5 + k), b = at(20.5, 21.5 - k), c = at(21.5, 2.5), d = at(1.5, 22.5);
    const Scene scene = shared_edge(a, b, c, d, k % 2 == 0);
    const Rendering r = render_by(scene, config, Traversal::tiled, FillRule::offset_point);
    const Rendering all = render_by(scene, config, Traversal::tiled, FillRule::inclusive);
    const double dx = b.x - a.x, dy = b.y - a.y;
    for (int x = 3; x < 20; ++x)
      for (int y = 0; y < 24; ++y)
        if (dx * (y + 0.5 - a.y) == dy * (x + 0.5 - a.x)) {
          ++ties;
          EXPECT_EQ(count_at(r, x, y), 1u) << k << ": " << x << ", " << y;
          EXPECT_EQ(count_at(all, x, y), 2u) << k << ": " << x << ", " << y;
        }
  }
  EXPECT_GT(ties, 30u);
}

TEST(FillRules, OppositeWindingsAgreeByEveryRule) {
  const Config config = preset("tiny");
  for (std::uint32_t seed = 1; seed <= 60; ++seed) {
    Generator generator(config, 16, 16, seed);
    const auto v = generator.triangle(static_cast<int>(seed) % Generator::kFamilies);
    SceneBuilder one(16, 16), other(16, 16);
    one.triangle(v[0], v[1], v[2]);
    other.triangle(v[0], v[2], v[1]);
    for (const FillRule rule : kFillRules)
      for (const Traversal traversal : kTraversals) {
        SCOPED_TRACE("seed " + std::to_string(seed) + ", " + std::string(name_of(rule)));
        const Rendering a = render_by(one.scene, config, traversal, rule),
                        b = render_by(other.scene, config, traversal, rule);
        EXPECT_EQ(a.count, b.count);
        EXPECT_EQ(a.frame.depth, b.frame.depth);
      }
  }
}

TEST(FillRules, DoubleDrawsAreTheSamplesOnTheEdgesThatAMeshShares) {
  const Config config = preset("embedded");
  const Scene square = shared_edge(at(2, 2), at(20, 20), at(20, 2), at(2, 20), false);
  EXPECT_EQ(count_draws(square, config, {Traversal::tiled, FillRule::inclusive}).doubled, 18u);
  EXPECT_EQ(count_draws(square, config, {Traversal::tiled, FillRule::offset_point}).doubled, 0u);
  EXPECT_EQ(count_draws(square, config, {Traversal::tiled, FillRule::top_left}).doubled, 0u);
  SceneBuilder fan(24, 24);  // round a pixel centre: the hub is drawn by all six
  for (int i = 0; i < 6; ++i) {
    const auto rim = [](int k) {
      return at(12.5 + 9 * std::cos(k * 1.0472 + 0.2), 12.5 + 9 * std::sin(k * 1.0472 + 0.2));
    };
    fan.triangle(at(12.5, 12.5), rim(i), rim((i + 1) % 6));
  }
  EXPECT_EQ(count_draws(fan.scene, config, {Traversal::tiled, FillRule::inclusive}).doubled, 5u);
}

TEST(FillRules, ExclusiveLeavesASharedEdgeThroughPixelCentresUndrawn) {
  const Config config = preset("embedded");
  // 18 x 18 pixels. The diagonal goes through the pixel centres from (2, 2) to (19, 19); the sides through none.
  const Scene square = shared_edge(at(2, 2), at(20, 20), at(20, 2), at(2, 20), false);
  const auto undrawn = [&](FillRule rule) { return count_draws(square, config, {Traversal::tiled, rule}).undrawn; };
  EXPECT_EQ(undrawn(FillRule::exclusive), 18U);
  EXPECT_EQ(undrawn(FillRule::offset_point), 18U) << "the line through (-1, -1)";
  EXPECT_EQ(undrawn(FillRule::inclusive), 0U);
  EXPECT_EQ(count_draws(square, config, {Traversal::tiled, FillRule::exclusive}).doubled, 0U);
  for (const Traversal traversal : kTraversals) {
    const Rendering r = render_by(square, config, traversal, FillRule::exclusive);
    EXPECT_EQ(draws(r), 18U * 18U - 18U) << name_of(traversal);
    for (int i = 2; i < 20; ++i)
      EXPECT_EQ(r.count[static_cast<std::size_t>(i * square.width + i)], 0U) << name_of(traversal) << ' ' << i;
  }
}

TEST(FillRules, DoubleDrawsAreCountedMeshByMesh) {
  const Config config = preset("embedded");
  // Two triangles that meet in x = y, as one mesh, as two objects, and with a clear between.
  const Vertex a = at(2, 2), b = at(20, 20), c = at(20, 2), d = at(2, 20);
  Scene one = shared_edge(a, b, c, d, false);
  one.commands = {one.commands[0], Draw{0, 0, Topology::triangles, 0, 3, 0}, Draw{0, 0, Topology::triangles, 3, 3, 0}};
  Scene two = one, cleared = one;
  two.objects.push_back("other");
  std::get<Draw>(two.commands[2]).object = 1;
  cleared.commands.insert(cleared.commands.begin() + 2, cleared.commands[0]);
  EXPECT_EQ(count_draws(one, config, {Traversal::tiled, FillRule::inclusive}).doubled, 18u);
  EXPECT_EQ(count_draws(two, config, {Traversal::tiled, FillRule::inclusive}).doubled, 0u);
  EXPECT_EQ(count_draws(cleared, config, {Traversal::tiled, FillRule::inclusive}).doubled, 0u);
}

TEST(FillRules, InclusiveDrawsTiesOfAMeshTwiceAndTopLeftOnce) {
  const Config config = preset("embedded");
  const Scene mesh = tie_mesh(12, 9);
  const Rendering once = render_by(mesh, config, Traversal::scanline, FillRule::top_left);
  EXPECT_EQ(std::count(once.count.begin(), once.count.end(), 1u), static_cast<std::ptrdiff_t>(once.count.size()));
  const Rendering twice = render_by(mesh, config, Traversal::scanline, FillRule::inclusive);
  EXPECT_EQ(std::count(twice.count.begin(), twice.count.end(), 0u), 0);
  EXPECT_EQ(count_draws(mesh, config, {Traversal::tiled, FillRule::inclusive}).doubled, draws(twice) - draws(once));
  EXPECT_GT(draws(twice) - draws(once), 100u);
}

TEST(FillRules, FunctionalEngineRefusesWhatItDoesNotHave) {
  const Scene scene = SceneBuilder(8, 8).scene;
  RenderOptions options;
  options.rules.traversal = Traversal::brute;
  EXPECT_THROW((void)render_functional(scene, preset("embedded"), options), InputError);
  options.rules = {Traversal::tiled, FillRule::inclusive};
  EXPECT_THROW((void)render_functional(scene, preset("embedded"), options), InputError);
}

}  // namespace
}  // namespace halfplane::traversal_test
