// Viewport: clip coordinates in, snapped window coordinates out (perspective divide, viewport, depth range, snap).
//
// Host side, binary64. All later numbers are integers. X, Y: floor(x * 2^S + 1/2), held in units of 2^-s pixel (s =
// max(S, 1)); Z: floor(z * (2^B - 1) + 1/2); colour: floor(c + 1/2).
#pragma once

#include <cstddef>
#include <string_view>

#include "../config.hpp"
#include "../packets/packets.hpp"
#include "../scene.hpp"

namespace halfplane {

/// A vertex in window coordinates before the snap: x, y in pixels (y down), z in [0, 1].
struct WindowPosition {
  double x = 0, y = 0, z = 0;
};

/// A window-space vertex in the rasterizer's coordinates: pixel centres at half-integers, y down from the top.
[[nodiscard]] WindowPosition window_position(const Vertex& v, const State& state, int target_height);

/// The viewport of a state, its own or the whole target, likewise.
[[nodiscard]] Viewport effective_viewport(const State& state, int target_width, int target_height);

/// The pixels that a draw may touch: target, scissor and (in clip space) the pixel centres inside the viewport.
[[nodiscard]] Rect raster_rect(const State& state, int target_width, int target_height);

/// Divide, viewport and depth range of a clipped vertex (w > 0).
[[nodiscard]] WindowPosition to_window(const Vertex& v, const State& state, const Viewport& viewport);

/// The origin of a vertex: for the message when it does not fit.
struct VertexSource {
  std::string_view file;   ///< Scene::name
  std::uint32_t line = 0;  ///< Draw::line
  std::size_t number = 0;  ///< index into Scene::vertices
};

/// The origin of the snap grid, in pixels along x and y: 1/2 if pixels are not subdivided and the state has pixel
/// centres at integers, so that an integer stays a centre; else 0, and every centre is on the grid.
[[nodiscard]] constexpr double snap_origin(const State& state, const Config& config) {
  return config.subpixel_bits == 0 && state.pixel_center == PixelCenter::integer ? 0.5 : 0.0;
}

/// The snap. Throws InputError naming the vertex when it is outside the guard band or the depth range.
[[nodiscard]] SnappedVertex snap_vertex(const WindowPosition& p, const Vertex& vertex, const Config& config,
                                        const VertexSource& source, double origin = 0);

/// The codes of every plane: window depth in [0, 1], colour 0...255 a channel. A new plane gets its codes here, and its
/// value from a code in vertex_of_codes().
[[nodiscard]] PerPlane<std::uint32_t> snap_codes(double z, const Vertex& vertex, const Config& config);

/// A vertex of window space that snaps to these codes; its position is left at 0.
[[nodiscard]] Vertex vertex_of_codes(const PerPlane<std::uint32_t>& code, const Config& config);

/// color_planes(), without making the list for each vertex.
[[nodiscard]] constexpr std::size_t color_channels_of(const Config& config) { return needs_alpha(config) ? 4 : 3; }

/// Gives `to` the colour of `from`.
constexpr void copy_color(PerPlane<std::uint32_t>& to, const PerPlane<std::uint32_t>& from, const Config& config) {
  const std::size_t colors = color_channels_of(config);
  for (std::size_t p = kColorPlane; p < kColorPlane + colors; ++p) to[p] = from[p];
}

/// A colour channel (0...255) as its 8-bit code: a half is rounded up, what lies beyond 0 and 255 is held. Not for NaN.
[[nodiscard]] inline std::uint8_t snap_color(double channel) {
  const double held = std::clamp(channel, 0.0, 255.0);
  const auto whole = static_cast<int>(held);  // its floor: std::floor is a call on x86-64 without SSE4.1
  return static_cast<std::uint8_t>(whole + (held - whole >= 0.5 ? 1 : 0));
}

}  // namespace halfplane
