// The triangles of a clipped polygon, after the snap: a fan about one of its corners.
#pragma once

#include <cstdint>
#include <span>

#include "../stages/cull.hpp"

namespace halfplane {

/// Twice the area of the piece i >= 1 of a polygon's fan about the corner `start`.
[[nodiscard]] inline std::int64_t fan_area(std::span<const SnappedVertex> polygon, std::size_t start, std::size_t i) {
  const std::size_t size = polygon.size();
  return signed_area(polygon[start % size], polygon[(start + i) % size], polygon[(start + i + 1) % size]);
}

[[nodiscard]] inline std::int64_t total_area(std::span<const SnappedVertex> polygon) {
  std::int64_t sum = 0;
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) sum += fan_area(polygon, 0, i);
  return sum;
}

/// The start of the fan of a polygon with more than three corners. The snap can dent a convex polygon by a subpixel, and a
/// fan across the dent would draw some pixels twice; a fan with no reversed piece covers the polygon exactly once. Among
/// the corners with such a fan, or among all if there is none, the smallest (Y, X, Z): the result must not depend on the
/// order of the vertices.
[[nodiscard]] inline std::size_t fan_start(std::span<const SnappedVertex> polygon) {
  const std::int64_t area = total_area(polygon);
  std::size_t best = 0;
  bool best_agrees = false;
  for (std::size_t start = 0; start < polygon.size(); ++start) {
    bool agrees = true;
    for (std::size_t i = 1; i + 1 < polygon.size() && agrees; ++i) {
      const std::int64_t piece = fan_area(polygon, start, i);
      agrees = piece == 0 || (piece > 0) == (area > 0);
    }
    const bool is_smaller = canonically_before(polygon[start], polygon[best]);
    if (agrees == best_agrees ? is_smaller : agrees) {
      best = start;
      best_agrees = agrees;
    }
  }
  return best;
}

}  // namespace halfplane
