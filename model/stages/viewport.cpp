#include "viewport.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

namespace halfplane {
namespace {

Rect intersect(const Rect& a, const Rect& b) {
  // 64-bit sums: a scissor may start far outside and be as wide as an int.
  const auto end = [](int start, int size) { return static_cast<std::int64_t>(start) + size; };
  const int left = std::max(a.x, b.x), top = std::max(a.y, b.y);
  const std::int64_t width = std::min(end(a.x, a.width), end(b.x, b.width)) - left;
  const std::int64_t height = std::min(end(a.y, a.height), end(b.y, b.height)) - top;
  if (width <= 0 || height <= 0) return {};
  return {left, top, static_cast<int>(width), static_cast<int>(height)};
}

[[noreturn]] void refuse_vertex(const WindowPosition& p, const VertexSource& source, const Config& config) {
  char position[96];
  std::snprintf(position, sizeof position, "(%.9g, %.9g, %.9g)", p.x, p.y, p.z);
  const std::string band = std::to_string(config.guard_band);
  throw InputError(place_of_draw(source.file, source.line) + ": vertex " + std::to_string(source.number) +
                   " at window " + position + " is outside the guard band: x and y must snap into [-" + band + ", " +
                   band + ") pixels and z into [0, 1]; clip it first or raise guard.band");
}

}  // namespace

std::string place_of_draw(std::string_view file, std::uint32_t line) {
  return std::string(file) + (line != 0 ? ": draw from line " + std::to_string(line) : "");
}

Viewport effective_viewport(const State& state, int target_width, int target_height) {
  return state.viewport.value_or(Viewport{0, 0, static_cast<double>(target_width), static_cast<double>(target_height)});
}

Rect raster_rect(const State& state, int target_width, int target_height) {
  Rect rect{0, 0, target_width, target_height};
  if (state.scissor) rect = intersect(rect, *state.scissor);
  if (state.space == Space::clip && state.viewport) {
    // Pixel x is inside when its centre is: viewport.x <= x + 1/2 < viewport.x + width. Clamped to the target first.
    const auto first = [](double edge, int limit) {
      return static_cast<int>(std::ceil(std::clamp(edge - 0.5, 0.0, static_cast<double>(limit))));
    };
    const Viewport& v = *state.viewport;
    const int left = first(v.x, target_width), right = first(v.x + v.width, target_width);
    const int top = first(v.y, target_height), bottom = first(v.y + v.height, target_height);
    rect = intersect(rect, {left, top, right - left, bottom - top});
  }
  return rect;
}

WindowPosition to_window(const Vertex& v, const State& state, const Viewport& viewport) {
  const double x = v.x / v.w, y = v.y / v.w, z = v.z / v.w;
  const double depth = state.clip_z == ClipZ::zero_one ? z : (z + 1) / 2;
  // A vertex cut by near or far is on the plane up to rounding; the clamp keeps it there.
  return {viewport.x + (x + 1) / 2 * viewport.width, viewport.y + (1 - y) / 2 * viewport.height,
          state.depth_range[0] + (state.depth_range[1] - state.depth_range[0]) * std::clamp(depth, 0.0, 1.0)};
}

std::uint8_t snap_color(double channel) {
  return static_cast<std::uint8_t>(std::clamp<std::int64_t>(snap(std::clamp(channel, 0.0, 255.0), 1.0), 0, 255));
}

std::uint32_t snap_depth(double z, int depth_bits) {
  return static_cast<std::uint32_t>(snap(z, static_cast<double>((std::int64_t{1} << depth_bits) - 1)));
}

SnappedVertex snap_vertex(const WindowPosition& p, const std::array<double, 4>& rgba, const Config& config,
                          const VertexSource& source) {
  const double band = config.guard_band;
  // The comparisons are false for a NaN, and coarse enough that the conversions below are in range.
  if (!(std::abs(p.x) <= 2 * band && std::abs(p.y) <= 2 * band && p.z >= -1 && p.z <= 2))
    refuse_vertex(p, source, config);
  const int S = config.subpixel_bits, grid_bits = std::max(S, 1);
  const double scale = static_cast<double>(std::int64_t{1} << S);
  const std::int64_t x = snap(p.x, scale) << (grid_bits - S), y = snap(p.y, scale) << (grid_bits - S);
  const std::int64_t z = snap(p.z, static_cast<double>((std::int64_t{1} << config.depth_bits) - 1));
  const std::int64_t limit = static_cast<std::int64_t>(config.guard_band) << grid_bits;
  if (x < -limit || x >= limit || y < -limit || y >= limit || z < 0 || z >= std::int64_t{1} << config.depth_bits)
    refuse_vertex(p, source, config);
  SnappedVertex v;
  v.x = static_cast<std::int32_t>(x);
  v.y = static_cast<std::int32_t>(y);
  v.z = static_cast<std::uint32_t>(z);
  for (std::size_t c = 0; c < 4; ++c) v.rgba[c] = snap_color(rgba[c]);
  return v;
}

}  // namespace halfplane
