// Golden viewport: perspective divide, viewport transform, depth range; and the pixels that a draw may touch.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "../scene.hpp"
#include "clip.hpp"

namespace halfplane::golden {

/// A vertex on the screen, not snapped.
template <class Real>
struct ScreenVertex {
  Real x = 0, y = 0;  ///< pixels, y down
  Real z = 0;         ///< window depth, 0...1
  Real inverse_w = 1;
  std::array<Real, 4> rgba{};  ///< 0...255
  std::array<Real, 2> uv{};    ///< texture coordinates
};

/// A rectangle of pixels, half-open: `end_x` and `end_y` are outside. (Boxes and bounds of the model are inclusive.)
struct PixelRange {
  int begin_x = 0, begin_y = 0, end_x = 0, end_y = 0;
  [[nodiscard]] bool empty() const { return begin_x >= end_x || begin_y >= end_y; }
};

[[nodiscard]] inline PixelRange intersect(const PixelRange& a, const PixelRange& b) {
  return {std::max(a.begin_x, b.begin_x), std::max(a.begin_y, b.begin_y), std::min(a.end_x, b.end_x),
          std::min(a.end_y, b.end_y)};
}

/// The first pixel whose centre is at or right of (below) `position`; clamped to 0...limit.
[[nodiscard]] inline int first_centre(double position, int limit) {
  return static_cast<int>(std::clamp(std::ceil(position - 0.5), 0.0, static_cast<double>(limit)));
}

/// The pixels whose centres lie in [left, right) x [top, bottom), inside the target.
[[nodiscard]] inline PixelRange pixel_range(double left, double top, double right, double bottom, const Scene& scene) {
  return {first_centre(left, scene.width), first_centre(top, scene.height), first_centre(right, scene.width),
          first_centre(bottom, scene.height)};
}

/// Target and scissor: the pixels of a clear.
[[nodiscard]] inline PixelRange clear_region(const Scene& scene, const State& state) {
  if (!state.scissor) return {0, 0, scene.width, scene.height};
  const double x = state.scissor->x, y = state.scissor->y;  // double: x + width may not fit an int
  const double bottom = y + state.scissor->height;
  const bool is_up = state.origin == Origin::bottom_left;
  return pixel_range(x, is_up ? scene.height - bottom : y, x + state.scissor->width, is_up ? scene.height - y : bottom,
                     scene);
}

/// Distance of the first pixel's outer corner from the origin of the state's window coordinates, along each axis.
[[nodiscard]] inline double first_pixel_offset(const State& state) {
  return state.pixel_center == PixelCenter::half ? 0.0 : 0.5;
}

/// A vertex given in the window coordinates of its state.
template <class Real>
[[nodiscard]] ScreenVertex<Real> from_window(const ClipVertex<Real>& v, const State& state, const Scene& scene) {
  const auto& [x, y, z, w] = v.position;
  const auto offset = static_cast<Real>(first_pixel_offset(state));
  const Real from_origin = y + offset;
  const bool is_up = state.origin == Origin::bottom_left;
  return {x + offset, is_up ? static_cast<Real>(scene.height) - from_origin : from_origin, z, 1 / w, v.rgba, v.uv};
}

[[nodiscard]] inline Viewport viewport_of(const Scene& scene, const State& state) {
  const double width = scene.width, height = scene.height;
  if (!state.viewport) return {0, 0, width, height};
  const double offset = first_pixel_offset(state);
  const double near_edge = state.viewport->y + offset;  // the edge at the origin's side
  return {state.viewport->x + offset,
          state.origin == Origin::bottom_left ? height - near_edge - state.viewport->height : near_edge,
          state.viewport->width, state.viewport->height};
}

/// Target, scissor and, in clip space, the viewport: the pixels of a draw.
[[nodiscard]] inline PixelRange draw_region(const Scene& scene, const State& state) {
  const PixelRange range = clear_region(scene, state);
  if (state.space == Space::window) return range;
  const Viewport vp = viewport_of(scene, state);
  return intersect(range, pixel_range(vp.x, vp.y, vp.x + vp.width, vp.y + vp.height, scene));
}

template <class Real>
[[nodiscard]] ScreenVertex<Real> to_screen(const ClipVertex<Real>& v, const State& state, const Viewport& vp) {
  // Divided, not multiplied by 1 / w: a vertex exactly on a pixel centre stays there.
  const auto& [clip_x, clip_y, clip_z, w] = v.position;
  const Real x = clip_x / w, y = clip_y / w, z = clip_z / w;
  const auto near = static_cast<Real>(state.depth_range[0]), far = static_cast<Real>(state.depth_range[1]);
  const Real depth = state.clip_z == ClipZ::zero_one ? z : (z + 1) / 2;
  return {static_cast<Real>(vp.x) + (x + 1) / 2 * static_cast<Real>(vp.width),
          static_cast<Real>(vp.y) + (1 - y) / 2 * static_cast<Real>(vp.height),
          near + (far - near) * depth,
          1 / w,
          v.rgba,
          v.uv};
}

}  // namespace halfplane::golden
