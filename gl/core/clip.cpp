#include "clip.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "matrix.hpp"

namespace halfplane::gl {
namespace {

template <std::size_t n>
std::array<double, n> mix(const std::array<double, n>& a, const std::array<double, n>& b, double t) {
  std::array<double, n> out;
  for (std::size_t i = 0; i < n; ++i) out[i] = a[i] + t * (b[i] - a[i]);
  return out;
}
template <class Element, std::size_t n>
std::array<Element, n> mix(const std::array<Element, n>& a, const std::array<Element, n>& b, double t) {
  std::array<Element, n> out;
  for (std::size_t i = 0; i < n; ++i) out[i] = mix(a[i], b[i], t);
  return out;
}

/// Every member linearly.
ShadedVertex mix(const ShadedVertex& a, const ShadedVertex& b, double t) {
  // The distance of a line that passes the eye has no sign: it is that of the mixed place, unless it is a coordinate.
  const auto is_depth = [](const ShadedVertex& v) { return v.fog_distance == std::abs(v.eye[2]); };
  ShadedVertex out{.eye = mix(a.eye, b.eye, t),
                   .clip = mix(a.clip, b.clip, t),
                   .color = mix(a.color, b.color, t),
                   .secondary = mix(a.secondary, b.secondary, t),
                   .tex_coord = mix(a.tex_coord, b.tex_coord, t),
                   .fog_distance = std::lerp(a.fog_distance, b.fog_distance, t),
                   .point_size = std::lerp(a.point_size, b.point_size, t),
                   .edge_flag = a.edge_flag};
  if (is_depth(a) && is_depth(b)) out.fog_distance = std::abs(out.eye[2]);
  return out;
}

double distance(const Plane& plane, const ShadedVertex& v) {
  const Vec4& at = v.*plane.where;
  return std::inner_product(at.begin(), at.end(), plane.equation.begin(), 0.0);
}

/// The same point for either order of the ends.
ShadedVertex cut(const ShadedVertex& inside, double from, const ShadedVertex& outside, double to) {
  return mix(inside, outside, from / (from - to));
}

void clip_polygon(Vertices& vertices, const Plane& plane) {
  Vertices out;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const ShadedVertex &a = vertices[i], &b = vertices[(i + 1) % vertices.size()];
    const double from = distance(plane, a), to = distance(plane, b);
    const bool is_in = from >= 0;
    if (is_in) out.push_back(a);
    if (is_in == (to >= 0)) continue;
    out.push_back(is_in ? cut(a, from, b, to) : cut(b, to, a, from));
    out.back().edge_flag = is_in ? plane.shows_cut : a.edge_flag;
  }
  vertices = std::move(out);
}

}  // namespace

ShadedVertex window_mix(const ShadedVertex& a, const ShadedVertex& b, double t) {
  const double per_w = (1 - t) / a.clip[3] + t / b.clip[3];
  ShadedVertex v = mix(a, b, t / b.clip[3] / per_w);
  v.clip = mix(a.clip, b.clip, t);
  v.clip[3] = 1 / per_w;
  return v;
}

std::array<Plane, 6> view_volume(const ViewportState& viewport, double margin) {
  const double x = 1 + 2 * margin / viewport.width, y = 1 + 2 * margin / viewport.height;
  return {{{&ShadedVertex::clip, {0, 0, 1, 1}, false},
           {&ShadedVertex::clip, {0, 0, -1, 1}, false},
           {&ShadedVertex::clip, {1, 0, 0, x}, false},
           {&ShadedVertex::clip, {-1, 0, 0, x}, false},
           {&ShadedVertex::clip, {0, 1, 0, y}, false},
           {&ShadedVertex::clip, {0, -1, 0, y}, false}}};
}

void clip(Vertices& vertices, std::span<const Plane> planes) {
  for (const Plane& plane : planes) {
    if (vertices.size() > 2) {
      clip_polygon(vertices, plane);
      if (vertices.size() < 3) vertices.clear();
      continue;
    }
    const Vertices whole = vertices;
    for (std::size_t i = 0; i < whole.size(); ++i) {
      const ShadedVertex &v = whole[i], &other = whole[whole.size() - 1 - i];
      const double at = distance(plane, v), beyond = distance(plane, other);
      if (at >= 0) continue;
      if (!(beyond >= 0) || !(at < 0)) return vertices.clear();
      vertices[i] = cut(other, beyond, v, at);
      vertices[i].edge_flag = v.edge_flag;
    }
  }
}

void clip(Vertices& vertices, const ClipPlanes& planes) {
  std::array<Plane, 6> equal;
  std::ranges::transform(planes, equal.begin(), [](const ClipPlane& p) {
    return Plane{&ShadedVertex::clip, {p.a, p.b, p.c, p.d}, false};
  });
  clip(vertices, equal);
}

Vec4 window_position(const ViewportState& v, const Vec4& clip) {
  const double x = clip[0] / clip[3], y = clip[1] / clip[3], z = clip[2] / clip[3];
  return {v.x + (x + 1) / 2 * v.width, v.y + (y + 1) / 2 * v.height, v.near + held((z + 1) / 2) * (v.far - v.near),
          clip[3]};
}

}  // namespace halfplane::gl
