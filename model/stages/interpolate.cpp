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

/// A plane of a packet, as it was before the wrap.
LocalPlane<std::uint64_t> plane_of(std::int64_t anchor, std::int64_t step_x, std::int64_t step_y) {
  return {static_cast<std::uint64_t>(anchor), static_cast<std::uint64_t>(step_x), static_cast<std::uint64_t>(step_y)};
}

}  // namespace

InterpolatedDepth depth_at(const TriangleSetup& setup, const Widths& widths, int x, int y) {
  const int depth_bits = widths.depth_code.bits;
  const Value depth =
      value_at(setup, setup.depth, widths.depth_plane, {depth_bits, widths.local_depth.bits - depth_bits - 1}, widths,
               x, y, setup.depth_min, setup.depth_max);
  return {depth.unrounded, static_cast<std::uint32_t>(depth.code)};
}

Interpolated interpolate_at(const TriangleSetup& setup, const Widths& widths, int x, int y) {
  const int guard_bits = widths.local_depth.bits - widths.depth_code.bits - 1;
  const InterpolatedDepth depth = depth_at(setup, widths, x, y);
  Interpolated result;
  result.depth = depth.unrounded;
  result.depth_code = depth.code;
  for (std::size_t c = 0; c < 4; ++c) {
    const Value color = value_at(setup, setup.color[c], widths.color_plane, {8, guard_bits}, widths, x, y,
                                 setup.color_min[c], setup.color_max[c]);
    result.color[c] = color.unrounded;
    result.color_code[c] = static_cast<std::uint8_t>(color.code);
  }
  return result;
}

FragmentPacket interpolate(const StampPacket& stamp, const ContextPacket& context, const Config& config,
                           const Widths& widths) {
  const int guard_bits = widths.local_color.bits - 8 - 1;
  const LocalFormat<std::uint64_t> depth_format(widths.depth_code.bits, guard_bits), color_format(8, guard_bits);
  const auto channels = static_cast<std::size_t>(widths.color_channels);
  FragmentPacket fragment;
  static_cast<PrimitiveState&>(fragment) = context;
  fragment.kind = stamp.kind;
  fragment.ends_visit = stamp.ends_visit;
  fragment.ends_primitive = stamp.ends_primitive;
  fragment.primitive_id = stamp.primitive_id;
  fragment.tile_x = stamp.tile_x;
  fragment.tile_y = stamp.tile_y;
  fragment.stamp = stamp.stamp;
  fragment.mask = stamp.mask;
  const int size = config.stamp_size, half_tile = config.tile_size / 2;
  const int first_x = stamp.stamp % widths.stamps_per_row * size - half_tile;  // pixels from the anchor
  const int first_y = stamp.stamp / widths.stamps_per_row * size - half_tile;
  std::size_t sample = 0;
  for (int y = first_y; y < first_y + size; ++y)
    for (int x = first_x; x < first_x + size; ++x, ++sample) {
      const auto code = [x, y](const LocalPlane<std::uint64_t>& plane, const LocalFormat<std::uint64_t>& format,
                               std::int64_t low, std::int64_t high) {
        const std::uint64_t value = plane.anchor + static_cast<std::uint64_t>(std::int64_t{x}) * plane.step_x +
                                    static_cast<std::uint64_t>(std::int64_t{y}) * plane.step_y;
        return static_cast<std::uint32_t>(decode(value, format, low, high));
      };
      fragment.depth[sample] = code(plane_of(stamp.depth_anchor, context.depth_step_x, context.depth_step_y),
                                    depth_format, context.depth_min, context.depth_max);
      for (std::size_t c = 0; c < channels; ++c)
        fragment.rgba[sample] |= code(plane_of(stamp.color_anchor[c], context.color_step_x[c], context.color_step_y[c]),
                                      color_format, context.color_min[c], context.color_max[c])
                                 << 8 * c;
    }
  return fragment;
}

}  // namespace halfplane
