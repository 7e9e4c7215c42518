#include "capture_textures.hpp"

#include <algorithm>
#include <filesystem>

#include "../config.hpp"

namespace halfplane {
namespace {

int digits_of(TextureFormat format) { return (texel_bits(format) + 3) / 4; }

/// Calls take(number) for each `digits` hex digits of the words that follow.
template <class Take>
void read_hex(CaptureText& text, int digits, std::string_view what, Take&& take) {
  if (!text.has_word()) text.fail(std::string(what) + " without digits");
  while (text.has_word()) {
    const std::string_view word = text.word();
    const auto length = static_cast<std::size_t>(digits);
    if (word.size() % length != 0)
      text.fail(std::string(what) + " of " + std::to_string(word.size()) + " digits in a word; write " +
                std::to_string(digits) + " for each");
    for (std::size_t i = 0; i < word.size(); i += length) {
      std::uint32_t number = 0;
      for (const char c : word.substr(i, length)) {
        const int digit = hex_digit(c);
        if (digit < 0) text.fail(quoted_word(word) + " holds a character that is no hex digit");
        number = number << 4 | static_cast<std::uint32_t>(digit);
      }
      take(number);
    }
  }
}

void append_hex(std::string& out, std::uint32_t number, int digits) {
  for (int shift = 4 * (digits - 1); shift >= 0; shift -= 4) out += "0123456789abcdef"[number >> shift & 15];
}

/// Calls work(); adds the place in the capture to its errors.
template <class Work>
void at_its_line(const CaptureText& text, Work&& work) {
  try {
    work();
  } catch (const InputError& error) {
    text.fail(error.what());
  }
}

int read_side(CaptureText& text, std::string_view what) { return text.integer(what, 1, kLargestTexture); }

}  // namespace

void TextureReader::read_texture(CaptureText& text, std::vector<Texture>& textures) {
  const std::string name(text.word());
  if (name.empty())
    text.fail("texture without a name; write texture NAME file PATH, pattern P W H or inline FORMAT W H");
  if (name == "off") text.fail("a texture named off; `state texture off` means none: choose another name");
  if (std::ranges::find(textures, name, &Texture::name) != textures.end())
    text.fail("a second texture " + quoted_word(name) + "; give each a name of its own");
  constexpr std::array<std::string_view, 3> sources{"file", "pattern", "inline"};
  const std::size_t source = text.choice("the source of a texture", sources);
  TexelImage image;
  TextureFormat format = TextureFormat::rgba8888;
  Mips mips = Mips::none;
  if (source == 0) {
    image = read_file(text, name);
  } else {
    const auto pattern = static_cast<TexturePattern>(source == 1 ? text.choice("the pattern", kTexturePatterns) : 0);
    if (source == 2) format = static_cast<TextureFormat>(text.choice("the format", kTextureFormats));
    const int width = read_side(text, "the texture's width");
    const int height = read_side(text, "the texture's height");
    if (source == 1)
      image = pattern_image(pattern, width, height);
    else
      incomplete_ = Inline{{name, format, mips, {}, {{width, height, {}}}}, text.line()};
  }
  while (text.has_word()) {
    constexpr std::array<std::string_view, 2> options{"format", "mips"};
    if (text.choice("an option of a texture", options) == 1) {
      mips = static_cast<Mips>(text.choice("mips", kMips));
      if (mips == Mips::levels && source != 2)
        text.fail("mips levels of a texture that is not inline; write its levels in texels lines, or mips box");
    } else if (source == 2)
      text.fail("format after inline, which names it already");
    else
      format = static_cast<TextureFormat>(text.choice("the format", kTextureFormats));
  }
  if (source == 2) {
    incomplete_->texture.mips = mips;
    return;
  }
  at_its_line(text, [&] { textures.push_back(make_texture(name, image, format, mips)); });
}

TexelImage TextureReader::read_file(CaptureText& text, const std::string& name) const {
  const std::filesystem::path path(text.word());
  if (path.empty()) text.fail("texture " + name + " file without a path");
  const auto beside = std::filesystem::path(file_name_).parent_path();
  TexelImage image;
  at_its_line(text, [&] { image = read_image_file(path.is_absolute() ? path.string() : (beside / path).string()); });
  return image;
}

void TextureReader::read_palette(CaptureText& text) {
  if (!incomplete_ || palette_size(incomplete_->texture.format) == 0)
    text.fail("palette without a texture inline p4 or p8 before it");
  std::vector<Texel>& palette = incomplete_->texture.palette;
  read_hex(text, 8, "palette", [&](std::uint32_t c) {
    palette.push_back({static_cast<std::uint8_t>(c >> 24), static_cast<std::uint8_t>(c >> 16),
                       static_cast<std::uint8_t>(c >> 8), static_cast<std::uint8_t>(c)});
  });
  if (palette.size() > palette_size(incomplete_->texture.format))
    text.fail("a palette of more than " + std::to_string(palette_size(incomplete_->texture.format)) + " colours");
}

void TextureReader::read_texels(CaptureText& text, std::vector<Texture>& textures) {
  if (!incomplete_) text.fail("texels without a texture inline before them, or more of them than it has");
  Texture& texture = incomplete_->texture;
  const auto is_full = [&texture] {
    const TextureLevel& level = texture.level.back();
    return level.code.size() == static_cast<std::size_t>(level.width) * static_cast<std::size_t>(level.height);
  };
  const bool has_palette = palette_size(texture.format) != 0;
  read_hex(text, digits_of(texture.format), "texels", [&](std::uint32_t code) {
    if (has_palette && code >= texture.palette.size())
      text.fail("texel " + std::to_string(code) + " of a palette of " + std::to_string(texture.palette.size()));
    TextureLevel& level = texture.level.back();
    if (is_full())
      text.fail("more texels than the " + std::to_string(level.code.size()) + " of " +
                (texture.last_level() == 0 ? "" : "the last level of ") + "texture " + quoted_word(texture.name));
    level.code.push_back(code);
    if (is_full() && texture.mips == Mips::levels && !texture.is_complete())
      texture.level.push_back({std::max(1, level.width / 2), std::max(1, level.height / 2), {}});
  });
  if (!is_full()) return;
  add_mips(texture);
  textures.push_back(std::move(texture));
  incomplete_.reset();
}

void TextureReader::expect_complete(const CaptureText& text) const {
  if (!incomplete_) return;
  const TextureLevel& image = incomplete_->texture.level.back();
  const int n = incomplete_->texture.last_level();
  text.fail((n == 0 ? "" : "level " + std::to_string(n) + " of ") + "texture " +
            quoted_word(incomplete_->texture.name) + " from line " + std::to_string(incomplete_->line) + " has " +
            std::to_string(image.code.size()) + " of its " + std::to_string(image.width) + "x" +
            std::to_string(image.height) + " texels; write the others in texels lines after it");
}

void write_texture(const Texture& texture, std::string& out) {
  const TextureLevel& image = texture.level.front();
  out += "texture " + texture.name + " inline " +
         std::string(kTextureFormats[static_cast<std::size_t>(texture.format)]) + ' ' + std::to_string(image.width) +
         ' ' + std::to_string(image.height);
  if (texture.mips != Mips::none) out += " mips " + std::string(kMips[static_cast<std::size_t>(texture.mips)]);
  out += '\n';
  if (!texture.palette.empty()) out += "palette";
  for (const Texel& c : texture.palette) {
    out += ' ';
    for (const std::uint8_t channel : c) append_hex(out, channel, 2);
  }
  if (!texture.palette.empty()) out += '\n';
  const std::size_t levels =
      texture.mips == Mips::levels ? texture.level.size() : 1;  // the others follow from the image
  for (std::size_t n = 0; n < levels; ++n) {
    const TextureLevel& level = texture.level[n];
    for (std::size_t i = 0; i < level.code.size(); ++i) {
      const std::size_t column = i % static_cast<std::size_t>(level.width);
      if (column % 16 == 0) out += column == 0 ? (i == 0 ? "texels " : "\ntexels ") : " ";
      append_hex(out, level.code[i], digits_of(texture.format));
    }
    out += '\n';
  }
}

}  // namespace halfplane
