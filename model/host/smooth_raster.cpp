#include "smooth_raster.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace halfplane {
namespace {

/// Pixels.
struct Point {
  double x, y;
};

/// A line: inside where a x + b y + c >= 0, which is the distance from it.
struct Side {
  double a = 0, b = 0, c = 0;
  double reach = 0;  ///< the largest distance of a pixel's corner from the line through its centre
  [[nodiscard]] double distance(const Point& p) const { return a * p.x + b * p.y + c; }
};

/// A square cut by four lines has at most eight corners.
struct Polygon {
  std::array<Point, 8> corner;
  std::size_t size = 0;
  void add(const Point& p) {
    if (size < corner.size()) corner[size++] = p;
  }
};

constexpr std::array<Point, 4> kSquare{{{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}}};

/// Writes the part of a polygon inside a line to `kept`.
void cut(const Polygon& polygon, const Side& side, Polygon& kept) {
  kept.size = 0;
  if (polygon.size == 0) return;
  const double d_first = side.distance(polygon.corner[0]);
  double d_from = d_first;
  for (std::size_t i = 0; i < polygon.size; ++i) {
    const bool is_last = i + 1 == polygon.size;
    const Point &from = polygon.corner[i], &to = polygon.corner[is_last ? 0 : i + 1];
    const double d_to = is_last ? d_first : side.distance(to);
    if (d_from >= 0) kept.add(from);
    if ((d_from < 0) != (d_to < 0)) {
      const double t = d_from / (d_from - d_to);
      kept.add({from.x + t * (to.x - from.x), from.y + t * (to.y - from.y)});
    }
    d_from = d_to;
  }
}

double area_of(const Polygon& polygon) {
  double doubled = 0;
  for (std::size_t i = 0; i < polygon.size; ++i) {
    const Point &a = polygon.corner[i], &b = polygon.corner[i + 1 == polygon.size ? 0 : i + 1];
    doubled += a.x * b.y - b.x * a.y;
  }
  return std::abs(doubled) / 2;
}

using Sides = std::array<Side, 4>;

Sides sides_of(const std::array<SnappedVertex, 4>& corners, int grid_bits) {
  const double sign = signed_area(corners[0], corners[1], corners[2]) < 0 ? -1 : 1;
  Sides sides;
  for (std::size_t i = 0; i < 4; ++i) {
    const SnappedVertex &from = corners[i], &to = corners[(i + 1) % 4];
    const double dx = static_cast<double>(to.x) - from.x, dy = static_cast<double>(to.y) - from.y;
    const double length = std::sqrt(dx * dx + dy * dy);
    const double c = std::ldexp(dy * from.x - dx * from.y, -grid_bits);
    sides[i] = {-sign * dy / length, sign * dx / length, sign * c / length};
    sides[i].reach = (std::abs(sides[i].a) + std::abs(sides[i].b)) / 2;
  }
  return sides;
}

/// The part of a pixel inside one line, at `distance` from its centre and less than `reach`: all but a triangle or a trapezoid
/// where that is positive.
double part_inside(const Side& side, double distance) {
  const double a = std::abs(side.a), b = std::abs(side.b), flat = std::min(a, b);
  const double height = side.reach - std::abs(distance);  // of the smaller part, from the line to its corner
  const double smaller = height < flat ? height * height / (2 * a * b) : (height - flat / 2) / std::max(a, b);
  return distance < 0 ? smaller : 1 - smaller;
}

double area_at(const Sides& sides, int x, int y) {
  const Point centre{x + 0.5, y + 0.5};
  std::array<double, 4> distance{};
  std::array<bool, 4> cuts{};
  bool is_outside = false;
  for (std::size_t i = 0; i < 4; ++i) {
    distance[i] = sides[i].distance(centre);
    is_outside |= distance[i] <= -sides[i].reach;
    cuts[i] = distance[i] < sides[i].reach;
  }
  if (is_outside) return 0;
  // Sides opposite each other cut off parts that do not meet.
  for (const std::size_t i : {0U, 1U}) {
    if (cuts[1 - i] || cuts[3 - i]) continue;
    double area = 1;
    for (const std::size_t k : {i, i + 2})
      if (cuts[k]) area -= 1 - part_inside(sides[k], distance[k]);
    return std::max(area, 0.0);
  }
  std::array<Polygon, 2> polygon;  // by turns
  std::ranges::copy(kSquare, polygon[0].corner.begin());
  polygon[0].size = kSquare.size();
  std::size_t now = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    if (!cuts[i]) continue;
    cut(polygon[now], {sides[i].a, sides[i].b, distance[i]}, polygon[1 - now]);
    now = 1 - now;
  }
  return area_of(polygon[now]);
}

/// To the nearest, halves up; of a number that is not negative.
std::uint32_t rounded(double value) {
  const auto whole = static_cast<std::uint32_t>(value);
  return whole + (value - whole >= 0.5 ? 1 : 0);
}

/// The columns that may have an area in a row: outside, area_at() is 0. A column is spared on each side for rounding.
class Columns {
 public:
  explicit Columns(const Sides& sides) {
    constexpr double kFlat = 1e-4;  // sides that bound no column
    for (const Side& side : sides) {
      if (std::abs(side.a) < kFlat) continue;
      Bound& bound = bound_[count_++];
      bound = {-(side.reach + side.c + side.b / 2) / side.a - 0.5, -side.b / side.a, side.a > 0};
      bound.at_zero += bound.is_first ? -1 : 1;
    }
  }
  [[nodiscard]] std::array<int, 2> operator()(int y, int left, int right) const {
    double first = left, last = right;
    for (std::size_t i = 0; i < count_; ++i) {
      const double bound = bound_[i].at_zero + bound_[i].per_row * y;
      if (bound_[i].is_first)
        first = std::max(first, bound);
      else
        last = std::min(last, bound);
    }
    if (!(first <= last)) return {0, -1};
    return {static_cast<int>(first), static_cast<int>(last) + 1};
  }

 private:
  struct Bound {
    double at_zero = 0, per_row = 0;
    bool is_first = false;
  };
  std::array<Bound, 4> bound_{};
  std::size_t count_ = 0;
};

/// The pixels of a box with an area(x, y) that does not round to 0. columns(y): the first and the last that may have one.
template <class Columns, class Area>
std::vector<SmoothPixel> pixels_of(const PixelBounds& box, Columns&& columns, Area&& area) {
  std::vector<SmoothPixel> pixels;
  if (box.is_empty()) return pixels;
  pixels.reserve(4 * static_cast<std::size_t>(box.right - box.left + box.bottom - box.top + 2));
  for (int y = box.top; y <= box.bottom; ++y) {
    const auto [first, last] = columns(y);
    for (int x = std::max(first, box.left); x <= std::min(last, box.right); ++x) {
      const std::uint32_t coverage = rounded(area(x, y) * kWholePixel);
      if (coverage != 0) pixels.push_back({x, y, coverage});
    }
  }
  return pixels;
}

/// The length of the overlap of [from, to] with a pixel, [0, 1].
double shared(double from, double to) { return std::max(0.0, std::min(1.0, to) - std::max(0.0, from)); }

}  // namespace

double area_in_pixel(const std::array<SnappedVertex, 4>& corners, int x, int y, int grid_bits) {
  return area_at(sides_of(corners, grid_bits), x, y);
}

std::vector<SmoothPixel> smooth_raster(const std::array<SnappedVertex, 4>& corners, const PixelBounds& limit,
                                       int grid_bits) {
  const Sides sides = sides_of(corners, grid_bits);
  const auto [left, right] = std::minmax({corners[0].x, corners[1].x, corners[2].x, corners[3].x});
  const auto [top, bottom] = std::minmax({corners[0].y, corners[1].y, corners[2].y, corners[3].y});
  const PixelBounds box{std::max(limit.left, left >> grid_bits), std::max(limit.top, top >> grid_bits),
                        std::min(limit.right, right >> grid_bits), std::min(limit.bottom, bottom >> grid_bits)};
  return pixels_of(
      box, [&, columns = Columns(sides)](int y) { return columns(y, box.left, box.right); },
      [&](int x, int y) { return area_at(sides, x, y); });
}

double area_in_pixel(const SnappedVertex& point, std::int32_t size, PointShape shape, int x, int y, int grid_bits) {
  const double cx = std::ldexp(point.x, -grid_bits) - x, cy = std::ldexp(point.y, -grid_bits) - y;
  const double radius = std::ldexp(size, -grid_bits - 1);
  if (shape == PointShape::square) return shared(cx - radius, cx + radius) * shared(cy - radius, cy + radius);
  constexpr int kRows = 64;
  double sum = 0;
  for (int i = 0; i < kRows; ++i) {
    const double dy = (i + 0.5) / kRows - cy;
    if (std::abs(dy) >= radius) continue;
    const double half = std::sqrt(radius * radius - dy * dy);
    sum += shared(cx - half, cx + half);
  }
  return sum / kRows;
}

std::vector<SmoothPixel> smooth_raster(const SnappedVertex& point, std::int32_t size, PointShape shape,
                                       const PixelBounds& limit, int grid_bits) {
  const auto pixel = [grid_bits](std::int32_t at) { return at >> grid_bits; };
  const std::int32_t half = (size + 1) / 2;
  const PixelBounds box{std::max(limit.left, pixel(point.x - half)), std::max(limit.top, pixel(point.y - half)),
                        std::min(limit.right, pixel(point.x + half)), std::min(limit.bottom, pixel(point.y + half))};
  return pixels_of(
      box,
      [&box](int) {
        return std::array{box.left, box.right};
      },
      [&](int x, int y) { return area_in_pixel(point, size, shape, x, y, grid_bits); });
}

PerPlane<std::uint32_t> codes_beside(const SnappedVertex& start, const SnappedVertex& end, int x, int y,
                                     const Widths& widths) {
  const int s = widths.grid_bits;
  const auto centre = [s](int i) { return (2 * std::int64_t{i} + 1) * (std::int64_t{1} << (s - 1)); };
  const std::int64_t dx = std::int64_t{end.x} - start.x, dy = std::int64_t{end.y} - start.y;
  const std::int64_t whole = dx * dx + dy * dy;
  const std::int64_t part = std::clamp<std::int64_t>((centre(x) - start.x) * dx + (centre(y) - start.y) * dy, 0, whole);
  PerPlane<std::uint32_t> code{};
  for (std::size_t p = 0; p < static_cast<std::size_t>(widths.affine_planes); ++p) {
    const std::uint32_t largest = std::max(start.code[p], end.code[p]);
    if (start.code[p] == end.code[p]) {
      code[p] = largest;
      continue;
    }
    // Both are weights of non-negative codes: the division rounds down.
    if (std::bit_width(largest) + std::bit_width(static_cast<std::uint64_t>(whole)) <= 61) {
      const std::int64_t sum = std::int64_t{start.code[p]} * (whole - part) + std::int64_t{end.code[p]} * part;
      code[p] = static_cast<std::uint32_t>((2 * sum + whole) / (2 * whole));
      continue;
    }
    const int128 sum = int128{start.code[p]} * (whole - part) + int128{end.code[p]} * part;
    code[p] = static_cast<std::uint32_t>((2 * sum + whole) / (2 * int128{whole}));
  }
  return code;
}

}  // namespace halfplane
