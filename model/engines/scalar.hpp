// The scalar engine: the stages, one triangle and one stamp at a time. Slow, short, and the specification of every other
// engine.
#pragma once

#include "render.hpp"

namespace halfplane {

/// Like render_functional, with the same image, counts and ids, bit for bit. Supports every traversal (the same image
/// from each), fill rule and fault of RenderOptions::rules. Clipping::homogeneous draws clip-space triangles by
/// homogeneous_setup instead: no primitive is cut, no triangle is kept; window-space triangles, lines and points are
/// drawn as usual.
[[nodiscard]] Rendering render_scalar(const Scene& scene, const Config& config, const RenderOptions& options = {});

}  // namespace halfplane
