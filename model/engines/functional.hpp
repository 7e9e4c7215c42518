// The functional engine: the image, fast, without time. Whole tiles at a time; bit-identical to the stages.
#pragma once

#include "render.hpp"

namespace halfplane {

/// Renders every command of `scene` in program order. Throws InputError for a scene that this configuration cannot take:
/// a target that is too large, a window-space vertex outside the guard band, a state that the engine does not have.
[[nodiscard]] Rendering render_functional(const Scene& scene, const Config& config, const RenderOptions& options = {});

}  // namespace halfplane
