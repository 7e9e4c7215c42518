// Golden clipper: Sutherland-Hodgman on homogeneous coordinates, in the given scalar type.
//
// In: three clip-space vertices. Out: a convex polygon of up to nine, all inside, its first vertex the fan's centre.
// In: two vertices. Out: the part of the segment that is inside.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "../scene.hpp"

namespace halfplane::golden {

template <class Real>
struct ClipVertex {
  std::array<Real, 4> position{};  ///< x, y, z, w
  std::array<Real, 4> rgba{};      ///< 0...255
  std::array<Real, 2> uv{};        ///< texture coordinates
};

/// A half-space: inside where the dot product with the position is >= 0.
template <class Real>
using Plane = std::array<Real, 4>;

template <class Real>
struct Polygon {
  std::array<ClipVertex<Real>, 9> vertex{};  // every plane adds at most one: 3 + 6
  std::size_t count = 0;

  void push(const ClipVertex<Real>& v) {
    if (count < vertex.size()) vertex[count++] = v;  // full only if rounding has made a sliver non-convex
  }
};

template <class Real>
[[nodiscard]] Real distance(const Plane<Real>& plane, const ClipVertex<Real>& v) {
  const auto& p = v.position;
  return plane[0] * p[0] + plane[1] * p[1] + plane[2] * p[2] + plane[3] * p[3];
}

/// The point where an edge meets the plane. Always computed from the inside vertex, so that the two triangles that
/// share the edge get the same point to the last bit.
template <class Real>
[[nodiscard]] ClipVertex<Real> intersect(const Plane<Real>& plane, const ClipVertex<Real>& inside,
                                         const ClipVertex<Real>& outside) {
  const Real from = distance(plane, inside);
  const Real t = from / (from - distance(plane, outside));
  ClipVertex<Real> v;
  for (std::size_t k = 0; k < 4; ++k) {
    v.position[k] = inside.position[k] + t * (outside.position[k] - inside.position[k]);
    v.rgba[k] = inside.rgba[k] + t * (outside.rgba[k] - inside.rgba[k]);
  }
  for (std::size_t k = 0; k < 2; ++k) v.uv[k] = inside.uv[k] + t * (outside.uv[k] - inside.uv[k]);
  return v;
}

template <class Real>
[[nodiscard]] Polygon<Real> clip_to_plane(const Polygon<Real>& in, const Plane<Real>& plane) {
  Polygon<Real> out;
  for (std::size_t i = 0; i < in.count; ++i) {
    const auto& a = in.vertex[i];
    const auto& b = in.vertex[(i + 1) % in.count];
    const bool a_in = distance(plane, a) >= 0, b_in = distance(plane, b) >= 0;
    if (a_in) out.push(a);
    if (a_in && !b_in) out.push(intersect(plane, a, b));
    if (!a_in && b_in) out.push(intersect(plane, b, a));
  }
  return out;
}

/// Near, far and the four sides of the guard band, window coordinates from -limit to limit. The sides remove no pixel,
/// they keep x / w finite; but a cut vertex gets its colour here, so affine colour depends on the place and order of
/// the cuts. Near and far together imply w >= 0.
template <class Real>
[[nodiscard]] std::array<Plane<Real>, 6> clip_planes(ClipZ clip_z, const Viewport& viewport, double limit) {
  // Window x = centre + half * x / w, so -limit <= window x is half * x + (centre + limit) * w >= 0.
  const auto half_x = static_cast<Real>(viewport.width / 2), half_y = static_cast<Real>(viewport.height / 2);
  const double centre_x = viewport.x + viewport.width / 2, centre_y = viewport.y + viewport.height / 2;
  const auto low_x = static_cast<Real>(limit + centre_x), high_x = static_cast<Real>(limit - centre_x);
  const auto low_y = static_cast<Real>(limit + centre_y), high_y = static_cast<Real>(limit - centre_y);
  const Plane<Real> near = clip_z == ClipZ::zero_one ? Plane<Real>{0, 0, 1, 0} : Plane<Real>{0, 0, 1, 1};
  return {near,
          {0, 0, -1, 1},
          {half_x, 0, 0, low_x},
          {-half_x, 0, 0, high_x},
          {0, -half_y, 0, low_y},
          {0, half_y, 0, high_y}};
}

/// `polygon` cut by all planes; `was_cut` tells whether any plane cut the polygon.
template <class Real>
[[nodiscard]] Polygon<Real> clip(Polygon<Real> polygon, std::span<const Plane<Real>> planes, bool& was_cut) {
  was_cut = false;
  for (const auto& plane : planes) {
    bool all_inside = true;
    for (std::size_t i = 0; i < polygon.count; ++i) all_inside &= distance(plane, polygon.vertex[i]) >= 0;
    if (all_inside) continue;
    was_cut = true;
    polygon = clip_to_plane(polygon, plane);
  }
  return polygon;
}

/// Cuts the segment from `a` to `b` by all planes; false when no part is left. `was_cut` as above.
template <class Real>
[[nodiscard]] bool clip_segment(ClipVertex<Real>& a, ClipVertex<Real>& b, std::span<const Plane<Real>> planes,
                                bool& was_cut) {
  for (const auto& plane : planes) {
    const bool a_in = distance(plane, a) >= 0, b_in = distance(plane, b) >= 0;
    if (!a_in && !b_in) return false;
    if (!a_in) a = intersect(plane, b, a);
    if (!b_in) b = intersect(plane, a, b);
    was_cut |= !a_in || !b_in;
  }
  return a.position[3] > 0 && b.position[3] > 0;  // w = 0 is the eye itself
}

/// Whether the vertex is outside near or far, or `whole_volume`: of any plane of the view volume.
template <class Real>
[[nodiscard]] bool is_outside(const ClipVertex<Real>& v, ClipZ clip_z, bool whole_volume) {
  const auto& [x, y, z, w] = v.position;
  const Real near = clip_z == ClipZ::zero_one ? Real(0) : -w;
  if (!(w > 0) || z < near || z > w) return true;
  return whole_volume && (x < -w || x > w || y < -w || y > w);
}

}  // namespace halfplane::golden
