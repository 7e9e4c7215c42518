// Fine raster: one tile in, the covered samples of its stamps out.
//
// In: a TilePacket and the triangle's EdgeContext. Out: a StampPacket for each stamp with at least one covered sample,
// row by row. Latency 2 cycles; one stamp position of the tile's box per cycle.
// A sample is covered when all three edge values are >= 0 there and it lies in the tile's box (which carries the scissor).
#pragma once

#include "triangle_setup.hpp"

namespace halfplane {

[[nodiscard]] inline EdgeContext make_edge_context(const TriangleSetup& setup) {
  EdgeContext context;
  for (std::size_t i = 0; i < 3; ++i) {
    context.step_x[i] = -setup.edge[i].dy;
    context.step_y[i] = setup.edge[i].dx;
  }
  return context;
}

/// Coverage of one stamp whose first sample is pixel (x, y) of the tile: bit j * stamp_size + i.
[[nodiscard]] inline std::uint64_t stamp_mask(const TilePacket& tile, const EdgeContext& edges, int x, int y,
                                              int stamp_size) {
  std::uint64_t mask = 0;
  for (int j = 0; j < stamp_size; ++j) {
    for (int i = 0; i < stamp_size; ++i) {
      bool covered = x + i >= tile.left && x + i <= tile.right && y + j >= tile.top && y + j <= tile.bottom;
      for (std::size_t e = 0; e < 3; ++e)
        covered &= tile.edge_value[e] + (x + i) * edges.step_x[e] + (y + j) * edges.step_y[e] >= 0;
      mask |= std::uint64_t{covered} << (j * stamp_size + i);
    }
  }
  return mask;
}

/// Calls emit(StampPacket) for every stamp of the tile that has coverage.
template <class Emit>
void fine_raster(const TilePacket& tile, const EdgeContext& edges, const Config& config, const Widths& widths,
                 Emit&& emit) {
  const int size = config.stamp_size;
  for (int row = tile.top / size; row <= tile.bottom / size; ++row) {
    for (int column = tile.left / size; column <= tile.right / size; ++column) {
      const std::uint64_t mask = stamp_mask(tile, edges, column * size, row * size, size);
      if (mask == 0) continue;
      StampPacket stamp;
      stamp.primitive_id = tile.primitive_id;
      stamp.slot = tile.slot;
      stamp.tile_x = tile.tile_x;
      stamp.tile_y = tile.tile_y;
      stamp.stamp = static_cast<std::uint16_t>(row * widths.stamps_per_row + column);
      stamp.mask = mask;
      emit(stamp);
    }
  }
}

}  // namespace halfplane
