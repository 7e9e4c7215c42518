// Smooth raster: how much of each pixel a line's rectangle, or a point, covers.
//
// Host side, binary64, contraction off. A pixel's square is cut by the rectangle's four sides, one after the other
// (Sutherland and Hodgman, CACM 17(1), 1974), and what is left is measured by the shoelace formula. Where the distance of a
// side from the pixel's centre says that it leaves the square whole, or all outside, nothing is cut. The corners are
// exact; each cut rounds, so areas are off by less than 2^-40 pixel^2. A disc's are off by up to 0.004, where a pixel
// holds its top or bottom (tests/unit/smooth_test.cpp).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "../config.hpp"
#include "../packets/packets.hpp"
#include "../scene.hpp"
#include "../stages/cull.hpp"

namespace halfplane {

/// Whether the lines and points of a state are smooth. Where a pixel has several samples nobody looks at the state.
[[nodiscard]] constexpr bool is_smooth(const State& state, const Config& config) {
  return state.smooth && config.msaa_samples == 1;
}

/// A pixel, and how much of it is covered: 1 to kWholePixel.
struct SmoothPixel {
  int x = 0, y = 0;
  std::uint32_t coverage = 0;
};

/// Coverage of a pixel that is covered as a whole: an area is rounded to the nearest of so many parts.
inline constexpr std::uint32_t kWholePixel = 255;

/// The area of a parallelogram in pixel (x, y), 0 to 1. Its corners go round it, of either orientation, on a grid of
/// 2^-grid_bits pixel.
[[nodiscard]] double area_in_pixel(const std::array<SnappedVertex, 4>& corners, int x, int y, int grid_bits);

/// The pixels of `limit` (inclusive) of which a parallelogram covers a part that does not round to 0, row by row.
[[nodiscard]] std::vector<SmoothPixel> smooth_raster(const std::array<SnappedVertex, 4>& corners,
                                                     const PixelBounds& limit, int grid_bits);

/// The area of a point in pixel (x, y), 0 to 1: of its square, or of the disc in it, whose extent is summed over 64 rows of
/// the pixel. `size`: as of point_bounds().
[[nodiscard]] double area_in_pixel(const SnappedVertex& point, std::int32_t size, PointShape shape, int x, int y,
                                   int grid_bits);

/// Likewise the pixels of a point.
[[nodiscard]] std::vector<SmoothPixel> smooth_raster(const SnappedVertex& point, std::int32_t size, PointShape shape,
                                                     const PixelBounds& limit, int grid_bits);

/// The codes of a line beside a pixel: those of the point of the segment that is nearest to the pixel's centre, between the
/// ends' codes and rounded to the nearest. The ends must not lie on each other.
[[nodiscard]] PerPlane<std::uint32_t> codes_beside(const SnappedVertex& start, const SnappedVertex& end, int x, int y,
                                                   const Widths& widths);

}  // namespace halfplane
