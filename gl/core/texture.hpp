// Textures as the driver keeps them, and as the model takes them (texture.cpp, texture_upload.cpp).
#pragma once

#include <cstdint>
#include <optional>

#include "../../model/scene.hpp"
#include "image.hpp"
#include "objects.hpp"

namespace halfplane::gl {

struct Context;

/// The texture that a unit samples: of the last target that is enabled, when it is complete. Null: none.
[[nodiscard]] const TextureObject* sampled_texture(const Context& context, int unit);
/// The object bound to `target` of the active unit; null and GL_INVALID_ENUM for what is no target.
[[nodiscard]] TextureObject* bound_texture(Context& context, GLenum target);

/// An image as an internal format keeps it. None: the format is none.
[[nodiscard]] std::optional<TextureImage> stored_image(const Image& image, GLint internal_format, int border);

/// Fills texture, filters, wraps, level of detail and combine mode of `state` as the unit's texture and environment ask,
/// and says by Frame::missing() what the model has not. `scale_color`: what the vertices' colour is multiplied with first
/// (GL_REPLACE is modulate with white where the base format has no alpha, so {1, 1, 1, 0} then replaces RGB alone).
struct TextureUse {
  bool replaces_rgb = false, replaces_alpha = false;  ///< the vertex's colour counts as 1 there
};
[[nodiscard]] TextureUse use_texture(Context& context, halfplane::State& state);

}  // namespace halfplane::gl
