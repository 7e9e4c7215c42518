#include "exact.hpp"

#include <array>
#include <cstddef>

namespace halfplane::exact {
namespace {

struct Point {
  std::int64_t x, y;  // subpixels, < 2^31, so that differences fit and one multiplication makes a product
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

/// Doubled area of the sample with each edge, turned to positive orientation. weight[i] belongs to vertex i, and their
/// sum is the doubled area of the triangle.
std::array<int128, 3> weights(const Triangle& t, Point sample, int128 area) {
  std::array<int128, 3> weight{};
  for (std::size_t i = 0; i < 3; ++i) {
    const int128 e = doubled_area(point(t.v[(i + 1) % 3]), point(t.v[(i + 2) % 3]), sample);
    weight[i] = area > 0 ? e : -e;
  }
  return weight;
}

Rational plane_at(const Triangle& t, const std::array<int128, 3>& codes, int x, int y, int grid_bits) {
  const int128 area = doubled_area(t);
  const auto weight = weights(t, centre(x, y, grid_bits), area);
  return {weight[0] * codes[0] + weight[1] * codes[1] + weight[2] * codes[2], area > 0 ? area : -area};
}

}  // namespace

bool covers(const Triangle& t, int x, int y, int grid_bits, FillRule rule) {
  const int128 area = doubled_area(t);
  if (area == 0) return false;
  const auto weight = weights(t, centre(x, y, grid_bits), area);
  const std::int64_t pixel = std::int64_t{1} << grid_bits;
  const auto offset = weights(t, {-pixel, -pixel}, area);  // of the point (-1, -1)
  for (std::size_t i = 0; i < 3; ++i) {
    if (weight[i] > 0) continue;
    if (weight[i] < 0) return false;
    // On the edge opposite vertex i, which a triangle of negative area runs through the other way round.
    const Point from = point(t.v[(i + (area > 0 ? 1 : 2)) % 3]), to = point(t.v[(i + (area > 0 ? 2 : 1)) % 3]);
    const bool is_left = to.y < from.y, is_top = to.y == from.y && to.x > from.x;
    const bool owns = rule == FillRule::inclusive || (rule == FillRule::top_left && (is_left || is_top)) ||
                      (rule == FillRule::offset_point && offset[i] > 0);
    if (!owns) return false;
  }
  return true;
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
  return plane_at(t, {t.v[0].z, t.v[1].z, t.v[2].z}, x, y, grid_bits);
}

Rational color_at(const Triangle& t, int x, int y, int grid_bits, int channel) {
  const auto c = static_cast<std::size_t>(channel);
  return plane_at(t, {t.v[0].rgba[c], t.v[1].rgba[c], t.v[2].rgba[c]}, x, y, grid_bits);
}

std::int64_t on_grid(const Rational& value, int scale_numerator, int scale_denominator) {
  // floor(n / d + 1/2) = floor((2n + d) / 2d); division truncates, so a remainder below zero takes one more.
  const int128 numerator = (value.numerator * scale_numerator) << kGridBits;
  const int128 denominator = value.denominator * scale_denominator;
  const int128 dividend = 2 * numerator + denominator, divisor = 2 * denominator;
  const int128 quotient = dividend / divisor;
  return static_cast<std::int64_t>(dividend % divisor < 0 ? quotient - 1 : quotient);
}

}  // namespace halfplane::exact
