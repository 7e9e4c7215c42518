// Primitive join: inserts the pixels of lines among the stamps in program order.
//
// In: fragments from interpolate, pixels from line_raster. Out: fragments. A fragment of kind line is the place of one
// line: it takes pixels up to the line's last one and becomes one fragment each. Every other fragment passes. The
// stream to read next follows from the last item read, never from which stream is valid first. No latency, one fragment
// per cycle.
#pragma once

#include <algorithm>

#include "line_raster.hpp"

namespace halfplane {

/// Turns the place of a line, or the pixel before, into a pixel of the line: a stamp with one covered pixel, which
/// belongs to no tile visit. All samples of the pixel that the state allows are drawn.
inline void set_line_pixel(const LinePixel& pixel, const Widths& widths, FragmentPacket& fragment) {
  const StampGrid& stamps = widths.stamps;
  const int last = (1 << widths.tile_shift) - 1;
  const int x = pixel.x & last, y = pixel.y & last;  // in the tile
  fragment.ends_visit = false;
  fragment.ends_primitive = pixel.is_last;
  fragment.key.tile_x = static_cast<std::uint16_t>(pixel.x >> widths.tile_shift);
  fragment.key.tile_y = static_cast<std::uint16_t>(pixel.y >> widths.tile_shift);
  fragment.stamp = static_cast<std::uint16_t>(stamps.stamp_at(x, y));
  fragment.mask = stamps.samples_at(x % stamps.size, y % stamps.size) &
                  stamps.in_every_pixel(~unsigned{fragment.state.masked_samples});
  // In every lane: the other pixels are ignored, and a lane of hardware need not know its pixel.
  std::fill_n(fragment.code.begin(), widths.pixels, pixel.code);
  std::fill_n(fragment.further_depth.begin(), widths.further_samples, pixel.code[kDepthPlane]);
}

/// The fragment for a pixel of the line whose place is `token`.
[[nodiscard]] inline FragmentPacket line_fragment(const FragmentPacket& token, const LinePixel& pixel,
                                                  const Widths& widths) {
  FragmentPacket fragment = token;
  set_line_pixel(pixel, widths, fragment);
  return fragment;
}

}  // namespace halfplane
