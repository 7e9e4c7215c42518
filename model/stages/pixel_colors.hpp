// Pixel colours: blocks of 4x4 pixels with one colour in each pixel lie in memory with one colour per pixel, others
// with one per sample (compress.unit). A bit for each block of the target says which; it is read and changed as
// requests go out, in their order, so that it always describes memory.
//
// An eviction writes a block's new samples. If in each pixel all samples are present and equal, or none is, the block
// is uniform: it is written with one colour per pixel if memory is stale, the whole block is present, or memory holds
// it so already. A block that is not uniform, over one stored with one colour per pixel, needs all its samples from now
// on: the pixels are read and merged. Data is in block_cache.hpp, time in engines/cycle/block_timing.hpp, the hardware
// in rtl_ref/stages/pixel_colors.sv.
#pragma once

#include "clear_flags.hpp"

namespace halfplane {

/// The colours of an evicted block.
struct LeavingColors {
  bool fills = false;      ///< memory is stale, and all of the block is written
  bool is_uniform = true;  ///< in each pixel all samples are present and equal, or none is
  bool is_whole = false;   ///< all of the block is present
};

/// The form in which colours go to memory.
enum class ColorMove : std::uint8_t {
  samples,  ///< colours present, one per sample
  pixels,   ///< colours present, one per pixel
  merge,    ///< all, one colour per sample: missing ones are read, one colour per pixel
};

/// `of_pixels`: the block lies in memory with one colour per pixel.
[[nodiscard]] constexpr ColorMove color_move(const LeavingColors& colors, bool of_pixels) {
  if (colors.is_uniform) return colors.fills || colors.is_whole || of_pixels ? ColorMove::pixels : ColorMove::samples;
  return of_pixels && !colors.fills ? ColorMove::merge : ColorMove::samples;
}

/// Whether in each pixel of a stamp all samples are in `mask` and equal, or none is. color(s): of sample s.
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
