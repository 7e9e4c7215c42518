#include "viewport.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

namespace halfplane {
namespace {

/// The part of `rect` inside columns [left, right) and rows [top, bottom). 64 bits: a scissor may start far outside and
/// be as wide as an int.
Rect intersect(const Rect& rect, std::int64_t left, std::int64_t top, std::int64_t right, std::int64_t bottom) {
  left = std::max<std::int64_t>(left, rect.x);
  top = std::max<std::int64_t>(top, rect.y);
  right = std::min<std::int64_t>(right, std::int64_t{rect.x} + rect.width);
  bottom = std::min<std::int64_t>(bottom, std::int64_t{rect.y} + rect.height);
  if (left >= right || top >= bottom) return {};
  return {static_cast<int>(left), static_cast<int>(top), static_cast<int>(right - left),
          static_cast<int>(bottom - top)};
}

/// Offset that moves the state's pixel centres to half-integers.
double center_offset(const State& state) { return state.pixel_center == PixelCenter::integer ? 0.5 : 0.0; }

[[noreturn]] void refuse_vertex(const WindowPosition& p, const VertexSource& source, const Config& config) {
  char position[96];
  std::snprintf(position, sizeof position, "(%.9g, %.9g, %.9g)", p.x, p.y, p.z);
  const std::string band = std::to_string(config.guard_band);
  throw InputError(place_of_draw(source.file, source.line) + ": vertex " + std::to_string(source.number) +
                   " at window " + position + " is outside the guard band: x and y must snap into [-" + band + ", " +
                   band + ") pixels and z into [0, 1]; clip it first or raise guard.band");
}

}  // namespace

WindowPosition window_position(const Vertex& v, const State& state, int target_height) {
  const double x = v.x + center_offset(state), y = v.y + center_offset(state);
  return {x, state.origin == Origin::bottom_left ? target_height - y : y, v.z};
}

Viewport effective_viewport(const State& state, int target_width, int target_height) {
  if (!state.viewport) return {0, 0, static_cast<double>(target_width), static_cast<double>(target_height)};
  Viewport v = *state.viewport;
  v.x += center_offset(state);
  v.y += center_offset(state);
  if (state.origin == Origin::bottom_left) v.y = target_height - (v.y + v.height);
  return v;
}

Rect raster_rect(const State& state, int target_width, int target_height) {
  Rect rect{0, 0, target_width, target_height};
  if (state.scissor) {
    const std::int64_t x = state.scissor->x, y = state.scissor->y, height = state.scissor->height;
    const std::int64_t top = state.origin == Origin::bottom_left ? target_height - (y + height) : y;
    rect = intersect(rect, x, top, x + state.scissor->width, top + height);
  }
  if (state.space == Space::clip && state.viewport) {
    // Pixel x is inside when its centre is: viewport.x <= x + 1/2 < viewport.x + width. Clamped to the target first.
    const auto first = [](double edge, int limit) {
      return static_cast<int>(std::ceil(std::clamp(edge - 0.5, 0.0, static_cast<double>(limit))));
    };
    const Viewport v = effective_viewport(state, target_width, target_height);
    const int left = first(v.x, target_width), right = first(v.x + v.width, target_width);
    const int top = first(v.y, target_height), bottom = first(v.y + v.height, target_height);
    rect = intersect(rect, left, top, right, bottom);
  }
  return rect;
}

WindowPosition to_window(const Vertex& v, const State& state, const Viewport& viewport) {
  const double x = v.x / v.w, y = v.y / v.w, z = v.z / v.w;
  const double depth = state.clip_z == ClipZ::zero_one ? z : (z + 1) / 2;
  // A vertex cut by near or far is on the plane up to rounding; the clamp puts it exactly there.
  return {viewport.x + (x + 1) / 2 * viewport.width, viewport.y + (1 - y) / 2 * viewport.height,
          state.depth_range[0] + (state.depth_range[1] - state.depth_range[0]) * std::clamp(depth, 0.0, 1.0)};
}

PerPlane<std::uint32_t> snap_codes(double z, const Vertex& vertex, const Config& config) {
  PerPlane<std::uint32_t> code{};
  code[kDepthPlane] = snap_depth(z, config.depth_bits);
  const std::size_t colors = color_channels_of(config);
  for (std::size_t c = 0; c < colors; ++c) code[kColorPlane + c] = snap_color(vertex.rgba[c]);
  return code;
}

Vertex vertex_of_codes(const PerPlane<std::uint32_t>& code, const Config& config) {
  Vertex vertex;
  vertex.z = code[kDepthPlane] / (std::ldexp(1.0, config.depth_bits) - 1);
  const std::size_t colors = color_channels_of(config);
  for (std::size_t c = 0; c < colors; ++c) vertex.rgba[c] = code[kColorPlane + c];
  return vertex;
}

SnappedVertex snap_vertex(const WindowPosition& p, const Vertex& vertex, const Config& config,
                          const VertexSource& source, double origin) {
  const double band = config.guard_band;
  // The comparisons are false for a NaN, and coarse enough that the conversions below are in range.
  if (!(std::abs(p.x) <= 2 * band && std::abs(p.y) <= 2 * band && p.z >= -1 && p.z <= 2))
    refuse_vertex(p, source, config);
  const int S = config.subpixel_bits, grid_bits = coordinate_grid_bits(config);
  const double scale = static_cast<double>(std::int64_t{1} << S);
  const auto on_grid = [&](double position) {  // an origin of 1/2 is on the grid, which has at least one fraction bit
    return (snap(position - origin, scale) << (grid_bits - S)) + (origin != 0 ? std::int64_t{1} << (grid_bits - 1) : 0);
  };
  const std::int64_t x = on_grid(p.x), y = on_grid(p.y);
  const std::int64_t z =
      snap(p.z, static_cast<double>((std::int64_t{1} << config.depth_bits) - 1));  // may be out of range
  const std::int64_t limit = static_cast<std::int64_t>(config.guard_band) << grid_bits;
  if (x < -limit || x >= limit || y < -limit || y >= limit || z < 0 || z >= std::int64_t{1} << config.depth_bits)
    refuse_vertex(p, source, config);
  SnappedVertex v;
  v.x = static_cast<std::int32_t>(x);
  v.y = static_cast<std::int32_t>(y);
  v.code = snap_codes(p.z, vertex, config);
  return v;
}

}  // namespace halfplane
