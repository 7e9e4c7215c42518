// The exact oracle for lines: pixel by pixel, straight from each rule's definition. No stepping, no octants, no code shared
// with the stages: each pixel is tested independently of its neighbours.
//
// Bounds: as in exact.hpp; with |X|, |Y| < 2^31 every product is below 2^70.
#pragma once

#include "../scene.hpp"
#include "exact.hpp"

namespace halfplane::exact {

/// A line from `start` to `end`, in units of 2^-grid_bits pixel, grid_bits >= 1 (Widths::grid_bits).
struct Line {
  SnappedVertex start, end;
  LineRule rule = LineRule::diamond;
  bool drops_last = true;  ///< must be true for diamond exit
  int grid_bits = 1;
};

/// Whether the line covers pixel (x, y). midpoint, bresenham: its centre is within half a pixel of the line through the
/// centres of the two end pixels, measured across the major axis, and between the ends; of two centres at exactly half
/// a pixel the one on the left end's side counts. diamond: the segment, moved by (-e, -e^2) for every small enough e >
/// 0, meets the open diamond |x - x_c| + |y - y_c| < 1/2, and does not end in it.
[[nodiscard]] bool covers(const Line& line, int x, int y);

/// An attribute that runs from `from` at the start to `to` at the end, at the pixel's major coordinate, clamped to the
/// two. A line without length has its start's value.
[[nodiscard]] Rational plane_at(const Line& line, int x, int y, std::int64_t from, std::int64_t to);

/// Depth at the pixel's major coordinate, clamped to the ends; in LSB. A line without length has its start's depth.
[[nodiscard]] Rational depth_at(const Line& line, int x, int y);

/// The same for one channel of the colour, in LSB of 8 bits.
[[nodiscard]] Rational color_at(const Line& line, int x, int y, int channel);

}  // namespace halfplane::exact
