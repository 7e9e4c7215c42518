// Lines, points and polygon modes through the host side and the engines.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "../functional_case.hpp"
#include "../line_builder.hpp"
#include "../scene_builder.hpp"
#include "model/engines/functional.hpp"
#include "model/engines/scalar.hpp"
#include "model/golden/golden.hpp"
#include "model/host/primitives.hpp"

namespace halfplane::outline_test {
namespace {

using namespace test;
using test::Random;  // beside sim's, which another file of the unity build may include

using Indices = std::vector<std::uint32_t>;
constexpr auto R = kRestart;

Scene scene_of(Topology topology, const Indices& indices) {
  Scene scene;
  scene.indices = indices;
  scene.states.resize(1);
  scene.commands = {Draw{.topology = topology, .count = indices.size()}};
  return scene;
}

/// All primitives of one draw, one after the other: three, two or one index each.
Indices assembled(Topology topology, const Indices& indices, Provoking provoking = Provoking::first) {
  const Scene scene = scene_of(topology, indices);
  Indices result;
  for_each_primitive(scene, std::get<Draw>(scene.commands[0]), provoking, [&](const AssembledPrimitive& p) {
    const std::ptrdiff_t count = p.type == PrimitiveType::triangle ? 3 : p.type == PrimitiveType::line ? 2 : 1;
    result.insert(result.end(), p.index.begin(), p.index.begin() + count);
  });
  return result;
}

TEST(Assembly, EveryTopologyNamesItsVertices) {
  EXPECT_EQ(assembled(Topology::triangles, {0, 1, 2, 3, 4, 5, 6}), (Indices{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(assembled(Topology::triangle_strip, {0, 1, 2, 3, 4}), (Indices{0, 1, 2, 1, 3, 2, 2, 3, 4}));
  EXPECT_EQ(assembled(Topology::triangle_fan, {0, 1, 2, 3}), (Indices{1, 2, 0, 2, 3, 0}));
  EXPECT_EQ(assembled(Topology::lines, {0, 1, 2, 3, 4}), (Indices{0, 1, 2, 3}));
  EXPECT_EQ(assembled(Topology::line_strip, {0, 1, 2}), (Indices{0, 1, 1, 2}));
  EXPECT_EQ(assembled(Topology::line_loop, {0, 1, 2}), (Indices{0, 1, 1, 2, 2, 0}));
  EXPECT_EQ(assembled(Topology::line_loop, {0, 1}), (Indices{0, 1, 1, 0}));
  EXPECT_EQ(assembled(Topology::line_loop, {0}), Indices{});
  EXPECT_EQ(assembled(Topology::points, {3, 1}), (Indices{3, 1}));
}

TEST(Assembly, TheProvokingVertexComesFirstAndTheFacingStays) {
  EXPECT_EQ(assembled(Topology::triangles, {0, 1, 2}, Provoking::last), (Indices{2, 0, 1}));
  EXPECT_EQ(assembled(Topology::triangle_strip, {0, 1, 2, 3}, Provoking::last), (Indices{2, 0, 1, 3, 2, 1}));
  EXPECT_EQ(assembled(Topology::triangle_fan, {0, 1, 2, 3}, Provoking::last), (Indices{2, 0, 1, 3, 0, 2}));
}

TEST(Assembly, RestartBeginsEveryTopologyAnew) {
  EXPECT_EQ(assembled(Topology::triangle_strip, {0, 1, 2, R, 3, 4, 5, 6}), (Indices{0, 1, 2, 3, 4, 5, 4, 6, 5}));
  EXPECT_EQ(assembled(Topology::triangle_fan, {0, 1, 2, R, 3, 4, 5}), (Indices{1, 2, 0, 4, 5, 3}));
  EXPECT_EQ(assembled(Topology::triangles, {0, 1, R, 2, 3, 4}), (Indices{2, 3, 4}));
  EXPECT_EQ(assembled(Topology::line_strip, {R, 0, 1, R, R, 2, R, 3, 4, R}), (Indices{0, 1, 3, 4}));
  EXPECT_EQ(assembled(Topology::line_loop, {0, 1, 2, R, 3, 4}), (Indices{0, 1, 1, 2, 2, 0, 3, 4, 4, 3}));
  EXPECT_EQ(assembled(Topology::points, {0, R, 1}), (Indices{0, 1}));
}

/// Every topology and state, in window space and across all clip planes.
Scene random_scene(std::uint32_t seed, int width, int height) {
  Random random(seed);
  SceneBuilder builder(width, height);
  Scene& scene = builder.scene;
  for (int n = 0; n < 12; ++n) {
    scene.states.push_back(random_state(SceneBuilder::window_state(), states_but({}), chooser(random)));
    const bool is_window = scene.states.back().space == Space::window;
    const std::size_t first_vertex = scene.vertices.size();
    for (int i = 0; i < 24; ++i) {
      Vertex v = is_window ? at(random.between(-9, width + 9), random.between(-9, height + 9), random.unit())
                           : clip_at(random.between(-2, 2), random.between(-2, 2), random.between(-2, 2),
                                     random.between(-0.5, 2));
      for (double& channel : v.rgba) channel = random.between(0, 255);
      scene.vertices.push_back(v);
    }
    Draw draw{.state = static_cast<std::uint32_t>(scene.states.size() - 1),
              .topology = static_cast<Topology>(random.index(7)),
              .first = scene.indices.size(),
              .count = 20};
    for (int i = 0; i < 20; ++i)
      scene.indices.push_back(random.unit() < 0.1 ? kRestart
                                                  : static_cast<std::uint32_t>(first_vertex) +
                                                        static_cast<std::uint32_t>(random.index(24)));
    scene.commands.push_back(draw);
  }
  return scene;
}

TEST(Outlines, FunctionalEqualsScalarOnRandomScenesOfEveryTopologyAndMode) {
  std::uint64_t lines = 0, points = 0, clipped = 0;
  for (std::uint32_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Config config = preset(preset_names()[seed % 4]);
    const bool is_tiny = config.preset == "tiny";
    const Scene scene = random_scene(seed, is_tiny ? 15 : 61, is_tiny ? 13 : 47);
    RenderOptions options;
    options.want_count = options.want_ids = options.want_triangles = true;
    const Rendering functional = render_functional(scene, config, options);
    const Rendering scalar = render_scalar(scene, config, options);
    EXPECT_EQ(functional.frame.depth, scalar.frame.depth);
    EXPECT_EQ(functional.frame.color, scalar.frame.color);
    EXPECT_EQ(functional.count, scalar.count);
    EXPECT_EQ(functional.ids, scalar.ids);
    EXPECT_EQ(functional.visible, scalar.visible);
    const Counters& c = functional.counters;
    EXPECT_EQ(c.primitives_in, c.culled + c.drawn);
    EXPECT_EQ(c.written, scalar.counters.written);
    lines += functional.lines.size();
    points += functional.points.size();
    clipped += c.clipped;
  }
  EXPECT_GT(lines, 1000u);
  EXPECT_GT(points, 500u);
  EXPECT_GT(clipped, 100u);
}

TEST(Outlines, EveryPixelOfALineIsTheOraclesAndInsideTheScissor) {
  const LineSpace space(preset("embedded"));
  std::uint64_t pixels = 0;
  for (std::uint32_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Scene scene = random_scene(seed, 61, 47);
    std::map<std::uint32_t, std::vector<std::pair<int, int>>> drawn;  // by primitive
    RenderOptions options;
    options.want_triangles = true;
    options.pixel_tap = [&](std::uint32_t primitive, int x, int y) { drawn[primitive].emplace_back(x, y); };
    const Rendering rendering = render_functional(scene, space.config, options);
    std::map<std::uint32_t, std::vector<std::pair<int, int>>> expected;
    for (const DrawnLine& line : rendering.lines) {
      const auto& draw = std::get<Draw>(scene.commands[line.draw]);
      const State& state = scene.states[draw.state];
      const Rect rect = raster_rect(state, scene.width, scene.height);
      const exact::Line oracle{line.start, line.end, state.line_rule, line.drops_last, space.widths.grid_bits};
      for (int y = rect.y; y < rect.y + rect.height; ++y)
        for (int x = rect.x; x < rect.x + rect.width; ++x)
          if (exact::covers(oracle, x, y)) expected[line.primitive].emplace_back(x, y);
    }
    for (const DrawnPoint& point : rendering.points) drawn.erase(point.primitive);
    for (auto& [primitive, list] : drawn) std::ranges::sort(list);
    for (auto& [primitive, list] : expected) std::ranges::sort(list);
    EXPECT_EQ(drawn, expected);
    for (const auto& [primitive, list] : expected) pixels += list.size();
  }
  EXPECT_GT(pixels, 10000u);
}

std::set<std::pair<int, int>> covered(const Scene& scene, const Config& config = preset("embedded")) {
  std::set<std::pair<int, int>> pixels;
  RenderOptions options;
  options.pixel_tap = [&pixels](std::uint32_t, int x, int y) { pixels.emplace(x, y); };
  (void)render_functional(scene, config, options);
  return pixels;
}

Scene one_draw(const State& state, Topology topology, const std::vector<Vertex>& vertices, int size = 32) {
  SceneBuilder builder(size, size, state);
  builder.scene.vertices = vertices;
  for (std::size_t i = 0; i < vertices.size(); ++i) builder.scene.indices.push_back(static_cast<std::uint32_t>(i));
  builder.scene.commands.push_back(Draw{.topology = topology, .count = vertices.size()});
  return builder.scene;
}

TEST(Outlines, CullingByFacingRemovesTheEdgesToo) {
  State state = SceneBuilder::window_state();
  state.polygon_mode = PolygonMode::line;
  state.cull = Cull::back;
  const std::vector<Vertex> front{at(4, 4), at(4, 20), at(20, 4)}, back{at(4, 4), at(20, 4), at(4, 20)};
  EXPECT_FALSE(covered(one_draw(state, Topology::triangles, front)).empty());
  EXPECT_TRUE(covered(one_draw(state, Topology::triangles, back)).empty());
}

TEST(Outlines, EdgesOfATriangleThatCrossesTheEyePlaneEndAtTheNearPlane) {
  State state = SceneBuilder::window_state();
  state.space = Space::clip;
  state.polygon_mode = PolygonMode::line;
  // Two corners in view, one behind the eye: two of its edges go up to the near plane, which no edge is drawn along.
  const std::vector<Vertex> v{clip_at(-0.5, -0.5, 0, 1), clip_at(0.5, -0.5, 0, 1), clip_at(0, 3, -2, -1)};
  std::map<int, int> per_row;
  for (const auto& [x, y] : covered(one_draw(state, Topology::triangles, v))) ++per_row[y];
  EXPECT_EQ(per_row.begin()->first, 4) << "a quarter of the way, y = 0.375 / 0.5";
  for (int y = 5; y < 23; ++y) EXPECT_EQ(per_row[y], 2) << "row " << y;  // row 23 is the third edge
}

TEST(Outlines, PointsAreClippedByPixelOrByCentre) {
  State state = SceneBuilder::window_state();
  state.space = Space::clip;
  state.point_size = 8;
  const std::vector<Vertex> half_out{clip_at(-1.05, 0, 0, 1)};
  EXPECT_EQ(covered(one_draw(state, Topology::points, half_out)).size(), 3u * 8u);
  state.point_clip = PointClip::center;
  EXPECT_TRUE(covered(one_draw(state, Topology::points, half_out)).empty());
  state.point_clip = PointClip::pixel;
  EXPECT_TRUE(covered(one_draw(state, Topology::points, {clip_at(0, 0, -1.1, 1)})).empty()) << "before the near plane";
  EXPECT_TRUE(covered(one_draw(state, Topology::points, {clip_at(0, 0, 0, -1)})).empty()) << "behind the eye";
}

TEST(Outlines, WhatIsWiderThanTheGuardBandAllowsIsRefused) {
  State state = SceneBuilder::window_state();
  state.point_size = state.line_width = 4096;
  EXPECT_THROW((void)covered(one_draw(state, Topology::points, {at(1, 1)})), InputError);
  EXPECT_THROW((void)covered(one_draw(state, Topology::lines, {at(1, 1), at(9, 9)})), InputError);
  state.polygon_mode = PolygonMode::line;
  EXPECT_THROW((void)covered(one_draw(state, Topology::triangles, {at(1, 1), at(9, 9), at(1, 9)})), InputError);
  state.polygon_mode = PolygonMode::fill;
  EXPECT_NO_THROW((void)covered(one_draw(state, Topology::triangles, {at(1, 1), at(9, 9), at(1, 9)})));
  state.line_width = 2 * (preset("embedded").guard_band - 1 - 32);
  EXPECT_EQ(covered(one_draw(state, Topology::lines, {at(1, 16), at(31, 16)})).size(), 30U * 32U);
}

TEST(Outlines, AWideLineIsItsThinLineSideBySide) {
  constexpr std::uint32_t kSeed = 31;
  Random random(kSeed);
  for (int n = 0; n < 300; ++n) {
    SCOPED_TRACE("seed " + std::to_string(kSeed) + ", line " + std::to_string(n));
    State state = SceneBuilder::window_state();
    state.line_rule = static_cast<LineRule>(random.index(3));
    const auto anywhere = [&random] { return at(random.between(12, 52), random.between(12, 52)); };
    const std::vector<Vertex> ends{anywhere(), anywhere()};
    const auto thin = covered(one_draw(state, Topology::lines, ends, 64));
    // One of the two axes, whichever is the minor one: each column has one pixel, and then three.
    state.line_width = 3.25;
    const auto wide = covered(one_draw(state, Topology::lines, ends, 64));
    std::set<std::pair<int, int>> moved_x, moved_y;
    for (const auto& [x, y] : thin)
      for (const int across : {-1, 0, 1}) {
        moved_x.emplace(x + across, y);
        moved_y.emplace(x, y + across);
      }
    EXPECT_EQ(wide.size(), 3 * thin.size()) << "a pixel is in two strands";
    EXPECT_TRUE(wide == moved_x || wide == moved_y);
  }
}

TEST(Outlines, ALineOfTwoPixelsLiesToBothSidesOfItsMiddle) {
  State state = SceneBuilder::window_state();
  state.line_width = 2;
  for (const auto rule : {LineRule::midpoint, LineRule::diamond}) {
    state.line_rule = rule;
    std::set<int> rows;
    for (const auto& [x, y] : covered(one_draw(state, Topology::lines, {at(2, 10), at(20, 10)}))) rows.insert(y);
    // On the border of rows 9 and 10: the two rows beside it; of whole pixels the end's own row and the row below.
    EXPECT_EQ(rows, (rule == LineRule::diamond ? std::set<int>{9, 10} : std::set<int>{10, 11}));
  }
}

TEST(Outlines, ALineOutsideTheTargetShowsTheStrandsThatAreInside) {
  State state = SceneBuilder::window_state();
  state.line_width = 9;
  for (const Topology topology : {Topology::lines, Topology::line_strip})
    EXPECT_EQ(covered(one_draw(state, topology, {at(-5, -2.5), at(40, -2.5)})).size(), 32U * 2U);
  state.space = Space::clip;  // beyond the view, not beyond the guard band
  EXPECT_EQ(covered(one_draw(state, Topology::lines, {clip_at(-2, 1.1, 0, 1), clip_at(2, 1.1, 0, 1)})).size(),
            32U * 3U);
}

TEST(Outlines, ARoundPointIsADisc) {
  State state = SceneBuilder::window_state();
  state.point_shape = PointShape::round;
  state.point_size = 9.25;
  std::set<std::pair<int, int>> disc;
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x)
      if (std::hypot(x + 0.5 - 28.75, y + 0.5 - 3.5) <= 9.25 / 2) disc.emplace(x, y);
  EXPECT_EQ(covered(one_draw(state, Topology::points, {at(28.75, 3.5)})), disc);
  state.point_size = 1;
  EXPECT_EQ(covered(one_draw(state, Topology::points, {at(4.5, 4.5)})).size(), 1U);
  EXPECT_TRUE(covered(one_draw(state, Topology::points, {at(4, 4)})).empty()) << "a disc that holds no centre";
}

TEST(Outlines, CoordinatesWhoseDistancesOverflowAreRefusedByModelAndGolden) {
  State state = SceneBuilder::window_state();
  state.space = Space::clip;
  for (const double large : {1e300, 8e307}) {
    const std::vector<Vertex> v{clip_at(large, large, 0, large), clip_at(-large, -large, 0, large),
                                clip_at(-large, large, 0, large)};
    const Scene scene = one_draw(state, Topology::triangles, v);
    if (large > 1e300) {
      EXPECT_THROW((void)render_functional(scene, preset("embedded"), {}), InputError);
      EXPECT_THROW((void)golden::render(scene, preset("embedded")), InputError);
    } else {
      EXPECT_GT(render_functional(scene, preset("embedded"), {}).counters.covered, 400u);
      EXPECT_GT(golden::render(scene, preset("embedded")).counters.covered, 400u);
    }
  }
}

/// Depth codes of a sloped triangle over the whole target, row by row.
std::vector<std::uint32_t> depths(double factor, double constant, double slope_per_pixel) {
  State state = SceneBuilder::window_state();
  state.polygon_offset = {factor, constant};
  const double lsb = 1 / 65535.0, far_z = 0.5 + 64 * slope_per_pixel * lsb;
  const Scene scene = one_draw(state, Topology::triangles, {at(0, 0, 0.5), at(64, 0, far_z), at(0, 64, 0.5)});
  const Rendering rendering = render_functional(scene, preset("embedded"), {});
  std::vector<std::uint32_t> codes;
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x) codes.push_back(rendering.frame.depth[rendering.frame.at(x, y)]);
  return codes;
}

TEST(PolygonOffset, TheConstantIsInCodesAndTheFactorMultipliesTheSteeperSlope) {
  const auto flat = depths(0, 0, 0), sloped = depths(0, 0, 20);
  for (std::size_t i = 0; i < flat.size(); ++i) {
    EXPECT_EQ(depths(0, 1, 0)[i], flat[i] + 1);
    EXPECT_EQ(depths(0, -3, 20)[i], sloped[i] - 3);
    EXPECT_EQ(depths(0.5, 2, 20)[i], sloped[i] + 12);
    EXPECT_EQ(depths(5, 0, 0)[i], flat[i]) << "a level plane has no slope";
  }
  EXPECT_EQ(depths(0, 1e9, 0)[0], 65535u) << "clamped to the largest code";
}

TEST(Outline, SmallPointsAreTheSameInLanes) {
  Random random(31);
  for (const double size : {1.0, 1.5, 2.0, 3.0, 4.0, 4.5})
    for (const PointClip clip : {PointClip::pixel, PointClip::center})
      for (const std::size_t every : {1U, 9U}) {  // all vertices in order, or few of them
        SceneBuilder builder(150, 110);
        Scene& scene = builder.scene;
        State state;
        state.point_size = size;
        state.point_clip = clip;
        scene.states.push_back(state);
        for (std::size_t i = 0; i < 1500; ++i) {
          const double w = random.between(-0.1, 1), reach = 1.05 * w;
          scene.vertices.push_back({random.between(-reach, reach),
                                    random.between(-reach, reach),
                                    random.between(-reach, reach),
                                    w,
                                    {10, 20, 30, 255},
                                    0,
                                    0});
          for (double& channel : scene.vertices.back().rgba) channel = random.index(256);
          if (i % every == 0) scene.indices.push_back(static_cast<std::uint32_t>(i));
        }
        scene.commands.push_back(
            Draw{static_cast<std::uint32_t>(scene.states.size() - 1), 0, Topology::points, 0, scene.indices.size(), 0});
        SCOPED_TRACE("size " + std::to_string(size) + ", one of " + std::to_string(every));
        expect_all_same(scene, preset("embedded"));
        EXPECT_GT(render_functional(scene, preset("embedded")).counters.written, 50U);
      }
}

}  // namespace
}  // namespace halfplane::outline_test
