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

/// A plane over the pixels of a stamp, modulo 2^64.
struct StampPlane {
  std::uint64_t first, step_x, step_y;  ///< at the stamp's first pixel; per pixel

  /// `from_anchor`: the stamp's first pixel, from the anchor of its tile.
  StampPlane(const StampPacket& stamp, const ContextPacket& context, std::size_t p, const PixelOffset& from_anchor)
      : step_x(static_cast<std::uint64_t>(context.step_x[p])), step_y(static_cast<std::uint64_t>(context.step_y[p])) {
    first = static_cast<std::uint64_t>(stamp.anchor[p]) +
            static_cast<std::uint64_t>(std::int64_t{from_anchor.x}) * step_x +
            static_cast<std::uint64_t>(std::int64_t{from_anchor.y}) * step_y;
  }
  /// visit(pixel, value): at each of `pixels`, row by row.
  template <class Visit>
  void for_each(SampleMask pixels, const StampGrid& stamps, Visit&& visit) const {
    if (stamps.size == 2) return for_each<2>(pixels, visit);  // the frequent size, unrolled
    pixels.for_each([&](std::size_t pixel) {
      const PixelOffset at = stamps.place_of(static_cast<int>(pixel));
      visit(pixel, first + static_cast<std::uint64_t>(at.x) * step_x + static_cast<std::uint64_t>(at.y) * step_y);
    });
  }
  template <std::size_t kSize, class Visit>
  void for_each(SampleMask pixels, Visit&& visit) const {
    std::uint64_t row = first;
    for (std::size_t y = 0; y < kSize; ++y, row += step_y) {
      std::uint64_t value = row;
      for (std::size_t x = 0; x < kSize; ++x, value += step_x)
        if (pixels.has(y * kSize + x)) visit(y * kSize + x, value);
    }
  }
  /// Increment from there to a sample of the pixel.
  [[nodiscard]] std::uint64_t to_sample(const SampleOffset& o, const Widths& widths) const {
    return static_cast<std::uint64_t>(
        sample_plane_offset(static_cast<std::int64_t>(step_x), static_cast<std::int64_t>(step_y), o, widths.grid_bits));
  }
};

PixelOffset from_anchor(int stamp, const Widths& widths) {
  const PixelOffset first = widths.stamps.origin_of(stamp);
  const int half_tile = 1 << (widths.tile_shift - 1);
  return {first.x - half_tile, first.y - half_tile};
}

/// The hardware's decode(): the rounded code modulo 2^bits, without the clamp. The error before rounding stays below
/// 1/2 LSB (depth_error_bound() is at most 1), so at a covered sample the code equals decode(); at others it is
/// undefined.
std::uint32_t wrapped_code(std::uint64_t value, const CodePlace& place) {
  return (static_cast<std::uint32_t>(value >> place.shift) - place.offset) & place.mask;
}

/// The shading place of a pixel of a stamp: its centre, or if a sample is covered and the centre is not, the first
/// covered sample.
SampleOffset shaded_offset(const StampPacket& stamp, int pixel, const Widths& widths) {
  const unsigned covered = widths.stamps.of_pixel(stamp.mask, pixel);
  if (covered == 0 || stamp.centre.has(static_cast<std::size_t>(pixel))) return {};
  return widths.sample_offset[static_cast<std::size_t>(std::countr_zero(covered))];
}

}  // namespace

void start_fragment(const StampPacket& stamp, const ContextPacket& context, const Widths& widths,
                    FragmentPacket& fragment) {
  fragment.kind = stamp.kind;
  fragment.ends_visit = stamp.ends_visit;
  fragment.ends_primitive = stamp.ends_primitive;
  fragment.key = stamp.key;
  fragment.state = context.state;
  enter_stamp(stamp, widths, fragment);
  if (widths.coordinates == 0) return;
  fragment.coordinates = context.coordinates;
  if (widths.has_colors_over_w == 0) return;
  fragment.least_color = vertex_color(context.range.low, widths);
  fragment.greatest_color = vertex_color(context.range.high, widths);
}

void enter_stamp(const StampPacket& stamp, const Widths& widths, FragmentPacket& fragment) {
  fragment.stamp = stamp.stamp;
  fragment.mask = stamp.mask;
  if (fragment.state.masked_samples != 0)
    fragment.mask = fragment.mask & widths.stamps.in_every_pixel(~unsigned{fragment.state.masked_samples});
}

void interpolate_depths(const StampPacket& stamp, const ContextPacket& context, SampleMask pixels, const Widths& widths,
                        FragmentPacket& fragment) {
  const CodePlace place = widths.code_place[kDepthPlane];
  const StampPlane plane(stamp, context, kDepthPlane, from_anchor(stamp.stamp, widths));
  if (widths.has_samples == 0)
    return plane.for_each(pixels, widths.stamps, [&](std::size_t pixel, std::uint64_t centre) {
      fragment.code[pixel][kDepthPlane] = wrapped_code(centre, place);
    });
  const std::size_t further = static_cast<std::size_t>(widths.pixel_samples) - 1;
  plane.for_each(pixels, widths.stamps, [&](std::size_t pixel, std::uint64_t centre) {
    const auto code_at = [&](std::size_t k) {
      return wrapped_code(centre + plane.to_sample(widths.sample_offset[k], widths), place);
    };
    fragment.code[pixel][kDepthPlane] = code_at(0);
    for (std::size_t k = 0; k < further; ++k) fragment.further_depth[pixel * further + k] = code_at(k + 1);
  });
}

void interpolate_planes(const StampPacket& stamp, const ContextPacket& context, int first, int end, SampleMask pixels,
                        const Widths& widths, FragmentPacket& fragment) {
  const PixelOffset origin = from_anchor(stamp.stamp, widths);
  const bool has_samples = widths.has_samples != 0;
  for (auto p = static_cast<std::size_t>(first); p < static_cast<std::size_t>(end); ++p) {
    const StampPlane plane(stamp, context, p, origin);
    const CodePlace place = widths.code_place[p];
    plane.for_each(pixels, widths.stamps, [&](std::size_t pixel, std::uint64_t value) {
      if (has_samples) value += plane.to_sample(shaded_offset(stamp, static_cast<int>(pixel), widths), widths);
      fragment.code[pixel][p] = wrapped_code(value, place);
    });
  }
}

void interpolate(const StampPacket& stamp, const ContextPacket& context, const Widths& widths,
                 FragmentPacket& fragment) {
  const SampleMask pixels = SampleMask::all(widths.pixels);
  start_fragment(stamp, context, widths, fragment);
  interpolate_depths(stamp, context, pixels, widths, fragment);
  interpolate_planes(stamp, context, kColorPlane, widths.planes, pixels, widths, fragment);
}

FragmentPacket interpolate(const StampPacket& stamp, const ContextPacket& context, const Widths& widths) {
  FragmentPacket fragment;
  interpolate(stamp, context, widths, fragment);
  return fragment;
}

}  // namespace halfplane
