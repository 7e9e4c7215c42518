// glXUseXFont: display lists that draw the characters of an X font.
#include <algorithm>

#include "../core/list.hpp"
#include "glx.hpp"

namespace halfplane::gl::glx {
namespace {

/// A list that draws character `c`: its box in the font is [lbearing, rbearing) x [-descent, ascent).
void compile_character(Context& context, Display* display, GC gc, Pixmap pixmap, const XCharStruct& box, unsigned c) {
  auto bits = std::make_shared<Bitmap>();
  bits->width = std::max(0, box.rbearing - box.lbearing);
  bits->height = std::max(0, box.ascent + box.descent);
  bits->bit.resize(static_cast<std::size_t>(bits->width) * static_cast<std::size_t>(bits->height));
  const auto width = static_cast<unsigned>(bits->width), height = static_cast<unsigned>(bits->height);
  XImage* image = nullptr;
  if (!bits->bit.empty()) {
    const XChar2b text{static_cast<unsigned char>(c >> 8), static_cast<unsigned char>(c & 255)};
    XSetForeground(display, gc, 0);
    XFillRectangle(display, pixmap, gc, 0, 0, width, height);
    XSetForeground(display, gc, 1);
    XDrawString16(display, pixmap, gc, -box.lbearing, box.ascent, &text, 1);
    image = XGetImage(display, pixmap, 0, 0, width, height, 1, XYPixmap);
  }
  if (image != nullptr) {
    for (int y = 0; y < bits->height; ++y)
      for (int x = 0; x < bits->width; ++x)
        bits->bit[static_cast<std::size_t>(bits->height - 1 - y) * width + static_cast<std::size_t>(x)] =
            XGetPixel(image, x, y) != 0;
    XDestroyImage(image);
  }
  issue<&bitmap>(context, bits, -box.lbearing, box.descent, box.width, 0);
}

}  // namespace

void use_x_font(Font font, int first, int count, int list_base) {
  GlxContext* const context = here();
  if (context == nullptr) return;
  Display* const display = context->display;
  if (context->inside_begin() || context->compiling != nullptr || context->draw == nullptr) {
    send(display, {GLXBadContextState, true, 0}, X_GLXUseXFont);
    return;
  }
  XFontStruct* const info = XQueryFont(display, font);
  if (info == nullptr) return;  // BadFont came from the server
  const int width = std::max(1, info->max_bounds.rbearing - info->min_bounds.lbearing);
  const int height = std::max(1, info->max_bounds.ascent + info->max_bounds.descent);
  const Pixmap pixmap = XCreatePixmap(display, RootWindow(display, context->config->screen),
                                      static_cast<unsigned>(width), static_cast<unsigned>(height), 1);
  const GC gc = XCreateGC(display, pixmap, 0, nullptr);
  XSetFont(display, gc, font);
  const unsigned columns = info->max_char_or_byte2 - info->min_char_or_byte2 + 1;
  for (int i = 0; i < count; ++i) {
    const auto c = static_cast<unsigned>(first + i);
    const unsigned row = c >> 8, column = info->max_byte1 == 0 ? c : c & 255;
    XCharStruct box{};
    if (column >= info->min_char_or_byte2 && column <= info->max_char_or_byte2 &&
        (info->max_byte1 == 0 || (row >= info->min_byte1 && row <= info->max_byte1)))
      box = info->per_char == nullptr ? info->max_bounds
                                      : info->per_char[(info->max_byte1 == 0 ? 0 : row - info->min_byte1) * columns +
                                                       column - info->min_char_or_byte2];
    new_list(*context, static_cast<GLuint>(list_base + i), GL_COMPILE);
    compile_character(*context, display, gc, pixmap, box, c);
    end_list(*context);
  }
  XFreeGC(display, gc);
  XFreePixmap(display, pixmap);
  XFreeFontInfo(nullptr, info, 1);
}

}  // namespace halfplane::gl::glx
