// Conversions of entry_points.cpp: from the arguments of an entry point to those of its command (OpenGL 1.5, 2.3, table 2.6
// and 6.1.2), and the way there.
#pragma once

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

#include "commands.hpp"
#include "list.hpp"

namespace halfplane::gl {

/// Calls `body` with the context of this thread. Without one, and where memory runs out: 0. No exception leaves.
template <class Body>
auto with_context(const Body& body) -> decltype(body(std::declval<Context&>())) {
  Context* context = current();
  if (context != nullptr) try {
      return body(*context);
    } catch (const std::exception&) {
      context->fail(GL_OUT_OF_MEMORY);
    }
  return decltype(body(std::declval<Context&>()))();
}

/// A command that goes into display lists, refused between glBegin and glEnd.
template <auto Command, class... Args>
void listed(const Args&... args) {
  with_context([&](Context& context) { issue<Command>(context, args...); });
}
/// The same, allowed there.
template <auto Command, class... Args>
void listed_inside(const Args&... args) {
  with_context([&](Context& context) { issue<Command, InsideBegin::allowed>(context, args...); });
}
/// For commands that no list holds: calls `body` with the context, not between glBegin and glEnd.
template <class Body>
auto outside_begin(const Body& body) {
  return with_context([&](Context& context) {
    if (!context.inside_begin()) return body(context);
    context.fail(GL_INVALID_OPERATION);
    return decltype(body(context))();
  });
}
/// A command that is carried out at once, refused between glBegin and glEnd.
template <auto Command, class... Args>
auto now(const Args&... args) {
  return outside_begin([&](Context& context) { return Command(context, args...); });
}
/// The same, allowed there.
template <auto Command, class... Args>
void now_inside(const Args&... args) {
  with_context([&](Context& context) { Command(context, args...); });
}

/// An error as a command: where a list is compiled, it comes when the list is called.
inline void fail(Context& context, GLenum error) { context.fail(error); }
inline void list_error(Context& context, GLenum error) { issue<&fail>(context, error); }

constexpr double real(double value) { return value; }
constexpr double fixed(GLfixed value) { return value / 65536.0; }
/// Integers as colours and normals (table 2.6).
template <class T>
constexpr double norm(T value) {
  if constexpr (!std::is_integral_v<T>)
    return value;
  else if constexpr (std::is_unsigned_v<T>)
    return value / static_cast<double>(std::numeric_limits<T>::max());
  else
    return (2.0 * value + 1) / static_cast<double>(std::numeric_limits<std::make_unsigned_t<T>>::max());
}

template <class T>
Params scalar(GLenum, T value) {
  return {{static_cast<double>(value)}, std::is_integral_v<T>, false};
}
template <class T>
Params vector(GLenum pname, const T* values) {
  Params params{{}, std::is_integral_v<T>, true};
  std::copy_n(values, param_count(pname), params.value.begin());
  return params;
}
/// Whether the values of `pname` are enums or booleans, which OpenGL ES does not scale in its x variants.
[[nodiscard]] bool is_unscaled(GLenum pname);
inline Params scaled(GLenum pname, Params params) {
  params.is_integer = is_unscaled(pname);
  if (!params.is_integer)
    for (double& value : params.value) value /= 65536;
  return params;
}
inline Params scalar_fixed(GLenum pname, GLfixed value) { return scaled(pname, scalar(pname, value)); }
inline Params vector_fixed(GLenum pname, const GLfixed* values) { return scaled(pname, vector(pname, values)); }

template <class T>
Mat4 matrix(const T* m) {
  Mat4 result;
  std::copy_n(m, result.size(), result.begin());
  return result;
}
inline Mat4 matrix_fixed(const GLfixed* m) {
  Mat4 result;
  std::transform(m, m + result.size(), result.begin(), fixed);
  return result;
}
template <class T>
Vec4 vec4(const T* v) {
  return {real(v[0]), real(v[1]), real(v[2]), real(v[3])};
}
inline Vec4 vec4_fixed(const GLfixed* v) { return {fixed(v[0]), fixed(v[1]), fixed(v[2]), fixed(v[3])}; }

/// A value of state as T (6.1.2).
template <class T>
T converted(double value, ValueKind kind) {
  if constexpr (!std::is_integral_v<T>) {
    return static_cast<T>(value);
  } else if constexpr (std::is_same_v<T, GLboolean>) {
    return value != 0;
  } else {
    using Limits = std::numeric_limits<T>;
    if (std::isnan(value)) return 0;
    if (kind == ValueKind::integer || kind == ValueKind::boolean)  // an unsigned one keeps its bits
      return static_cast<T>(static_cast<std::int64_t>(std::clamp(value, -9.0e18, 9.0e18)));
    if (kind == ValueKind::color)  // 0 lies between two integers and becomes 0
      value = std::nearbyint(std::is_unsigned_v<T> ? value * Limits::max()
                                                   : (value * std::numeric_limits<GLuint>::max() - 1) / 2);
    return static_cast<T>(
        std::clamp(std::round(value), static_cast<double>(Limits::min()), static_cast<double>(Limits::max())));
  }
}
template <class T>
void store(const Values& values, T* to) {
  for (const double value : values.value) *to++ = converted<T>(value, values.kind);
}
inline void store_fixed(const Values& values, GLfixed* to) {
  const bool is_scaled = values.kind == ValueKind::real || values.kind == ValueKind::color;
  for (const double value : values.value)
    *to++ = converted<GLfixed>(is_scaled ? value * 65536 : value, ValueKind::real);
}
/// glGetFixedv scales integers, too.
inline void store_state_fixed(Values values, GLfixed* to) {
  values.kind = ValueKind::real;
  store_fixed(values, to);
}
/// `equation` keeps its values where `plane` is none.
template <class T>
void store_clip_plane(Context& context, GLenum plane, T* equation) {
  const Vec4 value = get_clip_plane(context, plane);
  if (plane - GL_CLIP_PLANE0 >= GLuint{kClipPlanes}) return;
  for (const double part : value)
    *equation++ = static_cast<T>(std::is_integral_v<T> ? std::clamp(part * 65536, -2147483648.0, 2147483647.0) : part);
}

// Commands with arrays, and others without a simple row in entry_points.py (entry_conversions.cpp). Each is called at any time.
void enter_draw_pixels(Context& context, GLsizei width, GLsizei height, GLenum format, GLenum type, const void* pixels);
void enter_bitmap(Context& context, GLsizei width, GLsizei height, double x_origin, double y_origin, double x_move,
                  double y_move, const GLubyte* bits);
void enter_polygon_stipple(Context& context, const GLubyte* mask);
void enter_tex_image(Context& context, int dimensions, GLenum target, GLint level, GLint internal_format, GLsizei width,
                     GLsizei height, GLsizei depth, GLint border, GLenum format, GLenum type, const void* pixels);
void enter_tex_sub_image(Context& context, int dimensions, GLenum target, GLint level, GLint x, GLint y, GLint z,
                         GLsizei width, GLsizei height, GLsizei depth, GLenum format, GLenum type, const void* pixels);
void enter_call_lists(Context& context, GLsizei n, GLenum type, const void* lists);
void enter_prioritize_textures(Context& context, GLsizei n, const GLuint* names, const GLfloat* priorities);
void enter_delete_textures(Context& context, GLsizei n, const GLuint* names);
void enter_get_compressed_image(Context& context, GLenum target, GLint level);

template <class T>
void enter_pixel_map(Context& context, GLenum map, GLsizei size, const T* values) {
  if (size < 1 || size > kPixelMapTable) return list_error(context, GL_INVALID_VALUE);
  std::vector<float> table(static_cast<std::size_t>(size));
  const bool is_index = map == GL_PIXEL_MAP_I_TO_I || map == GL_PIXEL_MAP_S_TO_S;
  std::transform(values, values + size, table.begin(),
                 [&](T value) { return static_cast<float>(is_index ? real(value) : norm(value)); });
  issue<&pixel_map>(context, map, std::make_shared<const std::vector<float>>(std::move(table)));
}

/// One of the two directions of an evaluator's control points.
struct MapSide {
  GLint stride, order;
};
template <class T>
std::shared_ptr<const std::vector<double>> control_points(Context& context, GLenum target, MapSide u, MapSide v,
                                                          const T* points) {
  const int components = map_components(target);
  if (components == 0) return list_error(context, GL_INVALID_ENUM), nullptr;
  for (const MapSide side : {u, v})
    if (side.stride < components || side.order < 1 || side.order > kEvalOrder)
      return list_error(context, GL_INVALID_VALUE), nullptr;
  auto packed = std::make_shared<std::vector<double>>();
  for (std::ptrdiff_t i = 0; i < u.order; ++i)
    for (std::ptrdiff_t j = 0; j < v.order; ++j) {
      const T* point = points + i * u.stride + j * v.stride;
      packed->insert(packed->end(), point, point + components);
    }
  return packed;
}
template <class T>
void enter_map1(Context& context, GLenum target, T u1, T u2, GLint stride, GLint order, const T* points) {
  const auto packed = control_points(context, target, {stride, order}, {kEvalOrder, 1}, points);
  if (packed != nullptr) issue<&map1>(context, target, real(u1), real(u2), order, packed);
}
template <class T>
void enter_map2(Context& context, GLenum target, T u1, T u2, GLint ustride, GLint uorder, T v1, T v2, GLint vstride,
                GLint vorder, const T* points) {
  const auto packed = control_points(context, target, {ustride, uorder}, {vstride, vorder}, points);
  if (packed != nullptr) issue<&map2>(context, target, real(u1), real(u2), uorder, real(v1), real(v2), vorder, packed);
}

}  // namespace halfplane::gl
