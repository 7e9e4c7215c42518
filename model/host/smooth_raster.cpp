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

using Side = SmoothSide;
using Sides = SmoothSides;

double distance_from(const Side& side, const Point& p) { return side.a * p.x + side.b * p.y + side.c; }

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
  const double d_first = distance_from(side, polygon.corner[0]);
  double d_from = d_first;
  for (std::size_t i = 0; i < polygon.size; ++i) {
    const bool is_last = i + 1 == polygon.size;
    const Point &from = polygon.corner[i], &to = polygon.corner[is_last ? 0 : i + 1];
    const double d_to = is_last ? d_first : distance_from(side, to);
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

Sides sides_of(const std::array<SnappedVertex, 4>& corners, int grid_bits) {
  const double sign = signed_area(corners[0], corners[1], corners[2]) < 0 ? -1 : 1;
  Sides sides;
  for (std::size_t i = 0; i < 4; ++i) {
    const SnappedVertex &from = corners[i], &to = corners[(i + 1) % 4];
    const double dx = static_cast<double>(to.x) - from.x, dy = static_cast<double>(to.y) - from.y;
    const double length = std::sqrt(dx * dx + dy * dy);
    const double c = std::ldexp(dy * from.x - dx * from.y, -grid_bits);
    Side& side = sides[i];
    side.a = -sign * dy / length;
    side.b = sign * dx / length;
    side.c = sign * c / length;
    const double a = std::abs(side.a), b = std::abs(side.b);
    side.reach = (a + b) / 2;
    side.flat = std::min(a, b);
    side.steep = std::max(a, b);
    side.doubled_product = 2 * a * b;
  }
  return sides;
}

/// The part of a pixel inside one line, at `distance` from its centre and less than `reach`: all but a triangle or a trapezoid
/// where that is positive.
double part_inside(const Side& side, double distance) {
  const double height = side.reach - std::abs(distance);  // of the smaller part, from the line to its corner
  const double smaller =
      height < side.flat ? height * height / side.doubled_product : (height - side.flat / 2) / side.steep;
  return distance < 0 ? smaller : 1 - smaller;
}

/// The area of the pixels of a row.
class RowAreas {
 public:
  RowAreas(const Sides& sides, int y) : sides_(sides) { start(y); }
  void start(int y) {
    for (std::size_t i = 0; i < 4; ++i) of_row_[i] = sides_[i].b * (y + 0.5);
  }

  [[nodiscard]] double operator()(int x) const {
    std::array<double, 4> distance;
    unsigned cuts = 0;  // a bit each
    for (std::size_t i = 0; i < 4; ++i) {
      distance[i] = sides_[i].a * (x + 0.5) + of_row_[i] + sides_[i].c;
      if (distance[i] <= -sides_[i].reach) return 0;
      cuts |= (distance[i] < sides_[i].reach ? 1U : 0U) << i;
    }
    // Sides opposite each other cut off parts that do not meet.
    constexpr unsigned kFirstAndThird = 5;
    if ((cuts & kFirstAndThird) != 0 && (cuts & ~kFirstAndThird) != 0) return area_where_sides_meet(distance, cuts);
    double area = 1;
    for (std::size_t i = 0; i < 4; ++i)
      if ((cuts >> i & 1) != 0) area -= 1 - part_inside(sides_[i], distance[i]);
    return std::max(area, 0.0);
  }

 private:
  [[nodiscard]] double area_where_sides_meet(const std::array<double, 4>& distance, unsigned cuts) const {
    std::array<Polygon, 2> polygon;  // by turns
    std::ranges::copy(kSquare, polygon[0].corner.begin());
    polygon[0].size = kSquare.size();
    std::size_t now = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      if ((cuts >> i & 1) == 0) continue;
      Side side;
      side.a = sides_[i].a;
      side.b = sides_[i].b;
      side.c = distance[i];
      cut(polygon[now], side, polygon[1 - now]);
      now = 1 - now;
    }
    return area_of(polygon[now]);
  }

  const Sides& sides_;
  std::array<double, 4> of_row_{};
};

/// To the nearest, halves up; of a number that is not negative.
std::uint32_t rounded(double value) {
  const auto whole = static_cast<std::uint32_t>(value);
  return whole + (value - whole >= 0.5 ? 1 : 0);
}

/// The columns that may have an area in a row: outside, it is 0. A column is spared on each side for rounding.
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

/// The same for a parallelogram, its pixels in lanes.
std::vector<SmoothPixel> pixels_in_lanes(const Sides& sides, const PixelBounds& box, const Columns& columns,
                                         SmoothLanes lanes) {
  static thread_local std::vector<std::int32_t> at_x, at_y, coverage;
  std::size_t count = 0, drawn = 0;
  for (int y = box.top; y <= box.bottom; ++y) {
    const auto [from, to] = columns(y, box.left, box.right);
    const int first = std::max(from, box.left), last = std::min(to, box.right);
    if (first > last) continue;
    const auto length = static_cast<std::size_t>(last - first) + 1;
    constexpr std::size_t kSpare = 16;
    if (at_x.size() < count + length + kSpare)
      for (auto* const of_pixels : {&at_x, &at_y, &coverage}) of_pixels->resize(2 * (count + length + kSpare));
    for (std::size_t i = 0; i < length; ++i) at_x[count + i] = first + static_cast<int>(i);
    std::fill_n(at_y.begin() + static_cast<std::ptrdiff_t>(count), length, y);
    count += length;
  }
  std::vector<SmoothPixel> pixels(count);
  if (count != 0) lanes(sides, at_x.data(), at_y.data(), count, coverage.data());
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t part = coverage[i] >= 0 ? static_cast<std::uint32_t>(coverage[i])
                                                : rounded(RowAreas(sides, at_y[i])(at_x[i]) * kWholePixel);
    pixels[drawn] = {at_x[i], at_y[i], part};
    drawn += part != 0 ? 1 : 0;
  }
  pixels.resize(drawn);
  return pixels;
}

/// The length of the overlap of [from, to] with a pixel, [0, 1].
double shared(double from, double to) { return std::max(0.0, std::min(1.0, to) - std::max(0.0, from)); }

}  // namespace

double area_in_pixel(const std::array<SnappedVertex, 4>& corners, int x, int y, int grid_bits) {
  const Sides sides = sides_of(corners, grid_bits);
  return RowAreas(sides, y)(x);
}

std::vector<SmoothPixel> smooth_raster(const std::array<SnappedVertex, 4>& corners, const PixelBounds& limit,
                                       int grid_bits, SmoothLanes lanes) {
  const Sides sides = sides_of(corners, grid_bits);
  const auto [left, right] = std::minmax({corners[0].x, corners[1].x, corners[2].x, corners[3].x});
  const auto [top, bottom] = std::minmax({corners[0].y, corners[1].y, corners[2].y, corners[3].y});
  const PixelBounds box{std::max(limit.left, left >> grid_bits), std::max(limit.top, top >> grid_bits),
                        std::min(limit.right, right >> grid_bits), std::min(limit.bottom, bottom >> grid_bits)};
  const Columns columns(sides);
  if (lanes != nullptr) return pixels_in_lanes(sides, box, columns, lanes);
  RowAreas areas(sides, box.top);
  return pixels_of(
      box,
      [&](int y) {
        areas.start(y);
        return columns(y, box.left, box.right);
      },
      [&](int x, int) { return areas(x); });
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

CodesBeside::CodesBeside(const SnappedVertex& start, const SnappedVertex& end, const Widths& widths)
    : start_(start.code), end_(end.code) {
  const int s = widths.grid_bits;
  const std::int64_t half = std::int64_t{1} << (s - 1), dx = std::int64_t{end.x} - start.x,
                     dy = std::int64_t{end.y} - start.y;
  at_zero_ = (half - start.x) * dx + (half - start.y) * dy;
  per_x_ = dx * 2 * half;
  per_y_ = dy * 2 * half;
  whole_ = dx * dx + dy * dy;
  for (std::size_t p = 0; p < start_.size(); ++p) {
    if (p >= static_cast<std::size_t>(widths.affine_planes)) start_[p] = end_[p] = 0;
    if (start_[p] != end_[p]) changing_[changing_count_++] = p;
  }
  codes_ = start_;
}

const PerPlane<std::uint32_t>& CodesBeside::operator()(int x, int y) {
  if (changing_count_ == 0) return codes_;
  const std::int64_t part = std::clamp<std::int64_t>(at_zero_ + x * per_x_ + y * per_y_, 0, whole_);
  const double ratio = static_cast<double>(part) / static_cast<double>(whole_);
  for (std::size_t i = 0; i < changing_count_; ++i) codes_[changing_[i]] = code(changing_[i], part, ratio);
  return codes_;
}

/// (start (whole - part) + end part) / whole, rounded to the nearest.
std::uint32_t CodesBeside::code(std::size_t plane, std::int64_t part, double ratio) const {
  const std::int64_t start = start_[plane], way = std::int64_t{end_[plane]} - start;
  if (std::bit_width(std::max(start_[plane], end_[plane])) + std::bit_width(static_cast<std::uint64_t>(whole_)) > 61) {
    const int128 sum = int128{start} * (whole_ - part) + int128{end_[plane]} * part;
    return static_cast<std::uint32_t>((2 * sum + whole_) / (2 * int128{whole_}));
  }
  // binary64 may be one code off. `left` is 2 whole_ (exact - code + 1/2): the code is right where that is 0 ... 2 whole_ - 1.
  auto code = static_cast<std::int64_t>(static_cast<double>(start) + static_cast<double>(way) * ratio);
  const std::int64_t left = 2 * way * part + whole_ - (code - start) * 2 * whole_;
  code += left >= 2 * whole_ ? 1 : left < 0 ? -1 : 0;
  return static_cast<std::uint32_t>(code);
}

}  // namespace halfplane
