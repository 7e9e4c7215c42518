#include "exact_line.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace halfplane::exact {
namespace {

using Integer = std::int64_t;

/// n + e1 e + e2 e^2 for an infinitely small e > 0.
struct Epsilons {
  int128 n = 0, e1 = 0, e2 = 0;
};

int sign(int128 value) { return value > 0 ? 1 : value < 0 ? -1 : 0; }

int sign(const Epsilons& value) {
  if (value.n != 0) return sign(value.n);
  return value.e1 != 0 ? sign(value.e1) : sign(value.e2);
}

/// p a - q b.
Epsilons difference(const Epsilons& p, int128 a, const Epsilons& q, int128 b) {
  return {p.n * a - q.n * b, p.e1 * a - q.e1 * b, p.e2 * a - q.e2 * b};
}

/// One side of the diamond: the moved segment is inside where value + t slope < 0, for t from 0 to 1.
struct Side {
  Epsilons value;
  int128 slope;
};

/// The four sides: +-(x - x_c) +-(y - y_c) - 1/2 along the segment.
std::array<Side, 4> diamond_sides(const Line& line, int x, int y) {
  const int128 pixel = int128{1} << line.grid_bits, half = pixel / 2;
  const int128 u = line.start.x - (x * pixel + half), v = line.start.y - (y * pixel + half);
  const int128 dx = Integer{line.end.x} - line.start.x, dy = Integer{line.end.y} - line.start.y;
  std::array<Side, 4> sides{};
  std::size_t i = 0;
  for (const int sx : {-1, 1})
    for (const int sy : {-1, 1}) sides[i++] = {{sx * u + sy * v - half, -sx, -sy}, sx * dx + sy * dy};
  return sides;
}

/// Whether some t in [0, 1] is inside all sides. Each side allows an open half line of t, bounded at -value / slope.
bool meets(const std::array<Side, 4>& sides) {
  for (const Side& a : sides) {
    if (a.slope == 0 && sign(a.value) >= 0) return false;
    if (a.slope > 0 && sign(a.value) >= 0) return false;  // t < -value / slope <= 0
    const Epsilons at_end{a.value.n + a.slope, a.value.e1, a.value.e2};
    if (a.slope < 0 && sign(at_end) >= 0) return false;  // t > value / -slope >= 1
    // t > a.value / -a.slope and t < -b.value / b.slope overlap when the first bound is the smaller.
    if (a.slope < 0)
      for (const Side& b : sides)
        if (b.slope > 0 && sign(difference(a.value, b.slope, b.value, a.slope)) >= 0) return false;
  }
  return true;
}

bool diamond_covers(const Line& line, int x, int y) {
  const auto sides = diamond_sides(line, x, y);
  const bool ends_inside = std::all_of(sides.begin(), sides.end(), [](const Side& side) {
    return sign({side.value.n + side.slope, side.value.e1, side.value.e2}) < 0;
  });
  return !ends_inside && meets(sides);
}

bool centre_covers(const Line& line, Integer x, Integer y) {
  const int s = line.grid_bits;
  const Integer x0 = line.start.x >> s, y0 = line.start.y >> s, x1 = line.end.x >> s, y1 = line.end.y >> s;
  if (line.drops_last && x == x1 && y == y1) return false;
  if (x < std::min(x0, x1) || x > std::max(x0, x1) || y < std::min(y0, y1) || y > std::max(y0, y1)) return false;
  const Integer dx = x1 - x0, dy = y1 - y0;
  if (dx == 0 && dy == 0) return true;
  const bool is_x_major = std::abs(dx) >= std::abs(dy);
  // The centre's distance from the line across the major axis is cross / (major delta): y - y(x), or x - x(y).
  const int128 cross =
      is_x_major ? int128{y - y0} * dx - int128{x - x0} * dy : int128{x - x0} * dy - int128{y - y0} * dx;
  const Integer major = is_x_major ? dx : dy;
  const int128 doubled = 2 * (cross < 0 ? -cross : cross), length = std::abs(major);
  if (doubled != length) return doubled < length;
  const int side = sign(cross) * sign(int128{major});    // -1: above the line, or left of it
  if (!is_x_major) return side < 0;                      // the left end is to the left
  const int rise = sign(int128{dx}) * sign(int128{dy});  // 1: y grows to the right, so that the left end is above
  return side * rise < 0;
}

}  // namespace

Rational plane_at(const Line& line, int x, int y, Integer from, Integer to) {
  const Integer pixel = Integer{1} << line.grid_bits;
  const auto at = [&](Integer v) {
    return line.rule == LineRule::diamond ? v : (v >> line.grid_bits) * pixel + pixel / 2;
  };
  const Integer x0 = at(line.start.x), y0 = at(line.start.y), x1 = at(line.end.x), y1 = at(line.end.y);
  const bool is_x_major = std::abs(x1 - x0) >= std::abs(y1 - y0);
  const Integer length = is_x_major ? x1 - x0 : y1 - y0;
  if (length == 0) return {from, 1};
  const Integer way = (is_x_major ? x : y) * pixel + pixel / 2 - (is_x_major ? x0 : y0);
  const Integer inside = std::clamp(length > 0 ? way : -way, Integer{0}, std::abs(length));
  return {int128{from} * std::abs(length) + int128{to - from} * inside, std::abs(length)};
}

bool covers(const Line& line, int x, int y) {
  return line.rule == LineRule::diamond ? diamond_covers(line, x, y) : centre_covers(line, x, y);
}

Rational depth_at(const Line& line, int x, int y) { return plane_at(line, x, y, line.start.depth(), line.end.depth()); }

Rational color_at(const Line& line, int x, int y, int channel) {
  const std::size_t p = kColorPlane + static_cast<std::size_t>(channel);
  return plane_at(line, x, y, line.start.code[p], line.end.code[p]);
}

}  // namespace halfplane::exact
