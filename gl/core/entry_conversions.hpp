// Conversions of entry_points.cpp: from the arguments of an entry point to those of its command (OpenGL 1.5, 2.3, table 2.6
// and 6.1.2), and the way there.
#pragma once

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <memory>
#include <span>
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

/// Calls `body` with the context, not between glBegin and glEnd.
template <class Body>
auto outside_begin(const Body& body) {
  return with_context([&](Context& context) {
    if (!context.inside_begin()) return body(context);
    return context.fail(GL_INVALID_OPERATION), decltype(body(context))();
  });
}

// Commands as functions of their arguments but for the context.

/// A command that goes into display lists.
template <auto Command>
constexpr auto listed =
    [](const auto&... args) { with_context([&](Context& context) { issue<Command>(context, args...); }); };
/// A command that is carried out at once.
template <auto Command>
constexpr auto now = [](const auto&... args) {
  const auto body = [&](Context& context) { return Command(context, args...); };
  if constexpr (kIsAllowedInside<Command>)
    return with_context(body);
  else
    return outside_begin(body);
};
/// A function that issues a command itself.
template <auto Function>
constexpr auto entered =
    [](const auto&... args) { with_context([&](Context& context) { Function(context, args...); }); };

/// An error as a command: where a list is compiled, it comes when the list is called.
inline void fail(Context& context, GLenum error) { context.fail(error); }
inline void list_error(Context& context, GLenum error) { issue<&fail>(context, error); }

/// The 16.16 numbers of OpenGL ES, in place of their type, which is that of an integer.
struct Fixed;
/// The type that numbers are passed by.
template <class T>
using Raw = std::conditional_t<std::is_same_v<T, Fixed>, GLfixed, T>;

/// The type of an entry point's parameter where a command has a P, and its value.
template <class P, class T>
using Given = std::conditional_t<std::is_same_v<P, double>, Raw<T>, P>;
template <class P, class T>
constexpr P read(Given<P, T> value) {
  if constexpr (std::is_same_v<P, double> && std::is_same_v<T, Fixed>)
    return value / 65536.0;
  else
    return static_cast<P>(value);
}
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
Params params_of(GLenum pname, std::span<const Raw<T>> values, bool is_vector) {
  Params params{{}, std::is_integral_v<Raw<T>>, is_vector};
  std::ranges::copy(values, params.value.begin());
  if (std::is_same_v<T, Fixed>) params.is_integer = is_unscaled(pname);
  if (std::is_same_v<T, Fixed> && !params.is_integer)
    for (double& value : params.value) value /= 65536;
  return params;
}

template <std::size_t N, class T>
std::array<double, N> read_all(const Raw<T>* values) {
  std::array<double, N> result;
  std::transform(values, values + N, result.begin(), read<double, T>);
  return result;
}

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
void store(const Values& values, Raw<T>* to) {
  const bool is_real = values.kind == ValueKind::real || values.kind == ValueKind::color;
  for (const double value : values.value)
    *to++ = std::is_same_v<T, Fixed> ? converted<Raw<T>>(is_real ? value * 65536 : value, ValueKind::real)
                                     : converted<Raw<T>>(value, values.kind);
}
/// `equation` keeps its values where `plane` is none.
template <class T>
void store_clip_plane(Context& context, GLenum plane, T* equation) {
  const Vec4 value = get_clip_plane(context, plane);
  if (plane - GL_CLIP_PLANE0 >= GLuint{kClipPlanes}) return;
  for (const double part : value)
    *equation++ = static_cast<T>(std::is_integral_v<T> ? std::clamp(part * 65536, -2147483648.0, 2147483647.0) : part);
}

// Commands with arrays, and others without a simple row in the table of entry points (entry_conversions.cpp). Each is called at any time.
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
void enter_get_compressed_image(Context& context, GLenum target, GLint level);

template <class T>
void enter_pixel_map(Context& context, GLenum map, GLsizei size, const T* values) {
  if (size < 1 || size > kPixelMapTable) return list_error(context, GL_INVALID_VALUE);
  std::vector<float> table(static_cast<std::size_t>(size));
  const bool is_index = map == GL_PIXEL_MAP_I_TO_I || map == GL_PIXEL_MAP_S_TO_S;
  std::transform(values, values + size, table.begin(),
                 [&](T value) { return static_cast<float>(is_index ? static_cast<double>(value) : norm(value)); });
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
  if (packed != nullptr) issue<&map1>(context, target, u1, u2, order, packed);
}
template <class T>
void enter_map2(Context& context, GLenum target, T u1, T u2, GLint ustride, GLint uorder, T v1, T v2, GLint vstride,
                GLint vorder, const T* points) {
  const auto packed = control_points(context, target, {ustride, uorder}, {vstride, vorder}, points);
  if (packed != nullptr) issue<&map2>(context, target, u1, u2, uorder, v1, v2, vorder, packed);
}

}  // namespace halfplane::gl
