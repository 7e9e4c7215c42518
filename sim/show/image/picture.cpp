#include "picture.hpp"

#include <stb_easy_font.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>

namespace halfplane {
namespace {

constexpr std::size_t kVertexBytes = 16;  // stb_easy_font: x, y, z as float and four bytes of colour
constexpr std::size_t kQuadBytes = 4 * kVertexBytes;

// The font's table ends at '~'; anything else would be read from outside it.
std::string printable(std::string_view text) {
  std::string result(text);
  for (char& c : result)
    if (c < ' ' || c > '~') c = '?';
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

std::string fit_text(std::string_view text, int width, int scale) {
  if (text_width(text, scale) <= width) return std::string(text);
  while (!text.empty() && text_width(std::string(text) + "..", scale) > width) text.remove_suffix(1);
  return std::string(text) + "..";
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
