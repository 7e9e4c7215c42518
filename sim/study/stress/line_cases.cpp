// Lines and points: every pixel against the exact oracle, depth and colour against the exact quotients.
#include <algorithm>

#include "sim/study/compare/coverage.hpp"
#include "sim/study/stress/cases.hpp"
#include "sim/study/stress/grid.hpp"
#include "sim/study/stress/line_check.hpp"
#include "sim/study/stress/shapes.hpp"

namespace halfplane::stress {
namespace {

constexpr std::array<LineRule, 3> kRules{LineRule::midpoint, LineRule::bresenham, LineRule::diamond};

/// The line as a capture that draws it again, if a part of it is in a target.
Scene line_scene(const exact::Line& line, const LineSpace& space) {
  State state = SceneBuilder::window_state();
  state.line_rule = line.rule;
  state.line_last = !line.drops_last;
  Scene scene =
      SceneBuilder(std::min(640, space.config.target_width), std::min(480, space.config.target_height), state).scene;
  for (const SnappedVertex& v : {line.start, line.end}) {
    Vertex vertex =
        at(std::ldexp(v.x, -line.grid_bits), std::ldexp(v.y, -line.grid_bits), depth_of(space.config, v.depth()));
    vertex.rgba = colors_of(v);
    scene.indices.push_back(static_cast<std::uint32_t>(scene.vertices.size()));
    scene.vertices.push_back(vertex);
  }
  scene.commands.emplace_back(Draw{0, 0, Topology::lines, 0, 2, 0});
  return scene;
}

/// Checks the whole line against the oracle. Returns its pixels.
std::vector<LinePixel> check_line(Unit& unit, const exact::Line& line, const LineSpace& space) {
  const auto pixels = pixels_of(line, space);
  const Positions drawn = positions(pixels), expected = oracle_positions_nearby(line);
  Positions wrong;
  std::set_symmetric_difference(drawn.begin(), drawn.end(), expected.begin(), expected.end(),
                                std::back_inserter(wrong));
  const Scene scene = line_scene(line, space);
  LineErrors errors;
  add_errors(errors, line, pixels, space);
  unit.count_triangles(1);
  // Five pixels per column are tested, two columns beyond each end; and each fragment.
  const std::int64_t columns =
      std::max(std::abs(std::int64_t{line.end.x} - line.start.x), std::abs(std::int64_t{line.end.y} - line.start.y)) >>
      line.grid_bits;
  unit.count_samples(static_cast<std::uint64_t>(5 * (columns + 5)) + pixels.size());
  unit.measure("coverage", "pixels", static_cast<double>(wrong.size()), 0, scene);
  unit.measure("line depth", "LSB", errors.depth, line_depth_error_bound(space.config), scene);
  unit.measure("color", "LSB", errors.color, 1, scene);
  return pixels;
}

exact::Line random_line(Unit& unit, const LineSpace& space, LineRule rule, double reach) {
  const SnappedVertex start = random_vertex(unit.random, space, reach), end = random_vertex(unit.random, space, reach);
  return {start, end, rule, rule == LineRule::diamond || unit.random.coin(), space.widths.grid_bits};
}

/// Common properties of a line and its reverse, and of the two books' rules.
void check_symmetry(Unit& unit, exact::Line line, const LineSpace& space) {
  if (line.rule == LineRule::diamond) return;
  line.drops_last = false;
  const Positions forth = positions(pixels_of(line, space));
  std::swap(line.start, line.end);
  unit.require(positions(pixels_of(line, space)) == forth, "reversal", line_scene(line, space),
               "a line and its reverse cover different pixels");
  line.rule = line.rule == LineRule::midpoint ? LineRule::bresenham : LineRule::midpoint;
  unit.require(positions(pixels_of(line, space)) == forth, "midpoint = bresenham", line_scene(line, space),
               "the two rules cover different pixels");
}

SnappedVertex in_octant(std::int32_t u, std::int32_t v, int octant) {
  if ((octant & 2) != 0) u = -u;
  if ((octant & 4) != 0) v = -v;
  return (octant & 1) != 0 ? snapped_vertex(v, u) : snapped_vertex(u, v);
}

}  // namespace

void lines_random(Unit& unit) {
  const LineSpace space(unit.config);
  for (const LineRule rule : kRules) {
    const int kind = unit.random.index(16);
    const double most = 400.0 / unit.config.guard_band;  // limits the pixels, to leave time for others
    const exact::Line line = random_line(unit, space, rule,
                                         std::min(1.0, kind == 0       ? most
                                                       : kind % 2 == 0 ? most / 8
                                                                       : most / 200));
    (void)check_line(unit, line, space);
    check_symmetry(unit, line, space);
  }
}

void lines_octants(Unit& unit) {
  // All octants, the axes, 45 degrees, slope 1/2 and its ties, between pixel centres, corners and diamond corners.
  const LineSpace space(unit.config);
  Random& random = unit.random;
  const int s = space.widths.grid_bits, pixel = 1 << s, half = pixel / 2;
  const int length = 1 + random.index(std::min(24, unit.config.guard_band / 4));
  const int kind = random.index(5);
  const int du = kind == 3 ? 2 * (length / 2 + 1) : length, dv = kind == 0   ? 0
                                                                 : kind == 1 ? du
                                                                 : kind == 3 ? du / 2
                                                                             : random.index(du + 1);
  const int from_u = random.index(3) * half, from_v = random.index(3) * half;
  for (int octant = 0; octant < 8; ++octant)
    for (const LineRule rule : kRules) {
      exact::Line line{in_octant(from_u, from_v, octant), in_octant(from_u + du * pixel, from_v + dv * pixel, octant),
                       rule, rule == LineRule::diamond || random.coin(), s};
      if (kind == 4) line.end = line.start;  // no length
      line.start.depth() = random_depth(unit);
      line.end.depth() = random_depth(unit);
      (void)check_line(unit, line, space);
      check_symmetry(unit, line, space);
    }
}

void lines_long(Unit& unit) {
  // 16384 pixels at the slopes of the list.
  Config config = unit.config;
  config.guard_band = 16384;
  if (!is_legal(config)) return;
  const LineSpace space(config);
  Random& random = unit.random;
  constexpr std::array<std::array<int, 2>, 5> kSlopes{
      {{16383, 1}, {16384, 8191}, {16383, 0}, {16383, 16383}, {16384, 8192}}};
  const auto [du, dv] = kSlopes[static_cast<std::size_t>(random.index(5))];
  const int s = space.widths.grid_bits, half = 1 << (s - 1), octant = random.index(8);
  const int shift = unit.config.subpixel_bits == 0 ? 0 : random.index(2) * (1 + random.index(half));
  const LineRule rule = kRules[static_cast<std::size_t>(random.index(3))];
  exact::Line line{in_octant((-8192 << s) + half + shift, (-8192 << s) + half, octant),
                   in_octant(((du - 8192) << s) + half + shift, ((dv - 8192) << s) + half, octant), rule,
                   rule == LineRule::diamond || random.coin(), s};
  line.start.depth() = random_depth(unit);
  line.end.depth() = random_depth(unit);
  (void)check_line(unit, line, space);
  check_symmetry(unit, line, space);
}

void polylines(Unit& unit) {
  // Diamond exit, in one octant: no pixel twice, no column skipped.
  const LineSpace space(unit.config);
  Random& random = unit.random;
  const int octant = random.index(8), pixel = 1 << space.widths.grid_bits,
            step = unit.config.subpixel_bits == 0 ? 2 : 1;
  const std::int32_t limit = static_cast<std::int32_t>(space.widths.coordinate.range.hi);
  std::int32_t u = -random.index(8 * pixel) / step * step, v = -random.index(8 * pixel) / step * step;
  Positions all;
  SnappedVertex from = in_octant(u, v, octant);
  exact::Line last{};
  for (int n = 0; n < 12; ++n) {
    const std::int32_t du = (1 + random.index(5 * pixel)) / step * step, dv = random.index(du + 1) / step * step;
    if (u + du > limit) break;
    u += du;
    v += dv;
    const SnappedVertex to = in_octant(u, v, octant);
    last = {from, to, LineRule::diamond, true, space.widths.grid_bits};
    for (const LinePixel& p : check_line(unit, last, space)) all.emplace_back(p.x, p.y);
    from = to;
  }
  if (all.empty()) return;
  std::sort(all.begin(), all.end());
  unit.require(std::adjacent_find(all.begin(), all.end()) == all.end(), "once", line_scene(last, space),
               "a polyline covers a pixel twice");
  std::vector<int> columns;
  for (const auto& [x, y] : all) columns.push_back((octant & 1) != 0 ? y : x);
  std::sort(columns.begin(), columns.end());
  bool has_gap = false;
  for (std::size_t i = 1; i < columns.size(); ++i) has_gap |= columns[i] != columns[i - 1] + 1;
  unit.require(!has_gap, "no gap", line_scene(last, space), "a polyline leaves a column out, or has two pixels in one");
}

void wires(Unit& unit) {
  // Lines, points and outlines through a whole engine, with scissor: every pixel against the oracle.
  Random& random = unit.random;
  const int width = unit.width(40), height = unit.height(40);
  State state = SceneBuilder::window_state();
  state.line_rule = kRules[static_cast<std::size_t>(random.index(3))];
  state.polygon_mode = random.coin() ? PolygonMode::line : PolygonMode::point;
  state.point_size = random.coin() ? 1 : random.between(1, 5);
  state.line_width = random.coin() ? 1 : 1 + random.index(4);
  state.point_shape = random.coin() ? PointShape::square : PointShape::round;
  if (random.coin()) state.scissor = Rect{random.index(8), random.index(8), 1 + random.index(30), 21};
  SceneBuilder builder(width, height, state);
  for (int n = 0; n < 5; ++n) {
    const auto point = [&] { return random_vertex_at(unit, random_point(unit, width, height, 6)); };
    const Vertex a = point(), b = point(), c = point();
    builder.triangle(a, b, c);
  }
  PixelLog log;
  RenderOptions options = render_options();
  options.pixel_tap = [&log](std::uint32_t primitive, int x, int y) { log.add(primitive, x, y); };
  const Rendering rendering = unit.engine(builder.scene, unit.config, options);
  expect_same_image(unit, builder.scene, rendering, unit.engine(builder.scene, unit.config, {}));
  log.sort();
  OracleResult oracle;
  check_line_coverage(builder.scene, unit.config, rendering, log, oracle);
  unit.count_triangles(5);
  unit.count_samples(oracle.samples);
  unit.measure("coverage", "pixels", static_cast<double>(oracle.mismatches), 0, builder.scene);
}

}  // namespace halfplane::stress
