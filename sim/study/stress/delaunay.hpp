// Delaunay triangulations in exact arithmetic: meshes that tile a rectangle, for any points.
#pragma once

#include <array>
#include <functional>
#include <set>
#include <vector>

#include "sim/study/stress/check.hpp"

namespace halfplane::stress {

using Corner = std::array<Point, 3>;
using Mesh = std::vector<Corner>;

/// Twice the signed area; positive is clockwise with y down.
[[nodiscard]] inline std::int64_t doubled_area(Point a, Point b, Point c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// The Delaunay triangulation of the points and the rectangle's corners, triangles of positive area. Points must lie
/// strictly inside the rectangle; |coordinates| < 2^29. Bowyer and Watson's insertion (Computer Journal 24(2), 1981)
/// with a walk to the triangle at the point: about n^1.5 for sorted points. `poll` is called from time to time and may
/// end the work by throwing; may be empty.
[[nodiscard]] Mesh delaunay(Point low, Point high, const std::set<Point>& points,
                            const std::function<void()>& poll = {});

}  // namespace halfplane::stress
