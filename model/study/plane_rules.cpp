#include "plane_rules.hpp"

#include <algorithm>

namespace halfplane {
namespace {

/// Constants of the planes of one triangle, and their rules.
struct RulesFrame {
  std::int64_t ax, ay, bx, by;  // v1 - v0 and v2 - v0, subpixels
  std::int64_t dx, dy;          // from v0 to the anchor of the first tile, subpixels
  std::uint64_t x_reciprocal = 0, y_reciprocal = 0;
  int shift = 0;  // k
  int fraction;   // F
  int kept;       // fraction bits kept of a gradient per subpixel: F, or l + s
  StudyRules rules;
};

/// `value` clamped or wrapped to a register of `bits` bits.
std::int64_t held(int128 value, int bits, Accumulator accumulator) {
  if (accumulator == Accumulator::wrap) return wrap_signed(static_cast<std::int64_t>(value), bits);
  const int128 half = int128{1} << (bits - 1);
  return static_cast<std::int64_t>(std::clamp(value, -half, half - 1));
}

/// Per subpixel, F fraction bits.
int128 gradient(std::int64_t numerator, std::uint64_t reciprocal, const RulesFrame& f) {
  const int128 product = static_cast<int128>(numerator) * static_cast<int128>(reciprocal);
  const int drop = f.shift - f.kept;
  if (f.rules.gradients != Gradients::truncated) return round_shift(product, drop);
  return (drop > 0 ? product >> drop : product << -drop) << (f.fraction - f.kept);
}

/// For planes with this many significant bits of the reciprocal.
void set_reciprocals(RulesFrame& frame, std::int64_t area, int significant_bits) {
  const Reciprocal nearest = reciprocal(area, significant_bits);
  frame.shift = nearest.shift;
  frame.x_reciprocal = frame.y_reciprocal = nearest.value;
  if (frame.rules.gradients != Gradients::two_reciprocals) return;
  const uint128 one = uint128{1} << nearest.shift, divisor = static_cast<uint128>(area);
  frame.x_reciprocal = static_cast<std::uint64_t>(one / divisor);
  frame.y_reciprocal = static_cast<std::uint64_t>((one + divisor - 1) / divisor);
}

Plane plane_by_rules(std::int64_t c0, std::int64_t c1, std::int64_t c2, const RulesFrame& f, int bits) {
  const std::int64_t ac = c1 - c0, bc = c2 - c0;
  const Accumulator accumulator = f.rules.accumulator;
  Plane plane;
  plane.step_x = held(gradient(ac * f.by - bc * f.ay, f.x_reciprocal, f), bits, accumulator);
  plane.step_y = held(gradient(f.ax * bc - f.bx * ac, f.y_reciprocal, f), bits, accumulator);
  plane.value =
      held((int128{c0} << f.fraction) + int128{plane.step_x} * f.dx + int128{plane.step_y} * f.dy, bits, accumulator);
  return plane;
}

/// Saturated plane `p` at pixel (x, y), clamped to the range of the vertices.
PlaneSample saturated_at(const TriangleSetup& setup, std::size_t p, const Widths& widths, int x, int y) {
  const Plane& plane = setup.plane[p];
  const int plane_bits = widths.of_plane(p).plane.bits, local_bits = widths.of_plane(p).local.bits;
  const int guard_bits = widths.of_plane(p).guard_bits();
  const int shift = widths.tile_shift, to_subpixels = shift + widths.grid_bits;
  const int tile_x = x >> shift, tile_y = y >> shift;
  const auto tiles = [to_subpixels](int last, int first) { return int128{last - first} << to_subpixels; };
  const std::int64_t column =
      held(plane.value + plane.step_y * tiles(tile_y, setup.top >> shift), plane_bits, Accumulator::saturate);
  const std::int64_t anchor =
      held(column + plane.step_x * tiles(tile_x, setup.left >> shift), plane_bits, Accumulator::saturate);
  const int drop = widths.plane_fraction - guard_bits, half_tile = 1 << (shift - 1);
  const std::int64_t i = x - (tile_x << shift) - half_tile, j = y - (tile_y << shift) - half_tile;
  const std::int64_t value =
      held(int128{round_shift(anchor, drop)} + i * round_shift(plane.step_x, drop - widths.grid_bits) +
               j * round_shift(plane.step_y, drop - widths.grid_bits),
           local_bits, Accumulator::saturate);
  return {value, static_cast<std::uint32_t>(std::clamp<std::int64_t>(round_shift(value, guard_bits), setup.range.low[p],
                                                                     setup.range.high[p]))};
}

}  // namespace

void set_planes(TriangleSetup& setup, const std::array<SnappedVertex, 3>& v, const StudyRules& rules,
                const Config& config, const Widths& widths) {
  const int s = widths.grid_bits, tile = widths.tile_shift;
  const auto anchor = [&](int first) {  // centre of pixel T/2 of the tile that holds pixel `first`, subpixels
    return (std::int64_t{(first >> tile << tile) + config.tile_size / 2} << s) + (std::int64_t{1} << (s - 1));
  };
  RulesFrame frame{.ax = std::int64_t{v[1].x} - v[0].x,
                   .ay = std::int64_t{v[1].y} - v[0].y,
                   .bx = std::int64_t{v[2].x} - v[0].x,
                   .by = std::int64_t{v[2].y} - v[0].y,
                   .dx = anchor(setup.left) - v[0].x,
                   .dy = anchor(setup.top) - v[0].y,
                   .fraction = widths.plane_fraction,
                   .kept = rules.gradients == Gradients::truncated
                               ? std::min(config.local_guard_bits + s, widths.plane_fraction)
                               : widths.plane_fraction,
                   .rules = rules};
  for (std::size_t p = 0; p < static_cast<std::size_t>(widths.affine_planes); ++p) {
    const AttributeWidths& attribute = widths.of_plane(p);
    set_reciprocals(frame, setup.area, attribute.reciprocal_bits());
    setup.plane[p] = plane_by_rules(v[0].code[p], v[1].code[p], v[2].code[p], frame, attribute.plane.bits);
  }
}

Interpolated interpolate_by_rules(const TriangleSetup& setup, const StudyRules& rules, const Widths& widths, int x,
                                  int y) {
  if (rules.accumulator == Accumulator::wrap) return interpolate_at(setup, widths, x, y);
  Interpolated result;
  for (std::size_t p = 0; p < static_cast<std::size_t>(widths.affine_planes); ++p) {
    const PlaneSample sample = saturated_at(setup, p, widths, x, y);
    result.unrounded[p] = sample.unrounded;
    result.code[p] = sample.code;
  }
  return result;
}

}  // namespace halfplane
