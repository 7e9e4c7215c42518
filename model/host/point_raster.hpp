// Point raster: the pixels of a point as boxes: rectangles of one depth and one colour (PrimitiveKind::rectangle), a
// single one for a square point, one per row for a round point.
//
// A point of size n covers the pixels whose centres lie in [X - n/2, X + n/2) x [Y - n/2, Y + n/2): left and top border
// in, right and bottom out, as in the fill rule. Whole sizes cover n x n pixels at any position, and adjacent points
// share no pixel.
//
// A round point covers the pixels of the square whose centres lie in its disc, (x - X)^2 + (y - Y)^2 <= (n/2)^2: none,
// if it is small and lies between them.
#pragma once

#include "../fixed.hpp"
#include "../scene.hpp"
#include "../stages/cull.hpp"

namespace halfplane {

/// The first pixel whose centre is at or after a border; in halves of a subpixel, so that the border of an odd size is
/// an integer and the centre of pixel i is at (2 i + 1) 2^grid_bits.
[[nodiscard]] constexpr int first_centre(std::int64_t border, int grid_bits) {
  const std::int64_t centre = std::int64_t{1} << grid_bits, pixel = 2 * centre;
  // The last pixel whose centre is before the border: one less than the first one not before it.
  return static_cast<int>((border - centre + pixel - 1) >> (grid_bits + 1));
}

/// The pixels of the point's square inside `limit`; may be empty. `size`: the side, in subpixels of 2^-grid_bits pixel,
/// at least one pixel, so that no point falls between the centres; X, Y, size: any in a legal guard band.
[[nodiscard]] constexpr PixelBounds point_bounds(const SnappedVertex& point, std::int32_t size,
                                                 const PixelBounds& limit, int grid_bits) {
  const auto first = [grid_bits](std::int64_t border) { return first_centre(border, grid_bits); };
  const std::int64_t x = 2 * std::int64_t{point.x}, y = 2 * std::int64_t{point.y};
  return {std::max(limit.left, first(x - size)), std::max(limit.top, first(y - size)),
          std::min(limit.right, first(x + size) - 1), std::min(limit.bottom, first(y + size) - 1)};
}

/// Calls visit(box) for the boxes of a point's pixels, from top to bottom. `box`: its square's pixels, from
/// point_bounds().
template <class Visit>
void for_each_run(const SnappedVertex& point, std::int32_t size, PointShape shape, const PixelBounds& box,
                  int grid_bits, Visit&& visit) {
  if (box.is_empty()) return;
  if (shape == PointShape::square) return visit(box);
  // In halves of a subpixel, as above: the radius is `size`.
  const auto centre = [grid_bits](std::int64_t i) { return (2 * i + 1) * (std::int64_t{1} << grid_bits); };
  const auto root_of = [](std::int64_t square) {
    return static_cast<std::int64_t>(integer_sqrt(static_cast<std::uint64_t>(square)));
  };
  const std::int64_t x = 2 * std::int64_t{point.x}, y = 2 * std::int64_t{point.y}, radius = size;
  for (int row = box.top; row <= box.bottom; ++row) {
    const std::int64_t dy = centre(row) - y, reach = root_of(radius * radius - dy * dy);
    PixelBounds run{box.left, row, box.right, row};
    run.left = std::max<int>(run.left, first_centre(x - reach, grid_bits));
    run.right = std::min<int>(run.right, first_centre(x + reach + 1, grid_bits) - 1);
    if (!run.is_empty()) visit(run);
  }
}

}  // namespace halfplane
