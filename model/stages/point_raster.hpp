// Point raster: the pixels of a square point, as a box: what is drawn is a rectangle of one depth and one colour
// (PrimitiveKind::rectangle).
//
// A point of size n covers the pixels whose centres lie in [X - n/2, X + n/2) x [Y - n/2, Y + n/2): left and top border
// in, right and bottom out, as the fill rule has it. Whole sizes cover n x n pixels wherever the point lies, and points
// side by side share none.
#pragma once

#include "cull.hpp"

namespace halfplane {

/// The pixels inside `limit`; empty when there are none. `size`: the side, in subpixels of 2^-grid_bits pixel, at least
/// one pixel, so that no point falls between the centres; X, Y, size: any in a legal guard band.
[[nodiscard]] constexpr PixelBounds point_bounds(const SnappedVertex& point, std::int32_t size,
                                                 const PixelBounds& limit, int grid_bits) {
  // In halves of a subpixel: the border of an odd size is an integer, the centre of pixel i is at (2 i + 1) 2^s.
  const std::int64_t centre = std::int64_t{1} << grid_bits, pixel = 2 * centre;
  // The first pixel whose centre is at or behind the border: the last one that is not ends just before the next.
  const auto first = [&](std::int64_t border) {
    return static_cast<int>((border - centre + pixel - 1) >> (grid_bits + 1));
  };
  const std::int64_t x = 2 * std::int64_t{point.x}, y = 2 * std::int64_t{point.y};
  return {std::max(limit.left, first(x - size)), std::max(limit.top, first(y - size)),
          std::min(limit.right, first(x + size) - 1), std::min(limit.bottom, first(y + size) - 1)};
}

}  // namespace halfplane
