#include "clip.hpp"

#include <algorithm>
#include <cmath>

namespace halfplane {
namespace {

/// The point where the edge crosses the plane, from the inside end (distance `d_in` >= 0) to the outside end (< 0).
Vertex cut(const Vertex& in, const Vertex& out, double d_in, double d_out) {
  const double t = d_in / (d_in - d_out);
  const auto mix = [t](double from, double to) { return from + t * (to - from); };
  VertexNumbers made = numbers_of(in);
  std::ranges::transform(made, numbers_of(out), made.begin(), mix);
  return vertex_of(made);
}

/// Cuts a line at a plane, with these distances of its ends. Returns whether a part remains.
bool cut_line(std::array<Vertex, 2>& line, double d_a, double d_b) {
  if (d_a < 0 && d_b < 0) return false;
  if (d_a < 0) line[0] = cut(line[1], line[0], d_b, d_a);
  if (d_b < 0) line[1] = cut(line[0], line[1], d_a, d_b);
  return true;
}

/// One step of Sutherland and Hodgman's reentrant polygon clipping (CACM 17(1), 1974).
ClipPolygon clip_against(const ClipPlane& plane, const ClipPolygon& polygon) {
  ClipPolygon result;
  const auto append = [&result](const Vertex& v) { result.v[static_cast<std::size_t>(result.size++)] = v; };
  for (int i = 0; i < polygon.size; ++i) {
    const Vertex& from = polygon.v[static_cast<std::size_t>(i)];
    const Vertex& to = polygon.v[static_cast<std::size_t>((i + 1) % polygon.size)];
    const double d_from = distance(plane, from), d_to = distance(plane, to);
    if (d_from >= 0) append(from);
    if (d_from >= 0 && d_to < 0) append(cut(from, to, d_from, d_to));
    if (d_from < 0 && d_to >= 0) append(cut(to, from, d_to, d_from));
    if (result.size + 2 > static_cast<int>(result.v.size())) break;  // a convex polygon never gets here
  }
  return result;
}

}  // namespace

ClipPlanes view_volume_planes(ClipZ clip_z) {
  const ClipPlane near = clip_z == ClipZ::zero_one ? ClipPlane{0, 0, 1, 0} : ClipPlane{0, 0, 1, 1};
  return {near, {0, 0, -1, 1}, {1, 0, 0, 1}, {-1, 0, 0, 1}, {0, -1, 0, 1}, {0, 1, 0, 1}};
}

ClipPlanes view_volume_planes(ClipZ clip_z, const Viewport& viewport, double margin) {
  const double x = 1 + 2 * margin / viewport.width, y = 1 + 2 * margin / viewport.height;
  ClipPlanes planes = view_volume_planes(clip_z);
  planes[2] = {1, 0, 0, x};
  planes[3] = {-1, 0, 0, x};
  planes[4] = {0, -1, 0, y};
  planes[5] = {0, 1, 0, y};
  return planes;
}

double guard_band_limit(const Config& config) { return config.guard_band - std::ldexp(1.0, -config.subpixel_bits); }

ClipPlanes guard_band_planes(ClipZ clip_z, const Viewport& viewport, double limit) {
  // Window x = vx + (x/w + 1) vw/2 and y = vy + (1 - y/w) vh/2, both kept in [-limit, limit].
  const double half_width = viewport.width / 2, half_height = viewport.height / 2;
  const double center_x = viewport.x + half_width, center_y = viewport.y + half_height;
  ClipPlanes planes = view_volume_planes(clip_z);
  planes[2] = {half_width, 0, 0, limit + center_x};
  planes[3] = {-half_width, 0, 0, limit - center_x};
  planes[4] = {0, -half_height, 0, limit + center_y};
  planes[5] = {0, half_height, 0, limit - center_y};
  return planes;
}

ClipPolygon clip(const ClipPlanes& planes, const Vertex& a, const Vertex& b, const Vertex& c) {
  ClipPolygon polygon;
  polygon.v[0] = a;
  polygon.v[1] = b;
  polygon.v[2] = c;
  polygon.size = 3;
  for (const ClipPlane& plane : planes) {
    polygon = clip_against(plane, polygon);
    if (polygon.size < 3) return {};
  }
  // Inside all planes w >= 0, and w = 0 only at the eye itself: then the triangle is seen edge-on and covers no pixel.
  for (int i = 0; i < polygon.size; ++i)
    if (!(polygon.v[static_cast<std::size_t>(i)].w > 0)) return {};
  return polygon;
}

std::optional<std::array<Vertex, 2>> clip(const ClipPlanes& planes, const Vertex& a, const Vertex& b) {
  std::array<Vertex, 2> line{a, b};
  for (const ClipPlane& plane : planes)
    if (!cut_line(line, distance(plane, line[0]), distance(plane, line[1]))) return std::nullopt;
  if (!(line[0].w > 0 && line[1].w > 0)) return std::nullopt;
  return line;
}

std::optional<std::array<Vertex, 2>> clip_to_square(double limit, const Vertex& a, const Vertex& b) {
  std::array<Vertex, 2> line{a, b};
  for (double Vertex::*const axis : {&Vertex::x, &Vertex::y})
    for (const double side : {-1.0, 1.0})
      if (!cut_line(line, limit - side * line[0].*axis, limit - side * line[1].*axis)) return std::nullopt;
  return line;
}

}  // namespace halfplane
