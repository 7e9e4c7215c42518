// The comparison on lines and points: figures that must be zero are, differences from the golden are explained by the
// snap, and engines that are wrong are caught. The engine here is the stages in a plain loop.
#include <gtest/gtest.h>

#include <cmath>

#include "../scene_builder.hpp"
#include "model/pipeline.hpp"
#include "model/stages/line_raster.hpp"
#include "model/stages/point_raster.hpp"
#include "sim/compare/compare.hpp"

namespace halfplane {
namespace {

using test::at;
using test::Random;
using test::SceneBuilder;

constexpr int kWidth = 48, kHeight = 44;

/// What a test may do to an engine: `pixel` to a pixel of a line or point before it is drawn (false: it is not drawn),
/// `code` to its codes, `damage` to the result.
struct Hooks {
  std::function<bool(std::uint32_t primitive, int& x, int& y)> pixel;
  std::function<void(LinePixel&)> code;
  std::function<void(Rendering&)> damage;
};

/// Draws the lines and points of window-space draws. Depth test always.
class StageEngine {
 public:
  StageEngine(const Scene& scene, const Config& config, const RenderOptions& options, const Hooks& hooks)
      : scene_(scene), config_(config), widths_(derive_widths(config)), options_(options), hooks_(hooks) {
    result_ = make_rendering(scene, config, options);
  }

  Rendering run() && {
    std::uint32_t primitive = 0;
    for (std::size_t i = 0; i < scene_.commands.size(); ++i) {
      const auto* draw = std::get_if<Draw>(&scene_.commands[i]);
      if (draw == nullptr) continue;
      const auto command = static_cast<std::uint32_t>(i);
      const State& state = scene_.states[draw->state];
      if (draw->topology == Topology::points)
        for_each_point(scene_, *draw, [&](std::uint32_t a) {
          const double size = std::ldexp(state.point_size, widths_.grid_bits);
          point(state, {primitive++, command, snapped(a), static_cast<std::int32_t>(snap(size, 1))});
        });
      else
        for_each_line(scene_, *draw, [&](std::uint32_t a, std::uint32_t b) {
          line(state, {primitive++, command, snapped(a), snapped(b), false});
        });
    }
    if (hooks_.damage) hooks_.damage(result_);
    return std::move(result_);
  }

 private:
  [[nodiscard]] SnappedVertex snapped(std::uint32_t index) const {
    const Vertex& v = scene_.vertices[index];
    return snap_vertex({v.x, v.y, v.z}, v.rgba, config_, {scene_.name, 0, index});
  }

  [[nodiscard]] PixelBounds bounds(const State& state) const {
    const Rect rect = raster_rect(state, scene_.width, scene_.height);
    return {rect.x, rect.y, rect.x + rect.width - 1, rect.y + rect.height - 1};
  }

  void line(const State& state, DrawnLine line) {
    line.drops_last = state.line_rule == LineRule::diamond || !state.line_last.value_or(true);
    const auto setup =
        setup_line(line.start, line.end, state.line_rule, line.drops_last, bounds(state), config_, widths_);
    if (!setup) return;
    result_.lines.push_back(line);
    line_raster(*setup, widths_, [&](const LinePixel& pixel) { shade(line.primitive, state, pixel); });
  }

  void point(const State& state, const DrawnPoint& point) {
    const PixelBounds box = point_bounds(point.at, point.size, bounds(state), widths_.grid_bits);
    if (box.is_empty()) return;
    result_.points.push_back(point);
    for (int y = box.top; y <= box.bottom; ++y)
      for (int x = box.left; x <= box.right; ++x)
        shade(point.primitive, state, {x, y, 0, point.at.z, packet_color(point.at.rgba, widths_)});
  }

  void shade(std::uint32_t primitive, const State& state, LinePixel pixel) {
    if (hooks_.code) hooks_.code(pixel);
    if (hooks_.pixel && !hooks_.pixel(primitive, pixel.x, pixel.y)) return;
    options_.pixel_tap(primitive, pixel.x, pixel.y);
    const auto p = static_cast<std::size_t>(pixel.y * scene_.width + pixel.x);
    const std::size_t stored = result_.frame.at(pixel.x, pixel.y);
    ++result_.counters.covered;
    ++result_.count[p];
    if (!state.depth_write && !state.color_write) return;
    if (state.depth_write) result_.frame.depth[stored] = pixel.depth;
    std::array<std::uint8_t, 4> code;
    for (std::size_t c = 0; c < 4; ++c) code[c] = static_cast<std::uint8_t>(pixel.color >> 8 * c);
    if (state.color_write) result_.frame.color[stored] = pack_color(config_.color_format, code);
    result_.ids[p] = static_cast<std::int32_t>(primitive);
    result_.visible[p] = -2;
  }

  const Scene& scene_;
  const Config& config_;
  const Widths widths_;
  const RenderOptions& options_;
  const Hooks& hooks_;
  Rendering result_;
};

Comparison compare_lines(const Scene& scene, const Config& config, const Hooks& hooks = {}) {
  CompareOptions options;
  options.engine = [&hooks](const Scene& s, const Config& c, const RenderOptions& o) {
    return StageEngine(s, c, o, hooks).run();
  };
  return compare(scene, config, options);
}

/// Lines, strips, loops and points at random. `grid`: coordinates per pixel; 0: anywhere.
Scene random_scene(std::uint32_t seed, int grid) {
  Random random(seed);
  Scene scene = SceneBuilder(kWidth, kHeight).scene;
  for (int d = 0; d < 6; ++d) {
    State state = SceneBuilder::window_state();
    state.line_rule = static_cast<LineRule>(random.index(3));
    if (random.index(2) == 0) state.line_last = random.index(2) == 0;
    state.point_size = grid == 0 ? random.between(1, 7) : 1 + random.index(5 * grid) / static_cast<double>(grid);
    state.depth_write = random.index(4) != 0;
    state.color_write = random.index(4) != 0;
    if (random.index(3) == 0) state.scissor = Rect{random.index(20), random.index(20), 1 + random.index(25), 17};
    scene.states.push_back(state);
    const std::size_t first = scene.indices.size();
    for (int i = 3 + random.index(5); i > 0; --i) {
      scene.indices.push_back(static_cast<std::uint32_t>(scene.vertices.size()));
      const auto coordinate = [&] {
        const double v = random.between(-8, kWidth + 8);
        return grid == 0 ? v : std::floor(v * grid) / grid;
      };
      const double x = coordinate(), y = coordinate(), z = random.index(65536) / 65535.0;
      const auto channel = [&] { return static_cast<double>(random.index(256)); };
      scene.vertices.push_back(at(x, y, z, {channel(), channel(), channel(), channel()}));
      if (random.index(8) == 0) scene.indices.push_back(kRestart);
    }
    scene.commands.push_back(Draw{static_cast<std::uint32_t>(scene.states.size() - 1), 0,
                                  static_cast<Topology>(3 + random.index(4)), first, scene.indices.size() - first, 0});
  }
  return scene;
}

TEST(CompareLines, VerticesOnTheGridDifferFromTheGoldenInNoPixelAndHoldEveryBound) {
  for (const auto name : {"embedded", "full"}) {
    const Config config = preset(name);
    std::uint64_t compared = 0;
    double worst = 0;
    for (std::uint32_t seed = 1; seed <= 60; ++seed) {
      SCOPED_TRACE(std::string(name) + ", seed " + std::to_string(seed));
      const Comparison c = compare_lines(random_scene(seed, 1 << config.subpixel_bits), config);
      EXPECT_EQ(c.coverage.missing + c.coverage.extra, 0u);
      EXPECT_EQ(c.other_visible, 0u);
      EXPECT_EQ(c.oracle.mismatches, 0u);
      EXPECT_EQ(c.stage_mismatches, 0u);
      EXPECT_TRUE(broken_bounds(c, config).empty()) << broken_bounds(c, config).front();
      if (config.depth_bits == 16) {  // then z lies on the grid too; that of the parts is 2^-20
        EXPECT_LE(c.parts.snap.max, 2e-6);
      }
      EXPECT_GT(c.oracle.samples, c.compared_pixels);
      compared += c.compared_pixels;
      worst = std::max(worst, c.line_datapath.max);
    }
    EXPECT_GT(compared, 10000u);
    EXPECT_GT(worst, 0.4);
    RecordProperty(std::string(name) + "_depth", std::to_string(worst));
  }
}

TEST(CompareLines, VerticesAnywhereDifferOnlyWhereTheSnapMayDecide) {
  for (const int subpixel_bits : {0, 2, 4, 8}) {
    Config config = preset("full");
    config.subpixel_bits = subpixel_bits;
    std::uint64_t differences = 0, covered = 0, near = 0;
    for (std::uint32_t seed = 1; seed <= 150; ++seed) {
      SCOPED_TRACE("S = " + std::to_string(subpixel_bits) + ", seed " + std::to_string(seed));
      const Comparison c = compare_lines(random_scene(seed, 0), config);
      EXPECT_EQ(c.coverage.near_edge, c.coverage.missing + c.coverage.extra);
      EXPECT_TRUE(broken_bounds(c, config).empty()) << broken_bounds(c, config).front();
      differences += c.coverage.missing + c.coverage.extra;
      near += c.coverage.near_edge;
      covered += c.rendering.counters.covered;
    }
    EXPECT_GT(differences, 0u);
    RecordProperty("S" + std::to_string(subpixel_bits),
                   std::to_string(differences) + " of " + std::to_string(covered) + ", near " + std::to_string(near));
    if (subpixel_bits == 8) {
      EXPECT_LT(differences, covered / 100);
    }
  }
}

/// A line and a point, far apart, on the grid.
Scene line_and_point(LineRule rule) {
  State state = SceneBuilder::window_state();
  state.line_rule = rule;
  state.point_size = 3;
  SceneBuilder builder(kWidth, kHeight, state);
  Scene& scene = builder.scene;
  scene.vertices = {at(3.25, 4.5, 0.1), at(40.5, 19.75, 0.8), at(10.5, 30.5, 0.5)};
  scene.indices = {0, 1, 2};
  scene.commands.push_back(Draw{0, 0, Topology::lines, 0, 2, 0});
  scene.commands.push_back(Draw{0, 0, Topology::points, 2, 1, 0});
  return scene;
}

TEST(CompareLinesMustFail, LineOnePixelLowerIsSeenByTheOracleAndIsNotExplainedByTheSnap) {
  for (const auto rule : {LineRule::midpoint, LineRule::diamond}) {
    Hooks hooks;
    hooks.pixel = [](std::uint32_t primitive, int&, int& y) {
      y += primitive == 0 ? 1 : 0;
      return true;
    };
    const Comparison c = compare_lines(line_and_point(rule), preset("embedded"), hooks);
    EXPECT_GT(c.oracle.mismatches, 60u);
    EXPECT_GT(c.coverage.missing, 30u);
    EXPECT_EQ(c.coverage.missing, c.coverage.extra);
    EXPECT_LT(c.coverage.near_edge, c.coverage.missing / 2);
    EXPECT_FALSE(broken_bounds(c, preset("embedded")).empty());
  }
}

TEST(CompareLinesMustFail, OnePixelTooFewOrDrawnTwiceIsReportedWithItsPlace) {
  Hooks hooks;
  hooks.pixel = [](std::uint32_t, int& x, int&) { return x != 20; };
  const Comparison dropped = compare_lines(line_and_point(LineRule::bresenham), preset("embedded"), hooks);
  EXPECT_EQ(dropped.oracle.mismatches, 1u);
  ASSERT_TRUE(dropped.oracle.first);
  EXPECT_EQ(dropped.oracle.first->x, 20);
  EXPECT_TRUE(dropped.oracle.first->oracle_covers);
  EXPECT_EQ(dropped.coverage.missing, 1u);
  EXPECT_EQ(dropped.coverage.near_edge, 0u);

  hooks.pixel = [last_y = 0](std::uint32_t, int& x, int& y) mutable {
    if (x == 20) x = 19, y = last_y;
    last_y = y;
    return true;
  };
  const Comparison twice = compare_lines(line_and_point(LineRule::bresenham), preset("embedded"), hooks);
  EXPECT_EQ(twice.oracle.mismatches, 2u);
}

TEST(CompareLinesMustFail, PointShiftedByAPixelIsReported) {
  Hooks hooks;
  hooks.pixel = [](std::uint32_t primitive, int& x, int&) {
    x += primitive == 1 ? 1 : 0;
    return true;
  };
  const Comparison c = compare_lines(line_and_point(LineRule::diamond), preset("embedded"), hooks);
  EXPECT_EQ(c.oracle.mismatches, 6u);
  EXPECT_EQ(c.coverage.missing, 3u);
  EXPECT_EQ(c.coverage.extra, 3u);
}

TEST(CompareLinesMustFail, WrongDepthOrColorCodeIsReported) {
  const Config config = preset("embedded");
  Hooks hooks;
  hooks.code = [](LinePixel& pixel) { pixel.depth += pixel.x == 20 ? 2 : 0; };
  const Comparison depth = compare_lines(line_and_point(LineRule::diamond), config, hooks);
  EXPECT_EQ(depth.stage_mismatches, 1u);
  EXPECT_GT(depth.line_datapath.max, 1.3);
  EXPECT_EQ(broken_bounds(depth, config).size(), 2u);
  hooks.code = [](LinePixel& pixel) { pixel.color ^= pixel.x == 20 ? 0x40 : 0; };
  const Comparison color = compare_lines(line_and_point(LineRule::diamond), config, hooks);
  EXPECT_EQ(color.stage_mismatches, 1u);
  EXPECT_GT(color.color_datapath.max, 5);
}

TEST(CompareLinesMustFail, PixelOwnedByALineThatDoesNotCoverItIsReported) {
  Hooks hooks;
  hooks.damage = [](Rendering& r) {
    r.visible[5] = -2;
    r.ids[5] = 0;
  };
  EXPECT_EQ(compare_lines(line_and_point(LineRule::diamond), preset("embedded"), hooks).stage_mismatches, 1u);
}

}  // namespace
}  // namespace halfplane
