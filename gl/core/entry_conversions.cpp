#include "entry_conversions.hpp"

#include <array>

namespace halfplane::gl {
namespace {

constexpr GLsizei kLargestImage = kLargestTexture + 2;  // with its border

// Unpacks an image and hands it to `command`, or issues an error. `dimensions`: of a texture; 0: for none.
template <class Command>
void with_image(Context& context, std::array<GLsizei, 3> size, GLenum format, GLenum type, const void* pixels,
                const Command& command, int dimensions = 0) {
  const auto [width, height, depth] = size;
  if (width < 0 || height < 0 || depth < 0) return list_error(context, GL_INVALID_VALUE);
  if (const GLenum error = check_format(format, type); error != GL_NO_ERROR) return list_error(context, error);
  command(std::make_shared<const Image>(
      unpack(context, width, height, depth, format, type, pixels, dimensions == 3, dimensions != 0)));
}

bool is_proxy(GLenum target) {
  return target == GL_PROXY_TEXTURE_1D || target == GL_PROXY_TEXTURE_2D || target == GL_PROXY_TEXTURE_3D ||
         target == GL_PROXY_TEXTURE_CUBE_MAP;
}

}  // namespace

void enter_draw_pixels(Context& context, GLsizei width, GLsizei height, GLenum format, GLenum type,
                       const void* pixels) {
  with_image(context, {width, height, 1}, format, type, pixels,
             [&](const std::shared_ptr<const Image>& image) { issue<&draw_pixels>(context, image); });
}

void enter_bitmap(Context& context, GLsizei width, GLsizei height, double x_origin, double y_origin, double x_move,
                  double y_move, const GLubyte* bits) {
  if (width < 0 || height < 0) return list_error(context, GL_INVALID_VALUE);
  if (bits == nullptr) width = height = 0;  // the raster position moves
  auto bitmap_bits = std::make_shared<const Bitmap>(unpack_bitmap(context, width, height, bits));
  issue<&bitmap>(context, bitmap_bits, x_origin, y_origin, x_move, y_move);
}

void enter_polygon_stipple(Context& context, const GLubyte* mask) {
  const Bitmap bits = unpack_bitmap(context, 32, 32, mask);
  std::array<std::uint32_t, 32> rows{};
  for (std::size_t i = 0; i < bits.bit.size(); ++i) rows[i / 32] |= std::uint32_t{bits.bit[i]} << (31 - i % 32);
  issue<&polygon_stipple>(context, rows);
}

void enter_tex_image(Context& context, int dimensions, GLenum target, GLint level, GLint internal_format, GLsizei width,
                     GLsizei height, GLsizei depth, GLint border, GLenum format, GLenum type, const void* pixels) {
  // Too large an image is refused by the command, and is not read.
  if (std::max({width, height, depth}) > kLargestImage || is_proxy(target)) pixels = nullptr;
  const auto command = [&](const std::shared_ptr<const Image>& image) {
    if (!is_proxy(target))
      issue<&tex_image>(context, dimensions, target, level, internal_format, width, height, depth, border, image);
    else if (context.inside_begin())
      context.fail(GL_INVALID_OPERATION);
    else  // at once, also where a list is compiled
      tex_image(context, dimensions, target, level, internal_format, width, height, depth, border, nullptr);
  };
  with_image(context, {width, height, depth}, format, type, pixels, command, dimensions);
}

void enter_tex_sub_image(Context& context, int dimensions, GLenum target, GLint level, GLint x, GLint y, GLint z,
                         GLsizei width, GLsizei height, GLsizei depth, GLenum format, GLenum type, const void* pixels) {
  if (std::max({width, height, depth}) > kLargestImage) return list_error(context, GL_INVALID_VALUE);
  const auto command = [&](const std::shared_ptr<const Image>& image) {
    issue<&tex_sub_image>(context, dimensions, target, level, x, y, z, image);
  };
  with_image(context, {width, height, depth}, format, type, pixels, command, dimensions);
}

void enter_call_lists(Context& context, GLsizei n, GLenum type, const void* lists) {
  if (const auto names = list_names(context, n, type, lists)) issue<&call_lists>(context, names);
}

void enter_prioritize_textures(Context& context, GLsizei n, const GLuint* names, const GLfloat* priorities) {
  if (n < 0) return list_error(context, GL_INVALID_VALUE);
  auto pairs = std::make_shared<std::vector<std::pair<GLuint, double>>>();
  for (GLsizei i = 0; i < n; ++i) pairs->emplace_back(names[i], priorities[i]);
  issue<&prioritize_textures>(context, pairs);
}

void enter_get_compressed_image(Context& context, GLenum target, GLint level) {
  // No image is compressed. The query has the errors of target and level.
  if (!get_tex_level_parameter(context, target, level, GL_TEXTURE_COMPRESSED).value.empty())
    context.fail(GL_INVALID_OPERATION);
}

}  // namespace halfplane::gl
