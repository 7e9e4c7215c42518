#include "embedded.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

#include "entry_conversions.hpp"

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

}  // namespace halfplane::gl
