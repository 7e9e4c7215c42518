// Selection and feedback (OpenGL 1.5, 5.2 and 5.3).
#include <algorithm>
#include <cmath>

#include "commands.hpp"
#include "context.hpp"
#include "primitive.hpp"

namespace halfplane::gl {
namespace {

/// Values of a vertex in feedback beside x and y.
struct FeedbackType {
  GLenum type;
  int coordinates;
  bool has_color, has_texture;
};
constexpr std::array<FeedbackType, 5> kFeedbackTypes{{{GL_2D, 2, false, false},
                                                      {GL_3D, 3, false, false},
                                                      {GL_3D_COLOR, 3, true, false},
                                                      {GL_3D_COLOR_TEXTURE, 3, true, true},
                                                      {GL_4D_COLOR_TEXTURE, 4, true, true}}};

void select(Context& context, GLuint value) {
  if (context.select_used < static_cast<std::size_t>(context.select_size))
    context.select_buffer[context.select_used++] = value;
  else
    context.overflowed = true;
}

/// Ends the hit record of the names so far.
void record_hit(Context& context) {
  if (!context.was_hit) return;
  const auto depth = [](double z) { return static_cast<GLuint>(std::llround(std::clamp(z, 0.0, 1.0) * 0xffffffffU)); };
  select(context, static_cast<GLuint>(context.names.size()));
  select(context, depth(context.hit_low));
  select(context, depth(context.hit_high));
  for (const GLuint name : context.names) select(context, name);
  ++context.hits;
  context.was_hit = false;
}

void feed(Context& context, double value) {
  if (context.feedback_used < static_cast<std::size_t>(context.feedback_size))
    context.feedback_buffer[context.feedback_used++] = static_cast<GLfloat>(value);
  else
    context.overflowed = true;
}

void feed_vertex(Context& context, const Vec4& window, const Vec4& color, const Vec4& texture) {
  const FeedbackType& type = *std::ranges::find(kFeedbackTypes, context.feedback_type, &FeedbackType::type);
  for (int i = 0; i < type.coordinates; ++i) feed(context, window[static_cast<std::size_t>(i)]);
  for (const double c : color)
    if (type.has_color) feed(context, std::clamp(c, 0.0, 1.0));
  for (const double c : texture)
    if (type.has_texture) feed(context, c);
}

/// Whether names are kept, after writing the record of a hit under the names before the change.
bool changes_names(Context& context, bool is_allowed, GLenum error) {
  if (context.render_mode != GL_SELECT) return false;
  if (!is_allowed) return context.fail(error), false;
  record_hit(context);
  return true;
}

}  // namespace

void init_names(Context& context) {
  if (changes_names(context, true, GL_NO_ERROR)) context.names.clear();
}

void load_name(Context& context, GLuint name) {
  if (changes_names(context, !context.names.empty(), GL_INVALID_OPERATION)) context.names.back() = name;
}

void push_name(Context& context, GLuint name) {
  if (changes_names(context, context.names.size() < std::size_t{kNameDepth}, GL_STACK_OVERFLOW))
    context.names.push_back(name);
}

void pop_name(Context& context) {
  if (changes_names(context, !context.names.empty(), GL_STACK_UNDERFLOW)) context.names.pop_back();
}

void pass_through(Context& context, double token) {
  if (context.render_mode != GL_FEEDBACK) return;
  feed(context, GL_PASS_THROUGH_TOKEN);
  feed(context, token);
}

GLint set_render_mode(Context& context, GLenum mode) {
  if (mode != GL_RENDER && mode != GL_SELECT && mode != GL_FEEDBACK) return context.fail(GL_INVALID_ENUM), 0;
  if ((mode == GL_SELECT && context.select_buffer == nullptr) ||
      (mode == GL_FEEDBACK && context.feedback_buffer == nullptr))
    return context.fail(GL_INVALID_OPERATION), 0;
  GLint result = 0;
  if (context.render_mode == GL_SELECT) {
    record_hit(context);
    result = context.hits;
  } else if (context.render_mode == GL_FEEDBACK) {
    result = static_cast<GLint>(context.feedback_used);
  }
  if (context.overflowed) result = -1;
  context.render_mode = mode;
  context.names.clear();
  context.feedback_used = context.select_used = 0;
  context.hits = 0;
  context.overflowed = context.was_hit = false;
  return result;
}

void select_buffer(Context& context, GLsizei size, GLuint* buffer) {
  if (size < 0) return context.fail(GL_INVALID_VALUE);
  if (context.render_mode == GL_SELECT) return context.fail(GL_INVALID_OPERATION);
  context.select_buffer = buffer;
  context.select_size = buffer != nullptr ? size : 0;
}

void feedback_buffer(Context& context, GLsizei size, GLenum type, GLfloat* buffer) {
  if (std::ranges::find(kFeedbackTypes, type, &FeedbackType::type) == kFeedbackTypes.end())
    return context.fail(GL_INVALID_ENUM);
  if (size < 0) return context.fail(GL_INVALID_VALUE);
  if (context.render_mode == GL_FEEDBACK) return context.fail(GL_INVALID_OPERATION);
  context.feedback_buffer = buffer;
  context.feedback_size = buffer != nullptr ? size : 0;
  context.feedback_type = type;
}

void hit(Context& context, double z) {
  if (context.render_mode != GL_SELECT) return;
  context.hit_low = context.was_hit ? std::min(context.hit_low, z) : z;
  context.hit_high = context.was_hit ? std::max(context.hit_high, z) : z;
  context.was_hit = true;
}

void feed_primitive(Context& context, GLenum token, std::span<const ShadedVertex> vertices) {
  for (const ShadedVertex& v : vertices) hit(context, v.clip[2]);
  if (context.render_mode != GL_FEEDBACK) return;
  feed(context, token);
  if (token == GL_POLYGON_TOKEN) feed(context, static_cast<double>(vertices.size()));
  for (const ShadedVertex& v : vertices) feed_vertex(context, v.clip, v.color[0], v.tex_coord[0]);
}

bool feed_raster(Context& context, GLenum token) {
  const RasterPosition& raster = context.state.current.raster;
  if (context.render_mode == GL_FEEDBACK && raster.valid) {
    feed(context, token);
    feed_vertex(context, raster.window, raster.color, raster.tex_coord[0]);
  }
  return context.render_mode != GL_RENDER;
}

}  // namespace halfplane::gl
