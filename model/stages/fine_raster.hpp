// Fine raster: one tile in, the covered samples of its stamps out.
//
// In: a TilePacket and the triangle's EdgeContext. Out: a StampPacket for each stamp with at least one covered sample,
// row by row. Latency 2 cycles; one stamp position of the tile's box per cycle.
// A sample is covered when all three edge values are >= 0 there and it lies in the tile's box (which carries the scissor).
// The last row of stamps ends the visit: its last covered stamp, or, when it has none, an empty one at its first
// column. So the end is known without looking ahead further than a row. A packet without a visit passes as an empty
// stamp.
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

[[nodiscard]] inline EdgeContext make_edge_context(const SetupPacket& setup) {
  EdgeContext context;
  for (std::size_t i = 0; i < 3; ++i) {
    context.step_x[i] = -setup.dy[i];
    context.step_y[i] = setup.dx[i];
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
      for (std::size_t e = 0; e < 3 && tile.is_inside == 0; ++e)
        covered &= tile.edge_value[e] + (x + i) * edges.step_x[e] + (y + j) * edges.step_y[e] >= 0;
      mask |= std::uint64_t{covered} << (j * stamp_size + i);
    }
  }
  return mask;
}

/// The parts of a stamp that are its tile's.
[[nodiscard]] inline StampPacket empty_stamp(const TilePacket& tile) {
  StampPacket stamp;
  stamp.kind = tile.kind;
  stamp.primitive_id = tile.primitive_id;
  stamp.slot = tile.slot;
  stamp.tile_x = tile.tile_x;
  stamp.tile_y = tile.tile_y;
  stamp.depth_anchor = tile.depth_anchor;
  stamp.color_anchor = tile.color_anchor;
  return stamp;
}

/// Calls emit(StampPacket) for every stamp of the tile that has coverage or ends something.
template <class Emit>
void fine_raster(const TilePacket& tile, const EdgeContext& edges, const Config& config, const Widths& widths,
                 Emit&& emit) {
  const int size = config.stamp_size, last_row = tile.bottom / size;
  StampPacket stamp = empty_stamp(tile);
  if (tile.is_visit == 0) {
    stamp.ends_primitive = tile.ends_primitive;
    emit(stamp);
    return;
  }
  const auto number = [&](int row, int column) {
    return static_cast<std::uint16_t>(row * widths.stamps_per_row + column);
  };
  StampPacket held = stamp;  // the last one of the last row so far
  held.stamp = number(last_row, 0);
  for (int row = tile.top / size; row <= last_row; ++row) {
    for (int column = tile.left / size; column <= tile.right / size; ++column) {
      stamp.mask = stamp_mask(tile, edges, column * size, row * size, size);
      if (stamp.mask == 0) continue;
      stamp.stamp = number(row, column);
      const bool is_last_row = row == last_row;
      if (!is_last_row) emit(stamp);
      if (is_last_row && held.mask != 0) emit(held);
      if (is_last_row) held = stamp;
    }
  }
  held.ends_visit = 1;
  held.ends_primitive = tile.ends_primitive;
  emit(held);
}

}  // namespace halfplane
