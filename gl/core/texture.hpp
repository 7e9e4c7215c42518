// Textures as the driver keeps them, and as the model takes them (texture.cpp, texture_upload.cpp).
#pragma once

#include <cstdint>
#include <functional>
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

/// Whether sampling finds all images that the filters ask for (OpenGL 1.5, 3.8.10).
[[nodiscard]] bool is_complete(const TextureObject& texture);

/// An image as an internal format keeps it, without its border. None: the format is none.
[[nodiscard]] std::optional<TextureImage> stored_image(const Image& image, GLint internal_format, int border);

/// Fills texture, filters, wraps, level of detail and combine mode of `state` as the unit's texture and environment ask,
/// and reports by Frame::missing() what the model lacks. Where the result says so, vertices are white or opaque: GL_REPLACE
/// by a texture without alpha is modulate with white, which leaves alpha.
struct TextureUse {
  bool replaces_rgb = false, replaces_alpha = false;  ///< the vertex's colour counts as 1 there
};
[[nodiscard]] TextureUse use_texture(Context& context, halfplane::State& state);

/// The function that the unit's texture applies to colors of fragments at the raster position, where it is magnified. Empty: no
/// texture. Valid while the state of the context stays.
[[nodiscard]] std::function<Vec4(const Vec4&)> raster_texture(const Context& context);

}  // namespace halfplane::gl
