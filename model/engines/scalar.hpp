// The scalar engine: the stages, one triangle and one stamp at a time. Slow, short, and the specification of every other
// engine.
#pragma once

#include "render.hpp"

namespace halfplane {

/// As render_functional, with the same image, counts and ids, bit for bit. Has every traversal (the same image from
/// each), fill rule and fault of RenderOptions::rules. Clipping::homogeneous draws clip-space triangles by homogeneous_setup
/// instead: no primitive is cut, no triangle is kept; window-space ones, lines and points are drawn as ever.
[[nodiscard]] Rendering render_scalar(const Scene& scene, const Config& config, const RenderOptions& options = {});

}  // namespace halfplane
