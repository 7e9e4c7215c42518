// Polygons into triangles by ear clipping: convex, concave, with points on straight edges or touching points.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim/scene/vec3.hpp"

namespace halfplane {

/// Longest polygon that triangulate_polygon takes unless it is convex: its cost grows with the square.
inline constexpr std::size_t kLargestConcavePolygon = 4096;

/// Splits the polygon through `corners` (in order, 3 or more) into corners.size() - 2 triangles of corner numbers, each
/// wound like the polygon, and appends them. No corner is added or left out: a corner on a straight edge becomes the
/// corner of some triangle, so that the neighbour across the edge stays joined. A polygon without area, or the rest of
/// a self-intersecting one, becomes a fan. False (and nothing appended) for a polygon that is too large.
[[nodiscard]] bool triangulate_polygon(std::span<const Vec3> corners,
                                       std::vector<std::array<std::uint32_t, 3>>& triangles);

}  // namespace halfplane
