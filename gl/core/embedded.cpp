#include "embedded.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

#include "entry_conversions.hpp"
#include "primitive.hpp"
#include "texture.hpp"

namespace halfplane::gl {
namespace {

/// Entries of a palette, as glTexImage2D takes them.
struct PaletteFormat {
  GLenum format, type;
  std::size_t bytes;
};
// In the order of the formats, 4 bits before 8.
constexpr std::array<PaletteFormat, kPalettes / 2> kPaletteFormats{{{GL_RGB, GL_UNSIGNED_BYTE, 3},
                                                                    {GL_RGBA, GL_UNSIGNED_BYTE, 4},
                                                                    {GL_RGB, GL_UNSIGNED_SHORT_5_6_5, 2},
                                                                    {GL_RGBA, GL_UNSIGNED_SHORT_4_4_4_4, 2},
                                                                    {GL_RGBA, GL_UNSIGNED_SHORT_5_5_5_1, 2}}};

}  // namespace

bool takes_array_type(GLenum type, bool is_color) {
  if (type == GL_FLOAT || type == GL_FIXED) return true;
  return is_color ? type == GL_UNSIGNED_BYTE : type == GL_BYTE || type == GL_SHORT;
}

GLenum last_mode(const Context& context) { return context.is_embedded ? GL_TRIANGLE_FAN : GL_POLYGON; }

void enter_compressed_image(Context& context, GLenum target, GLint level, GLenum format, GLsizei width, GLsizei height,
                            GLint border, GLsizei bytes, const void* data) {
  if (!context.is_embedded || format - kFirstPalette >= kPalettes) return list_error(context, GL_INVALID_ENUM);
  // A level of -n says that levels 0 to n follow each other.
  constexpr int kMostLevels = std::bit_width(static_cast<unsigned>(kLargestTexture));
  if (level > 0 || level <= -kMostLevels || border != 0 || width < 0 || height < 0 || width > kLargestTexture ||
      height > kLargestTexture)
    return list_error(context, GL_INVALID_VALUE);
  const bool is_short = format - kFirstPalette < kPaletteFormats.size();  // 4 bits a texel
  const PaletteFormat& palette = kPaletteFormats[(format - kFirstPalette) % kPaletteFormats.size()];
  const std::size_t palette_bytes = palette.bytes * (is_short ? 16 : 256);
  const auto texels_of = [&](int l) {
    return static_cast<std::size_t>(std::max(width >> l, 1)) * static_cast<std::size_t>(std::max(height >> l, 1));
  };
  const auto bytes_of = [&](int l) { return is_short ? (texels_of(l) + 1) / 2 : texels_of(l); };
  std::size_t wanted = palette_bytes;
  for (int l = 0; l <= -level; ++l) wanted += bytes_of(l);
  if (bytes < 0 || static_cast<std::size_t>(bytes) != wanted || data == nullptr)
    return list_error(context, GL_INVALID_VALUE);

  const auto* const entries = static_cast<const std::byte*>(data);
  const std::byte* indices = entries + palette_bytes;
  const PixelStore unpack = std::exchange(context.client.unpack, {.alignment = 1});
  std::vector<std::byte> image;
  for (int l = 0; l <= -level; indices += bytes_of(l), ++l) {
    image.resize(texels_of(l) * palette.bytes);
    for (std::size_t i = 0; i < texels_of(l); ++i) {
      const auto index = std::to_integer<std::size_t>(indices[is_short ? i / 2 : i]);
      const std::size_t entry = !is_short ? index : i % 2 == 0 ? index >> 4 : index & 15;  // the high half first
      std::memcpy(&image[i * palette.bytes], entries + entry * palette.bytes, palette.bytes);
    }
    enter_tex_image(context, 2, target, l, static_cast<GLint>(palette.format), std::max(width >> l, 1),
                    std::max(height >> l, 1), 1, 0, palette.format, palette.type, image.data());
  }
  context.client.unpack = unpack;
}

// GL_OES_draw_texture: a rectangle of the window with the crop rectangle of the texture.
void draw_tex(Context& context, double x, double y, double z, double width, double height) {
  if (!(width > 0 && height > 0)) return context.fail(GL_INVALID_VALUE);
  if (context.drawable == nullptr || context.render_mode != GL_RENDER) return;
  const State saved = context.state;
  const ViewportState& view = saved.viewport;
  const double depth = view.near + std::clamp(z, 0.0, 1.0) * (view.far - view.near);

  ShadedVertex vertex;
  vertex.color.fill(saved.current.color);
  vertex.fog_distance = saved.current.fog_coord;
  std::array<ShadedVertex, 4> corners;
  const Frame& frame = context.drawable->frame;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const double right = i == 1 || i == 2 ? 1 : 0, up = i >= 2 ? 1 : 0;
    vertex.clip = {2 * (x + right * width) / frame.width() - 1, 2 * (y + up * height) / frame.height() - 1,
                   2 * depth - 1, 1};
    for (int unit = 0; unit < kTextureUnits; ++unit)
      if (const TextureObject* texture = sampled_texture(context, unit)) {
        const TextureImage& image = texture->face[0][static_cast<std::size_t>(texture->base_level)];
        const auto& [u, v, columns, rows] = texture->crop;
        vertex.tex_coord[static_cast<std::size_t>(unit)] = {(u + right * columns) / image.width,
                                                            (v + up * rows) / image.height, 0, 1};
      }
    corners[i] = vertex;
  }

  // In a viewport of the whole window, without the states of polygons that do not apply here.
  context.state.viewport = {0, 0, frame.width(), frame.height(), 0, 1};
  context.state.polygon = {};
  context.state.transform.clip_enabled = {};
  ++context.revision;
  constexpr std::array<std::uint32_t, 4> kCorners{0, 1, 2, 3};
  draw_primitives(context, GL_TRIANGLE_FAN, ShadedVertices(corners), kCorners);
  context.state = saved;
  ++context.revision;
}

}  // namespace halfplane::gl
