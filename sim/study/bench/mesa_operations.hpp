// Fragment operations of a state, in OpenGL.
#pragma once

#include <string>
#include <vector>

#include "model/scene.hpp"
#include "sim/study/bench/mesa_gl.hpp"

namespace halfplane::gl {

// Textures of a Scene in OpenGL: images, samplers, and their use in a shader.

/// The scene's textures, all their levels, decoded.
[[nodiscard]] std::vector<Name> make_textures(const Functions& gl, const Scene& scene);

/// Binds the texture and gives it the state's filters, borders and levels.
void apply_texture(const Functions& gl, Name texture, const State& state);

/// GLSL that combines `vec4 color` and `vec4 texel` as OpenGL ES 1.1 does.
[[nodiscard]] std::string combine_source(const State& state, bool has_alpha);

/// The name of a comparison.
[[nodiscard]] Enum comparison(DepthFunc func);

/// Sets blending, masks and stencil as the context's state.
void apply_operations(const Functions& gl, const State& state);

/// The alpha test as a statement of a fragment shader with the colour in `result`; empty: no test.
[[nodiscard]] std::string alpha_test_source(const AlphaTest& test);

/// Likewise fog, by the w of the fragment; before the alpha test.
[[nodiscard]] std::string fog_source(const State& state);

}  // namespace halfplane::gl
