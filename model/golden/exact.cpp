#include "exact.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdlib>

namespace halfplane::exact {
namespace {

struct Point {
  std::int64_t x, y;  // subpixels, < 2^31, so that differences fit and a product needs one multiplication
};

Point point(const SnappedVertex& v) { return {v.x, v.y}; }

/// The centre of pixel (x, y): (2x + 1) / 2 pixels.
Point centre(int x, int y, int grid_bits) {
  const std::int64_t half_pixel = std::int64_t{1} << (grid_bits - 1);
  return {(2 * std::int64_t{x} + 1) * half_pixel, (2 * std::int64_t{y} + 1) * half_pixel};
}

/// Twice the signed area of the triangle a, b, c; positive is clockwise with y down.
int128 doubled_area(Point a, Point b, Point c) {
  return int128{b.x - a.x} * (c.y - a.y) - int128{b.y - a.y} * (c.x - a.x);
}

int128 doubled_area(const Triangle& t) { return doubled_area(point(t.v[0]), point(t.v[1]), point(t.v[2])); }

/// Doubled area of the sample with each edge, in positive orientation. weight[i] belongs to vertex i, and their sum is
/// the doubled area of the triangle.
std::array<int128, 3> weights(const Triangle& t, Point sample, int128 area) {
  std::array<int128, 3> weight{};
  for (std::size_t i = 0; i < 3; ++i) {
    const int128 e = doubled_area(point(t.v[(i + 1) % 3]), point(t.v[(i + 2) % 3]), sample);
    weight[i] = area > 0 ? e : -e;
  }
  return weight;
}

}  // namespace

bool covers(const Triangle& t, int x, int y, int grid_bits, FillRule rule) {
  return TriangleOracle(t, grid_bits, rule).covers(x, y);
}

bool is_on_border(const Triangle& t, int x, int y, int grid_bits) {
  const int128 area = doubled_area(t);
  if (area == 0) return false;
  bool touches = false;
  for (const int128 weight : weights(t, centre(x, y, grid_bits), area)) {
    if (weight < 0) return false;
    touches |= weight == 0;
  }
  return touches;
}

Rational depth_at(const Triangle& t, int x, int y, int grid_bits) {
  return TriangleOracle(t, grid_bits).depth_at(x, y);
}

Rational color_at(const Triangle& t, int x, int y, int grid_bits, int channel) {
  return TriangleOracle(t, grid_bits).color_at(x, y, channel);
}

TriangleOracle::TriangleOracle(const Triangle& triangle, int grid_bits, FillRule rule)
    : triangle_(triangle), grid_bits_(grid_bits), area_(doubled_area(triangle)) {
  const bool is_turned = area_ < 0;  // then every edge is traversed in reverse
  if (is_turned) area_ = -area_;
  const std::int64_t pixel = std::int64_t{1} << grid_bits;
  std::int64_t largest = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Point from = point(triangle.v[(i + (is_turned ? 2 : 1)) % 3]);
    const Point to = point(triangle.v[(i + (is_turned ? 1 : 2)) % 3]);
    largest = std::max({largest, std::abs(from.x), std::abs(from.y)});
    const bool is_left = to.y < from.y, is_top = to.y == from.y && to.x > from.x;
    const bool owns = rule == FillRule::inclusive || (rule == FillRule::top_left && (is_left || is_top)) ||
                      (rule == FillRule::offset_point && doubled_area(from, to, {-pixel, -pixel}) > 0);
    edge_[i] = {from.x, from.y, to.x - from.x, to.y - from.y, owns};
  }
  constexpr std::int64_t kNarrow = std::int64_t{1} << 29;  // differences < 2^30, products < 2^60
  narrow_limit_ = largest < kNarrow ? kNarrow : 0;
}

bool TriangleOracle::covers(int x, int y) const {
  if (area_ == 0) return false;
  const Point p = centre(x, y, grid_bits_);
  if (std::abs(p.x) < narrow_limit_ && std::abs(p.y) < narrow_limit_) {
    for (const Edge& e : edge_)
      if (e.dx * (p.y - e.y) - e.dy * (p.x - e.x) < (e.owns ? 0 : 1)) return false;
    return true;
  }
  for (const Edge& e : edge_)
    if (int128{e.dx} * (p.y - e.y) - int128{e.dy} * (p.x - e.x) < (e.owns ? 0 : 1)) return false;
  return true;
}

PlaneWeights TriangleOracle::weights_at(int x, int y) const {
  const Point p = centre(x, y, grid_bits_);
  const auto weight = [&p](const Edge& e) { return int128{e.dx} * (p.y - e.y) - int128{e.dy} * (p.x - e.x); };
  return {{weight(edge_[0]), weight(edge_[1]), weight(edge_[2])}, area_};
}

Rational TriangleOracle::depth_at(int x, int y) const {
  return weights_at(x, y).plane({triangle_.v[0].depth(), triangle_.v[1].depth(), triangle_.v[2].depth()});
}

Rational TriangleOracle::color_at(int x, int y, int channel) const {
  const std::size_t p = kColorPlane + static_cast<std::size_t>(channel);
  return weights_at(x, y).plane({triangle_.v[0].code[p], triangle_.v[1].code[p], triangle_.v[2].code[p]});
}

Triangle seen_from(Triangle triangle, const SampleOffset& offset) {
  for (SnappedVertex& v : triangle.v) {
    v.x -= offset.x;
    v.y -= offset.y;
  }
  return triangle;
}

std::int64_t on_grid(const Rational& value, int scale_numerator, int scale_denominator) {
  // floor(n / d + 1/2) = floor((2n + d) / 2d); division truncates, so a negative remainder subtracts one more.
  const int128 numerator = (value.numerator * scale_numerator) << kGridBits;
  const int128 denominator = value.denominator * scale_denominator;
  const int128 dividend = 2 * numerator + denominator, divisor = 2 * denominator;
  const int128 quotient = dividend / divisor;
  return static_cast<std::int64_t>(dividend % divisor < 0 ? quotient - 1 : quotient);
}

}  // namespace halfplane::exact
