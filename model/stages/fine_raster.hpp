// Fine raster: one tile in, the covered samples of its stamps out.
//
// In: a TilePacket and the triangle's EdgeContext. Out: a StampPacket for each stamp with at least one covered sample,
// row by row. Latency 3 cycles; one stamp position of the tile's box per cycle.
// A sample is covered when all three edge values are >= 0 there and it lies in the tile's box (which carries the scissor).
// Where a pixel has several samples, all of them are looked at, and its centre too: at an uncovered one it is not shaded.
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
    context.low[i] = setup.edge[i].low;
  }
  return context;
}

[[nodiscard]] inline EdgeContext make_edge_context(const SetupPacket& setup) {
  EdgeContext context;
  for (std::size_t i = 0; i < 3; ++i) {
    context.step_x[i] = -setup.dy[i];
    context.step_y[i] = setup.dx[i];
    context.low[i] = setup.edge_low[i];
  }
  return context;
}

/// The edges of a triangle at the place of one sample of every pixel: what each gains from the pixel's centre.
using EdgePlace = EdgeDeltas;

/// At the centre of pixels, and at each of their samples where they have several.
struct EdgePlaces {
  EdgePlace centre{};
  std::array<EdgePlace, kMaxPixelSamples> sample{};  ///< of one sample: the centre

  EdgePlaces(const EdgeContext& edges, const Widths& widths) {
    for (std::size_t k = 0; widths.has_samples != 0 && k < static_cast<std::size_t>(widths.pixel_samples); ++k)
      for (std::size_t e = 0; e < 3; ++e)
        sample[k][e] = static_cast<std::int32_t>(sample_edge_offset(edges.low[e], edges.step_x[e], edges.step_y[e],
                                                                    widths.sample_offset[k], widths.grid_bits));
  }
};

/// Whether pixel (x, y) of the tile is covered at one sample position.
[[nodiscard]] inline bool is_covered(const TilePacket& tile, const EdgeContext& edges, const EdgePlace& place, int x,
                                     int y) {
  bool covered = x >= tile.box.left && x <= tile.box.right && y >= tile.box.top && y <= tile.box.bottom;
  for (std::size_t e = 0; e < 3 && !tile.is_inside; ++e)
    covered &= tile.edge_value[e] + place[e] + x * edges.step_x[e] + y * edges.step_y[e] >= 0;
  return covered;
}

/// Gives a stamp whose first pixel is `origin` of the tile its coverage: of its samples, and of its pixels' centres.
inline void cover_stamp(const TilePacket& tile, const EdgeContext& edges, const EdgePlaces& places, PixelOffset origin,
                        const Widths& widths, StampPacket& stamp) {
  const StampGrid& stamps = widths.stamps;
  stamp.mask = stamp.centre = {};
  for (int s = 0; s < stamps.samples(); ++s) {
    const PixelOffset pixel = stamps.pixel_of(s);
    const int x = origin.x + pixel.x, y = origin.y + pixel.y, k = s % stamps.per_pixel;
    stamp.mask.set(s, is_covered(tile, edges, places.sample[static_cast<std::size_t>(k)], x, y));
    if (widths.has_samples != 0 && k == 0)
      stamp.centre.set(s / stamps.per_pixel, is_covered(tile, edges, places.centre, x, y));
  }
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
  const EdgePlaces places(edges, widths);
  StampPacket held = stamp;  // the last one of the last row so far
  held.stamp = static_cast<std::uint16_t>(stamps.stamp_at(0, last_row * size));
  for (int row = tile.box.top / size; row <= last_row; ++row) {
    for (int column = tile.box.left / size; column <= tile.box.right / size; ++column) {
      cover_stamp(tile, edges, places, {column * size, row * size}, widths, stamp);
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
