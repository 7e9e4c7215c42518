// Clip: a triangle in homogeneous clip coordinates in, a convex polygon out; a line in, the part of it inside out.
//
// Host side, binary64, contraction off. Planes: near and far of the view volume, then the four sides of the guard band
// (at the largest snapped coordinate). An edge is cut only where it leaves the guard band, so most triangles that cross
// the border of the screen keep their edges and the scissor does the rest.
//
// Exactly-once: the cut of an edge depends on its two ends alone. The parameter is always computed from the inside end,
// so both triangles on the edge get the identical new vertex, in either direction.
#pragma once

#include <array>
#include <optional>

#include "../config.hpp"
#include "../scene.hpp"

namespace halfplane {

/// Inside: a x + b y + c z + d w >= 0.
struct ClipPlane {
  double a = 0, b = 0, c = 0, d = 0;
};

/// near, far, left, right, top, bottom.
using ClipPlanes = std::array<ClipPlane, 6>;

/// A triangle cut by six planes has at most nine corners.
struct ClipPolygon {
  std::array<Vertex, 9> v;
  int size = 0;
};

[[nodiscard]] inline double distance(const ClipPlane& p, const Vertex& v) {
  return p.a * v.x + p.b * v.y + p.c * v.z + p.d * v.w;
}

/// Distance of the guard band's sides from 0, pixels: the largest snapped coordinate.
[[nodiscard]] double guard_band_limit(const Config& config);

/// The clip planes: near, far, and the guard band as seen through `viewport`, its sides `limit` pixels from 0.
[[nodiscard]] ClipPlanes guard_band_planes(ClipZ clip_z, const Viewport& viewport, double limit);

[[nodiscard]] ClipPlanes view_volume_planes(ClipZ clip_z);

/// The same with its sides `margin` pixels farther out, as seen through `viewport`. A vertex outside the volume itself
/// may still snap to a pixel centre inside the viewport, half a subpixel away; with a margin of a pixel, a primitive
/// outside one plane covers no pixel.
[[nodiscard]] ClipPlanes view_volume_planes(ClipZ clip_z, const Viewport& viewport, double margin);

/// One bit per plane that has the vertex outside (Cohen and Sutherland). A triangle with a bit common to all three
/// codes is outside; a triangle with no bit in any code needs no cut.
[[nodiscard]] inline unsigned outcode(const ClipPlanes& planes, const Vertex& v) {
  unsigned code = 0;
  for (std::size_t i = 0; i < planes.size(); ++i) code |= (distance(planes[i], v) >= 0 ? 0U : 1U) << i;
  return code;
}

/// The part of the triangle inside all planes, corners in the triangle's order. Empty when no part with w > 0 is left.
[[nodiscard]] ClipPolygon clip(const ClipPlanes& planes, const Vertex& a, const Vertex& b, const Vertex& c);

/// The part of the line inside all planes, from `a` towards `b`; none when no part with w > 0 is left.
[[nodiscard]] std::optional<std::array<Vertex, 2>> clip(const ClipPlanes& planes, const Vertex& a, const Vertex& b);

/// The part of a line of window space with both coordinates in [-limit, limit]; none when the line lies outside.
[[nodiscard]] std::optional<std::array<Vertex, 2>> clip_to_square(double limit, const Vertex& a, const Vertex& b);

}  // namespace halfplane
