// Pixel colours: blocks of 4x4 pixels whose pixels have one colour each lie in memory with one colour a pixel, others with one
// a sample (compress.unit). A bit for each block of the target says which; it is looked at and changed where requests go out,
// in their order, so that it is always what memory has.
//
// What leaves the chip of a block is its new samples. Where those of each pixel are all there and equal, or none is, the block
// is uniform: it is written with a colour a pixel where memory holds garbage, the whole block is there, or memory has such a
// block already. A block that is not, over one in memory that has a colour a pixel, must have all its samples from now on:
// that is read and merged. Data is in block_cache.hpp, time in engines/cycle/block_timing.hpp, the hardware in
// rtl_ref/stages/pixel_colors.sv.
#pragma once

#include "clear_flags.hpp"

namespace halfplane {

/// The colours of a block that leaves the chip.
struct LeavingColors {
  bool fills = false;      ///< memory holds garbage, and all of the block is there
  bool is_uniform = true;  ///< of each pixel all samples are there, and equal, or none
  bool is_whole = false;   ///< all of the block is there
};

/// How they go to memory.
enum class ColorMove : std::uint8_t {
  samples,  ///< those that are there, a colour a sample
  pixels,   ///< likewise, a colour a pixel
  merge,    ///< all, a colour a sample: what is not there is read, a colour a pixel
};

/// `of_pixels`: memory has the block with a colour a pixel.
[[nodiscard]] constexpr ColorMove color_move(const LeavingColors& colors, bool of_pixels) {
  if (colors.is_uniform) return colors.fills || colors.is_whole || of_pixels ? ColorMove::pixels : ColorMove::samples;
  return of_pixels && !colors.fills ? ColorMove::merge : ColorMove::samples;
}

/// Whether of each pixel of a stamp all samples in `mask` are there, and equal, or none is. color(s): that of sample s.
template <class Color>
[[nodiscard]] bool has_one_color(SampleMask mask, const Widths& widths, Color&& color) {
  const int n = widths.pixel_samples;
  for (int pixel = 0; pixel < widths.pixels; ++pixel) {
    const auto first = static_cast<std::size_t>(pixel * n);
    for (std::size_t s = first; s < first + static_cast<std::size_t>(n); ++s) {
      if (mask.has(s) != mask.has(first)) return false;
      if (mask.has(s) && color(s) != color(first)) return false;
    }
  }
  return true;
}

}  // namespace halfplane
