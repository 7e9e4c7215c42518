#include "line_coverage.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "model/golden/exact_line.hpp"
#include "model/golden/line.hpp"
#include "model/widths.hpp"

namespace halfplane {
namespace {

using Pixel = PixelLog::Pixel;
using GoldenLine = golden::Line<double>;

/// The draw's state.
const State& state_of(const Scene& scene, std::uint32_t command) {
  return scene.states[std::get<Draw>(scene.commands[command]).state];
}

/// Every disagreement of two sorted lists counts, also a pixel that is drawn twice.
void compare_pixels(std::span<const Pixel> drawn, std::span<const Pixel> expected, OracleResult& result) {
  const auto report = [&result](const Pixel& pixel, bool oracle_covers) {
    ++result.mismatches;
    if (!result.first) result.first = CoverageMismatch{0, pixel.primitive, pixel.x, pixel.y, oracle_covers};
  };
  auto d = drawn.begin();
  auto e = expected.begin();
  while (d != drawn.end() || e != expected.end()) {
    if (e == expected.end() || (d != drawn.end() && *d < *e))
      report(*d++, false);
    else if (d == drawn.end() || *e < *d)
      report(*e++, true);
    else
      ++d, ++e;
  }
}

double distance_to_segment(double px, double py, const GoldenLine& line) {
  const double dx = line.end.x - line.start.x, dy = line.end.y - line.start.y, length2 = dx * dx + dy * dy;
  px -= line.start.x;
  py -= line.start.y;
  const double t = length2 > 0 ? std::clamp((px * dx + py * dy) / length2, 0.0, 1.0) : 0;
  return std::hypot(px - t * dx, py - t * dy);
}

/// Distance from a point to the border of the diamond around (cx, cy).
double distance_to_diamond(double px, double py, double cx, double cy) {
  // By symmetry the side from (1/2, 0) to (0, 1/2).
  GoldenLine side;
  side.start.x = side.end.y = 0.5;
  return distance_to_segment(std::abs(px - cx), std::abs(py - cy), side);
}

/// Coverage changes where the segment passes a corner of the diamond, or where an end crosses its border.
bool diamond_is_uncertain(const GoldenLine& line, int x, int y, double reach) {
  const double cx = x + 0.5, cy = y + 0.5;
  for (const auto& end : {line.start, line.end})
    if (distance_to_diamond(end.x, end.y, cx, cy) <= reach) return true;
  for (const auto& [u, v] : {std::array{0.5, 0.0}, std::array{-0.5, 0.0}, std::array{0.0, 0.5}, std::array{0.0, -0.5}})
    if (distance_to_segment(cx + u, cy + v, line) <= reach) return true;
  return false;
}

/// Coverage changes where an end moves to another pixel: whether pixels within reach of the ends give different
/// results.
bool rounded_is_uncertain(const GoldenLine& line, int x, int y, double reach) {
  const auto low = [reach](double v) { return std::floor(v - reach); };
  const auto high = [reach](double v) { return std::floor(v + reach); };
  const auto &a = line.start, &b = line.end;
  const bool now = covers(line, x, y);
  for (double x0 = low(a.x); x0 <= high(a.x); ++x0)
    for (double y0 = low(a.y); y0 <= high(a.y); ++y0)
      for (double x1 = low(b.x); x1 <= high(b.x); ++x1)
        for (double y1 = low(b.y); y1 <= high(b.y); ++y1)
          if (golden::connects(x0, y0, x1, y1, line.drops_last, x, y) != now) return true;
  return false;
}

/// Coverage changes where a border of the point passes the centre.
bool point_is_uncertain(double dx, double dy, const State& state, double reach) {
  const double distance =
      state.point_shape == PointShape::round ? std::hypot(dx, dy) : std::max(std::abs(dx), std::abs(dy));
  return std::abs(distance - state.point_size / 2) <= reach;
}

/// Whether a line within reach of this one may have the other major axis, and thus its strands on the other sides.
bool may_turn(const GoldenLine& line, double reach) {
  const double run = std::abs(line.end.x - line.start.x), rise = std::abs(line.end.y - line.start.y);
  // Each coordinate moves by that much, and by a pixel more if it is rounded.
  return std::abs(run - rise) <= 4 * (line.rule == LineRule::diamond ? reach : reach + 1);
}

/// The pixels of `region` that a line covers by definition. `tested` counts the tested pixels.
std::vector<Pixel> oracle_pixels(const DrawnLine& drawn, LineRule rule, const golden::PixelRange& region, int grid_bits,
                                 std::uint64_t& tested) {
  const exact::Line line{drawn.start, drawn.end, rule, drawn.drops_last, grid_bits};
  const auto real = [grid_bits](const SnappedVertex& v) {
    golden::ScreenVertex<double> at;
    at.x = std::ldexp(v.x, -grid_bits);
    at.y = std::ldexp(v.y, -grid_bits);
    return at;
  };
  std::vector<Pixel> pixels;
  // The walk only selects candidates: two pixels more to each side than a line can reach.
  golden::for_each_candidate(GoldenLine{real(drawn.start), real(drawn.end), rule, true}, region, 3, [&](int x, int y) {
    ++tested;
    if (exact::covers(line, x, y)) pixels.push_back({drawn.primitive, y, x});
  });
  return pixels;
}

/// Likewise for a point.
std::vector<Pixel> oracle_pixels(const DrawnPoint& point, const golden::PixelRange& region, int grid_bits,
                                 std::uint64_t& tested) {
  // In halves of a subpixel, so that the border of an odd size is an integer.
  const std::int64_t pixel = std::int64_t{2} << grid_bits, size = point.size;
  const std::int64_t x = std::int64_t{2} * point.at.x, y = std::int64_t{2} * point.at.y;
  const auto holds = [&](std::int64_t centre, std::int64_t at) { return at - size <= centre && centre < at + size; };
  const auto around = [&](std::int64_t border, int low, int high) {  // the pixel that contains it, inside the region
    return static_cast<int>(std::clamp<std::int64_t>(border >> (grid_bits + 1), low, high));
  };
  // Twice the distance from the centre, squared: below 2^63 as long as sizes are below 2^30.
  const auto disc_holds = [&](std::int64_t i, std::int64_t j) {
    const std::int64_t dx = i * pixel + pixel / 2 - x, dy = j * pixel + pixel / 2 - y;
    return point.shape == PointShape::square || dx * dx + dy * dy <= size * size;
  };
  std::vector<Pixel> pixels;
  for (int j = around(y - size - pixel, region.begin_y, region.end_y);
       j < around(y + size + 2 * pixel, region.begin_y, region.end_y); ++j)
    for (int i = around(x - size - pixel, region.begin_x, region.end_x);
         i < around(x + size + 2 * pixel, region.begin_x, region.end_x); ++i) {
      ++tested;
      if (holds(i * pixel + pixel / 2, x) && holds(j * pixel + pixel / 2, y) && disc_holds(i, j))
        pixels.push_back({point.primitive, j, i});
    }
  return pixels;
}

}  // namespace

void PixelLog::sort() { std::sort(pixels_.begin(), pixels_.end()); }

void check_line_coverage(const Scene& scene, const Config& config, const Rendering& rendering, const PixelLog& log,
                         OracleResult& result) {
  const int grid_bits = derive_widths(config).grid_bits;
  std::vector<Pixel> expected;
  const auto append = [&expected](const std::vector<Pixel>& pixels) {
    expected.insert(expected.end(), pixels.begin(), pixels.end());
  };
  for (const DrawnLine& line : rendering.lines) {
    const State& state = state_of(scene, line.draw);
    append(oracle_pixels(line, state.line_rule, golden::draw_region(scene, state), grid_bits, result.samples));
  }
  for (const DrawnPoint& point : rendering.points)
    append(oracle_pixels(point, golden::draw_region(scene, state_of(scene, point.draw)), grid_bits, result.samples));
  std::sort(expected.begin(), expected.end());
  compare_pixels(log.pixels(), expected, result);
}

void mark_uncertain(const golden::Outline& outline, const State& state, int subpixel_bits, const golden::Image& image,
                    const std::vector<bool>& wanted, std::vector<bool>& near) {
  // A smooth primitive covers pixels partially, up to half a diagonal from their centres.
  const double reach = std::ldexp(1.0, -subpixel_bits) + (state.smooth && image.samples.empty() ? std::sqrt(0.5) : 0);
  const golden::PixelRange target{0, 0, image.width, image.height};
  const auto index = [&image](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x);
  };
  if (outline.corners == 1) {
    const double half = state.point_size / 2, far = half + reach + 1;
    const auto pixel = [](double v, int limit) {
      return static_cast<int>(std::clamp<double>(std::floor(v), 0, limit));
    };
    for (int y = pixel(outline.y[0] - far, image.height); y < pixel(outline.y[0] + far + 1, image.height); ++y)
      for (int x = pixel(outline.x[0] - far, image.width); x < pixel(outline.x[0] + far + 1, image.width); ++x)
        if (wanted[index(x, y)] && point_is_uncertain(x + 0.5 - outline.x[0], y + 0.5 - outline.y[0], state, reach))
          near[index(x, y)] = true;
    return;
  }
  GoldenLine line;
  line.rule = state.line_rule;
  line.drops_last = golden::drops_last_pixel(state);
  line.start.x = outline.x[0];
  line.start.y = outline.y[0];
  line.end.x = outline.x[1];
  line.end.y = outline.y[1];
  // 3: an end moves by at most a pixel, and may move the line out of its column's three candidates by as much.
  const auto mark = [&](const GoldenLine& strand, auto&& is_uncertain) {
    golden::for_each_candidate(strand, target, 3, [&](int x, int y) {
      if (wanted[index(x, y)] && !near[index(x, y)] && is_uncertain(x, y)) near[index(x, y)] = true;
    });
  };
  const int count = golden::strands_of(state.line_width);
  for (int i = 0; i < count; ++i) {
    const GoldenLine strand = golden::strand(line, i, count);
    mark(strand, [&](int x, int y) {
      return strand.rule == LineRule::diamond ? diamond_is_uncertain(strand, x, y, reach)
                                              : rounded_is_uncertain(strand, x, y, reach);
    });
    if (count > 1 && may_turn(line, reach))
      for (const auto axis : {&golden::ScreenVertex<double>::x, &golden::ScreenVertex<double>::y})
        mark(golden::strand_along(line, axis, i, count), [](int, int) { return true; });
  }
}

}  // namespace halfplane
