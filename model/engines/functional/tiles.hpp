// The functional engine's plain path: one triangle after the other, every tile of it. It has what the fast path has not:
// counts, ids, taps, every tile size, more depth and reciprocal bits, depth formats, and vertices of surfaces that are not
// in front of the eye.
#pragma once

#include "../render.hpp"

namespace halfplane {

/// As render_functional.
[[nodiscard]] Rendering render_tiles(const Scene& scene, const Config& config, const RenderOptions& options);

}  // namespace halfplane
