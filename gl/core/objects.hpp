// Objects that contexts share: textures, display lists, buffer objects (OpenGL 1.5, 5.4 and 2.9).
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "../../model/formats/texture.hpp"
#include "state.hpp"

namespace halfplane::gl {

class DisplayList;  // list.hpp

/// One image of a texture, as it is stored: 8 bits a channel, channels that the base format lacks filled in as for sampling
/// (OpenGL 1.5, table 3.21: LUMINANCE is L L L 1, ALPHA 1 1 1 A for modulate, INTENSITY I I I I).
struct TextureImage {
  int width = 0, height = 0, depth = 0, border = 0;  ///< without the border; 0: no image
  GLint internal_format = 1;                         ///< as the program asked
  GLenum base_format = GL_LUMINANCE;  ///< GL_ALPHA, LUMINANCE, LUMINANCE_ALPHA, INTENSITY, RGB, RGBA, DEPTH_COMPONENT
  std::vector<Texel> texel;           ///< row 0 at t = 0; of depth textures texel_of_depth()
};

inline constexpr GLenum kTextureCropRect = 0x8b9d;  ///< GL_TEXTURE_CROP_RECT_OES

/// The state of a texture that GL_TEXTURE_BIT saves.
struct TextureParameters {
  GLenum min_filter = GL_NEAREST_MIPMAP_LINEAR, mag_filter = GL_LINEAR;
  std::array<GLenum, 3> wrap{GL_REPEAT, GL_REPEAT, GL_REPEAT};
  Vec4 border_color{0, 0, 0, 0};
  double min_lod = -1000, max_lod = 1000, lod_bias = 0, priority = 1;
  int base_level = 0, max_level = 1000;
  bool generate_mipmap = false;
  GLenum compare_mode = GL_NONE, compare_func = GL_LEQUAL, depth_mode = GL_LUMINANCE;
  std::array<int, 4> crop{};  ///< GL_TEXTURE_CROP_RECT_OES: x, y, width, height in texels
};

struct TextureObject : TextureParameters {
  GLuint name = 0;
  GLenum target = 0;  ///< 0 until it is bound for the first time
  /// Levels of each face: one face, or the six of a cube map.
  std::array<std::vector<TextureImage>, 6> face;
  std::uint64_t revision = 0;  ///< raised by every change of an image; unique over all textures
};

struct BufferObject {
  std::vector<std::byte> data;
  GLenum usage = GL_STATIC_DRAW, access = GL_READ_WRITE;
  bool mapped = false;
};

struct SharedObjects {
  std::mutex mutex;                                           ///< held by each entry point that looks here
  std::map<GLuint, std::shared_ptr<TextureObject>> textures;  ///< null: a name without an object yet, as of buffers
  std::map<GLuint, std::shared_ptr<DisplayList>> lists;
  std::map<GLuint, std::shared_ptr<BufferObject>> buffers;

  /// The buffer of a name; null: none. Not while `mutex` is held.
  [[nodiscard]] std::shared_ptr<BufferObject> buffer(GLuint name) {
    const std::lock_guard lock(mutex);
    const auto found = buffers.find(name);
    return found == buffers.end() ? nullptr : found->second;
  }
};

}  // namespace halfplane::gl
