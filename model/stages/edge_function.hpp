// The edge function: on which side of an edge a pixel centre lies. cull evaluates it once per edge, coarse_raster and
// fine_raster step it.
#pragma once

#include <cstdint>

#include "../packets.hpp"

namespace halfplane {

using EdgeValue = std::int64_t;  ///< floor((E + bias) / 2^s) at a pixel centre; covered when >= 0

/// E of the edge from `from` to `to` at the centre of pixel (x, y), with the fill rule folded in: >= 0 when covered.
/// Top-left rule: a sample exactly on the edge belongs to the triangle when the edge is a top (dy = 0, dx > 0) or left
/// (dy < 0) edge of a triangle of positive area.
[[nodiscard]] constexpr EdgeValue edge_function(const SnappedVertex& from, const SnappedVertex& to, int x, int y,
                                                int grid_bits) {
  const std::int64_t half = std::int64_t{1} << (grid_bits - 1);
  const std::int64_t px = (std::int64_t{x} << grid_bits) + half, py = (std::int64_t{y} << grid_bits) + half;
  const std::int64_t dx = std::int64_t{to.x} - from.x, dy = std::int64_t{to.y} - from.y;
  const bool is_top_left = dy < 0 || (dy == 0 && dx > 0);
  return (dx * (py - from.y) - dy * (px - from.x) - (is_top_left ? 0 : 1)) >> grid_bits;
}

}  // namespace halfplane
