// OpenGL ES-CM 1.1 where it is not a part of OpenGL 1.5: names that glext.h lacks, what it refuses, and textures with palettes.
#pragma once

#include <array>

#include "context.hpp"

namespace halfplane::gl {

// GL_OES_point_size_array.
inline constexpr GLenum kPointSizeArray = 0x8b9c, kPointSizeArrayType = 0x898a, kPointSizeArrayStride = 0x898b,
                        kPointSizeArrayPointer = 0x898c, kPointSizeArrayBufferBinding = 0x8b9f;
/// GL_MODELVIEW_MATRIX_FLOAT_AS_INT_BITS_OES of GL_OES_matrix_get; those of the projection and the texture follow it.
inline constexpr GLenum kModelviewBits = 0x898d;
/// GL_PALETTE4_RGB8_OES; nine more formats follow it.
inline constexpr GLenum kFirstPalette = 0x8b90;
inline constexpr GLenum kPalettes = 10;

inline constexpr const char* kEmbeddedVersion = "OpenGL ES-CM 1.1 Halfplane 0.1";
inline constexpr const char* kEmbeddedExtensions =
    "GL_EXT_blend_minmax GL_OES_byte_coordinates GL_OES_compressed_paletted_texture GL_OES_draw_texture "
    "GL_OES_element_index_uint GL_OES_fixed_point GL_OES_matrix_get GL_OES_point_size_array GL_OES_point_sprite "
    "GL_OES_read_format GL_OES_single_precision GL_OES_stencil_wrap GL_OES_texture_env_crossbar "
    "GL_OES_texture_mirrored_repeat";

/// Whether a context takes `cap` in glEnable: any, or one of OpenGL ES (get.cpp).
[[nodiscard]] bool takes_enable(const Context& context, GLenum cap);
/// Whether OpenGL ES takes the type of an array; `is_color`: of colours.
[[nodiscard]] bool takes_array_type(GLenum type, bool is_color);
/// The last mode of glBegin that draws may have.
[[nodiscard]] GLenum last_mode(const Context& context);

/// glCompressedTexImage2D: GL_OES_compressed_paletted_texture, in a context of OpenGL ES alone.
void enter_compressed_image(Context& context, GLenum target, GLint level, GLenum format, GLsizei width, GLsizei height,
                            GLint border, GLsizei bytes, const void* data);

}  // namespace halfplane::gl
