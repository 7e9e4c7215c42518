// Matrices, their stacks, and where clip space comes to lie (OpenGL 1.5, 2.11 and 2.12).
#include "matrix.hpp"

#include <cmath>
#include <numbers>

#include "commands.hpp"

namespace halfplane::gl {

Mat4 product(const Mat4& a, const Mat4& b) {
  Mat4 result;
  for (std::size_t column = 0; column < 16; column += 4) {
    const Vec4 image = transformed(a, {b[column], b[column + 1], b[column + 2], b[column + 3]});
    std::ranges::copy(image, result.begin() + static_cast<std::ptrdiff_t>(column));
  }
  return result;
}

Mat4 inverse(const Mat4& m) {
  // Minors of two columns: of the first two (low) and of the last two (high), for each pair of rows.
  constexpr std::array<std::array<std::size_t, 2>, 6> kRows{{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};
  std::array<double, 6> low{}, high{};
  for (std::size_t i = 0; i < 6; ++i) {
    const auto [r, s] = kRows[i];
    low[i] = m[r] * m[4 + s] - m[s] * m[4 + r];
    high[i] = m[8 + r] * m[12 + s] - m[8 + s] * m[12 + r];
  }
  const double determinant =
      low[0] * high[5] - low[1] * high[4] + low[2] * high[3] + low[3] * high[2] - low[4] * high[1] + low[5] * high[0];
  const double scale = determinant != 0 && std::isfinite(1 / determinant) ? 1 / determinant : 1;
  // Row `column` of the result are the cofactors of that column: the other column of its half with the minors of the other.
  Mat4 result;
  for (std::size_t column = 0; column < 4; ++column) {
    const double* other = &m[4 * (column ^ 1U)];
    const auto& minor = column < 2 ? high : low;
    const double sign = column % 2 == 0 ? scale : -scale;
    result[column] = sign * (other[1] * minor[5] - other[2] * minor[4] + other[3] * minor[3]);
    result[4 + column] = -sign * (other[0] * minor[5] - other[2] * minor[2] + other[3] * minor[1]);
    result[8 + column] = sign * (other[0] * minor[4] - other[1] * minor[2] + other[3] * minor[0]);
    result[12 + column] = -sign * (other[0] * minor[3] - other[1] * minor[1] + other[2] * minor[0]);
  }
  return result;
}

namespace {

struct Stack {
  std::vector<Mat4>& matrix;
  std::size_t depth;
};

Stack stack_of(Context& context) {
  switch (context.state.transform.matrix_mode) {
    case GL_PROJECTION: return {context.projection, kProjectionDepth};
    case GL_TEXTURE:
      return {context.texture_matrix[static_cast<std::size_t>(context.state.texture.active)], kTextureDepth};
    default: return {context.modelview, kModelviewDepth};
  }
}

Mat4& top(Context& context) { return stack_of(context).matrix.back(); }

Mat4 transposed(const Mat4& m) {
  Mat4 result;
  for (std::size_t i = 0; i < 16; ++i) result[i] = m[i % 4 * 4 + i / 4];
  return result;
}

/// A box that is taken to -1...1, by the mean and the half of its sides.
struct Box {
  std::array<double, 3> low, high;
  [[nodiscard]] bool is_flat() const { return low[0] == high[0] || low[1] == high[1] || low[2] == high[2]; }
  [[nodiscard]] double size(std::size_t i) const { return high[i] - low[i]; }
  [[nodiscard]] double middle(std::size_t i) const { return (high[i] + low[i]) / size(i); }
};

}  // namespace

void matrix_mode(Context& context, GLenum mode) {
  set_enum(context, context.state.transform.matrix_mode, mode, {GL_MODELVIEW, GL_PROJECTION, GL_TEXTURE});
}

void load_identity(Context& context) { top(context) = kIdentity; }
void load_matrix(Context& context, Mat4 m) { top(context) = m; }
void load_transpose_matrix(Context& context, Mat4 m) { top(context) = transposed(m); }
void mult_matrix(Context& context, Mat4 m) { top(context) = product(top(context), m); }
void mult_transpose_matrix(Context& context, Mat4 m) { mult_matrix(context, transposed(m)); }

void push_matrix(Context& context) {
  const auto [matrix, depth] = stack_of(context);
  if (matrix.size() >= depth) return context.fail(GL_STACK_OVERFLOW);
  matrix.push_back(Mat4(matrix.back()));
}

void pop_matrix(Context& context) {
  auto& matrix = stack_of(context).matrix;
  if (matrix.size() == 1) return context.fail(GL_STACK_UNDERFLOW);
  matrix.pop_back();
}

void rotate(Context& context, double degrees, double x, double y, double z) {
  const double length = std::hypot(x, y, z);
  if (!(length > 0)) return;
  x /= length, y /= length, z /= length;
  const double angle = degrees * std::numbers::pi / 180, s = std::sin(angle), c = std::cos(angle), d = 1 - c;
  mult_matrix(context, {x * x * d + c, y * x * d + z * s, z * x * d - y * s, 0,  //
                        x * y * d - z * s, y * y * d + c, z * y * d + x * s, 0,  //
                        x * z * d + y * s, y * z * d - x * s, z * z * d + c, 0,  //
                        0, 0, 0, 1});
}

void scale(Context& context, double x, double y, double z) {
  Mat4& m = top(context);
  for (std::size_t row = 0; row < 4; ++row) m[row] *= x, m[4 + row] *= y, m[8 + row] *= z;
}

void translate(Context& context, double x, double y, double z) {
  Mat4& m = top(context);
  const Vec4 moved = transformed(m, {x, y, z, 1});
  std::ranges::copy(moved, m.begin() + 12);
}

void frustum(Context& context, double left, double right, double bottom, double top, double near, double far) {
  const Box box{{left, bottom, near}, {right, top, far}};
  if (!(near > 0) || !(far > 0) || box.is_flat()) return context.fail(GL_INVALID_VALUE);
  mult_matrix(context, {2 * near / box.size(0), 0, 0, 0,                   //
                        0, 2 * near / box.size(1), 0, 0,                   //
                        box.middle(0), box.middle(1), -box.middle(2), -1,  //
                        0, 0, -2 * far * near / box.size(2), 0});
}

void ortho(Context& context, double left, double right, double bottom, double top, double near, double far) {
  const Box box{{left, bottom, near}, {right, top, far}};
  if (box.is_flat()) return context.fail(GL_INVALID_VALUE);
  mult_matrix(context, {2 / box.size(0), 0, 0, 0,   //
                        0, 2 / box.size(1), 0, 0,   //
                        0, 0, -2 / box.size(2), 0,  //
                        -box.middle(0), -box.middle(1), -box.middle(2), 1});
}

void viewport(Context& context, GLint x, GLint y, GLsizei width, GLsizei height) {
  if (width < 0 || height < 0) return context.fail(GL_INVALID_VALUE);
  ViewportState& viewport = context.state.viewport;
  viewport.x = x, viewport.y = y;
  viewport.width = std::min(width, kLargestViewport), viewport.height = std::min(height, kLargestViewport);
}

void depth_range(Context& context, double near, double far) {
  context.state.viewport.near = held(near);
  context.state.viewport.far = held(far);
}

void clip_plane(Context& context, GLenum plane, Vec4 equation) {
  if (plane < GL_CLIP_PLANE0 || plane >= GL_CLIP_PLANE0 + kClipPlanes) return context.fail(GL_INVALID_ENUM);
  context.state.transform.clip_plane[plane - GL_CLIP_PLANE0] =
      transformed_plane(equation, inverse(context.modelview.back()));
}

}  // namespace halfplane::gl
