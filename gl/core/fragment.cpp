// State of fragments and of the framebuffer, clears and the accumulation buffer (OpenGL 1.5, 4.1 and 4.2).
#include <algorithm>
#include <cmath>
#include <utility>

#include "commands.hpp"
#include "context.hpp"
#include "embedded.hpp"
#include "matrix.hpp"
#include "primitive.hpp"

namespace halfplane::gl {
namespace {

bool is_one_of(GLenum value, std::initializer_list<GLenum> values) {
  return std::ranges::find(values, value) != values.end();
}
bool is_comparison(GLenum func) { return func >= GL_NEVER && func <= GL_ALWAYS; }
bool is_factor(GLenum factor, bool is_source) {
  return factor <= GL_ONE || (factor >= GL_SRC_COLOR && factor <= GL_ONE_MINUS_DST_COLOR) ||
         (factor == GL_SRC_ALPHA_SATURATE && is_source) ||
         (factor >= GL_CONSTANT_COLOR && factor <= GL_ONE_MINUS_CONSTANT_ALPHA);
}
bool is_stencil_op(GLenum op) {
  return is_one_of(op, {GL_KEEP, GL_ZERO, GL_REPLACE, GL_INCR, GL_DECR, GL_INVERT, GL_INCR_WRAP, GL_DECR_WRAP});
}

/// Whether `mode` names a colour buffer of the drawable; reports the error where it does not.
bool has_buffer(Context& context, GLenum mode, bool is_single) {
  if (is_one_of(mode, {GL_FRONT, GL_FRONT_LEFT, GL_LEFT})) return true;
  if (is_one_of(mode, {GL_BACK, GL_BACK_LEFT})) {
    if (!is_single) return true;
    return context.fail(GL_INVALID_OPERATION), false;
  }
  const bool is_absent = is_one_of(mode, {GL_RIGHT, GL_FRONT_RIGHT, GL_BACK_RIGHT, GL_AUX0, GL_AUX1, GL_AUX2, GL_AUX3});
  return context.fail(is_absent ? GL_INVALID_OPERATION : GL_INVALID_ENUM), false;
}
bool is_front(GLenum buffer) { return buffer == GL_FRONT || buffer == GL_FRONT_LEFT; }
/// The back buffer stands for both.
bool is_front_and_back(GLenum buffer) { return buffer == GL_FRONT_AND_BACK || buffer == GL_LEFT; }
bool is_single(const Drawable* drawable) { return drawable != nullptr && drawable->single_buffered; }

/// The state of masked clears: all pixels in the scissor.
halfplane::State fill_state(Context& context) {
  halfplane::State state = all_pixels();
  state.scissor = clear_state(context).scissor;
  return state;
}

std::array<double, 4> in_bytes(const Vec4& color) {
  std::array<double, 4> rgba{};
  std::ranges::transform(color, rgba.begin(), [](double c) { return 255 * c; });
  return rgba;
}

/// Pixels of the drawable in the scissor, as columns and rows from the bottom left.
struct Pixels {
  int left = 0, bottom = 0, right = 0, top = 0;
};
Pixels pixels_in_scissor(Context& context) {
  const Frame& frame = context.drawable->frame;
  Pixels in{0, 0, frame.width(), frame.height()};
  if (const auto scissor = clear_state(context).scissor) {
    in = {std::min(scissor->x, in.right), std::min(scissor->y, in.top), std::min(scissor->x + scissor->width, in.right),
          std::min(scissor->y + scissor->height, in.top)};
  }
  return in;
}

/// Calls visit(value) for each accumulated value in the scissor, with the place of its pixel there, row by row.
template <class Visit>
void for_each_accumulated(Context& context, const Visit& visit) {
  const Frame& frame = context.drawable->frame;
  const auto width = static_cast<std::size_t>(frame.width());
  context.accumulation.resize(width * static_cast<std::size_t>(frame.height()));
  const Pixels in = pixels_in_scissor(context);
  std::size_t place = 0;
  for (int y = in.bottom; y < in.top; ++y)
    for (int x = in.left; x < in.right; ++x)
      visit(context.accumulation[static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)], place++);
}

/// Writes the accumulation buffer, times `value`, to the colour buffer.
void return_accumulated(Context& context, float value) {
  if (context.state.color.draw_buffer == GL_NONE) return;
  const Pixels in = pixels_in_scissor(context);
  if (in.left >= in.right || in.bottom >= in.top) return;
  TexelImage image{in.right - in.left, in.top - in.bottom, {}};
  for_each_accumulated(context, [&](const std::array<float, 4>& from, std::size_t) {
    Texel& texel = image.texel.emplace_back();
    std::ranges::transform(from, texel.begin(), [value](float c) {
      return static_cast<std::uint8_t>(std::lround(held(static_cast<double>(c * value)) * 255));
    });
  });
  halfplane::State state = fill_state(context);
  state.color_mask = context.state.color.write;
  state.dither = context.state.color.dither && context.drawable->frame.options().config.dither_units != 0;
  draw_image(context, state, image, in.left, in.bottom);
}

}  // namespace

void enable(Context& context, GLenum cap, bool enabled) {
  if (!takes_enable(context, cap)) return context.fail(GL_INVALID_ENUM);
  bool* const flag = enable_flag(context, cap);
  if (flag == nullptr) return client_state(context, cap, enabled);  // GL_EXT_vertex_array enables arrays here
  *flag = enabled;
  if (cap == GL_COLOR_MATERIAL && enabled) track_color(context);
}

void alpha_func(Context& context, GLenum func, double reference) {
  if (!is_comparison(func)) return context.fail(GL_INVALID_ENUM);
  context.state.color.alpha_func = func;
  context.state.color.alpha_reference = held(reference);
}

void blend_func_separate(Context& context, GLenum src, GLenum dst, GLenum src_alpha, GLenum dst_alpha) {
  if (!is_factor(src, true) || !is_factor(dst, false) || !is_factor(src_alpha, true) || !is_factor(dst_alpha, false))
    return context.fail(GL_INVALID_ENUM);
  ColorState& color = context.state.color;
  color.src_rgb = src, color.dst_rgb = dst, color.src_alpha = src_alpha, color.dst_alpha = dst_alpha;
}

void blend_equation(Context& context, GLenum mode) {
  if (!is_one_of(mode, {GL_FUNC_ADD, GL_FUNC_SUBTRACT, GL_FUNC_REVERSE_SUBTRACT, GL_MIN, GL_MAX}))
    return context.fail(GL_INVALID_ENUM);
  context.state.color.equation = mode;
}

void blend_color(Context& context, double r, double g, double b, double a) {
  context.state.color.blend_color = held_color({r, g, b, a});
}

void depth_func(Context& context, GLenum func) {
  if (!is_comparison(func)) return context.fail(GL_INVALID_ENUM);
  context.state.depth.func = func;
}

void depth_mask(Context& context, GLboolean write) { context.state.depth.write = write != GL_FALSE; }

void stencil_func(Context& context, GLenum func, GLint reference, GLuint mask) {
  if (!is_comparison(func)) return context.fail(GL_INVALID_ENUM);
  StencilState& stencil = context.state.stencil;
  stencil.func = func, stencil.reference = std::clamp(reference, 0, 255), stencil.value_mask = mask;
}

void stencil_mask(Context& context, GLuint mask) { context.state.stencil.write_mask = mask; }

void stencil_op(Context& context, GLenum fail, GLenum depth_fail, GLenum depth_pass) {
  if (!is_stencil_op(fail) || !is_stencil_op(depth_fail) || !is_stencil_op(depth_pass))
    return context.fail(GL_INVALID_ENUM);
  StencilState& stencil = context.state.stencil;
  stencil.fail = fail, stencil.depth_fail = depth_fail, stencil.depth_pass = depth_pass;
}

void color_mask(Context& context, GLboolean r, GLboolean g, GLboolean b, GLboolean a) {
  context.state.color.write = {r != GL_FALSE, g != GL_FALSE, b != GL_FALSE, a != GL_FALSE};
}

void index_mask(Context& context, GLuint mask) { context.state.color.index_write = mask; }

void logic_op(Context& context, GLenum op) {
  if (op < GL_CLEAR || op > GL_SET) return context.fail(GL_INVALID_ENUM);
  context.state.color.logic_func = op;
}

void scissor(Context& context, GLint x, GLint y, GLsizei width, GLsizei height) {
  if (width < 0 || height < 0) return context.fail(GL_INVALID_VALUE);
  ScissorState& scissor = context.state.scissor;
  scissor.x = x, scissor.y = y, scissor.width = width, scissor.height = height;
}

void sample_coverage(Context& context, double value, GLboolean invert) {
  context.state.multisample.value = held(value);
  context.state.multisample.invert = invert != GL_FALSE;
}

void hint(Context& context, GLenum target, GLenum mode) {
  const auto at = std::ranges::find(kHints, target);
  if (at == kHints.end()) return context.fail(GL_INVALID_ENUM);
  set_enum(context, context.state.hint[static_cast<std::size_t>(at - kHints.begin())], mode,
           {GL_FASTEST, GL_NICEST, GL_DONT_CARE});
}

void draw_buffer(Context& context, GLenum mode) {
  if (mode != GL_NONE && mode != GL_FRONT_AND_BACK && !has_buffer(context, mode, is_single(context.drawable))) return;
  const GLenum before = std::exchange(context.state.color.draw_buffer, mode);
  if (context.drawable != nullptr && !context.drawable->single_buffered && is_front_and_back(before))
    context.drawable->make_front(true);
  follow_draw_buffer(context);
}

void follow_draw_buffer(Context& context) {
  const GLenum mode = context.state.color.draw_buffer;
  if (context.drawable != nullptr && mode != GL_NONE) context.drawable->draw_to(is_front(mode));
}

void read_buffer(Context& context, GLenum mode) {
  Drawable* const drawable = context.read_drawable;
  if (!has_buffer(context, mode, is_single(drawable))) return;
  context.state.pixel.read_buffer = mode;
  if (drawable != nullptr && !drawable->single_buffered && is_front(mode)) drawable->make_front();
}

bool reads_front(const Context& context) {
  const bool both = context.drawable == context.read_drawable && is_front_and_back(context.state.color.draw_buffer);
  return !both && is_front(context.state.pixel.read_buffer);
}

void clear(Context& context, GLbitfield mask) {
  constexpr GLbitfield kAll = GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT | GL_ACCUM_BUFFER_BIT;
  if ((mask & ~kAll) != 0) return context.fail(GL_INVALID_VALUE);
  if (context.render_mode != GL_RENDER || context.drawable == nullptr) return;
  const gl::State& from = context.state;
  Clear what;
  const auto writes = std::ranges::count(from.color.write, true);
  if ((mask & GL_COLOR_BUFFER_BIT) != 0 && from.color.draw_buffer != GL_NONE && writes > 0) {
    if (writes == 4) {
      what.color = in_bytes(from.color.clear);
    } else {
      halfplane::State masked = fill_state(context);
      masked.color_mask = from.color.write;
      fill_target(context, masked, in_bytes(from.color.clear));
    }
  }
  if ((mask & GL_DEPTH_BUFFER_BIT) != 0 && from.depth.write) what.depth = from.depth.clear;
  const auto value = static_cast<std::uint8_t>(from.stencil.clear & 255),
             bits = static_cast<std::uint8_t>(from.stencil.write_mask & 255);
  if ((mask & GL_STENCIL_BUFFER_BIT) != 0 && bits != 0) {
    if (bits == 255) {
      what.stencil = value;
    } else {
      halfplane::State masked = fill_state(context);
      masked.color_write = false;
      masked.stencil = Stencil{.reference = value, .write_mask = bits, .passes = StencilOp::replace};
      fill_target(context, masked, {});
    }
  }
  if (what.color || what.depth || what.stencil) context.drawable->frame.clear(clear_state(context), what);
  if ((mask & GL_ACCUM_BUFFER_BIT) == 0) return;
  std::array<float, 4> accumulated{};
  std::ranges::transform(from.accum.clear, accumulated.begin(), [](double c) { return static_cast<float>(c); });
  for_each_accumulated(context, [&](std::array<float, 4>& to, std::size_t) { to = accumulated; });
}

void clear_color(Context& context, double r, double g, double b, double a) {
  context.state.color.clear = held_color({r, g, b, a});
}
void clear_depth(Context& context, double depth) { context.state.depth.clear = held(depth); }
void clear_stencil(Context& context, GLint value) { context.state.stencil.clear = value & 255; }
void clear_index(Context& context, double index) { context.state.color.clear_index = index; }
void clear_accum(Context& context, double r, double g, double b, double a) {
  context.state.accum.clear = held_color({r, g, b, a}, -1);
}

void accum(Context& context, GLenum op, double value) {
  if (!is_one_of(op, {GL_ACCUM, GL_LOAD, GL_ADD, GL_MULT, GL_RETURN})) return context.fail(GL_INVALID_ENUM);
  if (context.render_mode != GL_RENDER || context.drawable == nullptr) return;
  const auto factor = static_cast<float>(value);
  if (op == GL_RETURN) return return_accumulated(context, factor);
  Image image;
  if (op == GL_ACCUM || op == GL_LOAD) {
    const Pixels in = pixels_in_scissor(context);
    if (in.left >= in.right || in.bottom >= in.top) return;
    image = read_rectangle(context, in.left, in.bottom, in.right - in.left, in.top - in.bottom, GL_RGBA);
  }
  for_each_accumulated(context, [&](std::array<float, 4>& to, std::size_t place) {
    for (std::size_t c = 0; c < 4; ++c) {
      float& a = to[c];
      if (op == GL_ADD) a += factor;
      if (op == GL_MULT) a *= factor;
      if (op == GL_ACCUM) a += factor * image.pixel[place][c];
      if (op == GL_LOAD) a = factor * image.pixel[place][c];
    }
  });
}

void flush(Context& context) {
  Drawable* const drawable = context.drawable;
  if (drawable == nullptr) return;
  const GLenum buffer = context.state.color.draw_buffer;
  if (drawable->single_buffered || is_front(buffer) || is_front_and_back(buffer)) drawable->present();
}

void finish(Context& context) {
  flush(context);
  if (context.drawable != nullptr) context.drawable->finish();
}

}  // namespace halfplane::gl
