// Textures: images of texels in a stored format, each with its mipmaps. Made on the host, and read by every engine.
//
// A texel is stored as a code: its channels from the top bits down, in the order of the format's name (rgb565: R in
// bits 15...11), or a palette index. Decoded, each channel has 8 bits: 5 and 6 bits are widened by repeating their top
// bits, 4 bits by repeating all, one bit is 0 or 255; luminance is R, G and B; without an alpha channel alpha is 255.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "../enum_names.hpp"
#include "../signature.hpp"

namespace halfplane {

enum class TextureFormat : std::uint8_t { l8, la88, rgb565, rgba5551, rgba4444, rgba8888, p4, p8 };
inline constexpr auto kTextureFormats = kNamesOf<TextureFormat>;

/// Source of the smaller levels: none, means over boxes of the image (of the codes or of linear light, sRGB), or images of
/// their own.
enum class Mips : std::uint8_t { none, box, box_linear, levels };
inline constexpr auto kMips = kNamesOf<Mips>;

enum class TexturePattern : std::uint8_t { chequer, gradient, grid };
inline constexpr auto kTexturePatterns = kNamesOf<TexturePattern>;

inline constexpr int kLargestTexture = 4096;  ///< texels along a side

/// R, G, B, A, 0...255.
using Texel = std::array<std::uint8_t, 4>;

/// Bits of a code.
[[nodiscard]] int texel_bits(TextureFormat format);
/// Entries of its palette; 0 for a format without one.
[[nodiscard]] std::size_t palette_size(TextureFormat format);
[[nodiscard]] bool has_alpha(TextureFormat format);
[[nodiscard]] Texel decode_texel(TextureFormat format, std::uint32_t code, std::span<const Texel> palette);
/// The nearest code. With a palette: the nearest entry, the first of several. Luminance is that of Rec. 601.
[[nodiscard]] std::uint32_t encode_texel(TextureFormat format, const Texel& texel, std::span<const Texel> palette);

/// Row-major, row 0 at v = 0.
struct TexelImage {
  int width = 0, height = 0;
  std::vector<Texel> texel;
};

/// Level n has max(1, size >> n) texels along a side.
struct TextureLevel {
  int width = 0, height = 0;
  std::vector<std::uint32_t> code;  ///< row-major, row 0 at v = 0
  bool operator==(const TextureLevel&) const = default;
};

struct Texture {
  std::string name;
  TextureFormat format = TextureFormat::rgba8888;
  Mips mips = Mips::none;
  std::vector<Texel> palette;       ///< for p4 and p8
  std::vector<TextureLevel> level;  ///< the image first; the smaller ones down to 1x1 with mipmaps

  [[nodiscard]] int width() const { return level.front().width; }
  [[nodiscard]] int height() const { return level.front().height; }
  /// Whether its levels reach down to 1x1.
  [[nodiscard]] bool is_complete() const {
    return !level.empty() && level.back().width == 1 && level.back().height == 1;
  }
  [[nodiscard]] int last_level() const { return static_cast<int>(level.size()) - 1; }
  /// Precondition: inside the level.
  [[nodiscard]] Texel texel(int n, int x, int y) const {
    const TextureLevel& l = level[static_cast<std::size_t>(n)];
    return decode_texel(
        format, l.code[static_cast<std::size_t>(y) * static_cast<std::size_t>(l.width) + static_cast<std::size_t>(x)],
        palette);
  }
  bool operator==(const Texture&) const = default;
};

/// Signature of all data that can be read from the texture.
[[nodiscard]] Signature signature_of(const Texture& texture);

/// Stores an image. Throws InputError when its colours are more than the format's palette holds, or its sides are not 1 to
/// kLargestTexture.
[[nodiscard]] Texture make_texture(std::string name, const TexelImage& image, TextureFormat format, Mips mips);
/// Stores an image and its smaller levels; levels missing before 1x1 become box means of the last one. Throws InputError
/// likewise, for a level that does not have half the size of the level before, and for palettes.
[[nodiscard]] Texture make_texture(std::string name, std::span<const TexelImage> levels, TextureFormat format);
/// Adds the levels that are missing down to 1x1, as `mips` says, to an image of codes; Mips::levels: to its last level.
void add_mips(Texture& texture);

/// chequer: 8x8 squares. gradient: R along u, G along v. grid: 8x8 cells with lines between them, and in large enough
/// cells their column and row in digits.
[[nodiscard]] TexelImage pattern_image(TexturePattern pattern, int width, int height);

}  // namespace halfplane
