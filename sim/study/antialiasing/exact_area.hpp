// The exact area reference: the part of a pixel that a triangle covers, in rationals.
//
// The triangle is the snapped one. It is clipped against the four sides of the pixel, as a polygon whose corners are
// rational, and measured by the shoelace formula: no sample, no rounding, no code of the engines.
#pragma once

#include <gmpxx.h>

#include <vector>

#include "model/packets/packets.hpp"
#include "model/scene.hpp"

namespace halfplane::antialiasing {

/// The area of the triangle inside pixel (x, y), 0 to 1 pixels^2. Coordinates of 2^-grid_bits pixel; either orientation.
[[nodiscard]] mpq_class covered_area(const Triangle& triangle, int x, int y, int grid_bits);

/// The sum of covered_area() over triangles in every pixel of a target, width * height, rows from the top. For disjoint
/// triangles it is their coverage of the pixel.
[[nodiscard]] std::vector<double> covered_areas(const std::vector<Triangle>& triangles, int width, int height,
                                                int grid_bits);

}  // namespace halfplane::antialiasing
