// Supersampling by accumulation: the scene drawn repeatedly, moved by a fraction of a pixel, and the mean of the
// pictures.
//
// N x N pictures, one for each place of a grid in the pixel: textures, depth and blending are as fine as coverage, and
// lines and points keep their size. Each channel of a pixel is (sum + n/2) / n of the n stored values: the box filter
// over the pixel.
#pragma once

#include <functional>
#include <string_view>
#include <vector>

#include "model/engines/render.hpp"

namespace halfplane::antialiasing {

/// `side` x `side` places: in rows and columns, or rotated, so that no two of them share a row or a column.
struct SupersampleGrid {
  int side = 1;
  bool is_rotated = false;
};

/// Reads `NxN` or `NxN:rotated`, N from 2 to 8. Throws InputError.
[[nodiscard]] SupersampleGrid parse_supersample(std::string_view text);

/// A place in a pixel, from its upper left corner, 0 to 1.
struct Place {
  double x = 0, y = 0;
};
[[nodiscard]] std::vector<Place> places_of(const SupersampleGrid& grid);

/// The scene moved so that its pixel centres are at the given places of its pixels.
[[nodiscard]] Scene seen_from(Scene scene, const Place& place);

/// Draws the scene from each place of the grid and returns the first rendering with the mean of all colours, the sum of all
/// counts and times.
[[nodiscard]] Rendering supersampled(const Scene& scene, const Config& config, const SupersampleGrid& grid,
                                     const std::function<Rendering(const Scene&)>& draw);

}  // namespace halfplane::antialiasing
