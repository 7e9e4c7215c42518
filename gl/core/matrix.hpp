// Matrices, and the check of an enumerator, for the commands that take them.
#pragma once

#include <algorithm>
#include <initializer_list>

#include "context.hpp"

namespace halfplane::gl {

/// Into low...high, NaN as low.
[[nodiscard]] constexpr double held(double value, double low = 0, double high = 1) {
  const double raised = value > low ? value : low;  // one after the other: a maximum and a minimum, without a branch
  return raised < high ? raised : high;
}
[[nodiscard]] constexpr Vec4 held_color(const Vec4& v, double low = 0) {
  return {held(v[0], low), held(v[1], low), held(v[2], low), held(v[3], low)};
}

[[nodiscard]] constexpr Vec4 transformed(const Mat4& m, const Vec4& v) {
  Vec4 result{};
  for (std::size_t row = 0; row < 4; ++row)
    result[row] = m[row] * v[0] + m[4 + row] * v[1] + m[8 + row] * v[2] + m[12 + row] * v[3];
  return result;
}

/// A row times a matrix: how planes go from one space to the other, by the inverse of the matrix of points.
[[nodiscard]] constexpr Vec4 transformed_plane(const Vec4& plane, const Mat4& m) {
  Vec4 result{};
  for (std::size_t column = 0; column < 4; ++column)
    for (std::size_t row = 0; row < 4; ++row) result[column] += plane[row] * m[4 * column + row];
  return result;
}

[[nodiscard]] Mat4 product(const Mat4& a, const Mat4& b);
/// The adjugate where there is none.
[[nodiscard]] Mat4 inverse(const Mat4& m);

/// Sets `where`, or GL_INVALID_ENUM for illegal values.
inline void set_enum(Context& context, GLenum& where, GLenum value, std::initializer_list<GLenum> allowed) {
  if (std::ranges::find(allowed, value) == allowed.end()) return context.fail(GL_INVALID_ENUM);
  where = value;
}

}  // namespace halfplane::gl
