#include "picture.hpp"

#include <stb_easy_font.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>

#include "sim/utf8.hpp"

namespace halfplane {
namespace {

constexpr std::size_t kVertexBytes = 16;  // stb_easy_font: x, y, z as float and four bytes of colour
constexpr std::size_t kQuadBytes = 4 * kVertexBytes;

// Replacement letters for characters missing in the font: U+00C0 to U+00FF, and U+0100 to U+017F.
constexpr std::string_view kLatin1 = "AAAAAAACEEEEIIIIDNOOOOOxOUUUUYTsaaaaaaaceeeeiiiidnooooo/ouuuuyty";
constexpr std::string_view kLatinExtendedA =
    "AaAaAaCcCcCcCcDdDdEeEeEeEeEeGgGgGgGgHhHhIiIiIiIiIiIiJjKkkLlLlLlLlLlNnNnNnnNnOoOoOoOoRrRrRrSsSsSsSsTtTtTt"
    "UuUuUuUuUuUuWwYyYZzZzZzs";
static_assert(kLatin1.size() == 0x40 && kLatinExtendedA.size() == 0x80);

/// The glyph for a code point; 0 for a combining mark.
char glyph_of(char32_t c) {
  if (c >= ' ' && c <= '~') return static_cast<char>(c);
  if (c >= 0xc0 && c < 0x100) return kLatin1[c - 0xc0];
  if (c >= 0x100 && c < 0x180) return kLatinExtendedA[c - 0x100];
  if (c >= 0x300 && c < 0x370) return 0;
  if (c == 0xa0 || (c >= 0x2000 && c <= 0x200a) || c == 0x202f) return ' ';
  if ((c >= 0x2010 && c <= 0x2015) || c == 0x2212) return '-';
  if (c == 0x2018 || c == 0x2019) return '\'';
  if (c == 0x201c || c == 0x201d) return '"';
  if (c == 0xb5 || c == 0x3bc) return 'u';
  return '?';
}

// The font's table ends at '~'; other codes would be read outside it.
std::string printable(std::string_view text) {
  std::string result;
  for (std::size_t at = 0; at < text.size();)
    if (const char glyph = glyph_of(next_code_point(text, at)); glyph != 0) result += glyph;
  return result;
}

int corner_coordinate(const char* vertex, std::size_t axis) {
  float value = 0;
  std::memcpy(&value, vertex + axis * sizeof(float), sizeof(float));
  return static_cast<int>(value);  // whole font pixels
}

}  // namespace

Picture::Picture(int width_, int height_, Rgb fill) : width(width_), height(height_) {
  rgb.resize(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (std::size_t i = 0; i < rgb.size(); i += 3) {
    rgb[i] = fill.r;
    rgb[i + 1] = fill.g;
    rgb[i + 2] = fill.b;
  }
}

void set_pixel(Picture& picture, int x, int y, Rgb color) {
  if (x < 0 || y < 0 || x >= picture.width || y >= picture.height) return;
  const std::size_t i = picture.at(x, y);
  picture.rgb[i] = color.r;
  picture.rgb[i + 1] = color.g;
  picture.rgb[i + 2] = color.b;
}

void fill_rect(Picture& picture, const Rect& rect, Rgb color) {
  const int right = std::min(rect.x + rect.width, picture.width);
  const int bottom = std::min(rect.y + rect.height, picture.height);
  for (int y = std::max(rect.y, 0); y < bottom; ++y)
    for (int x = std::max(rect.x, 0); x < right; ++x) set_pixel(picture, x, y, color);
}

void frame_rect(Picture& picture, const Rect& rect, Rgb color) {
  fill_rect(picture, {rect.x, rect.y, rect.width, 1}, color);
  fill_rect(picture, {rect.x, rect.y + rect.height - 1, rect.width, 1}, color);
  fill_rect(picture, {rect.x, rect.y, 1, rect.height}, color);
  fill_rect(picture, {rect.x + rect.width - 1, rect.y, 1, rect.height}, color);
}

void draw_line(Picture& picture, int x0, int y0, int x1, int y1, Rgb color) {
  const int steps = std::max(std::abs(x1 - x0), std::abs(y1 - y0));
  for (int i = 0; i <= steps; ++i) {
    const double t = steps == 0 ? 0.0 : static_cast<double>(i) / steps;
    set_pixel(picture, static_cast<int>(std::lround(x0 + t * (x1 - x0))),
              static_cast<int>(std::lround(y0 + t * (y1 - y0))), color);
  }
}

void draw_picture(Picture& picture, const Picture& source, int x, int y, int scale) {
  for (int row = 0; row < source.height; ++row)
    for (int column = 0; column < source.width; ++column)
      fill_rect(picture, {x + column * scale, y + row * scale, scale, scale}, source.get(column, row));
}

int text_width(std::string_view text, int scale) {
  std::string line = printable(text);
  return scale * stb_easy_font_width(line.data());
}

void draw_text(Picture& picture, int x, int y, std::string_view text, Rgb color, int scale) {
  std::string glyph(1, ' ');
  std::array<char, 32 * kQuadBytes> quads{};  // the busiest glyph has 11
  for (const char c : printable(text)) {
    glyph[0] = c;
    const int count = stb_easy_font_print(0, 0, glyph.data(), nullptr, quads.data(), static_cast<int>(quads.size()));
    for (int i = 0; i < count; ++i) {
      const char* first = quads.data() + static_cast<std::size_t>(i) * kQuadBytes;  // top left
      const char* third = first + 2 * kVertexBytes;                                 // bottom right
      const int left = corner_coordinate(first, 0), top = corner_coordinate(first, 1);
      const Rect stroke{x + scale * left, y + scale * top, scale * (corner_coordinate(third, 0) - left),
                        scale * (corner_coordinate(third, 1) - top)};
      fill_rect(picture, stroke, color);
    }
    x += text_width(glyph, scale);
  }
}

std::vector<std::string> wrap_text(std::string_view text, int width, int scale) {
  const std::size_t indent = std::min(text.find_first_not_of(' '), text.size());
  const std::string hanging(indent + 2, ' ');
  std::vector<std::string> lines{std::string(text.substr(0, indent))};
  const auto fits = [&](const std::string& line) { return text_width(line, scale) <= width; };
  bool is_empty = true;  // the current line has no word yet
  for (std::size_t at = indent; at < text.size();) {
    const std::size_t blank_end = std::min(text.find_first_not_of(' ', at), text.size());
    const std::size_t end = std::min(text.find(' ', blank_end), text.size());
    std::string_view word = text.substr(blank_end, end - blank_end);
    if (const std::string longer = lines.back() + std::string(text.substr(at, end - at)); is_empty || fits(longer)) {
      lines.back() = longer;
    } else {
      lines.push_back(hanging + std::string(word));
    }
    at = end;
    is_empty = false;
    while (!fits(lines.back())) {  // one word, wider than a line: it is broken where the line is full
      std::string& line = lines.back();
      std::size_t kept = line.size();
      const std::size_t least = line.find_first_not_of(' ');
      while (kept > least && !fits(line.substr(0, kept)))
        kept = without_last_code_point(std::string_view(line).substr(0, kept));
      if (kept <= least) break;  // not even one letter
      const std::string rest = line.substr(kept);
      line.resize(kept);
      lines.push_back(hanging + rest);
    }
  }
  return lines;
}

Picture shrink(const Picture& picture, int factor) {
  Picture result((picture.width + factor - 1) / factor, (picture.height + factor - 1) / factor);
  for (int y = 0; y < result.height; ++y) {
    const int bottom = std::min((y + 1) * factor, picture.height);
    for (int x = 0; x < result.width; ++x) {
      const int right = std::min((x + 1) * factor, picture.width);
      std::array<unsigned long long, 3> sum{};
      for (int v = y * factor; v < bottom; ++v)
        for (std::size_t i = picture.at(x * factor, v), end = picture.at(right - 1, v) + 3; i < end; ++i)
          sum[(i - picture.at(x * factor, v)) % 3] += picture.rgb[i];
      const auto pixels =
          static_cast<unsigned long long>(bottom - y * factor) * static_cast<unsigned long long>(right - x * factor);
      for (std::size_t c = 0; c < 3; ++c)
        result.rgb[result.at(x, y) + c] = static_cast<std::uint8_t>((sum[c] + pixels / 2) / pixels);
    }
  }
  return result;
}

}  // namespace halfplane
