// Golden lines and points: coverage straight from each rule's definition, depth and colour along the line, for ends
// that are not snapped. Each pixel is tested independently of its neighbours.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "interpolate.hpp"
#include "viewport.hpp"

namespace halfplane::golden {

/// A line on the screen.
template <class Real>
struct Line {
  ScreenVertex<Real> start, end;
  LineRule rule = LineRule::diamond;
  bool drops_last = true;
};

/// Diamond exit never draws the last pixel; the other rules do unless told otherwise.
[[nodiscard]] inline bool drops_last_pixel(const State& state) {
  return state.line_rule == LineRule::diamond || !state.line_last.value_or(true);
}

/// Whether a midpoint or Bresenham line from pixel (x0, y0) to pixel (x1, y1) covers pixel (x, y). All are whole
/// numbers. Seen from left to right, the centre's distance from the line across the major axis is in [-1/2, 1/2),
/// including the border on the left end's side. Exact below 2^25 pixels.
[[nodiscard]] inline bool connects(double x0, double y0, double x1, double y1, bool drops_last, double x, double y) {
  if (drops_last && x == x1 && y == y1) return false;
  if (x < std::min(x0, x1) || x > std::max(x0, x1) || y < std::min(y0, y1) || y > std::max(y0, y1)) return false;
  if (x1 < x0) {
    std::swap(x0, x1);
    std::swap(y0, y1);
  }
  const double run = x1 - x0, rise = y1 - y0, length = std::max(run, std::abs(rise));
  // Twice the distance, times the length; positive: below an x-major line, right of a y-major one.
  const double below = 2 * ((y - y0) * run - (x - x0) * rise);
  if (run < std::abs(rise)) {
    const double right = rise > 0 ? -below : below;
    return -length <= right && right < length;
  }
  if (run == 0) return true;  // a single pixel
  return rise >= 0 ? -length <= below && below < length : -length < below && below <= length;
}

/// Diamond exit: whether the segment, moved by (-e, -e^2) for every small enough e > 0, meets the open diamond |x -
/// x_c| + |y - y_c| < 1/2 of the pixel, and does not end in it. On the axes x + y and x - y the diamond is a square and
/// a moved point lies inside it when it was in (-1/2, 1/2]. Segment and square meet unless one of three axes separates
/// them: the square's own two, and the axis across the segment.
template <class Real>
[[nodiscard]] bool leaves_diamond(Real x0, Real y0, Real x1, Real y1, int x, int y) {
  const Real cx = static_cast<Real>(x) + Real(0.5), cy = static_cast<Real>(y) + Real(0.5), half = Real(0.5);
  x0 -= cx, x1 -= cx, y0 -= cy, y1 -= cy;
  const auto inside = [half](Real v) { return v > -half && v <= half; };
  if (inside(x1 + y1) && inside(x1 - y1)) return false;
  const auto separates = [half](Real a, Real b) { return std::max(a, b) <= -half || std::min(a, b) > half; };
  if (separates(x0 + y0, x1 + y1) || separates(x0 - y0, x1 - y1)) return false;
  const Real dx = x1 - x0, dy = y1 - y0;
  if (dx == 0 && dy == 0) return false;
  const std::array<std::array<Real, 2>, 4> corners{{{half, 0}, {-half, 0}, {0, half}, {0, -half}}};
  bool has_left = false, has_right = false;
  for (const auto& [u, v] : corners) {
    // The side of the moved segment on which the corner lies: moving it by -e across counts first, then -e^2.
    const Real side = dx * (v - y0) - dy * (u - x0), moved = dy != 0 ? -dy : dx;
    has_left |= side != 0 ? side < 0 : moved < 0;
    has_right |= side != 0 ? side > 0 : moved > 0;
  }
  return has_left && has_right;
}

template <class Real>
[[nodiscard]] bool covers(const Line<Real>& line, int x, int y) {
  if (line.rule == LineRule::diamond) return leaves_diamond(line.start.x, line.start.y, line.end.x, line.end.y, x, y);
  return connects(std::floor(line.start.x), std::floor(line.start.y), std::floor(line.end.x), std::floor(line.end.y),
                  line.drops_last, x, y);
}

/// The ends for coverage and attributes: all rules but diamond exit move them to the centres of their pixels.
template <class Real>
struct Track {
  Real x0 = 0, y0 = 0, x1 = 0, y1 = 0;

  explicit Track(const Line<Real>& line) : x0(line.start.x), y0(line.start.y), x1(line.end.x), y1(line.end.y) {
    if (line.rule == LineRule::diamond) return;
    for (Real* v : {&x0, &y0, &x1, &y1}) *v = std::floor(*v) + Real(0.5);
  }
  [[nodiscard]] bool is_x_major() const { return std::abs(x1 - x0) >= std::abs(y1 - y0); }
  /// Parameter of the line, 0 at the start, 1 at the end, at the pixel's coordinate on the major axis; clamped. 0 for a
  /// line without length.
  [[nodiscard]] Real parameter(int x, int y) const {
    const Real from = is_x_major() ? x0 : y0, length = is_x_major() ? x1 - x0 : y1 - y0;
    const Real at = static_cast<Real>(is_x_major() ? x : y) + Real(0.5);
    return length == 0 ? Real(0) : std::clamp((at - from) / length, Real(0), Real(1));
  }
};

/// Number of strands of a line of `width` pixels: rounded, at least 1.
[[nodiscard]] inline int strands_of(double width) { return std::max(1, static_cast<int>(std::floor(width + 0.5))); }

/// The line moved along one axis to strand i of `count`: by i - (count - 1)/2 pixels, by whole pixels if the rule
/// rounds its ends.
template <class Real>
[[nodiscard]] Line<Real> strand_along(Line<Real> line, Real ScreenVertex<Real>::*axis, int i, int count) {
  const int whole = i - (count - 1) / 2;
  const double across = line.rule == LineRule::diamond ? i - (count - 1) / 2.0 : whole;
  line.start.*axis += static_cast<Real>(across);
  line.end.*axis += static_cast<Real>(across);
  return line;
}

/// Strand i of `count`: along the minor axis.
template <class Real>
[[nodiscard]] Line<Real> strand(const Line<Real>& line, int i, int count) {
  const bool is_x_major = Track<Real>(line).is_x_major();
  return strand_along(line, is_x_major ? &ScreenVertex<Real>::y : &ScreenVertex<Real>::x, i, count);
}

/// A line as a rectangle: two corners of the start and two of the end, in order around it, each half of `width` pixels
/// across the line from its end. None for a line without length.
template <class Real>
[[nodiscard]] std::optional<std::array<ScreenVertex<Real>, 4>> rectangle_about(const ScreenVertex<Real>& start,
                                                                               const ScreenVertex<Real>& end,
                                                                               double width) {
  const Real dx = end.x - start.x, dy = end.y - start.y, length = std::hypot(dx, dy);
  if (!(length > 0)) return std::nullopt;
  const auto corner = [&, half = static_cast<Real>(width / 2)](ScreenVertex<Real> v, Real side) {
    v.x -= side * half * dy / length;
    v.y += side * half * dx / length;
    return v;
  };
  return std::array{corner(start, 1), corner(start, -1), corner(end, -1), corner(end, 1)};
}

/// The area of a rectangle in pixel (x, y), 0 to 1: of its part between the pixel's four sides. Corners are in order.
template <class Real>
[[nodiscard]] double area_in_pixel(const std::array<ScreenVertex<Real>, 4>& corners, int x, int y) {
  struct Point {
    double x, y;
  };
  std::vector<Point> polygon;
  for (const auto& v : corners) polygon.push_back({static_cast<double>(v.x) - x, static_cast<double>(v.y) - y});
  const auto keep = [&polygon](auto&& inside) {  // by the distance from a side
    std::vector<Point> kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Point &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
      const double from = inside(a), to = inside(b);
      if (from >= 0) kept.push_back(a);
      if ((from >= 0) != (to >= 0))
        kept.push_back({a.x + (b.x - a.x) * from / (from - to), a.y + (b.y - a.y) * from / (from - to)});
    }
    polygon = std::move(kept);
  };
  keep([](const Point& p) { return p.x; });
  keep([](const Point& p) { return 1 - p.x; });
  keep([](const Point& p) { return p.y; });
  keep([](const Point& p) { return 1 - p.y; });
  double doubled = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    doubled += a.x * b.y - b.x * a.y;
  }
  return std::min(1.0, std::abs(doubled) / 2);
}

/// The attributes of a line at a nearby pixel: at the point of the segment nearest to the pixel's centre.
template <class Real>
[[nodiscard]] Fragment<Real> beside(const ScreenVertex<Real>& a, const ScreenVertex<Real>& b, int x, int y) {
  const Real dx = b.x - a.x, dy = b.y - a.y, px = static_cast<Real>(x) + Real(0.5),
             py = static_cast<Real>(y) + Real(0.5);
  const Real t = std::clamp(((px - a.x) * dx + (py - a.y) * dy) / (dx * dx + dy * dy), Real(0), Real(1));
  Fragment<Real> f;
  f.z = a.z + t * (b.z - a.z);
  for (std::size_t c = 0; c < 4; ++c) f.rgba[c] = a.rgba[c] + t * (b.rgba[c] - a.rgba[c]);
  return f;
}

/// Calls visit(x, y) for the pixels of `range` that lie within `margin` pixels of the line along both axes: one column
/// of 2 * margin + 1 candidates per pixel of the major axis. 1 is enough for coverage: a covered pixel contains, or
/// touches, the point where the line crosses its column or ends in it.
template <class Real, class Visit>
void for_each_candidate(const Line<Real>& line, const PixelRange& range, int margin, Visit&& visit) {
  const Track<Real> track(line);
  const bool x_major = track.is_x_major();
  const double a0 = x_major ? track.x0 : track.y0, a1 = x_major ? track.x1 : track.y1;
  const double b0 = x_major ? track.y0 : track.x0, b1 = x_major ? track.y1 : track.x1;
  if (!std::isfinite(a0) || !std::isfinite(a1) || !std::isfinite(b0) || !std::isfinite(b1)) return;
  const auto pixel = [](double v) { return static_cast<int>(std::floor(std::clamp(v, -1e9, 1e9))); };
  const int low = x_major ? range.begin_x : range.begin_y, high = x_major ? range.end_x : range.end_y;
  const int minor_low = x_major ? range.begin_y : range.begin_x, minor_high = x_major ? range.end_y : range.end_x;
  const int end = std::min(high, pixel(std::max(a0, a1)) + margin + 1);
  for (int i = std::max(low, pixel(std::min(a0, a1)) - margin); i < end; ++i) {
    const double t = x_major ? track.parameter(i, 0) : track.parameter(0, i);
    const int row = pixel(b0 + t * (b1 - b0));
    for (int j = std::max(minor_low, row - margin); j < std::min(minor_high, row + margin + 1); ++j)
      visit(x_major ? i : j, x_major ? j : i);
  }
}

/// The attributes at a pixel of the line, by its coordinate on the major axis.
template <class Real>
[[nodiscard]] Fragment<Real> interpolate(const Line<Real>& line, int x, int y, InterpolationRules rules) {
  const Real t = Track<Real>(line).parameter(x, y);
  const ScreenVertex<Real>&a = line.start, &b = line.end;
  const auto blend = [](Real from, Real to, Real part) { return part == 1 ? to : from + part * (to - from); };
  const bool has_w = rules.color == ColorInterp::perspective && a.inverse_w > 0 && b.inverse_w > 0;
  const Real part = has_w ? t * b.inverse_w / blend(a.inverse_w, b.inverse_w, t) : t;
  Fragment<Real> f;
  f.z = blend(a.z, b.z, t);
  for (std::size_t c = 0; c < 4; ++c) f.rgba[c] = blend(a.rgba[c], b.rgba[c], part);
  return f;
}

/// The pixels of a square point of that size, inside the target: centres in [x - size/2, x + size/2), likewise y.
template <class Real>
[[nodiscard]] PixelRange point_range(const ScreenVertex<Real>& at, double size, const Scene& scene) {
  const double x = at.x, y = at.y, half = size / 2;
  if (!std::isfinite(x) || !std::isfinite(y)) return {};
  return pixel_range(x - half, y - half, x + half, y + half, scene);
}

/// The area of a disc of that radius about the origin in [x0, x1] x [y0, y1]: its part above y0 and below y1,
/// integrated between the crossings of their borders.
[[nodiscard]] inline double disc_in_box(double radius, double x0, double x1, double y0, double y1) {
  x0 = std::clamp(x0, -radius, radius);
  x1 = std::clamp(x1, -radius, radius);
  const auto half = [radius](double v) { return std::sqrt(std::max(0.0, radius * radius - v * v)); };
  const auto integral = [&](double x) {
    return (x * half(x) + radius * radius * std::asin(std::clamp(x / radius, -1.0, 1.0))) / 2;
  };
  std::vector<double> borders{x0, x1};
  for (const double y : {y0, y1})
    for (const double x : {-half(y), half(y)}) borders.push_back(std::clamp(x, x0, x1));
  std::sort(borders.begin(), borders.end());
  double area = 0;
  for (std::size_t i = 0; i + 1 < borders.size(); ++i) {
    const double a = borders[i], b = borders[i + 1], s = half((a + b) / 2), of_disc = integral(b) - integral(a);
    if (std::min(y1, s) <= std::max(y0, -s)) continue;
    area += (y1 < s ? y1 * (b - a) : of_disc) - (y0 > -s ? y0 * (b - a) : -of_disc);
  }
  return std::clamp(area, 0.0, 1.0);
}

/// The area of a point in pixel (x, y), 0 to 1.
template <class Real>
[[nodiscard]] double area_in_pixel(const ScreenVertex<Real>& at, const State& state, int x, int y) {
  const double left = x - static_cast<double>(at.x), top = y - static_cast<double>(at.y), r = state.point_size / 2;
  if (state.point_shape == PointShape::round) return disc_in_box(r, left, left + 1, top, top + 1);
  const auto shared = [r](double from) { return std::max(0.0, std::min(from + 1, r) - std::max(from, -r)); };
  return shared(left) * shared(top);
}

/// Whether the point covers a pixel of that square: a round point if its disc contains the centre.
template <class Real>
[[nodiscard]] bool point_covers(const ScreenVertex<Real>& at, const State& state, int x, int y) {
  const Real dx = static_cast<Real>(x) + Real(0.5) - at.x, dy = static_cast<Real>(y) + Real(0.5) - at.y;
  const Real radius = static_cast<Real>(state.point_size / 2);
  return state.point_shape == PointShape::square || dx * dx + dy * dy <= radius * radius;
}

}  // namespace halfplane::golden
