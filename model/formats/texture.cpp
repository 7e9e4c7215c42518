#include "texture.hpp"

#include <algorithm>
#include <cmath>

#include "../input_error.hpp"

namespace halfplane {
namespace {

/// The place of a format's channels: bits of R, G, B, A from the top down. Luminance counts as R.
struct Layout {
  std::array<int, 4> bits;
  bool is_luminance = false;
};

constexpr Layout layout_of(TextureFormat format) {
  switch (format) {
    case TextureFormat::l8: return {{8, 0, 0, 0}, true};
    case TextureFormat::la88: return {{8, 0, 0, 8}, true};
    case TextureFormat::rgb565: return {{5, 6, 5, 0}};
    case TextureFormat::rgba5551: return {{5, 5, 5, 1}};
    case TextureFormat::rgba4444: return {{4, 4, 4, 4}};
    case TextureFormat::rgba8888: return {{8, 8, 8, 8}};
    case TextureFormat::p4:
    case TextureFormat::p8: break;
  }
  return {{0, 0, 0, 0}};
}

/// `bits` of a channel widened to 8 by repetition.
std::uint8_t widen(std::uint32_t value, int bits) {
  std::uint32_t wide = value << (8 - bits);
  for (int filled = bits; filled < 8; filled += filled) wide |= wide >> filled;
  return static_cast<std::uint8_t>(wide);
}

std::uint32_t narrow(std::uint8_t value, int bits) {
  const std::uint32_t largest = (1U << bits) - 1;
  return (value * largest * 2 + 255) / 510;
}

std::uint8_t luminance(const Texel& t) {
  return static_cast<std::uint8_t>((77 * t[0] + 150 * t[1] + 29 * t[2] + 128) >> 8);
}

std::uint32_t nearest_entry(const Texel& texel, std::span<const Texel> palette) {
  const auto distance = [&texel](const Texel& entry) {
    int sum = 0;
    for (std::size_t c = 0; c < 4; ++c) sum += (texel[c] - entry[c]) * (texel[c] - entry[c]);
    return sum;
  };
  const auto nearest = std::ranges::min_element(palette, {}, distance);
  return static_cast<std::uint32_t>(nearest - palette.begin());
}

std::vector<Texel> palette_of(const std::string& name, const TexelImage& image, TextureFormat format) {
  std::vector<Texel> colors = image.texel;
  std::ranges::sort(colors);
  colors.erase(std::unique(colors.begin(), colors.end()), colors.end());
  if (colors.size() > palette_size(format))
    throw InputError("texture " + name + ": " + std::to_string(colors.size()) + " colours, but " +
                     std::string(kTextureFormats[static_cast<std::size_t>(format)]) + " holds " +
                     std::to_string(palette_size(format)) + "; use another format");
  return colors;
}

/// Linear light of each sRGB code, 0...65535 (IEC 61966-2-1).
std::array<std::uint32_t, 256> light_of_codes() {
  std::array<std::uint32_t, 256> light{};
  for (std::size_t code = 0; code < light.size(); ++code) {
    const double c = static_cast<double>(code) / 255;
    const double l = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
    light[code] = static_cast<std::uint32_t>(std::floor(l * 65535 + 0.5));
  }
  return light;
}

/// The parts of `size` texels covered by one of `smaller`: calls visit(texel, weight); the weights add up to `size`.
template <class Visit>
void for_each_part(int at, int size, int smaller, Visit&& visit) {
  const int first = at * size, last = first + size;  // in parts of a texel, `smaller` each
  for (int i = first / smaller; i * smaller < last; ++i)
    visit(i, static_cast<std::uint64_t>(std::min(last, (i + 1) * smaller) - std::max(first, i * smaller)));
}

/// The mean of the image over the box of each texel of a smaller one, rounded once.
TexelImage box_filtered(const TexelImage& image, int width, int height, bool is_linear) {
  static const std::array<std::uint32_t, 256> light = light_of_codes();
  const auto value = [is_linear](std::uint8_t code, std::size_t channel) -> std::uint64_t {
    return is_linear && channel < 3 ? light[code] : code;
  };
  const auto code_of = [is_linear](std::uint64_t mean, std::size_t channel) {
    if (!is_linear || channel == 3) return static_cast<std::uint8_t>(mean);
    const auto above = std::ranges::lower_bound(light, mean);  // the nearest light
    const bool is_below = above != light.begin() && mean - *(above - 1) < *above - mean;
    return static_cast<std::uint8_t>(above - light.begin() - (is_below ? 1 : 0));
  };
  TexelImage result{width, height, {}};
  const auto area = static_cast<std::uint64_t>(image.width) * static_cast<std::uint64_t>(image.height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      std::array<std::uint64_t, 4> sum{};
      for_each_part(y, image.height, height, [&](int row, std::uint64_t high) {
        for_each_part(x, image.width, width, [&](int column, std::uint64_t wide) {
          const Texel& t = image.texel[static_cast<std::size_t>(row) * static_cast<std::size_t>(image.width) +
                                       static_cast<std::size_t>(column)];
          for (std::size_t c = 0; c < 4; ++c) sum[c] += high * wide * value(t[c], c);
        });
      });
      Texel& mean = result.texel.emplace_back();
      for (std::size_t c = 0; c < 4; ++c) mean[c] = code_of((sum[c] + area / 2) / area, c);
    }
  return result;
}

TextureLevel encoded(const Texture& texture, const TexelImage& image) {
  TextureLevel level{image.width, image.height, {}};
  level.code.resize(image.texel.size());
  const auto fill = [&](const auto& encode) { std::ranges::transform(image.texel, level.code.begin(), encode); };
  switch (texture.format) {  // formats of large images
    case TextureFormat::rgba8888:
      fill([](const Texel& t) {
        return std::uint32_t{t[0]} << 24 | std::uint32_t{t[1]} << 16 | std::uint32_t{t[2]} << 8 | t[3];
      });
      break;
    case TextureFormat::la88: fill([](const Texel& t) { return std::uint32_t{luminance(t)} << 8 | t[3]; }); break;
    case TextureFormat::l8: fill([](const Texel& t) { return std::uint32_t{luminance(t)}; }); break;
    default: fill([&texture](const Texel& t) { return encode_texel(texture.format, t, texture.palette); });
  }
  return level;
}

// ---- patterns

/// 3x5 pixels a digit, rows from the top, the left pixel in bit 2.
constexpr std::array<std::array<std::uint8_t, 5>, 10> kDigits{{{7, 5, 5, 5, 7},
                                                               {2, 6, 2, 2, 7},
                                                               {7, 1, 7, 4, 7},
                                                               {7, 1, 7, 1, 7},
                                                               {5, 5, 7, 1, 1},
                                                               {7, 4, 7, 1, 7},
                                                               {7, 4, 7, 5, 7},
                                                               {7, 1, 1, 1, 1},
                                                               {7, 5, 7, 5, 7},
                                                               {7, 5, 7, 1, 7}}};

/// One texel of the grid: a line, a digit of its cell's column or row, or the cell's own colour.
Texel grid_texel(int x, int y, int width, int height) {
  constexpr Texel kLine{32, 32, 40, 255}, kDigit{16, 16, 16, 255};
  const int column = x * 8 / width, row = y * 8 / height;
  const int left = (column * width + 7) / 8, top = (row * height + 7) / 8;
  const int i = x - left, j = y - top;
  if (i == 0 || j == 0) return kLine;
  const int scale = std::max(1, std::min(width / 8 / 9, height / 8 / 7));
  const int dot_x = (i - 1) / scale - 1, dot_y = (j - 1) / scale - 1;  // digits begin a dot from the lines
  const bool has_room = width / 8 >= 9 && height / 8 >= 7;
  if (has_room && dot_y >= 0 && dot_y < 5 && dot_x >= 0 && dot_x < 7 && dot_x != 3) {
    const int digit = dot_x < 3 ? column : row;
    if ((kDigits[static_cast<std::size_t>(digit)][static_cast<std::size_t>(dot_y)] >> (2 - dot_x % 4) & 1) != 0)
      return kDigit;
  }
  const auto shade = [](int n) { return static_cast<std::uint8_t>(112 + n * 18); };
  return {shade(column), shade(row), static_cast<std::uint8_t>((column + row) % 2 != 0 ? 128 : 208), 255};
}

}  // namespace

int texel_bits(TextureFormat format) {
  if (format == TextureFormat::p4) return 4;
  if (format == TextureFormat::p8) return 8;
  const Layout layout = layout_of(format);
  return layout.bits[0] + layout.bits[1] + layout.bits[2] + layout.bits[3];
}

std::size_t palette_size(TextureFormat format) {
  return format == TextureFormat::p4 ? 16 : format == TextureFormat::p8 ? 256 : 0;
}

bool has_alpha(TextureFormat format) { return palette_size(format) != 0 || layout_of(format).bits[3] != 0; }

Texel decode_texel(TextureFormat format, std::uint32_t code, std::span<const Texel> palette) {
  if (palette_size(format) != 0) return palette[code];
  const Layout layout = layout_of(format);
  Texel texel{0, 0, 0, 255};
  int shift = texel_bits(format);
  for (std::size_t c = 0; c < 4; ++c) {
    if (layout.bits[c] == 0) continue;
    shift -= layout.bits[c];
    texel[c] = widen(code >> shift & ((1U << layout.bits[c]) - 1), layout.bits[c]);
  }
  if (layout.is_luminance) texel[1] = texel[2] = texel[0];
  return texel;
}

std::uint32_t encode_texel(TextureFormat format, const Texel& texel, std::span<const Texel> palette) {
  if (palette_size(format) != 0) return nearest_entry(texel, palette);
  const Layout layout = layout_of(format);
  std::uint32_t code = 0;
  for (std::size_t c = 0; c < 4; ++c)
    code = code << layout.bits[c] | narrow(c == 0 && layout.is_luminance ? luminance(texel) : texel[c], layout.bits[c]);
  return code;
}

namespace {

void check_sides(const std::string& name, const TexelImage& image) {
  if (image.width < 1 || image.height < 1 || image.width > kLargestTexture || image.height > kLargestTexture)
    throw InputError("texture " + name + " of " + std::to_string(image.width) + "x" + std::to_string(image.height) +
                     " texels; give 1x1 to 4096x4096");
}

TexelImage decoded(const Texture& texture, int n) {
  const TextureLevel& level = texture.level[static_cast<std::size_t>(n)];
  TexelImage image{level.width, level.height, {}};
  image.texel.reserve(level.code.size());
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) image.texel.push_back(texture.texel(n, x, y));
  return image;
}

}  // namespace

Texture make_texture(std::string name, const TexelImage& image, TextureFormat format, Mips mips) {
  check_sides(name, image);
  Texture texture{std::move(name), format, mips, {}, {}};
  if (palette_size(format) != 0) texture.palette = palette_of(texture.name, image, format);
  texture.level.push_back(encoded(texture, image));
  add_mips(texture);
  return texture;
}

Texture make_texture(std::string name, std::span<const TexelImage> levels, TextureFormat format) {
  if (levels.empty()) throw InputError("texture " + name + " without an image; give at least one level");
  if (palette_size(format) != 0) throw InputError("texture " + name + " of a palette with levels; give them as codes");
  check_sides(name, levels.front());
  Texture texture{std::move(name), format, Mips::levels, {}, {}};
  int width = levels.front().width, height = levels.front().height;
  for (const TexelImage& image : levels) {
    if (image.width != width || image.height != height || texture.is_complete())
      throw InputError("texture " + texture.name + ": level " + std::to_string(texture.level.size()) + " of " +
                       std::to_string(image.width) + "x" + std::to_string(image.height) +
                       " texels; each level has half the size of the one before, down to 1x1");
    texture.level.push_back(encoded(texture, image));
    width = std::max(1, width / 2);
    height = std::max(1, height / 2);
  }
  add_mips(texture);
  return texture;
}

void add_mips(Texture& texture) {
  if (texture.mips != Mips::levels) texture.level.resize(1);
  if (texture.mips == Mips::none) return;
  const TexelImage image = decoded(texture, texture.last_level());
  for (int width = image.width, height = image.height; width > 1 || height > 1;) {
    width = std::max(1, width / 2);
    height = std::max(1, height / 2);
    texture.level.push_back(encoded(texture, box_filtered(image, width, height, texture.mips == Mips::box_linear)));
  }
}

TexelImage pattern_image(TexturePattern pattern, int width, int height) {
  TexelImage image{width, height, {}};
  image.texel.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  const auto ramp = [](int at, int size) { return static_cast<std::uint8_t>(size == 1 ? 0 : at * 255 / (size - 1)); };
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) switch (pattern) {
        case TexturePattern::chequer:
          image.texel.push_back((x * 8 / width + y * 8 / height) % 2 == 0 ? Texel{232, 232, 224, 255}
                                                                          : Texel{40, 44, 60, 255});
          break;
        case TexturePattern::gradient: image.texel.push_back({ramp(x, width), ramp(y, height), 128, 255}); break;
        case TexturePattern::grid: image.texel.push_back(grid_texel(x, y, width, height)); break;
      }
  return image;
}

Signature signature_of(const Texture& texture) {
  SignatureHash hash;
  hash.add(static_cast<std::uint64_t>(texture.format));
  for (const Texel& entry : texture.palette)
    hash.add(std::uint64_t{entry[0]} | std::uint64_t{entry[1]} << 8 | std::uint64_t{entry[2]} << 16 |
             std::uint64_t{entry[3]} << 24);
  for (const TextureLevel& level : texture.level) {
    hash.add(static_cast<std::uint64_t>(level.width) << 32 | static_cast<std::uint64_t>(level.height));
    for (std::size_t i = 0; i < level.code.size(); i += 2)
      hash.add(std::uint64_t{level.code[i]} << 32 | (i + 1 < level.code.size() ? level.code[i + 1] : 0U));
  }
  return hash.signature();
}

}  // namespace halfplane
