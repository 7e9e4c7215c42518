// Textures of a Scene in OpenGL: images, samplers, and what a shader does with a texel.
#pragma once

#include <string>
#include <vector>

#include "model/scene.hpp"
#include "sim/study/bench/mesa_gl.hpp"

namespace halfplane::gl {

/// The scene's textures, all their levels, decoded.
[[nodiscard]] std::vector<Name> make_textures(const Functions& gl, const Scene& scene);

/// Binds the texture and gives it the state's filters, borders and levels.
void apply_texture(const Functions& gl, Name texture, const State& state);

/// GLSL: of `vec4 color` and `vec4 texel`, as OpenGL ES 1.1 combines them.
[[nodiscard]] std::string combine_source(TextureCombine combine, bool has_alpha);

}  // namespace halfplane::gl
