// The golden by itself: figures worked out by hand.
#include "model/golden/golden.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "../scene_builder.hpp"
#include "model/golden/fragment_buffer.hpp"

namespace halfplane::golden_test {
namespace {

using golden::Image;
using golden::Precision;
using test::at;
using test::clip_at;
using test::SceneBuilder;

std::uint64_t total_count(const Image& image) {
  return std::accumulate(image.count.begin(), image.count.end(), std::uint64_t{0});
}

std::size_t pixel(const Image& image, int x, int y) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x);
}

Config embedded() { return preset("embedded"); }

/// Two triangles over the square (0, 0)...(size, size).
SceneBuilder square(int size, State state = SceneBuilder::window_state()) {
  SceneBuilder builder(size, size, state);
  builder.triangle(at(0, 0), at(size, 0), at(0, size)).triangle(at(size, 0), at(size, size), at(0, size));
  return builder;
}

TEST(Golden, TwoTrianglesOfASquareCoverEachPixelOnce) {
  const Image image = golden::render(square(8).scene, embedded());
  for (const std::uint32_t count : image.count) EXPECT_EQ(count, 1u);
  EXPECT_EQ(image.counters.covered, 64u);
  EXPECT_EQ(image.counters.primitives_in, 2u);
}

TEST(Golden, DiagonalSampleGoesToTheTriangleWhoseLeftEdgeItIs) {
  // The diagonal runs through pixel centres; it is the left edge of the lower right triangle, number 1.
  const Image image = golden::render(square(8).scene, embedded());
  EXPECT_EQ(image.ids[pixel(image, 3, 4)], 1);
  EXPECT_EQ(image.ids[pixel(image, 3, 3)], 0);
}

TEST(Golden, SampleOnTopEdgeIsCoveredAndOnBottomEdgeIsNot) {
  SceneBuilder builder(8, 8);
  builder.triangle(at(0, 2.5), at(8, 2.5), at(4, 6.5)).triangle(at(0, 2.5), at(4, 0.25), at(8, 2.5));
  const Image image = golden::render(builder.scene, embedded());
  EXPECT_EQ(image.ids[pixel(image, 4, 2)], 0);
  EXPECT_EQ(image.count[pixel(image, 4, 2)], 1u);
}

TEST(Golden, CullingFollowsTheWindingSeenOnTheScreen) {
  const auto covered = [](Cull cull, FrontFace front) {
    State state = SceneBuilder::window_state();
    state.cull = cull;
    state.front = front;
    SceneBuilder builder(8, 8, state);
    builder.triangle(at(0, 0), at(8, 0), at(0, 8));  // clockwise with y down
    return golden::render(builder.scene, embedded()).counters.covered;
  };
  EXPECT_GT(covered(Cull::none, FrontFace::ccw), 0u);
  EXPECT_EQ(covered(Cull::back, FrontFace::ccw), 0u);
  EXPECT_GT(covered(Cull::back, FrontFace::cw), 0u);
  EXPECT_EQ(covered(Cull::front, FrontFace::cw), 0u);
  EXPECT_EQ(covered(Cull::both, FrontFace::cw), 0u);
}

TEST(Golden, ViewportPutsPlusYAtTheTopAndMapsDepth) {
  State state;
  state.depth_test = DepthFunc::always;
  SceneBuilder builder(8, 8, state);
  // Over the whole upper half: y in 0...1, z = 0.5.
  builder.triangle(clip_at(-1, 0, 0.5, 1), clip_at(3, 0, 0.5, 1), clip_at(-1, 4, 0.5, 1));
  const Image image = golden::render(builder.scene, embedded());
  EXPECT_EQ(image.ids[pixel(image, 0, 3)], 0);
  EXPECT_EQ(image.ids[pixel(image, 0, 4)], -1);
  EXPECT_DOUBLE_EQ(image.depth[pixel(image, 0, 0)], 0.75 * 65535);
}

TEST(Golden, ZeroOneClipDepthAndDepthRangeAreApplied) {
  State state;
  state.depth_test = DepthFunc::always;
  state.clip_z = ClipZ::zero_one;
  state.depth_range = {0.2, 0.6};
  SceneBuilder builder(4, 4, state);
  builder.triangle(clip_at(-1, -1, 0.5, 1), clip_at(3, -1, 0.5, 1), clip_at(-1, 3, 0.5, 1));
  const Image image = golden::render(builder.scene, embedded());
  EXPECT_NEAR(image.depth[0], 0.4 * 65535, 1e-9);
}

TEST(Golden, NearPlaneCutsWhereClipDepthBelowMinusW) {
  State state;
  state.depth_test = DepthFunc::always;
  SceneBuilder builder(16, 16, state);
  // z runs from -3 at the left border to 1 at the right one (w = 1): the left half lies before the near plane.
  builder.triangle(clip_at(-1, -1, -3, 1), clip_at(1, -1, 1, 1), clip_at(1, 1, 1, 1))
      .triangle(clip_at(-1, -1, -3, 1), clip_at(1, 1, 1, 1), clip_at(-1, 1, -3, 1));
  const Image image = golden::render(builder.scene, embedded());
  EXPECT_EQ(total_count(image), 16u * 8);
  EXPECT_EQ(image.ids[pixel(image, 7, 5)], -1);
  EXPECT_NE(image.ids[pixel(image, 8, 5)], -1);
  EXPECT_EQ(image.counters.clipped, 2u);
}

TEST(Golden, TriangleBehindTheEyeDrawsNothing) {
  SceneBuilder builder(8, 8, State{});
  builder.triangle(clip_at(0, 0, 0, -1), clip_at(1, 0, 0, -2), clip_at(0, 1, 0, -1));
  const Image image = golden::render(builder.scene, embedded());
  EXPECT_EQ(image.counters.covered, 0u);
  EXPECT_EQ(image.counters.culled, 1u);
}

TEST(Golden, PerspectiveColorAtHalfTheScreenWeighsTheNearEndMore) {
  // Left edge at w = 1 black, right edge at w = 3 red: halfway on the screen is a quarter of the way in space.
  State state;
  state.depth_test = DepthFunc::always;
  SceneBuilder builder(2, 1, state);
  const std::array<double, 4> black{0, 0, 0, 255}, red{240, 0, 0, 255};
  builder.triangle(clip_at(-1, -1, 0, 1, black), clip_at(3, -3, 0, 3, red), clip_at(3, 3, 0, 3, red))
      .triangle(clip_at(-1, -1, 0, 1, black), clip_at(3, 3, 0, 3, red), clip_at(-1, 1, 0, 1, black));
  const Image image = golden::render(builder.scene, embedded());
  // Pixel 1 has its centre at 3/4 of the width: 1/w = 1/2, so the share of red is (3/4 * 1/3) / (1/2) = 1/2.
  EXPECT_NEAR(image.color[1][0], 0.75 * 240, 1e-9);
  golden::Options options;
  options.color_interp = ColorInterp::perspective;
  EXPECT_NEAR(golden::render(builder.scene, embedded(), options).color[1][0], 0.5 * 240, 1e-9);
  builder.scene.states[0].color_interp = ColorInterp::perspective;
  EXPECT_NEAR(golden::render(builder.scene, embedded()).color[1][0], 0.5 * 240, 1e-9);
  options.color_interp = ColorInterp::affine;
  EXPECT_NEAR(golden::render(builder.scene, embedded(), options).color[1][0], 0.75 * 240, 1e-9);
}

TEST(Golden, FlatShadingTakesTheProvokingVertexOfListStripAndFan) {
  State state = SceneBuilder::window_state();
  state.shade = Shade::flat;
  Scene scene = SceneBuilder(8, 8, state).scene;
  scene.vertices = {at(0, 0, 0, {10, 0, 0, 255}), at(8, 0, 0, {20, 0, 0, 255}), at(0, 8, 0, {30, 0, 0, 255}),
                    at(8, 8, 0, {40, 0, 0, 255})};
  const auto red_of_second = [&](Topology topology, std::vector<std::uint32_t> indices) {
    scene.indices = std::move(indices);
    scene.commands = {Draw{0, 0, topology, 0, scene.indices.size(), 0}};
    const Image image = golden::render(scene, embedded());
    EXPECT_EQ(image.counters.primitives_in, 2u);
    EXPECT_EQ(image.ids[pixel(image, 7, 7)], 1);
    return image.color[pixel(image, 7, 7)][0];
  };
  EXPECT_EQ(red_of_second(Topology::triangles, {0, 1, 2, 3, 2, 1}), 40);
  EXPECT_EQ(red_of_second(Topology::triangle_strip, {0, 1, 2, 3}), 20);
  EXPECT_EQ(red_of_second(Topology::triangle_fan, {1, 0, 2, 3}), 30);
}

TEST(Golden, ClearObeysScissorAndDrawsObeyIt) {
  State state = SceneBuilder::window_state();
  state.scissor = Rect{2, 3, 4, 2};
  SceneBuilder builder = square(8, state);
  std::get<Clear>(builder.scene.commands[0]).color = std::array<double, 4>{255, 0, 0, 255};
  std::get<Clear>(builder.scene.commands[0]).depth = 0.25;
  builder.scene.commands.resize(1);
  const Image cleared = golden::render(builder.scene, embedded());
  EXPECT_DOUBLE_EQ(cleared.depth[pixel(cleared, 2, 3)], 0.25 * 65535);
  EXPECT_DOUBLE_EQ(cleared.depth[pixel(cleared, 1, 3)], 65535);
  EXPECT_EQ(cleared.frame.color[cleared.frame.at(5, 4)], 31u << 11);
  EXPECT_EQ(total_count(golden::render(square(8, state).scene, embedded())), 8u);
}

TEST(Golden, EveryDepthFunctionComparesAsItsNameSays) {
  const auto second_wins = [](DepthFunc function, double z) {
    State state = SceneBuilder::window_state();
    SceneBuilder builder(2, 2, state);
    builder.triangle(at(0, 0, 0.5), at(4, 0, 0.5), at(0, 4, 0.5));
    state.depth_test = function;
    builder.with_state(state).triangle(at(0, 0, z), at(4, 0, z), at(0, 4, z));
    return golden::render(builder.scene, embedded()).ids[0] == 1;
  };
  struct Row {
    DepthFunc function;
    bool nearer, same, farther;
  };
  for (const Row& row : {Row{DepthFunc::never, false, false, false}, Row{DepthFunc::less, true, false, false},
                         Row{DepthFunc::lequal, true, true, false}, Row{DepthFunc::equal, false, true, false},
                         Row{DepthFunc::greater, false, false, true}, Row{DepthFunc::gequal, false, true, true},
                         Row{DepthFunc::notequal, true, false, true}, Row{DepthFunc::always, true, true, true}}) {
    SCOPED_TRACE(static_cast<int>(row.function));
    EXPECT_EQ(second_wins(row.function, 0.25), row.nearer);
    EXPECT_EQ(second_wins(row.function, 0.5), row.same);
    EXPECT_EQ(second_wins(row.function, 0.75), row.farther);
  }
}

TEST(Golden, WriteMasksKeepWhatWasThere) {
  State state = SceneBuilder::window_state();
  state.depth_write = false;
  const Image no_depth = golden::render(square(4, state).scene, embedded());
  EXPECT_DOUBLE_EQ(no_depth.depth[0], 65535);
  EXPECT_EQ(no_depth.frame.color[0], 0xffffu);
  state.color_write = false;
  const Image nothing = golden::render(square(4, state).scene, embedded());
  EXPECT_EQ(nothing.counters.depth_passed, 16u);
  EXPECT_EQ(nothing.counters.written, 0u);
  EXPECT_EQ(nothing.ids[0], -1);
}

TEST(Golden, StoredCodesRoundToNearest) {
  SceneBuilder builder(1, 1);
  const std::array<double, 4> rgba{4.2, 2.1, 250.7, 128};  // 0.51, 0.52 and 30.48 codes
  builder.triangle(at(0, 0, 0.3, rgba), at(4, 0, 0.3, rgba), at(0, 4, 0.3, rgba));
  const Image small = golden::render(builder.scene, embedded());
  EXPECT_EQ(small.frame.color[0], 1u << 11 | 1u << 5 | 30u);
  EXPECT_EQ(small.frame.depth[0], 19661u);  // 0.3 * 65535 = 19660.5
  const Image full = golden::render(builder.scene, preset("full"));
  EXPECT_EQ(full.frame.color[0], 4u | 2u << 8 | 251u << 16 | 128u << 24);
}

TEST(Golden, Binary32DepthIsCoarserThanA24BitCodeAndBinary64IsNot) {
  SceneBuilder builder(64, 64);
  builder.triangle(at(0.1, 0.2, 0.913), at(63.7, 3.3, 0.127), at(9.9, 63.1, 0.655));
  const Image wide = golden::render(builder.scene, preset("full"));
  const Image narrow = golden::render(builder.scene, preset("full"), Precision::binary32);
  double worst = 0;
  for (std::size_t p = 0; p < wide.depth.size(); ++p)
    if (wide.ids[p] == 0 && narrow.ids[p] == 0) worst = std::max(worst, std::abs(wide.depth[p] - narrow.depth[p]));
  EXPECT_GT(worst, 0.25);
  EXPECT_LT(worst, 64);
}

TEST(Golden, TargetBeyondTheConfigurationIsRefused) {
  EXPECT_THROW((void)golden::render(SceneBuilder(1921, 1080).scene, embedded()), InputError);
  EXPECT_NO_THROW((void)golden::render(SceneBuilder(1920, 1).scene, embedded()));
}

TEST(Golden, ZeroWidthTriangleAndNumbersBeyondFloatDrawNothing) {
  SceneBuilder builder(4, 4);
  builder.triangle(at(0, 0), at(2, 2), at(4, 4)).triangle(at(-1e200, 0), at(1e200, -1e200), at(0, 1e200));
  EXPECT_EQ(golden::render(builder.scene, embedded()).counters.covered, 0u);
  EXPECT_EQ(golden::render(builder.scene, embedded(), Precision::binary32).counters.covered, 0u);
}

TEST(GoldenFragmentBuffer, RunsTheOperationsOfTheStateAndRoundsNothing) {
  golden::FragmentBuffer<double, int> pixels(2, 1.0, 0);
  State state;
  EXPECT_TRUE(pixels.apply(0, state, {0.5}, 7, 3).written);
  EXPECT_FALSE(pixels.apply(0, state, {0.5}, 8, 4).passed) << "less";
  EXPECT_TRUE(pixels.apply(0, state, {0.5 - 1e-15}, 9, 5).written);
  EXPECT_EQ(pixels.value(0), 9);
  EXPECT_EQ(pixels.owners()[0], 5);
  EXPECT_EQ(pixels.owners()[1], -1);
  state.depth_test = DepthFunc::always;
  state.color_write = false;
  EXPECT_TRUE(pixels.apply(0, state, {0.75}, 1, 6).written);
  EXPECT_EQ(pixels.depth(0), 0.75);
  EXPECT_EQ(pixels.value(0), 9) << "colour is masked";
  EXPECT_EQ(pixels.owners()[0], 6);
  state.depth_write = false;
  const golden::Fate fate = pixels.apply(0, state, {0.25}, 1, 7);
  EXPECT_TRUE(fate.passed);
  EXPECT_FALSE(fate.written);
  EXPECT_EQ(pixels.owners()[0], 6) << "what writes nothing owns nothing";
  pixels.disown(0);
  EXPECT_EQ(pixels.owners()[0], -1);
}

}  // namespace
}  // namespace halfplane::golden_test
