// Golden polygon offset: the displacement of a triangle's plane, from its slope.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include "viewport.hpp"

namespace halfplane::golden {

/// The normal of a flat polygon on the screen, its length twice the area. z > 0: clockwise as seen. 0 for fewer than
/// three corners.
template <class Real>
struct PlaneNormal {
  Real x = 0, y = 0, z = 0;
};

/// Summed over the polygon's fan, so that thin pieces of a clipped triangle count by their area.
template <class Real>
[[nodiscard]] PlaneNormal<Real> plane_normal(std::span<const ScreenVertex<Real>> v) {
  PlaneNormal<Real> n;
  for (std::size_t i = 1; i + 1 < v.size(); ++i) {
    const Real ax = v[i].x - v[0].x, ay = v[i].y - v[0].y, az = v[i].z - v[0].z;
    const Real bx = v[i + 1].x - v[0].x, by = v[i + 1].y - v[0].y, bz = v[i + 1].z - v[0].z;
    n.x += ay * bz - az * by;
    n.y += az * bx - ax * bz;
    n.z += ax * by - ay * bx;
  }
  return n;
}

/// factor * max(|dz/dx|, |dz/dy|) + constant / `depth_max`, in window depth; `offset` holds the factor and the constant
/// in depth LSB. dz/dx of the plane is -x / z of its normal.
template <class Real>
[[nodiscard]] Real polygon_offset(const PlaneNormal<Real>& n, const std::array<double, 2>& offset, Real depth_max) {
  const Real constant = static_cast<Real>(offset[1]) / depth_max;
  if (offset[0] == 0 || n.z == 0) return constant;  // without area: culled
  return static_cast<Real>(offset[0]) * std::max(std::abs(n.x), std::abs(n.y)) / std::abs(n.z) + constant;
}

}  // namespace halfplane::golden
