// Fine raster: one tile in, the covered samples of its stamps out.
//
// In: a TilePacket and the triangle's EdgeContext. Out: a StampPacket for each stamp with at least one covered sample,
// row by row. Latency 3 cycles; one stamp position of the tile's box per cycle.
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

/// Coverage of the stamp whose first pixel is `origin` of the tile.
[[nodiscard]] inline SampleMask stamp_mask(const TilePacket& tile, const EdgeContext& edges, PixelOffset origin,
                                           const StampGrid& stamps) {
  SampleMask mask;
  for (int s = 0; s < stamps.samples(); ++s) {
    const PixelOffset pixel = stamps.pixel_of(s);
    const int x = origin.x + pixel.x, y = origin.y + pixel.y;
    bool covered = x >= tile.box.left && x <= tile.box.right && y >= tile.box.top && y <= tile.box.bottom;
    for (std::size_t e = 0; e < 3 && !tile.is_inside; ++e)
      covered &= tile.edge_value[e] + x * edges.step_x[e] + y * edges.step_y[e] >= 0;
    mask.set(s, covered);
  }
  return mask;
}

/// The parts of a stamp that are its tile's.
[[nodiscard]] inline StampPacket empty_stamp(const TilePacket& tile) {
  StampPacket stamp;
  stamp.kind = tile.kind;
  stamp.key = tile.key;
  stamp.slot = tile.slot;
  stamp.anchor = tile.anchor;
  return stamp;
}

/// Calls emit(StampPacket) for every stamp of the tile that has coverage or ends something.
template <class Emit>
void fine_raster(const TilePacket& tile, const EdgeContext& edges, const Widths& widths, Emit&& emit) {
  const StampGrid& stamps = widths.stamps;
  const int size = stamps.size, last_row = tile.box.bottom / size;
  StampPacket stamp = empty_stamp(tile);
  if (!tile.is_visit) {
    stamp.ends_primitive = tile.ends_primitive;
    emit(stamp);
    return;
  }
  StampPacket held = stamp;  // the last one of the last row so far
  held.stamp = static_cast<std::uint16_t>(stamps.stamp_at(0, last_row * size));
  for (int row = tile.box.top / size; row <= last_row; ++row) {
    for (int column = tile.box.left / size; column <= tile.box.right / size; ++column) {
      stamp.mask = stamp_mask(tile, edges, {column * size, row * size}, stamps);
      if (!stamp.mask.any()) continue;
      stamp.stamp = static_cast<std::uint16_t>(stamps.stamp_at(column * size, row * size));
      const bool is_last_row = row == last_row;
      if (!is_last_row) emit(stamp);
      if (is_last_row && held.mask.any()) emit(held);
      if (is_last_row) held = stamp;
    }
  }
  held.ends_visit = true;
  held.ends_primitive = tile.ends_primitive;
  emit(held);
}

}  // namespace halfplane
