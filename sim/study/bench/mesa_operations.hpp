// Fragment operations of a state, in OpenGL.
#pragma once

#include <string>

#include "model/scene.hpp"
#include "sim/study/bench/mesa_gl.hpp"

namespace halfplane::gl {

/// The name of a comparison.
[[nodiscard]] Enum comparison(DepthFunc func);

/// Blending, masks, stencil, as the context's state.
void apply_operations(const Functions& gl, const State& state);

/// The alpha test as a statement of a fragment shader that has put the colour into `result`; empty: there is none.
[[nodiscard]] std::string alpha_test_source(const AlphaTest& test);

/// Fog likewise, by the w of the fragment; comes before the alpha test.
[[nodiscard]] std::string fog_source(const State& state);

}  // namespace halfplane::gl
