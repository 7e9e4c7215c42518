// Evaluators (OpenGL 1.5, 5.1): Bézier curves and surfaces that give vertices and their attributes.
#include <cmath>

#include "commands.hpp"
#include "matrix.hpp"
#include "shading.hpp"

namespace halfplane::gl {
namespace {

/// Values that a map gives, in the order of GL_MAP1_COLOR_4... and GL_MAP2_COLOR_4...
constexpr std::size_t kColor = 0, kIndex = 1, kNormal = 2, kTexture1 = 3, kTexture4 = 6, kVertex3 = 7, kVertex4 = 8,
                      kKinds = 9;
constexpr std::array<int, kKinds> kComponents{4, 1, 3, 1, 2, 3, 4, 3, 4};

/// A point of a map, with its derivatives along u and v.
struct Point {
  Vec4 value{}, along_u{}, along_v{};
};

/// Bernstein's polynomials of an order, and their derivatives.
struct Basis {
  std::array<double, kEvalOrder> value{}, derivative{};
  Basis(int order, double u) {
    const auto n = static_cast<std::size_t>(order);
    value[0] = 1;
    for (std::size_t degree = 1; degree < n; ++degree) {
      if (degree + 1 == n)
        for (std::size_t i = 0; i < n; ++i)
          derivative[i] = static_cast<double>(degree) * ((i > 0 ? value[i - 1] : 0) - (i < degree ? value[i] : 0));
      for (std::size_t i = degree; i > 0; --i) value[i] = (1 - u) * value[i] + u * value[i - 1];
      value[0] *= 1 - u;
    }
  }
};

constexpr bool is_map2(GLenum target) { return target >= GL_MAP2_COLOR_4; }

/// The map of a target: as it was set, or that of the beginning, a point.
const EvaluatorMap& map_of(const Context& context, GLenum target) {
  static const auto kInitial = [] {
    std::array<EvaluatorMap, kKinds> maps;
    for (std::size_t i = 0; i < kKinds; ++i) {
      maps[i].components = kComponents[i];
      maps[i].point.assign(static_cast<std::size_t>(kComponents[i]), i == kColor || i == kIndex ? 1 : 0);
    }
    maps[kNormal].point[2] = maps[kTexture4].point[3] = maps[kVertex4].point[3] = 1;
    return maps;
  }();
  const auto found = context.maps.find(target);
  if (found != context.maps.end()) return found->second;
  return kInitial[target - (is_map2(target) ? GL_MAP2_COLOR_4 : GL_MAP1_COLOR_4)];
}

/// Coordinates that a map lacks are as for vertices and texture coordinates: 0 0 0 1.
Point evaluate(const EvaluatorMap& map, double u, double v) {
  const auto& [u1, u2, v1, v2] = map.range;
  const Basis along_u(map.order[0], (u - u1) / (u2 - u1)), along_v(map.order[1], (v - v1) / (v2 - v1));
  Point point{.value = {0, 0, 0, map.components < 4 ? 1.0 : 0.0}};
  const double* control = map.point.data();
  for (std::size_t i = 0; i < static_cast<std::size_t>(map.order[0]); ++i)
    for (std::size_t j = 0; j < static_cast<std::size_t>(map.order[1]); ++j)
      for (std::size_t k = 0; k < static_cast<std::size_t>(map.components); ++k, ++control) {
        point.value[k] += *control * along_u.value[i] * along_v.value[j];
        point.along_u[k] += *control * along_u.derivative[i] * along_v.value[j] / (u2 - u1);
        point.along_v[k] += *control * along_u.value[i] * along_v.derivative[j] / (v2 - v1);
      }
  return point;
}

/// The normal of a surface: the product of its tangents, of unit length. Zero where they have none.
Vec3 normal_of(const Point& point) {
  // The derivative of x / w is (x' w - x w') / w^2.
  Vec3 u, v;
  for (std::size_t i = 0; i < 3; ++i) {
    u[i] = point.along_u[i] * point.value[3] - point.value[i] * point.along_u[3];
    v[i] = point.along_v[i] * point.value[3] - point.value[i] * point.along_v[3];
  }
  Vec3 normal{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
  const double length = std::hypot(normal[0], normal[1], normal[2]);
  if (length > 0)
    for (double& value : normal) value /= length;
  return normal;
}

/// Without a map of vertices nothing is drawn, however large a mesh is.
constexpr bool has_vertices(const std::array<bool, kKinds>& enabled) { return enabled[kVertex3] || enabled[kVertex4]; }

/// The attributes and the vertex that the enabled maps give, while the current attributes stay.
void eval_coord(Context& context, GLenum first_target, const std::array<bool, kKinds>& enabled, double u, double v) {
  if (!has_vertices(enabled)) return;
  const auto point_of = [&](std::size_t kind) {
    return evaluate(map_of(context, first_target + static_cast<GLenum>(kind)), u, v);
  };
  const CurrentKept kept(context);
  if (enabled[kColor]) {
    const Vec4 value = point_of(kColor).value;
    color(context, value[0], value[1], value[2], value[3]);
  }
  if (enabled[kIndex]) index(context, point_of(kIndex).value[0]);
  for (std::size_t kind = kTexture4; kind >= kTexture1; --kind)
    if (enabled[kind]) {
      const auto& [s, t, r, q] = point_of(kind).value;
      tex_coord(context, GL_TEXTURE0, s, t, r, q);
      break;
    }
  const Point point = point_of(enabled[kVertex4] ? kVertex4 : kVertex3);
  if (is_map2(first_target) && context.state.eval.auto_normal) {
    const auto& [nx, ny, nz] = normal_of(point);
    normal(context, nx, ny, nz);
  } else if (enabled[kNormal]) {
    const Vec4 value = point_of(kNormal).value;
    normal(context, value[0], value[1], value[2]);
  }
  const auto& [x, y, z, w] = point.value;
  vertex(context, x, y, z, w);
}

/// Coordinate `i` of a grid of `n` parts; its ends are exact.
double grid_coordinate(std::int64_t i, int n, double low, double high) {
  return i == n ? high : low + static_cast<double>(i) * ((high - low) / n);
}

void mesh_point(Context& context, std::int64_t i, std::int64_t j) {
  const EvalState& eval = context.state.eval;
  const auto& [u1, u2, v1, v2] = eval.range2;
  eval_coord2(context, grid_coordinate(i, eval.grid2[0], u1, u2), grid_coordinate(j, eval.grid2[1], v1, v2));
}

/// Checks and keeps a map. Of a one-dimensional one v has the order 1.
void set_map(Context& context, GLenum target, bool is_two_dimensional, const std::array<double, 4>& range,
             const std::array<int, 2>& order, const std::vector<double>* points) {
  const int components = map_components(target);
  if (components == 0 || is_map2(target) != is_two_dimensional) return context.fail(GL_INVALID_ENUM);
  for (const int n : order)
    if (n < 1 || n > kEvalOrder) return context.fail(GL_INVALID_VALUE);
  const auto numbers = static_cast<std::size_t>(order[0] * order[1] * components);
  if (range[0] == range[1] || range[2] == range[3] || points == nullptr || points->size() < numbers)
    return context.fail(GL_INVALID_VALUE);
  if (context.state.texture.active != 0) return context.fail(GL_INVALID_OPERATION);
  context.maps[target] = {
      components, order, range, {points->begin(), points->begin() + static_cast<std::ptrdiff_t>(numbers)}};
}

}  // namespace

int map_components(GLenum target) {
  for (const GLenum first : std::initializer_list<GLenum>{GL_MAP1_COLOR_4, GL_MAP2_COLOR_4})
    if (target >= first && target - first < kKinds) return kComponents[target - first];
  return 0;
}

void map1(Context& context, GLenum target, double u1, double u2, GLint order,
          const std::shared_ptr<const std::vector<double>>& points) {
  set_map(context, target, false, {u1, u2, 0, 1}, {order, 1}, points.get());
}

void map2(Context& context, GLenum target, double u1, double u2, GLint uorder, double v1, double v2, GLint vorder,
          const std::shared_ptr<const std::vector<double>>& points) {
  set_map(context, target, true, {u1, u2, v1, v2}, {uorder, vorder}, points.get());
}

Values get_map(Context& context, GLenum target, GLenum query) {
  if (map_components(target) == 0) return context.fail(GL_INVALID_ENUM), Values{};
  const EvaluatorMap& map = map_of(context, target);
  const std::ptrdiff_t dimensions = is_map2(target) ? 2 : 1;
  switch (query) {
    case GL_COEFF: return {ValueKind::real, map.point};
    case GL_ORDER: return {ValueKind::integer, {map.order.begin(), map.order.begin() + dimensions}};
    case GL_DOMAIN: return {ValueKind::real, {map.range.begin(), map.range.begin() + 2 * dimensions}};
    default: context.fail(GL_INVALID_ENUM); return {};
  }
}

void map_grid1(Context& context, GLint n, double u1, double u2) {
  if (n < 1) return context.fail(GL_INVALID_VALUE);
  context.state.eval.grid1 = n;
  context.state.eval.range1 = {u1, u2};
}

void map_grid2(Context& context, GLint nu, double u1, double u2, GLint nv, double v1, double v2) {
  if (nu < 1 || nv < 1) return context.fail(GL_INVALID_VALUE);
  context.state.eval.grid2 = {nu, nv};
  context.state.eval.range2 = {u1, u2, v1, v2};
}

void eval_coord1(Context& context, double u) { eval_coord(context, GL_MAP1_COLOR_4, context.state.eval.map1, u, 0); }

void eval_coord2(Context& context, double u, double v) {
  eval_coord(context, GL_MAP2_COLOR_4, context.state.eval.map2, u, v);
}

void eval_point1(Context& context, GLint i) {
  const EvalState& eval = context.state.eval;
  eval_coord1(context, grid_coordinate(i, eval.grid1, eval.range1[0], eval.range1[1]));
}

void eval_point2(Context& context, GLint i, GLint j) { mesh_point(context, i, j); }

void eval_mesh1(Context& context, GLenum mode, GLint i1, GLint i2) {
  if (mode != GL_POINT && mode != GL_LINE) return context.fail(GL_INVALID_ENUM);
  if (!has_vertices(context.state.eval.map1)) return;
  begin(context, mode == GL_POINT ? GL_POINTS : GL_LINE_STRIP);
  for (std::int64_t i = i1; i <= i2; ++i) eval_point1(context, static_cast<GLint>(i));
  end(context);
}

void eval_mesh2(Context& context, GLenum mode, GLint i1, GLint i2, GLint j1, GLint j2) {
  if (mode != GL_POINT && mode != GL_LINE && mode != GL_FILL) return context.fail(GL_INVALID_ENUM);
  if (!has_vertices(context.state.eval.map2)) return;
  // Rows of the mesh; of GL_FILL a strip to the next row each.
  const bool is_fill = mode == GL_FILL;
  const std::int64_t last_row = static_cast<std::int64_t>(j2) - (is_fill ? 1 : 0);
  for (std::int64_t j = j1; j <= last_row; ++j) {
    begin(context, is_fill ? GL_QUAD_STRIP : mode == GL_LINE ? GL_LINE_STRIP : GL_POINTS);
    for (std::int64_t i = i1; i <= i2; ++i) {
      mesh_point(context, i, j);
      if (is_fill) mesh_point(context, i, j + 1);
    }
    end(context);
  }
  if (mode != GL_LINE) return;
  for (std::int64_t i = i1; i <= i2; ++i) {
    begin(context, GL_LINE_STRIP);
    for (std::int64_t j = j1; j <= j2; ++j) mesh_point(context, i, j);
    end(context);
  }
}

}  // namespace halfplane::gl
