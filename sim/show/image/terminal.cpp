#include "terminal.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <new>
#include <string_view>

#define STB_IMAGE_RESIZE_STATIC  // our copy stays in this file, whatever other libraries contain
#define STB_IMAGE_RESIZE_IMPLEMENTATION
#include <stb_image_resize.h>

namespace halfplane {
namespace {

constexpr std::string_view kGreyRamp = " .:-=+*#%@";  // dark to bright on a dark terminal
constexpr int kMaxColumns = 400;                      // a wider terminal only gains escape sequences

// Averages areas in linear light, so that thin bright lines keep their brightness.
Picture resized(const Picture& picture, int width, int height) {
  Picture result(width, height);
  const int done = stbir_resize_uint8_generic(picture.rgb.data(), picture.width, picture.height, 0, result.rgb.data(),
                                              width, height, 0, 3, STBIR_ALPHA_CHANNEL_NONE, 0, STBIR_EDGE_CLAMP,
                                              STBIR_FILTER_BOX, STBIR_COLORSPACE_SRGB, nullptr);
  if (done == 0) throw std::bad_alloc();
  return result;
}

// Fits into columns x 2 rows square pixels.
Picture fitted(const Picture& picture, TerminalSize size) {
  const int columns = std::clamp(size.columns, 1, kMaxColumns), pixel_rows = 2 * std::max(size.rows, 1);
  const int factor = std::min(columns / picture.width, pixel_rows / picture.height);
  if (factor >= 1) {
    Picture result(factor * picture.width, factor * picture.height);
    draw_picture(result, picture, 0, 0, factor);
    return result;
  }
  const double scale =
      std::min(static_cast<double>(columns) / picture.width, static_cast<double>(pixel_rows) / picture.height);
  const auto side = [scale](int pixels) { return std::max(1, static_cast<int>(std::lround(pixels * scale))); };
  return resized(picture, side(picture.width), side(picture.height));
}

std::string escape(int layer, Rgb c) {  // layer 38: foreground, 48: background
  return "\x1b[" + std::to_string(layer) + ";2;" + std::to_string(c.r) + ";" + std::to_string(c.g) + ";" +
         std::to_string(c.b) + "m";
}

std::string color_line(const Picture& picture, int y) {
  std::string line;
  Rgb upper_before, lower_before;
  const bool has_lower = y + 1 < picture.height;
  for (int x = 0; x < picture.width; ++x) {
    const Rgb upper = picture.get(x, y), lower = has_lower ? picture.get(x, y + 1) : Rgb{};
    if (x == 0 || !(upper == upper_before)) line += escape(38, upper);
    if (has_lower && (x == 0 || !(lower == lower_before))) line += escape(48, lower);
    line += "\u2580";  // upper half block: foreground above, background below
    upper_before = upper;
    lower_before = lower;
  }
  return line + "\x1b[0m\n";
}

int luma(Rgb c) { return (2126 * c.r + 7152 * c.g + 722 * c.b) / 10000; }  // ITU-R BT.709 weights; 0...255

std::string plain_line(const Picture& picture, int y) {
  std::string line;
  const int lower = std::min(y + 1, picture.height - 1);
  for (int x = 0; x < picture.width; ++x) {
    const int grey = (luma(picture.get(x, y)) + luma(picture.get(x, lower)) + 1) / 2;
    line += kGreyRamp[static_cast<std::size_t>(grey) * kGreyRamp.size() / 256];
  }
  line.erase(line.find_last_not_of(' ') + 1);
  return line + "\n";
}

}  // namespace

TerminalStyle terminal_style(bool is_terminal, const char* no_color, const char* term) {
  const std::string_view name = term == nullptr ? "" : term;
  const bool refused = no_color != nullptr && *no_color != '\0';
  return is_terminal && !refused && !name.empty() && name != "dumb" ? TerminalStyle::color : TerminalStyle::plain;
}

TerminalStyle terminal_style(int descriptor) {
  return terminal_style(isatty(descriptor) == 1, std::getenv("NO_COLOR"), std::getenv("TERM"));
}

TerminalSize terminal_size(int descriptor, int max_rows) {
  TerminalSize size;
  winsize window{};
  if (ioctl(descriptor, TIOCGWINSZ, &window) == 0 && window.ws_col > 0) size.columns = window.ws_col;
  size.rows = max_rows;
  return size;
}

std::string terminal_preview(const Picture& picture, TerminalSize size, TerminalStyle style) {
  if (picture.width <= 0 || picture.height <= 0) return "";
  const Picture small = fitted(picture, size);
  std::string text;
  for (int y = 0; y < small.height; y += 2)
    text += style == TerminalStyle::color ? color_line(small, y) : plain_line(small, y);
  return text;
}

}  // namespace halfplane
