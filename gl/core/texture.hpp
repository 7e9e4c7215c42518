// Textures as the driver keeps them, and as the model takes them (texture.cpp, texture_upload.cpp).
#pragma once

#include <optional>

#include "../../model/scene.hpp"
#include "image.hpp"
#include "objects.hpp"

namespace halfplane::gl {

struct Context;

/// The texture that a unit samples: of the last target that is enabled, when it is complete. Null: none.
[[nodiscard]] const TextureObject* sampled_texture(const Context& context, int unit);
/// The object bound to `target` of the active unit; null and GL_INVALID_ENUM for an unknown target.
[[nodiscard]] TextureObject* bound_texture(Context& context, GLenum target);

/// RGBA as 8 bits a channel, held to 0...1.
[[nodiscard]] Texel texel_of(const std::array<float, 4>& color);

/// Depth textures keep 32 bits in the four channels of a texel, the highest in the first.
[[nodiscard]] double depth_of_texel(const Texel& texel);
/// A colour as a texel of a base format (TextureImage).
[[nodiscard]] Texel stored_texel(GLenum base, const Texel& color);
/// The border's colour as a texel of the base format.
[[nodiscard]] Texel border_texel(const TextureObject& texture);

/// Whether sampling finds all images that the filters ask for (OpenGL 1.5, 3.8.10).
[[nodiscard]] bool is_complete(const TextureObject& texture);

/// The units whose texture is on and complete: bit by bit.
[[nodiscard]] unsigned textured_units(const Context& context);

/// What of the context's textures and environments the model's texture unit does not have, so that fragments are shaded on
/// the host (host_shader.hpp). Null: it has all of it.
[[nodiscard]] const char* beyond_texture_unit(Context& context, unsigned units);

/// Fills texture, filters, wraps, level of detail and combine mode of `state` as the texture and environment of `unit` ask,
/// and says by Frame::missing() what the model has not. Where the result says so, vertices are white or opaque: GL_REPLACE
/// by a texture without alpha is modulate with white, which leaves alpha. Precondition: beyond_texture_unit() is null.
struct TextureUse {
  bool replaces_rgb = false, replaces_alpha = false;  ///< the vertex's colour counts as 1 there
};
[[nodiscard]] TextureUse use_texture(Context& context, std::size_t unit, halfplane::State& state);

}  // namespace halfplane::gl
