#include "interpolate.hpp"

namespace halfplane {
namespace {

struct Value {
  std::int64_t unrounded, code;
};

Value value_at(const TriangleSetup& setup, const Plane& plane, const Width& plane_width,
               const LocalFormat<std::uint64_t>& format, const Widths& widths, int x, int y, std::int64_t low,
               std::int64_t high) {
  const int tile_x = x >> widths.tile_shift, tile_y = y >> widths.tile_shift;
  const int half_tile = 1 << (widths.tile_shift - 1);
  const PlaneValue anchor = plane_at_tile(setup, plane, tile_x, tile_y, widths, plane_width.bits);
  const auto local = local_plane(anchor, plane, format, widths);
  const auto i = static_cast<std::uint64_t>(std::int64_t{x - (tile_x << widths.tile_shift) - half_tile});
  const auto j = static_cast<std::uint64_t>(std::int64_t{y - (tile_y << widths.tile_shift) - half_tile});
  const std::uint64_t sum = local.anchor + i * local.step_x + j * local.step_y;
  const std::uint64_t half = std::uint64_t{1} << (format.guard_bits - 1);
  const auto unrounded =
      static_cast<std::int64_t>((sum - half) & format.modulus_mask) - static_cast<std::int64_t>(format.offset());
  return {unrounded, decode(sum, format, low, high)};
}

}  // namespace

Interpolated interpolate_at(const TriangleSetup& setup, const Widths& widths, int x, int y) {
  const int depth_bits = widths.depth_code.bits;
  const int guard_bits = widths.local_depth.bits - depth_bits - 1;
  Interpolated result;
  const Value depth = value_at(setup, setup.depth, widths.depth_plane, {depth_bits, guard_bits}, widths, x, y,
                               setup.depth_min, setup.depth_max);
  result.depth = depth.unrounded;
  result.depth_code = static_cast<std::uint32_t>(depth.code);
  for (std::size_t c = 0; c < 4; ++c) {
    const Value color = value_at(setup, setup.color[c], widths.color_plane, {8, guard_bits}, widths, x, y,
                                 setup.color_min[c], setup.color_max[c]);
    result.color[c] = color.unrounded;
    result.color_code[c] = static_cast<std::uint8_t>(color.code);
  }
  return result;
}

}  // namespace halfplane
