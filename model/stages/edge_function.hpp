// The edge function: the side of an edge on which a pixel centre lies. cull evaluates it once per edge, coarse_raster
// and fine_raster step it.
#pragma once

#include <cstdint>

#include "../packets/packets.hpp"

namespace halfplane {

using EdgeValue = std::int64_t;  ///< floor((E + bias) / 2^s) at a pixel centre; covered when >= 0

/// E - bias of the edge from `from` to `to` at the centre of pixel (x, y), square subpixels. `bias` is 0 when samples exactly
/// on the edge belong to the triangle, otherwise 1.
[[nodiscard]] constexpr std::int64_t exact_edge(const SnappedVertex& from, const SnappedVertex& to, int x, int y,
                                                int grid_bits, int bias) {
  const std::int64_t half = std::int64_t{1} << (grid_bits - 1);
  const std::int64_t px = (std::int64_t{x} << grid_bits) + half, py = (std::int64_t{y} << grid_bits) + half;
  const std::int64_t dx = std::int64_t{to.x} - from.x, dy = std::int64_t{to.y} - from.y;
  return dx * (py - from.y) - dy * (px - from.x) - bias;
}

/// The pipeline's edge function, >= 0 when covered: floor((E - bias) / 2^s).
[[nodiscard]] constexpr EdgeValue edge_function(const SnappedVertex& from, const SnappedVertex& to, int x, int y,
                                                int grid_bits, int bias) {
  return exact_edge(from, to, x, y, grid_bits, bias) >> grid_bits;
}

/// The pipeline's fill rule: a sample exactly on the edge belongs to the triangle when the edge is a top (dy = 0, dx > 0)
/// or left (dy < 0) edge of a triangle of positive area.
[[nodiscard]] constexpr bool is_top_left(const SnappedVertex& from, const SnappedVertex& to) {
  return to.y < from.y || (to.y == from.y && to.x > from.x);
}

/// edge_function with that rule.
[[nodiscard]] constexpr EdgeValue edge_function(const SnappedVertex& from, const SnappedVertex& to, int x, int y,
                                                int grid_bits) {
  return edge_function(from, to, x, y, grid_bits, is_top_left(from, to) ? 0 : 1);
}

/// The grid_bits bits that edge_function() has dropped below its value: the same at every pixel centre.
[[nodiscard]] constexpr EdgeValue edge_low(const SnappedVertex& from, const SnappedVertex& to, int grid_bits) {
  return exact_edge(from, to, 0, 0, grid_bits, is_top_left(from, to) ? 0 : 1) & ((EdgeValue{1} << grid_bits) - 1);
}

/// c: the increment of an edge from the centre of a pixel to a sample at `o` from it, in 2^-s pixel. `step_x`,
/// `step_y`: increments per pixel.
[[nodiscard]] constexpr EdgeValue sample_edge_offset(EdgeValue low, EdgeValue step_x, EdgeValue step_y,
                                                     const SampleOffset& o, int grid_bits) {
  return (low + step_x * o.x + step_y * o.y) >> grid_bits;
}

/// Bound of |c| for any sample position in a pixel.
[[nodiscard]] constexpr EdgeValue sample_edge_reach(EdgeValue step_x, EdgeValue step_y) {
  return ((step_x < 0 ? -step_x : step_x) + (step_y < 0 ? -step_y : step_y) + 1) >> 1;
}

}  // namespace halfplane
