// Golden rasterization without clipping, in 2D homogeneous coordinates: Olano and Greer, "Triangle Scan Conversion
// using 2D Homogeneous Coordinates", Graphics Hardware 1997.
//
// In: three clip-space vertices, any of them behind the eye. Out: edge functions that are valid only in front of the
// eye. With v = (X, Y, W), window coordinates times w, a pixel (x, y, 1) is sum b_i v_i with b_i = e_i / det, e_0 = v1
// x v2 and so on, and b_i is the weight of vertex i in space over the w of the point seen there. So the point belongs
// to the triangle, in front of the eye, when no b_i is negative; and sum b_i f_i is f / w of that point for any f
// linear in clip space. Vertices are divided by w only for the range of pixels.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "interpolate.hpp"

namespace halfplane::golden {

/// A vertex in window coordinates times w, scaled by a power of two common to its triangle.
template <class Real>
struct HomogeneousVertex {
  Real x = 0, y = 0, w = 0;    ///< pixels, times w
  Real z = 0;                  ///< window depth, times w
  Real near = 0, far = 0;      ///< non-negative on the inner side of the plane
  std::array<Real, 4> rgba{};  ///< 0...255
  std::array<Real, 2> uv{};    ///< texture coordinates
};

/// a x + b y + c in pixels: the cross product of two vertices.
template <class Real>
struct HomogeneousEdge {
  Real a = 0, b = 0, c = 0;

  [[nodiscard]] Real value(Real px, Real py) const { return a * px + b * py + c; }
  /// Left edges grow to the right; top edges are level and grow downwards.
  [[nodiscard]] bool inside(Real e) const { return e > 0 || (e == 0 && (a > 0 || (a == 0 && b > 0))); }
};

/// Both products of a difference swap when the vertices do, so that a shared edge is negated to the last bit.
template <class Real>
[[nodiscard]] HomogeneousEdge<Real> cross(const HomogeneousVertex<Real>& p, const HomogeneousVertex<Real>& q) {
  return {p.y * q.w - q.y * p.w, p.w * q.x - q.w * p.x, p.x * q.y - q.x * p.y};
}

/// A triangle of positive determinant.
template <class Real>
struct HomogeneousSetup {
  std::array<HomogeneousVertex<Real>, 3> v{};
  std::array<HomogeneousEdge<Real>, 3> edge{};  ///< edge[i] is opposite v[i]
  Real determinant = 0;                         ///< before the swap: its sign is the facing, like that of an area
  Real scale = 1;                               ///< of its vertices
  bool is_in_front = false;                     ///< every w > 0: affine colour is meaningful
  bool is_outside = false;                      ///< completely behind the eye, before near or beyond far
};

template <class Real>
[[nodiscard]] HomogeneousVertex<Real> to_homogeneous(const ClipVertex<Real>& v, Real scale, const State& state,
                                                     const Viewport& vp) {
  const Real x = v.position[0] * scale, y = v.position[1] * scale, z = v.position[2] * scale, w = v.position[3] * scale;
  const bool is_zero_one = state.clip_z == ClipZ::zero_one;
  const Real depth = is_zero_one ? z : (z + w) / 2;
  const auto low = static_cast<Real>(state.depth_range[0]), high = static_cast<Real>(state.depth_range[1]);
  return {static_cast<Real>(vp.x) * w + (x + w) / 2 * static_cast<Real>(vp.width),
          static_cast<Real>(vp.y) * w + (w - y) / 2 * static_cast<Real>(vp.height),
          w,
          low * w + (high - low) * depth,
          is_zero_one ? z : z + w,
          w - z,
          v.rgba,
          v.uv};
}

template <class Real>
[[nodiscard]] HomogeneousSetup<Real> setup_homogeneous(const std::array<ClipVertex<Real>, 3>& v, const State& state,
                                                       const Viewport& vp) {
  Real largest = 0;
  for (const auto& corner : v)
    for (const Real p : corner.position) largest = std::max(largest, std::abs(p));
  // A power of two loses no bit, and keeps products of three coordinates within the range of Real.
  const Real scale = largest > 0 ? std::scalbn(Real(1), -std::ilogb(largest)) : Real(0);
  HomogeneousSetup<Real> t;
  for (std::size_t i = 0; i < 3; ++i) t.v[i] = to_homogeneous(v[i], scale, state, vp);
  t.scale = scale;
  t.is_in_front = t.v[0].w > 0 && t.v[1].w > 0 && t.v[2].w > 0;
  const auto none = [&t](auto&& holds) { return !(holds(t.v[0]) || holds(t.v[1]) || holds(t.v[2])); };
  t.is_outside = none([](const auto& p) { return p.w > 0; }) || none([](const auto& p) { return p.near >= 0; }) ||
                 none([](const auto& p) { return p.far >= 0; });
  const auto first = cross(t.v[1], t.v[2]);
  t.determinant = first.a * t.v[0].x + first.b * t.v[0].y + first.c * t.v[0].w;
  if (t.determinant < 0) std::swap(t.v[1], t.v[2]);
  for (std::size_t i = 0; i < 3; ++i) t.edge[i] = cross(t.v[(i + 1) % 3], t.v[(i + 2) % 3]);
  return t;
}

/// The pixels to test: around the vertices, or all of `region` if a vertex has no window position.
template <class Real>
[[nodiscard]] PixelRange homogeneous_range(const HomogeneousSetup<Real>& t, const PixelRange& region,
                                           const Scene& scene) {
  if (t.is_outside) return {};
  if (!t.is_in_front) return region;
  const auto& [p, q, r] = t.v;
  const auto [left, right] = std::minmax({p.x / p.w, q.x / q.w, r.x / r.w});
  const auto [top, bottom] = std::minmax({p.y / p.w, q.y / q.w, r.y / r.w});
  // One pixel wider on all sides: edges, not quotients, decide about a sample on the border.
  return intersect(region, pixel_range(left - 1, top - 1, right + 1, bottom + 1, scene));
}

/// Whether a sample with the edge values `e` belongs to the triangle, between near and far.
template <class Real>
[[nodiscard]] bool covers(const HomogeneousSetup<Real>& t, const std::array<Real, 3>& e) {
  if (!(t.edge[0].inside(e[0]) && t.edge[1].inside(e[1]) && t.edge[2].inside(e[2]))) return false;
  const Real near = e[0] * t.v[0].near + e[1] * t.v[1].near + e[2] * t.v[2].near;
  const Real far = e[0] * t.v[0].far + e[1] * t.v[1].far + e[2] * t.v[2].far;
  return near >= 0 && far >= 0;
}

/// The attributes there. Affine attributes are affine over the whole triangle; with a vertex behind the eye that is
/// meaningless on the screen, and they are interpolated over w.
template <class Real>
[[nodiscard]] Fragment<Real> interpolate(const HomogeneousSetup<Real>& t, const std::array<Real, 3>& e,
                                         InterpolationRules rules) {
  const auto& [v0, v1, v2] = t.v;
  // sum e_i w_i is the determinant; summed from these values, it keeps a depth equal at all vertices to one ulp or so.
  const Real one = e[0] * v0.w + e[1] * v1.w + e[2] * v2.w, inverse_w = e[0] + e[1] + e[2];
  const bool is_affine = rules.color == ColorInterp::affine && t.is_in_front;
  Fragment<Real> f;
  std::array<Slope<Real>, 3> weight;
  for (std::size_t i = 0; i < 3; ++i) {
    const Real w = rules.texture == TextureInterp::affine && t.is_in_front ? t.v[i].w : Real(1);
    weight[i] = {w * e[i], w * t.edge[i].a, w * t.edge[i].b};
  }
  f.texture = texture_at(weight, t.v);
  f.z = (e[0] * v0.z + e[1] * v1.z + e[2] * v2.z) / one;
  f.inverse_w = inverse_w / one * t.scale;
  for (std::size_t c = 0; c < 4; ++c) {
    const Real d1 = v1.rgba[c] - v0.rgba[c], d2 = v2.rgba[c] - v0.rgba[c];
    f.rgba[c] = is_affine ? v0.rgba[c] + (e[1] * v1.w * d1 + e[2] * v2.w * d2) / one
                          : v0.rgba[c] + (e[1] * d1 + e[2] * d2) / inverse_w;
  }
  return f;
}

/// dz/dx and dz/dy of the plane, window depth per pixel.
template <class Real>
[[nodiscard]] std::array<Real, 2> depth_slopes(const HomogeneousSetup<Real>& t) {
  const Real determinant = std::abs(t.determinant);
  std::array<Real, 2> slope{};
  for (std::size_t i = 0; i < 3; ++i) {
    slope[0] += t.edge[i].a * t.v[i].z / determinant;
    slope[1] += t.edge[i].b * t.v[i].z / determinant;
  }
  return slope;
}

}  // namespace halfplane::golden
