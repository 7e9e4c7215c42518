// Every state of a capture, at random: with vertices that the snap does not move, model and golden must show the same
// picture; on clipped triangles they may differ only beside an edge.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "../scene_builder.hpp"
#include "sim/study/compare/compare.hpp"

namespace halfplane::states_test {
namespace {

using test::at;
using test::clip_at;
using test::Random;
using test::SceneBuilder;

constexpr int kWidth = 40, kHeight = 36;

/// Draws of every topology at one of five depths each, on the 1/16 pixel grid; an occasional clear.
Scene random_window_scene(std::uint32_t seed) {
  Random random(seed);
  Scene scene = SceneBuilder(kWidth, kHeight).scene;
  for (int d = 0; d < 24; ++d) {
    scene.states.push_back(
        random_state(SceneBuilder::window_state(), states_but({"space", "smooth"}), chooser(random)));
    // The corners of a rectangle do not lie on the grid.
    if (scene.states.back().line_rule == LineRule::rectangle) scene.states.back().line_rule = LineRule::diamond;
    const auto state = static_cast<std::uint32_t>(scene.states.size() - 1);
    if (random.index(8) == 0) {
      Clear clear{state, {}, {}};
      if (random.index(2) == 0) clear.depth = random.index(6) / 5.0;
      if (random.index(3) == 0) clear.stencil = static_cast<std::uint8_t>(random.index(4));
      if (random.index(2) == 0) clear.color = std::array<double, 4>{random.unit() * 255, 20, 30, 255};
      scene.commands.push_back(clear);
    }
    const std::size_t count = 3 + static_cast<std::size_t>(random.index(5));
    const double z = random.index(6) / 5.0;          // equal depths meet often
    const double alpha = 25 + 51 * random.index(5);  // between two references of the alpha test: no rounding matters
    scene.commands.push_back(Draw{state, 0, static_cast<Topology>(random.index(3)), scene.indices.size(), count, 0});
    for (std::size_t i = 0; i < count; ++i) {
      scene.indices.push_back(static_cast<std::uint32_t>(scene.vertices.size()));
      const double x = random.index(60 * 16) / 16.0 - 10, y = random.index(60 * 16) / 16.0 - 10;
      const auto channel = [&] { return static_cast<double>(random.index(256)); };
      scene.vertices.push_back(at(x, y, z, {channel(), channel(), channel(), alpha}));
    }
  }
  return scene;
}

TEST(States, ModelAndGoldenShowTheSamePictureOfVerticesOnTheGrid) {
  for (const auto format : {ColorFormat::rgb565, ColorFormat::rgba8888}) {
    Config config = preset("embedded");
    config.color_format = format;
    std::uint64_t compared = 0, culled = 0, killed = 0;
    std::uint32_t layers = 0;
    for (std::uint32_t seed = 1; seed <= 60; ++seed) {
      SCOPED_TRACE("seed " + std::to_string(seed));
      const Scene scene = random_window_scene(seed);
      const Comparison c = compare(scene, config);
      ASSERT_EQ(c.rendering.count, c.golden.count);
      ASSERT_EQ(c.rendering.ids, c.golden.ids);
      EXPECT_EQ(c.rendering.counters.depth_passed, c.golden.counters.depth_passed);
      EXPECT_EQ(c.rendering.counters.alpha_killed, c.golden.counters.alpha_killed);
      EXPECT_EQ(c.rendering.counters.written, c.golden.counters.written);
      killed += c.rendering.counters.alpha_killed;
      EXPECT_EQ(c.rendering.frame.depth.size(), c.golden.frame.depth.size());
      for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
          const std::size_t p = c.rendering.frame.at(x, y);
          ASSERT_EQ(c.rendering.frame.depth[p], c.golden.frame.depth[p]) << x << ", " << y;
        }
      }
      EXPECT_LE(c.parts.snap.max, 1e-6);
      compared += c.compared_pixels;
      culled += c.rendering.counters.culled;
      EXPECT_LE(c.color_parts.total.max, 1) << "one fragment's colour: the model rounds to 8 bits on its way";
      for (const LayerRow& row : c.layers) layers = std::max(layers, row.layers);
      EXPECT_TRUE(broken_bounds(c, config).empty()) << broken_bounds(c, config).front();
    }
    EXPECT_GT(compared, 20000u);
    EXPECT_GT(culled, 100u);
    EXPECT_GT(killed, 1000u);
    EXPECT_GT(layers, 3u);
  }
}

/// Clip-space triangles that cross every plane, with w of both signs.
Scene random_clip_scene(std::uint32_t seed) {
  Random random(seed);
  State state;
  state.depth_test = DepthFunc::always;
  state.clip_z = random.index(2) == 0 ? ClipZ::zero_one : ClipZ::minus_one_one;
  if (random.index(2) == 0) state.viewport = Viewport{random.between(-9, 9), random.between(-9, 9), 31.5, 47.25};
  if (random.index(3) == 0) state.depth_range = {random.unit(), random.unit()};
  if (random.index(4) == 0) state.cull = Cull::back;
  if (random.index(4) == 0) state.scissor = Rect{5, 7, 20, 13};
  SceneBuilder builder(kWidth, kHeight, state);
  for (int i = 0; i < 8; ++i) {
    const double size = std::pow(10.0, random.between(-1, 3));
    const auto vertex = [&] {
      const double w = random.between(-1, 3) * size, x = random.between(-2, 2) * size, y = random.between(-2, 2) * size;
      const double z = random.between(-1.5, 1.5) * size;
      return clip_at(x, y, z, w, {random.unit() * 255, 90, 250 * random.unit(), 255});
    };
    const Vertex a = vertex(), b = vertex();
    builder.triangle(a, b, vertex());
  }
  return builder.scene;
}

TEST(States, ClippedTrianglesDifferFromTheGoldenOnlyBesideAnEdge) {
  Config config = preset("full");
  config.depth_bits = 10;  // an LSB is large against the snap: only the depth mapping remains
  std::uint64_t clipped = 0, compared = 0, far_off = 0, other = 0, other_beside_edge = 0;
  for (std::uint32_t seed = 1; seed <= 400; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Comparison c = compare(random_clip_scene(seed), config);
    EXPECT_EQ(c.oracle.mismatches, 0u);
    EXPECT_EQ(c.coverage.near_edge, c.coverage.missing + c.coverage.extra);
    EXPECT_EQ(c.stage_mismatches, 0u);
    EXPECT_LE(c.datapath.max, 0.75);
    clipped += c.rendering.counters.clipped;
    compared += c.compared_pixels;
    other += c.other_visible;
    other_beside_edge += c.coverage.near_edge;
    for (const float error : c.depth_error_lsb) far_off += std::abs(error) > 1.5F ? 1 : 0;  // false for NaN
  }
  EXPECT_GT(clipped, 400u);
  EXPECT_GT(compared, 100000u);
  EXPECT_LE(other, other_beside_edge + 4);
  EXPECT_LT(static_cast<double>(far_off), 0.002 * static_cast<double>(compared));
}

}  // namespace
}  // namespace halfplane::states_test
