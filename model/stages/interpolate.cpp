#include "interpolate.hpp"

#include <bit>

namespace halfplane {

PixelPlace place_of(const TriangleSetup& setup, const Widths& widths, int x, int y) {
  const int tile_x = x >> widths.tile_shift, tile_y = y >> widths.tile_shift;
  const int half_tile = 1 << (widths.tile_shift - 1);
  return {tile_offset(setup, tile_x, tile_y, widths),
          static_cast<std::uint64_t>(std::int64_t{x - (tile_x << widths.tile_shift) - half_tile}),
          static_cast<std::uint64_t>(std::int64_t{y - (tile_y << widths.tile_shift) - half_tile})};
}

namespace {

inline PlaneSample sample_at(const TriangleSetup& setup, std::size_t p, const Widths& widths, const PixelPlace& place) {
  const AttributeWidths& attribute = widths.of_plane(p);
  const LocalFormat<std::uint64_t> format(attribute);
  const PlaneValue anchor = plane_at_tile(setup.plane[p], place.tile, attribute.plane.bits);
  const auto local = local_plane(anchor, setup.plane[p], format, widths);
  const std::uint64_t sum = local.anchor + place.i * local.step_x + place.j * local.step_y;
  const std::uint64_t half = std::uint64_t{1} << (format.guard_bits - 1);
  const auto unrounded =
      static_cast<std::int64_t>((sum - half) & format.modulus_mask) - static_cast<std::int64_t>(format.offset());
  return {unrounded,
          static_cast<std::uint32_t>(decode<std::int64_t>(sum, format, setup.range.low[p], setup.range.high[p]))};
}

}  // namespace

PlaneSample plane_at(const TriangleSetup& setup, std::size_t p, const Widths& widths, int x, int y) {
  return sample_at(setup, p, widths, place_of(setup, widths, x, y));
}

Interpolated interpolate_at(const TriangleSetup& setup, const Widths& widths, int x, int y) {
  const PixelPlace place = place_of(setup, widths, x, y);
  Interpolated result;
  for (std::size_t p = 0; p < static_cast<std::size_t>(widths.affine_planes); ++p) {
    const PlaneSample sample = sample_at(setup, p, widths, place);
    result.unrounded[p] = sample.unrounded;
    result.code[p] = sample.code;
  }
  return result;
}

namespace {

/// What hardware has of decode(): the rounded code modulo 2^bits, without the clamp. The error before rounding stays below
/// 1/2 LSB (depth_error_bound() is at most 1), so at a covered sample it is that of decode(); at others it may be anything.
std::uint32_t wrapped_code(std::uint64_t value, const LocalFormat<std::uint64_t>& format) {
  const std::uint64_t half = std::uint64_t{1} << (format.bits - 1);
  return static_cast<std::uint32_t>(((value >> format.guard_bits) - half) & (2 * half - 1));
}

/// Where a pixel of a stamp is shaded: at its centre, or if a sample is covered and the centre is not, at the first such.
SampleOffset shaded_offset(const StampPacket& stamp, int pixel, const Widths& widths) {
  const unsigned covered = widths.stamps.of_pixel(stamp.mask, pixel);
  if (widths.has_samples == 0 || covered == 0 || stamp.centre.has(static_cast<std::size_t>(pixel))) return {};
  return widths.sample_offset[static_cast<std::size_t>(std::countr_zero(covered))];
}

}  // namespace

FragmentPacket interpolate(const StampPacket& stamp, const ContextPacket& context, const Widths& widths) {
  FragmentPacket fragment;
  fragment.kind = stamp.kind;
  fragment.ends_visit = stamp.ends_visit;
  fragment.ends_primitive = stamp.ends_primitive;
  fragment.key = stamp.key;
  fragment.stamp = stamp.stamp;
  fragment.state = context.state;
  fragment.mask = stamp.mask & widths.stamps.in_every_pixel(~unsigned{context.state.masked_samples});
  fragment.coordinates = context.coordinates;
  if (widths.has_colors_over_w != 0) {
    fragment.least_color = vertex_color(context.range.low, widths);
    fragment.greatest_color = vertex_color(context.range.high, widths);
  }
  const StampGrid& stamps = widths.stamps;
  const PixelOffset origin = stamps.origin_of(stamp.stamp);
  const int half_tile = 1 << (widths.tile_shift - 1);
  for (int pixel = 0; pixel < stamps.pixels(); ++pixel) {
    const auto at = static_cast<std::size_t>(pixel), n = static_cast<std::size_t>(widths.pixel_samples);
    const PixelOffset in_stamp = stamps.pixel_of(pixel * stamps.per_pixel);
    const auto i = static_cast<std::uint64_t>(std::int64_t{origin.x + in_stamp.x - half_tile});  // from the anchor
    const auto j = static_cast<std::uint64_t>(std::int64_t{origin.y + in_stamp.y - half_tile});
    const auto value_at = [&](std::size_t p, const SampleOffset& o) {
      return static_cast<std::uint64_t>(stamp.anchor[p]) + i * static_cast<std::uint64_t>(context.step_x[p]) +
             j * static_cast<std::uint64_t>(context.step_y[p]) +
             static_cast<std::uint64_t>(sample_plane_offset(context.step_x[p], context.step_y[p], o, widths.grid_bits));
    };
    const SampleOffset shaded = shaded_offset(stamp, pixel, widths);
    for (std::size_t p = 0; p < static_cast<std::size_t>(widths.planes); ++p) {
      const std::uint64_t value = value_at(p, p == kDepthPlane ? widths.sample_offset[0] : shaded);
      if (static_cast<int>(p) >= widths.affine_planes) {  // Q and P as they are: the texture unit divides
        fragment.code[at][p] = static_cast<std::uint32_t>(wrap_unsigned(value, widths.of_plane(p).local.bits));
        continue;
      }
      fragment.code[at][p] = wrapped_code(value, LocalFormat<std::uint64_t>(widths.of_plane(p)));
    }
    for (std::size_t k = 1; k < n; ++k)
      fragment.further_depth[at * (n - 1) + k - 1] =
          wrapped_code(value_at(kDepthPlane, widths.sample_offset[k]), LocalFormat<std::uint64_t>(widths.depth()));
  }
  return fragment;
}

}  // namespace halfplane
