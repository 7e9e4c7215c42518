// Smooth raster: the covered area of each pixel for a line's rectangle, or a point.
//
// Host side, binary64, contraction off. Which of the rectangle's four sides cut a pixel's square is known by their distances
// from its centre. What one side or two opposite ones cut off is a triangle or a trapezoid each; where others meet in the
// square, it is cut by one after the other (Sutherland and Hodgman, CACM 17(1), 1974), and the rest is measured by the
// shoelace formula. The corners are exact; distances and cuts round, so the error of areas is below 2^-40 pixel^2. The error
// for a disc is up to 0.004, in a pixel with its top or bottom (tests/unit/smooth_test.cpp).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "../config.hpp"
#include "../packets/packets.hpp"
#include "../scene.hpp"
#include "../stages/cull.hpp"

namespace halfplane {

/// Whether the lines and points of a state are smooth. Ignored with several samples per pixel.
[[nodiscard]] constexpr bool is_smooth(const State& state, const Config& config) {
  return state.smooth && config.msaa_samples == 1;
}

/// A pixel, and its coverage: 1 to kWholePixel.
struct SmoothPixel {
  int x = 0, y = 0;
  std::uint32_t coverage = 0;
};

/// Coverage of a full pixel: an area is rounded to the nearest multiple of 1/255.
inline constexpr std::uint32_t kWholePixel = 255;

/// The area of a parallelogram in pixel (x, y), 0 to 1. Its corners are in order around it, in either orientation, on a
/// grid of 2^-grid_bits pixel.
[[nodiscard]] double area_in_pixel(const std::array<SnappedVertex, 4>& corners, int x, int y, int grid_bits);

/// A side of a parallelogram: inside where a x + b y + c >= 0, which is the distance from it.
struct SmoothSide {
  double a = 0, b = 0, c = 0;
  double reach = 0;  ///< the largest distance of a pixel's corner from the line through its centre
  double flat = 0, steep = 0, doubled_product = 0;  ///< the smaller and the larger of |a| and |b|, and 2 |a| |b|
};
using SmoothSides = std::array<SmoothSide, 4>;

/// The coverage of `count` pixels, 0 to kWholePixel; -1 where sides meet that are not opposite each other. `x`, `y` and
/// `coverage` have room for 16 more.
using SmoothLanes = void (*)(const SmoothSides& sides, const std::int32_t* x, const std::int32_t* y, std::size_t count,
                             std::int32_t* coverage);

/// The pixels of `limit` (inclusive) whose area covered by a parallelogram does not round to 0, row by row. `lanes`: null, or
/// computes the same many pixels at a time.
[[nodiscard]] std::vector<SmoothPixel> smooth_raster(const std::array<SnappedVertex, 4>& corners,
                                                     const PixelBounds& limit, int grid_bits,
                                                     SmoothLanes lanes = nullptr);

/// The area of a point in pixel (x, y), 0 to 1: of its square, or of the disc in it, whose extent is summed over 64 rows of
/// the pixel. `size`: as of point_bounds().
[[nodiscard]] double area_in_pixel(const SnappedVertex& point, std::int32_t size, PointShape shape, int x, int y,
                                   int grid_bits);

/// Likewise the pixels of a point.
[[nodiscard]] std::vector<SmoothPixel> smooth_raster(const SnappedVertex& point, std::int32_t size, PointShape shape,
                                                     const PixelBounds& limit, int grid_bits);

/// The codes of a line at a nearby pixel: at the point of the segment nearest to the pixel's centre, interpolated
/// between the ends' codes and rounded to the nearest. The ends must not coincide.
class CodesBeside {
 public:
  CodesBeside(const SnappedVertex& start, const SnappedVertex& end, const Widths& widths);
  /// Until the next call.
  [[nodiscard]] const PerPlane<std::uint32_t>& operator()(int x, int y);

 private:
  [[nodiscard]] std::uint32_t code(std::size_t plane, std::int64_t part, double ratio) const;

  PerPlane<std::uint32_t> start_, end_, codes_;
  // (pixel centre - start) . (end - start), subpixels squared: at pixel (0, 0), its steps to the next pixel in x and in y, and
  // at the end of the line.
  std::int64_t at_zero_, per_x_, per_y_, whole_;
  PerPlane<std::size_t> changing_{};  ///< planes whose codes differ
  std::size_t changing_count_ = 0;
};

}  // namespace halfplane
