// Coarse raster: the tiles of a triangle's box, row by row, sorted into outside, cut and inside.
//
// In: a TriangleSetup. Out: per tile its class, its TilePacket, and the planes at its anchor; the engines walk.
// A tile is outside when the largest value of one edge over its pixels is negative (trivial reject), inside when the
// smallest value of every edge is not (trivial accept), cut otherwise.
//
// Edge values leave here narrow: inside a tile they move by at most M = (T-1)(|dx| + |dy|), so saturating the value at the
// first pixel to [-M_max - 1, M_max] leaves the sign of every sample as it was. A tile that an edge accepts or rejects
// as a whole needs no case of its own.
#pragma once

#include <algorithm>

#include "triangle_setup.hpp"

namespace halfplane {

enum class TileClass { outside, cut, inside };

/// Edge values at the first pixel of a tile.
using EdgeValues = std::array<EdgeValue, 3>;

[[nodiscard]] constexpr TileClass classify(const TriangleSetup& setup, const EdgeValues& value, int tile_size) {
  const EdgeValue extent = tile_size - 1;
  TileClass result = TileClass::inside;
  for (std::size_t i = 0; i < 3; ++i) {
    const EdgeValue dx = setup.edge[i].dx, dy = setup.edge[i].dy;
    const EdgeValue largest = value[i] + extent * ((dx > 0 ? dx : 0) + (dy < 0 ? -dy : 0));
    const EdgeValue smallest = value[i] + extent * ((dx < 0 ? dx : 0) + (dy > 0 ? -dy : 0));
    if (largest < 0) return TileClass::outside;
    if (smallest < 0) result = TileClass::cut;
  }
  return result;
}

/// The narrow edge value of a tile packet.
[[nodiscard]] inline std::int32_t saturate_tile_edge(EdgeValue value, const Widths& widths) {
  return static_cast<std::int32_t>(std::clamp(value, static_cast<EdgeValue>(widths.tile_edge.range.lo),
                                              static_cast<EdgeValue>(widths.tile_edge.range.hi)));
}

/// Edge values at the first pixel of tile (tile_x, tile_y).
[[nodiscard]] inline EdgeValues edges_at_tile(const TriangleSetup& setup, int tile_x, int tile_y,
                                              const Widths& widths) {
  const int steps_x = (tile_x - (setup.left >> widths.tile_shift)) << widths.tile_shift;
  const int steps_y = (tile_y - (setup.top >> widths.tile_shift)) << widths.tile_shift;
  EdgeValues value;
  for (std::size_t i = 0; i < 3; ++i)
    value[i] = setup.edge[i].value - EdgeValue{steps_x} * setup.edge[i].dy + EdgeValue{steps_y} * setup.edge[i].dx;
  return value;
}

/// A plane at the anchor of tile (tile_x, tile_y), modulo 2^bits.
[[nodiscard]] inline PlaneValue plane_at_tile(const TriangleSetup& setup, const Plane& plane, int tile_x, int tile_y,
                                              const Widths& widths, int bits) {
  const int to_subpixels = widths.tile_shift + widths.grid_bits;
  const auto dx = static_cast<std::uint64_t>(std::int64_t{tile_x - (setup.left >> widths.tile_shift)} << to_subpixels);
  const auto dy = static_cast<std::uint64_t>(std::int64_t{tile_y - (setup.top >> widths.tile_shift)} << to_subpixels);
  return wrap_signed(static_cast<std::int64_t>(static_cast<std::uint64_t>(plane.value) +
                                               static_cast<std::uint64_t>(plane.step_x) * dx +
                                               static_cast<std::uint64_t>(plane.step_y) * dy),
                     bits);
}

/// The packet of tile (tile_x, tile_y). `slot` is the context slot of the triangle.
[[nodiscard]] TilePacket make_tile_packet(const TriangleSetup& setup, int tile_x, int tile_y, std::uint8_t slot,
                                          const Widths& widths);

}  // namespace halfplane
