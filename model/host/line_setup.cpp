#include "line_setup.hpp"

#include <algorithm>
#include <cmath>

#include "../stages/triangle_setup.hpp"

namespace halfplane {
namespace {

/// The line in its own octant. Reversing an axis maps coordinate v to -v, and so pixel i to -1 - i.
struct OctantLine {
  bool is_x_major = false, is_major_negative = false, is_minor_negative = false;
  std::int64_t a0 = 0, b0 = 0, a1 = 0, b1 = 0;  ///< subpixels: a0 <= a1, b0 <= b1, a1 - a0 >= b1 - b0
  [[nodiscard]] std::int64_t major_delta() const { return a1 - a0 > 0 ? a1 - a0 : 1; }  // > 0, for a single pixel too
  [[nodiscard]] std::int64_t minor_delta() const { return b1 - b0; }
};

/// First and last pixel of `limit` along one axis of the octant.
struct Bounds {
  std::int64_t low, high;
};

Bounds turned(std::int64_t low, std::int64_t high, bool is_negative) {
  return is_negative ? Bounds{~high, ~low} : Bounds{low, high};
}

OctantLine to_octant(const SnappedVertex& start, const SnappedVertex& end, LineRule rule, int s) {
  const auto at = [&](std::int32_t v) -> std::int64_t {  // the centre of the pixel that contains v
    return rule == LineRule::diamond ? v : (std::int64_t{v >> s} << s) + (std::int64_t{1} << (s - 1));
  };
  const std::int64_t x0 = at(start.x), y0 = at(start.y), x1 = at(end.x), y1 = at(end.y);
  OctantLine line;
  line.is_x_major = std::abs(x1 - x0) >= std::abs(y1 - y0);
  line.a0 = line.is_x_major ? x0 : y0;
  line.a1 = line.is_x_major ? x1 : y1;
  line.b0 = line.is_x_major ? y0 : x0;
  line.b1 = line.is_x_major ? y1 : x1;
  line.is_major_negative = line.a1 < line.a0;
  line.is_minor_negative = line.b1 < line.b0;
  if (line.is_major_negative) line.a0 = -line.a0, line.a1 = -line.a1;
  if (line.is_minor_negative) line.b0 = -line.b0, line.b1 = -line.b1;
  return line;
}

/// Whether a line that crosses a column's centre exactly between two rows takes the later row.
bool tie_moves(const OctantLine& line, LineRule rule) {
  // Crossing a column of a y-major line: the left pixel, by either rule (-e is the larger part of the perturbation).
  if (!line.is_x_major) return line.is_minor_negative;
  // The left end's side: towards the start, unless the line is drawn from right to left.
  if (rule != LineRule::diamond) return line.is_major_negative;
  // Moved to the left, a sloped line crosses the column nearer its right end's row; a level line moves up.
  return !line.is_major_negative && line.minor_delta() != 0;
}

/// Diamond exit: the first column that a line from (a, b) on would cover, which is also one past the last column that a
/// line to (a, b) does. The point is moved by (-e, -e^2) in the window, so that it lies on no centre and on no border.
std::int64_t exit_column(const OctantLine& line, std::int64_t a, std::int64_t b, int s) {
  const std::int64_t pixel = std::int64_t{1} << s, half = pixel / 2;
  // The first column whose centre is not before the moved point. A turned axis moves it forward, off a centre it is on.
  const std::int64_t column = line.is_major_negative ? ((a - half) >> s) + 1 : (a - half + pixel - 1) >> s;
  // The previous column: the point is past its centre, but may still be inside the diamond of a pixel there.
  const std::int64_t u = a - ((column - 1) << s) - half;  // 0...pixel
  const std::int64_t v = (b & (pixel - 1)) - half;        // -half...half - 1
  const std::int64_t reach = u + std::abs(v);
  bool is_inside = reach < half;
  if (reach == half) {  // on the border: the larger part of the perturbation decides
    if (line.is_x_major)
      is_inside = !line.is_major_negative;
    else if (v == -half)
      is_inside = true;  // where two diamonds meet: it moves into one of them
    else
      is_inside = v != 0 && (v > 0) != line.is_minor_negative;
  }
  return is_inside ? column - 1 : column;
}

/// Columns [first, end) of the whole line.
struct ColumnSpan {
  std::int64_t first, end;
};

ColumnSpan columns_of(const OctantLine& line, LineRule rule, bool drops_last, int s) {
  if (rule == LineRule::diamond)
    return {exit_column(line, line.a0, line.b0, s), exit_column(line, line.a1, line.b1, s)};
  return {line.a0 >> s, (line.a1 >> s) + (drops_last ? 0 : 1)};
}

/// numerator / denominator, both above or at 0, to the next integer up.
std::int64_t divide_up(std::int64_t numerator, std::int64_t denominator) {
  return (numerator + denominator - 1) / denominator;
}

std::int64_t divide_down(std::int64_t numerator, std::int64_t denominator) {
  const std::int64_t quotient = numerator / denominator;
  return numerator % denominator < 0 ? quotient - 1 : quotient;
}

/// Positions Q along the minor axis, in units of 1/D pixel from the lower border of row `base`.
struct Positions {
  std::int64_t first = 0;   ///< Q at the line's first column, |Q| < 2^63: Widths::line_position
  std::int64_t base = 0;    ///< the start's row
  std::int64_t offset = 0;  ///< from the start to the centre of the first column, subpixels
};

Positions positions_of(const OctantLine& line, LineRule rule, std::int64_t first_column, int s) {
  const std::int64_t pixel = std::int64_t{1} << s;
  Positions q;
  q.base = line.b0 >> s;
  q.offset = (first_column << s) + pixel / 2 - line.a0;
  const std::int64_t numerator = (line.b0 & (pixel - 1)) * line.major_delta() + line.minor_delta() * q.offset;
  q.first = (numerator - (tie_moves(line, rule) ? 0 : 1)) >> s;
  return q;
}

/// Cuts `steps` to the n whose row, floor((Q + d n) / D), lies in `rows` (relative to the base). Rows never fall.
Bounds clip_to_rows(Bounds steps, const Bounds& rows, std::int64_t q, std::int64_t d, std::int64_t D) {
  const Bounds none{0, -1};
  if (q + d * steps.low < rows.low * D) {
    if (d == 0) return none;
    steps.low = divide_up(rows.low * D - q, d);
  }
  if (q + d * steps.high >= (rows.high + 1) * D) {
    const std::int64_t room = (rows.high + 1) * D - 1 - q;
    if (d == 0 || room < 0) return none;
    steps.high = room / d;
  }
  return steps;
}

/// Constants common to the attributes of one line.
struct Slope {
  Reciprocal reciprocal;    ///< of D; value 0 for a single pixel, whose steps are then 0
  std::int64_t offset = 0;  ///< from the start to the first pixel's centre along the major axis, subpixels
  int grid_bits = 0, guard_bits = 0;
};

/// `value` at the first pixel and `step` per pixel, in a register of `bits` bits.
void setup_attribute(std::int64_t from, std::int64_t to, const Slope& slope, int bits, std::uint64_t& value,
                     std::uint64_t& step) {
  const auto wrap = [bits](int128 v) { return wrap_unsigned(static_cast<std::uint64_t>(v), bits); };
  const int128 product = int128{to - from} * static_cast<int128>(slope.reciprocal.value);
  const int128 gradient = round_shift(product, slope.reciprocal.shift - slope.grid_bits - slope.guard_bits);
  const int128 half = int128{1} << (slope.guard_bits - 1);  // makes the final rounding a shift
  value = wrap((int128{from} << slope.guard_bits) + half + round_shift(gradient * slope.offset, slope.grid_bits));
  step = wrap(gradient);
}

}  // namespace

int strands_of(double width) { return std::max(1, static_cast<int>(std::floor(width + 0.5))); }

void move_to_strand(SnappedVertex& start, SnappedVertex& end, int i, int count, LineRule rule, int grid_bits) {
  const std::int32_t half = std::int32_t{1} << (grid_bits - 1);
  const std::int32_t across =
      rule == LineRule::diamond ? (2 * i - (count - 1)) * half : (i - (count - 1) / 2) * 2 * half;
  const auto minor = to_octant(start, end, rule, grid_bits).is_x_major ? &SnappedVertex::y : &SnappedVertex::x;
  start.*minor += across;
  end.*minor += across;
}

std::optional<std::array<SnappedVertex, 4>> line_rectangle(const SnappedVertex& start, const SnappedVertex& end,
                                                           double width, int grid_bits) {
  const double dx = static_cast<double>(end.x) - start.x, dy = static_cast<double>(end.y) - start.y;
  if (dx == 0 && dy == 0) return std::nullopt;
  // Half the width in grid steps, by a quarter turn of the direction; rounded symmetrically for both signs.
  const double scale = std::ldexp(width / 2, grid_bits) / std::sqrt(dx * dx + dy * dy);
  const auto x = static_cast<std::int32_t>(std::llround(-dy * scale)),
             y = static_cast<std::int32_t>(std::llround(dx * scale));
  const auto corner = [x, y](SnappedVertex v, int side) {
    v.x += side * x;
    v.y += side * y;
    return v;
  };
  return std::array{corner(start, 1), corner(start, -1), corner(end, -1), corner(end, 1)};
}

std::optional<LineSetup> setup_line(const SnappedVertex& start, const SnappedVertex& end, LineRule rule,
                                    bool drops_last, const PixelBounds& limit, const Widths& widths) {
  const int s = widths.grid_bits;
  const OctantLine line = to_octant(start, end, rule, s);
  const std::int64_t d = line.minor_delta(), D = line.major_delta();
  const ColumnSpan columns = columns_of(line, rule, drops_last, s);
  const Positions q = positions_of(line, rule, columns.first, s);

  const Bounds x = turned(limit.left, limit.right, line.is_x_major ? line.is_major_negative : line.is_minor_negative);
  const Bounds y = turned(limit.top, limit.bottom, line.is_x_major ? line.is_minor_negative : line.is_major_negative);
  const Bounds &major = line.is_x_major ? x : y, &minor = line.is_x_major ? y : x;
  Bounds steps{std::max<std::int64_t>(0, major.low - columns.first),
               std::min(columns.end - 1, major.high) - columns.first};
  if (steps.low > steps.high || minor.low > minor.high) return std::nullopt;
  steps = clip_to_rows(steps, {minor.low - q.base, minor.high - q.base}, q.first, d, D);
  if (steps.low > steps.high) return std::nullopt;

  const std::int64_t position = q.first + d * steps.low, row = divide_down(position, D);
  const std::int64_t column = columns.first + steps.low;
  const auto pixel = [](std::int64_t i, bool is_negative) { return static_cast<std::int32_t>(is_negative ? ~i : i); };
  const std::int32_t a = pixel(column, line.is_major_negative), b = pixel(row + q.base, line.is_minor_negative);
  LineSetup out;
  out.x = line.is_x_major ? a : b;
  out.y = line.is_x_major ? b : a;
  out.is_x_major = line.is_x_major;
  out.is_x_negative = line.is_x_major ? line.is_major_negative : line.is_minor_negative;
  out.is_y_negative = line.is_x_major ? line.is_minor_negative : line.is_major_negative;
  out.is_before_start = steps.low == 0 && q.offset < 0;
  out.remaining = static_cast<std::uint32_t>(steps.high - steps.low);
  out.step_stay = d;
  out.step_move = d - D;
  out.error = position - row * D + d - D;

  Slope slope{{}, q.offset + (steps.low << s), s, widths.line_guard_bits};
  slope.reciprocal = reciprocal(line.a1 - line.a0, widths.reciprocal_bits());
  for (std::size_t p = 0; p < static_cast<std::size_t>(widths.affine_planes); ++p)
    setup_attribute(start.code[p], end.code[p], slope, widths.of_plane(p).line.bits, out.value[p], out.step[p]);
  out.start = start.code;
  return out;
}

}  // namespace halfplane
