// Golden lines, points and polygon modes: against the exact oracle where snapping changes nothing, and by hand.
#include <numeric>

#include "../line_builder.hpp"
#include "model/golden/golden.hpp"
#include "model/golden/line.hpp"
#include "model/golden/primitive_assembly.hpp"
#include "model/host/primitive_assembly.hpp"

namespace halfplane::golden_lines_test {
namespace {

using namespace test;
using golden::Image;
using test::Random;  // beside sim's, which another file of the unity build may include
using GoldenLine = golden::Line<double>;

constexpr golden::PixelRange kEverywhere{-10000, -10000, 10000, 10000};

/// The same line for the golden: its ends lie on the snap grid, so that nothing is lost.
GoldenLine to_golden(const exact::Line& line) {
  GoldenLine real;
  real.start.x = std::ldexp(line.start.x, -line.grid_bits);
  real.start.y = std::ldexp(line.start.y, -line.grid_bits);
  real.end.x = std::ldexp(line.end.x, -line.grid_bits);
  real.end.y = std::ldexp(line.end.y, -line.grid_bits);
  real.rule = line.rule;
  real.drops_last = line.drops_last;
  return real;
}

Positions golden_positions(const GoldenLine& line) {
  Positions list;
  golden::for_each_candidate(line, kEverywhere, 1, [&](int x, int y) {
    if (golden::covers(line, x, y)) list.emplace_back(x, y);
  });
  std::sort(list.begin(), list.end());
  return list;
}

TEST(GoldenAssembly, EqualsTheStagesOverRandomDrawsWithRestarts) {
  constexpr std::uint32_t kSeed = 61;
  Random random(kSeed);
  std::size_t primitives = 0;
  for (int n = 0; n < 3000; ++n) {
    Scene scene;
    scene.vertices.resize(20);
    for (int i = random.index(16); i > 0; --i)
      scene.indices.push_back(random.index(5) == 0 ? kRestart : static_cast<std::uint32_t>(random.index(20)));
    const auto topology = static_cast<Topology>(random.index(7));
    const auto provoking = static_cast<Provoking>(random.index(2));
    const std::size_t first = std::min<std::size_t>(scene.indices.size(), 2);
    const Draw draw{0, 0, topology, first, scene.indices.size() - first, 0};
    SCOPED_TRACE("seed " + std::to_string(kSeed) + ", draw " + std::to_string(n));

    std::vector<std::vector<std::uint32_t>> expected, got;
    switch (primitive_type(topology)) {
      case PrimitiveType::triangle:
        for_each_triangle(scene, draw, provoking, [&](auto a, auto b, auto c) { expected.push_back({a, b, c, a}); });
        break;
      case PrimitiveType::line:
        for_each_line(scene, draw, [&](auto a, auto b) {
          expected.push_back({a, b, provoking == Provoking::first ? a : b});
        });
        break;
      case PrimitiveType::point: for_each_point(scene, draw, [&](auto a) { expected.push_back({a, a}); });
    }
    golden::for_each_primitive(scene, draw, provoking, [&](const golden::Primitive& p) {
      got.emplace_back(p.index.begin(), p.index.begin() + static_cast<std::ptrdiff_t>(p.corners));
      got.back().push_back(p.provoking);
    });
    ASSERT_EQ(got, expected);
    primitives += got.size();
  }
  EXPECT_GT(primitives, 5000u);
}

TEST(GoldenLine, EveryShortLineOnTheGridEqualsTheOracleInEveryRule) {
  for (const int bits : {1, 2}) {
    const int pixel = 1 << bits;
    for (int start = 0; start < pixel * pixel; ++start)
      for (int x = -2 * pixel; x < 3 * pixel; ++x)
        for (int y = -2 * pixel; y < 3 * pixel; ++y)
          for (const auto& [rule, drops_last] : all_rules()) {
            const exact::Line line{snapped_vertex(start % pixel, start / pixel), snapped_vertex(x, y), rule, drops_last,
                                   bits};
            ASSERT_EQ(golden_positions(to_golden(line)), oracle_positions(line)) << text(line);
          }
  }
}

TEST(GoldenLine, RandomLinesOnTheGridEqualTheOracleInEveryPreset) {
  constexpr std::uint32_t kSeed = 62;
  Random random(kSeed);
  for (const auto name : preset_names()) {
    const LineSpace space(preset(name));
    for (const double reach : {1.0, 0.05, 0.005})
      for (int n = 0; n < (reach == 1.0 ? 4 : 200); ++n)
        for (const auto& [rule, drops_last] : all_rules()) {
          const SnappedVertex start = random_vertex(random, space, reach), end = random_vertex(random, space, reach);
          exact::Line line{start, end, rule, drops_last, space.widths.grid_bits};
          ASSERT_EQ(golden_positions(to_golden(line)), oracle_positions_nearby(line))
              << name << ' ' << text(line) << ", seed " << kSeed;
          std::swap(line.start, line.end);
          ASSERT_EQ(golden_positions(to_golden(line)), oracle_positions_nearby(line)) << name << ' ' << text(line);
        }
  }
}

/// A window scene on the 1/16 pixel grid, and every primitive of it as the oracle takes it.
constexpr int kWidth = 40, kHeight = 36;

Scene random_scene(Random& random, const State& state) {
  SceneBuilder builder(kWidth, kHeight, state);
  Scene& scene = builder.scene;
  for (int d = 0; d < 6; ++d) {
    const auto topology = static_cast<Topology>(3 + random.index(4));
    const std::size_t first = scene.indices.size();
    for (int i = 2 + random.index(6); i > 0; --i) {
      scene.indices.push_back(static_cast<std::uint32_t>(scene.vertices.size()));
      // One coordinate in three on a half pixel: ties. Some beyond the target.
      const auto coordinate = [&] {
        const int v = random.index(56 * 16) - 8 * 16;
        return (random.index(3) == 0 ? v & -8 : v) / 16.0;
      };
      const double x = coordinate(), y = coordinate(), z = random.index(65536) / 65535.0;
      const auto channel = [&] { return static_cast<double>(random.index(256)); };
      scene.vertices.push_back(at(x, y, z, {channel(), channel(), channel(), channel()}));
      if (random.index(6) == 0) scene.indices.push_back(kRestart);
    }
    scene.commands.push_back(Draw{0, 0, topology, first, scene.indices.size() - first, 0});
  }
  return scene;
}

SnappedVertex on_grid(const Vertex& v) {
  SnappedVertex s = snapped_vertex(static_cast<int>(v.x * 16), static_cast<int>(v.y * 16),
                                   static_cast<std::uint32_t>(std::lround(v.z * 65535)));
  for (std::size_t c = 0; c < 4; ++c) s.code[kColorPlane + c] = static_cast<std::uint8_t>(v.rgba[c]);
  return s;
}

double value(const exact::Rational& r) { return static_cast<double>(r.numerator) / static_cast<double>(r.denominator); }

/// The lines of one pixel that a wide one is, by the words of the specification; sixteenths of a pixel.
std::vector<exact::Line> strands(const exact::Line& thin, double width) {
  const bool is_rounded = thin.rule != LineRule::diamond;
  const auto coordinate = [&](int v) { return is_rounded ? v >> 4 << 4 : v; };
  const int run = std::abs(coordinate(thin.end.x) - coordinate(thin.start.x));
  const int rise = std::abs(coordinate(thin.end.y) - coordinate(thin.start.y));
  std::vector<exact::Line> lines;
  const int count = static_cast<int>(std::lround(width));
  for (int i = 0; i < count; ++i) {
    const int halves = 2 * i - (count - 1);  // half pixels
    const int across = is_rounded ? (halves - (count % 2 == 0 ? -1 : 0)) / 2 * 16 : halves * 8;
    exact::Line line = thin;
    (run >= rise ? line.start.y : line.start.x) += across;
    (run >= rise ? line.end.y : line.end.x) += across;
    lines.push_back(line);
  }
  return lines;
}

/// How often each pixel is covered, and the attributes of the last primitive there.
struct Expected {
  std::vector<std::uint32_t> count = std::vector<std::uint32_t>(std::size_t{kWidth} * kHeight);
  std::vector<double> depth = std::vector<double>(count.size(), 65535);
  std::vector<double> red = std::vector<double>(count.size());
};

Expected expect(const Scene& scene) {
  Expected expected;
  const State& state = scene.states[0];
  const golden::PixelRange range = golden::draw_region(scene, state);
  const auto add = [&](int x, int y, double z, double red) {
    const auto p = static_cast<std::size_t>(y * kWidth + x);
    ++expected.count[p];
    expected.depth[p] = z;
    expected.red[p] = red;
  };
  const auto for_each_pixel = [&range](auto&& visit) {
    for (int y = range.begin_y; y < range.end_y; ++y)
      for (int x = range.begin_x; x < range.end_x; ++x) visit(x, y);
  };
  for (const Command& command : scene.commands) {
    const auto* draw = std::get_if<Draw>(&command);
    if (draw == nullptr) continue;
    if (draw->topology == Topology::points) {
      for_each_point(scene, *draw, [&](std::uint32_t index) {
        const Vertex& v = scene.vertices[index];
        const auto is_in = [&](int i, double at) {
          return at - state.point_size / 2 <= i + 0.5 && i + 0.5 < at + state.point_size / 2;
        };
        const auto in_disc = [&](int x, int y) {
          return std::hypot(x + 0.5 - v.x, y + 0.5 - v.y) <= state.point_size / 2;
        };
        for_each_pixel([&](int x, int y) {
          const bool is_round = state.point_shape == PointShape::round;
          if (is_in(x, v.x) && is_in(y, v.y) && (!is_round || in_disc(x, y))) add(x, y, v.z * 65535, v.rgba[0]);
        });
      });
    } else {
      for_each_line(scene, *draw, [&](std::uint32_t a, std::uint32_t b) {
        const exact::Line thin{on_grid(scene.vertices[a]), on_grid(scene.vertices[b]), state.line_rule,
                               golden::drops_last_pixel(state), 4};
        for (const exact::Line& line : strands(thin, state.line_width))
          for_each_pixel([&](int x, int y) {
            if (exact::covers(line, x, y)) add(x, y, value(depth_at(line, x, y)), value(color_at(line, x, y, 0)));
          });
      });
    }
  }
  return expected;
}

TEST(GoldenLine, ScenesOfLinesAndPointsOnTheGridEqualTheOracleInCoverageDepthAndColor) {
  std::uint64_t covered = 0;
  for (std::uint32_t seed = 1; seed <= 150; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    State state = SceneBuilder::window_state();
    state.line_rule = static_cast<LineRule>(random.index(3));
    if (random.index(2) == 0) state.line_last = random.index(2) == 0;
    state.point_size = 1 + random.index(6 * 16) / 16.0;
    if (seed % 2 == 0) state.line_width = 1 + random.index(10) / 2.0;
    if (seed % 3 == 0) state.point_shape = PointShape::round;
    if (random.index(2) == 0) state.scissor = Rect{random.index(20), random.index(20), 1 + random.index(25), 17};
    const Scene scene = random_scene(random, state);
    const Expected expected = expect(scene);
    const Image image = golden::render(scene, preset("embedded"));
    ASSERT_EQ(image.count, expected.count);
    for (std::size_t p = 0; p < expected.count.size(); ++p) {
      ASSERT_NEAR(image.depth[p], expected.depth[p], 1e-6) << p;
      ASSERT_NEAR(image.color[p][0], expected.red[p], 1e-9) << p;
    }
    covered += image.counters.covered;
  }
  EXPECT_GT(covered, 20000u);
}

std::size_t pixel(const Image& image, int x, int y) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x);
}

std::uint64_t total_count(const Image& image) {
  return std::accumulate(image.count.begin(), image.count.end(), std::uint64_t{0});
}

/// A scene of one draw with these vertices in order.
Scene one_draw(int width, int height, const State& state, Topology topology, const std::vector<Vertex>& vertices) {
  Scene scene = SceneBuilder(width, height, state).scene;
  scene.vertices = vertices;
  scene.indices.resize(vertices.size());
  std::iota(scene.indices.begin(), scene.indices.end(), 0U);
  scene.commands.push_back(Draw{0, 0, topology, 0, vertices.size(), 0});
  return scene;
}

State clip_state() {
  State state;
  state.depth_test = DepthFunc::always;
  return state;
}

TEST(GoldenLine, LineThroughTheNearPlaneIsCutThereAndKeepsItsPixelsAndDepth) {
  // From w = -1 behind the eye to w = 3: near (z = -w) is met at t = 1/2, where x = 0, w = 1, colour 100.
  State state = clip_state();
  state.line_last = true;
  state.line_rule = LineRule::midpoint;
  const Vertex behind = clip_at(-1.5, 0, -3, -1, {0, 0, 0, 255}), ahead = clip_at(1.5, 0, 1, 3, {200, 0, 0, 255});
  for (const bool is_reversed : {false, true}) {
    const Scene scene =
        one_draw(16, 16, state, Topology::lines, is_reversed ? std::vector{ahead, behind} : std::vector{behind, ahead});
    const Image image = golden::render(scene, preset("full"));
    golden::Options options;
    options.color_interp = ColorInterp::perspective;
    const Image perspective = golden::render(scene, preset("full"), options);
    // x from 8 (w = 1) to 12 (x / w = 1/2), both ends drawn: pixels 8 to 12 of row 8.
    EXPECT_EQ(total_count(image), 5u);
    for (int x = 8; x <= 12; ++x) EXPECT_EQ(image.count[pixel(image, x, 8)], 1u) << x;
    EXPECT_NEAR(image.depth[pixel(image, 8, 8)], 0, 1e-6);
    EXPECT_NEAR(image.depth[pixel(image, 12, 8)], 2.0 / 3 * 16777215, 1e-6);  // z / w = 1/3
    EXPECT_NEAR(image.color[pixel(image, 10, 8)][0], 150, 1e-9);
    EXPECT_NEAR(perspective.color[pixel(image, 10, 8)][0], 125, 1e-9);  // 1/w = 2/3: the far end's share is 1/4
    EXPECT_EQ(image.counters.clipped, 1u);
  }
}

TEST(GoldenLine, LineBehindTheEyeDrawsNothing) {
  const Image image = golden::render(
      one_draw(8, 8, clip_state(), Topology::lines, {clip_at(0, 0, 0, -1), clip_at(1, 0, 0, -2)}), preset("embedded"));
  EXPECT_EQ(total_count(image), 0u);
  EXPECT_EQ(image.counters.culled, 1u);
}

TEST(GoldenLine, FlatLineTakesTheColorOfTheProvokingEnd) {
  for (const auto provoking : {Provoking::first, Provoking::last}) {
    State state = SceneBuilder::window_state();
    state.shade = Shade::flat;
    state.provoking = provoking;
    const Image image =
        golden::render(one_draw(8, 2, state, Topology::lines,
                                {at(0.5, 0.5, 0.5, {10, 0, 0, 255}), at(7.5, 0.5, 0.5, {90, 0, 0, 255})}),
                       preset("embedded"));
    for (int x = 0; x < 7; ++x) EXPECT_EQ(image.color[pixel(image, x, 0)][0], provoking == Provoking::first ? 10 : 90);
    EXPECT_EQ(image.count[7], 0u) << "diamond exit drops the last pixel";
  }
}

TEST(GoldenLine, LargeFiniteWindowCoordinatesDrawWhatIsInTheTargetAndInfiniteOnesNothing) {
  State state = SceneBuilder::window_state();
  const Scene scene = one_draw(8, 8, state, Topology::lines, {at(-1e15, 3.5), at(1e15, 3.5)});
  EXPECT_EQ(total_count(golden::render(scene, preset("embedded"))), 8u);
  const Scene beyond = one_draw(8, 8, state, Topology::lines, {at(-1e200, 3.5), at(1e200, 3.5)});
  EXPECT_EQ(total_count(golden::render(beyond, preset("embedded"), golden::Precision::binary32)), 0u);
}

TEST(GoldenPoint, PointClipDecidesAboutAPointWhoseCentreIsOutside) {
  // A point of 4 pixels with its centre half a pixel left of the viewport: its last column of pixel centres is inside.
  const auto count = [](PointClip clip, double x, double z) {
    State state = clip_state();
    state.point_size = 4;
    state.point_clip = clip;
    return total_count(
        golden::render(one_draw(16, 16, state, Topology::points, {clip_at(x, 0, z, 1)}), preset("tiny")));
  };
  const double outside = -1 - 1.0 / 16;
  EXPECT_EQ(count(PointClip::pixel, outside, 0), 4u);
  EXPECT_EQ(count(PointClip::center, outside, 0), 0u);
  EXPECT_EQ(count(PointClip::center, -1, 0), 4u * 2);
  for (const auto clip : {PointClip::pixel, PointClip::center}) {
    EXPECT_EQ(count(clip, 0, 1.01), 0u);
    EXPECT_EQ(count(clip, 0, -1.01), 0u);
    EXPECT_EQ(count(clip, 0, 1), 16u);
  }
}

TEST(GoldenPoint, WholeSizeCoversItsSquareWhereverItLies) {
  constexpr std::uint32_t kSeed = 63;
  Random random(kSeed);
  for (int size = 1; size <= 5; ++size)
    for (int n = 0; n < 50; ++n) {
      State state = SceneBuilder::window_state();
      state.point_size = size;
      const double x = random.between(8, 24), y = random.between(8, 24);
      const Image image =
          golden::render(one_draw(32, 32, state, Topology::points, {at(x, y, 0.25)}), preset("embedded"));
      ASSERT_EQ(total_count(image), static_cast<std::uint64_t>(size * size)) << x << ", " << y << ", seed " << kSeed;
    }
}

/// A triangle with the plane z = 0.2 + 0.01 x - 0.02 y, counter-clockwise as seen when `is_ccw`.
std::vector<Vertex> sloped_triangle(bool is_ccw) {
  const auto vertex = [](double x, double y) { return at(x, y, 0.4 + 0.01 * x - 0.02 * y, {x, y, 0, 255}); };
  std::vector<Vertex> v{vertex(2.5, 3.5), vertex(14.5, 3.5), vertex(5.5, 13.5)};
  if (is_ccw) std::swap(v[1], v[2]);
  return v;
}

TEST(GoldenModes, LineModeDrawsTheThreeEdgesFromTheProvokingVertexOn) {
  for (const auto provoking : {Provoking::first, Provoking::last})
    for (const auto rule : {LineRule::diamond, LineRule::bresenham}) {
      State state = SceneBuilder::window_state();
      state.polygon_mode = PolygonMode::line;
      state.provoking = provoking;
      state.line_rule = rule;
      const auto v = sloped_triangle(false);
      const Image image = golden::render(one_draw(16, 16, state, Topology::triangles, v), preset("embedded"));
      const auto lines = provoking == Provoking::first ? std::vector{v[0], v[1], v[2]} : std::vector{v[2], v[0], v[1]};
      const Image loop = golden::render(one_draw(16, 16, state, Topology::line_loop, lines), preset("embedded"));
      EXPECT_EQ(image.count, loop.count);
      EXPECT_EQ(image.depth, loop.depth);
      EXPECT_EQ(image.color, loop.color);
      EXPECT_GT(total_count(image), 30u);
      EXPECT_EQ(image.counters.primitives_in, 1u);
      EXPECT_EQ(loop.counters.primitives_in, 3u);
    }
}

TEST(GoldenModes, PointModeDrawsTheThreeVerticesAndFlatColorsThemAlike) {
  State state = SceneBuilder::window_state();
  state.polygon_mode = PolygonMode::point;
  state.point_size = 2;
  state.shade = Shade::flat;
  state.provoking = Provoking::last;
  const Image image =
      golden::render(one_draw(16, 16, state, Topology::triangles, sloped_triangle(false)), preset("embedded"));
  EXPECT_EQ(total_count(image), 3u * 4);
  for (const auto& [x, y] : {std::pair{2, 3}, std::pair{14, 3}, std::pair{5, 13}}) {
    EXPECT_EQ(image.count[pixel(image, x, y)], 1u);
    EXPECT_EQ(image.color[pixel(image, x, y)][0], 5.5);
  }
}

TEST(GoldenModes, CulledTrianglesDrawNoEdgesAndNoVertices) {
  for (const auto mode : {PolygonMode::fill, PolygonMode::line, PolygonMode::point})
    for (const bool is_ccw : {false, true}) {
      State state = SceneBuilder::window_state();
      state.polygon_mode = mode;
      state.cull = Cull::back;  // the front is counter-clockwise
      const Image image =
          golden::render(one_draw(16, 16, state, Topology::triangles, sloped_triangle(is_ccw)), preset("embedded"));
      EXPECT_EQ(total_count(image) > 0, is_ccw);
      EXPECT_EQ(image.counters.culled, is_ccw ? 0u : 1u);
    }
}

TEST(GoldenModes, EdgesMadeByClippingAreNotDrawn) {
  // The right half lies beyond the far plane: two edges are cut there, and nothing joins the cuts.
  State state = clip_state();
  state.polygon_mode = PolygonMode::line;
  const std::vector<Vertex> v{clip_at(-0.9, 0, -1, 1), clip_at(0.9, -0.9, 3, 1), clip_at(0.9, 0.9, 3, 1)};
  const Image image = golden::render(one_draw(64, 64, state, Topology::triangles, v), preset("embedded"));
  for (int x = 0; x < 64; ++x) {
    std::uint32_t column = 0;
    for (int y = 0; y < 64; ++y) column += image.count[pixel(image, x, y)];
    EXPECT_LE(column, 2u) << x;
    if (x > 33) {
      EXPECT_EQ(column, 0u) << x;
    } else if (x > 4 && x < 31) {
      EXPECT_GE(column, 1u) << x;
    }
  }
  EXPECT_EQ(image.counters.clipped, 1u);
}

TEST(GoldenOffset, MovesThePlaneByItsSteeperSlopeAndTheConstantInEveryMode) {
  for (const auto mode : {PolygonMode::fill, PolygonMode::line, PolygonMode::point})
    for (const bool is_ccw : {false, true}) {
      State state = SceneBuilder::window_state();
      state.polygon_mode = mode;
      const auto v = sloped_triangle(is_ccw);
      const Image plain = golden::render(one_draw(16, 16, state, Topology::triangles, v), preset("embedded"));
      state.polygon_offset = {1.5, -40.25};
      const Image moved = golden::render(one_draw(16, 16, state, Topology::triangles, v), preset("embedded"));
      ASSERT_EQ(plain.count, moved.count);
      ASSERT_GT(total_count(plain), 2u);
      for (std::size_t p = 0; p < plain.count.size(); ++p)
        EXPECT_NEAR(moved.depth[p] - plain.depth[p], plain.count[p] == 0 ? 0 : 1.5 * 0.02 * 65535 - 40.25, 1e-6);
    }
}

TEST(GoldenOffset, IsClampedToTheDepthRangePixelByPixelAndLeavesLinesAlone) {
  State state = SceneBuilder::window_state();
  state.polygon_offset = {0, 0.5 * 65535};
  const Image image =
      golden::render(one_draw(16, 16, state, Topology::triangles, sloped_triangle(false)), preset("embedded"));
  // z = 0.9 + 0.01 x - 0.02 y at pixel centres.
  EXPECT_NEAR(image.depth[pixel(image, 12, 4)], 0.935 * 65535, 1e-6);
  EXPECT_NEAR(image.depth[pixel(image, 5, 9)], (0.9 + 0.055 - 0.19) * 65535, 1e-6);
  state.polygon_offset = {0, 0.58 * 65535};
  const Image clamped =
      golden::render(one_draw(16, 16, state, Topology::triangles, sloped_triangle(false)), preset("embedded"));
  EXPECT_EQ(clamped.depth[pixel(clamped, 12, 4)], 65535);
  EXPECT_NEAR(clamped.depth[pixel(clamped, 5, 9)], (0.98 + 0.055 - 0.19) * 65535, 1e-6);
  const Image line = golden::render(one_draw(16, 16, state, Topology::lines, {at(1, 1.5, 0.25), at(9, 1.5, 0.25)}),
                                    preset("embedded"));
  EXPECT_EQ(line.depth[pixel(line, 5, 1)], 0.25 * 65535);
}

}  // namespace
}  // namespace halfplane::golden_lines_test
