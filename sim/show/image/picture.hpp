// A picture in memory and functions that draw into it: rectangles, lines, other pictures, text.
//
// Drawing clips to the picture, so callers need no bounds checks. Text is UTF-8 in a 7-pixel bitmap font of ASCII: accented
// Latin letters show without their accents, other characters as one '?' each.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "model/scene.hpp"

namespace halfplane {

struct Rgb {
  std::uint8_t r = 0, g = 0, b = 0;
  bool operator==(const Rgb&) const = default;
};

/// 8-bit RGB, three bytes per pixel, row 0 at the top, no padding: rgb.size() == 3 * width * height.
struct Picture {
  int width = 0, height = 0;  ///< pixels
  std::vector<std::uint8_t> rgb;

  Picture() = default;
  Picture(int width_, int height_, Rgb fill = {});

  /// Index of the red byte of pixel (x, y), which must lie inside.
  [[nodiscard]] std::size_t at(int x, int y) const {
    return 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
  }
  [[nodiscard]] Rgb get(int x, int y) const { return {rgb[at(x, y)], rgb[at(x, y) + 1], rgb[at(x, y) + 2]}; }
};

void set_pixel(Picture& picture, int x, int y, Rgb color);
void fill_rect(Picture& picture, const Rect& rect, Rgb color);

/// The outline of `rect`, one pixel wide, inside it.
void frame_rect(Picture& picture, const Rect& rect, Rgb color);

/// Both end points are drawn.
void draw_line(Picture& picture, int x0, int y0, int x1, int y1, Rgb color);

/// Copies `source` with its top left at (x, y); each of its pixels becomes scale x scale pixels.
void draw_picture(Picture& picture, const Picture& source, int x, int y, int scale = 1);

/// Rows from the top of a capital letter to the bottom of a descender, pixels.
[[nodiscard]] constexpr int text_height(int scale) { return 10 * scale; }

[[nodiscard]] int text_width(std::string_view text, int scale);

/// Draws one line of text with its top left at (x, y); scale 1...3 times the font's 7-pixel capitals.
void draw_text(Picture& picture, int x, int y, std::string_view text, Rgb color, int scale);

/// `text` in lines of at most `width` pixels, broken between words; later lines are indented by two more blanks. A word
/// wider than a line is broken between characters.
[[nodiscard]] std::vector<std::string> wrap_text(std::string_view text, int width, int scale);

/// The picture with every factor x factor block averaged into one pixel; blocks at the right and bottom may be smaller.
[[nodiscard]] Picture shrink(const Picture& picture, int factor);

}  // namespace halfplane
