// Points, lines and polygons cut by planes, and where clip space lies in the window (OpenGL 1.5, 2.11 and 2.12).
#pragma once

#include <array>
#include <span>
#include <vector>

#include "../../model/host/clip.hpp"
#include "vertices.hpp"

namespace halfplane::gl {

using Vertices = std::vector<ShadedVertex>;

/// Inside: the product with a vertex's member is not negative.
struct Plane {
  Vec4 ShadedVertex::*where;
  Vec4 equation;
  bool shows_cut;  ///< the edge along the cut is one of the polygon's
};

/// Near and far, then the sides, so many pixels farther out.
[[nodiscard]] std::array<Plane, 6> view_volume(const ViewportState& viewport, double margin);

/// Points, lines and polygons. Empty: nothing is left.
void clip(Vertices& vertices, std::span<const Plane> planes);
/// A polygon of clip space as the model cuts its triangles.
void clip(Vertices& vertices, const ClipPlanes& planes);

/// As RasterPosition::window.
[[nodiscard]] Vec4 window_position(const ViewportState& viewport, const Vec4& clip);

/// Every member between two vertices in window coordinates: places are linear there, attributes over w.
[[nodiscard]] ShadedVertex window_mix(const ShadedVertex& a, const ShadedVertex& b, double t);

}  // namespace halfplane::gl
