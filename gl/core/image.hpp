// Pixels on their way between the program's memory and the driver (OpenGL 1.5, 3.6.3 to 3.6.5, 4.3.2).
#pragma once

#include <memory>
#include <vector>

#include "../../model/formats/texture.hpp"
#include "state.hpp"

namespace halfplane::gl {

struct Context;

/// Pixels as real numbers, rows from the bottom as in the program's memory. Colours are RGBA with 1 as the largest integer;
/// depth, stencil and index lie in the first component. Who stores them holds them to their range.
struct Image {
  int width = 0, height = 0, depth = 1;
  GLenum format = GL_RGBA;  ///< GL_RGBA, GL_DEPTH_COMPONENT, GL_STENCIL_INDEX or GL_COLOR_INDEX
  std::vector<std::array<float, 4>> pixel;
  std::vector<Texel> byte = {};  ///< in place of `pixel`, where unpack() keeps bytes
  [[nodiscard]] bool empty() const { return pixel.empty() && byte.empty(); }
};

/// Bits of glBitmap and glPolygonStipple, row 0 at the bottom.
struct Bitmap {
  int width = 0, height = 0;
  std::vector<bool> bit;
};

/// GL_INVALID_ENUM or GL_INVALID_OPERATION when format and type do not go together, else GL_NO_ERROR.
[[nodiscard]] GLenum check_format(GLenum format, GLenum type);

/// Reads the program's memory, by Context::client's unpack state. `is_3d`: of glTexImage3D and glTexSubImage3D, which skip
/// whole images. `keeps_bytes`: colours that are bytes stay so, as textures store them. Null: an image without its pixels, for
/// the errors that its command has. Precondition: check_format().
[[nodiscard]] Image unpack(const Context& context, int width, int height, int depth, GLenum format, GLenum type,
                           const void* pixels, bool is_3d = false, bool keeps_bytes = false);
/// Pixels after glPixelTransfer, which counts when a command is carried out: GL_RGBA for colours and colour indices.
[[nodiscard]] std::shared_ptr<const Image> transferred(const Context& context, std::shared_ptr<const Image> image);
/// Writes to the program's memory, by the pack state. Precondition: check_format().
void pack(const Context& context, const Image& image, GLenum format, GLenum type, void* pixels, bool is_3d = false);
[[nodiscard]] Bitmap unpack_bitmap(const Context& context, int width, int height, const GLubyte* bits);

}  // namespace halfplane::gl
