// Fine raster: one tile in, the covered samples of its stamps out.
//
// In: a TilePacket and the triangle's EdgeContext. Out: a StampPacket for each stamp with at least one covered sample,
// row by row. Time: docs/pipeline.md. A sample is covered when all three edge values are >= 0 there and it lies in the
// tile's box (which carries the scissor). With several samples per pixel all of them are tested, and the centre too: an
// uncovered centre is not shaded. The last row of stamps ends the visit: its last covered stamp, or, if it has none, an
// empty one at its first column. So the end is known with one row of look-ahead. A packet without a visit passes as an
// empty stamp.
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

/// The edges of a triangle at one sample position of every pixel: increments from the pixel's centre.
using EdgePlace = EdgeDeltas;

/// Edges at the centre of pixels, the position of a single sample, and at each of several samples.
struct EdgePlaces {
  EdgePlace centre{};
  std::array<EdgePlace, kMaxPixelSamples> sample{};  ///< with one sample: the centre

  EdgePlaces(const EdgeContext& edges, const Widths& widths) {
    for (std::size_t k = 0; widths.has_samples != 0 && k < static_cast<std::size_t>(widths.pixel_samples); ++k)
      for (std::size_t e = 0; e < 3; ++e)
        sample[k][e] = static_cast<std::int32_t>(sample_edge_offset(edges.low[e], edges.step_x[e], edges.step_y[e],
                                                                    widths.sample_offset[k], widths.grid_bits));
  }
};

/// The edge values at pixel (x, y) of the tile.
[[nodiscard]] inline EdgeDeltas edges_at(const TilePacket& tile, const EdgeContext& edges, int x, int y) {
  EdgeDeltas value;
  for (std::size_t e = 0; e < 3; ++e) value[e] = tile.edge_value[e] + x * edges.step_x[e] + y * edges.step_y[e];
  return value;
}

/// Whether no edge is negative at a place of the pixel with these edge values: the sign bit of their OR is 0.
[[nodiscard]] constexpr bool is_inside(const EdgeDeltas& edge, const EdgePlace& place) {
  return ((edge[0] + place[0]) | (edge[1] + place[1]) | (edge[2] + place[2])) >= 0;
}

[[nodiscard]] constexpr bool is_in_box(const TilePacket& tile, int x, int y) {
  return x >= tile.box.left && x <= tile.box.right && y >= tile.box.top && y <= tile.box.bottom;
}

/// Whether pixel (x, y) of the tile is covered at one sample position.
[[nodiscard]] inline bool is_covered(const TilePacket& tile, const EdgeContext& edges, const EdgePlace& place, int x,
                                     int y) {
  return is_in_box(tile, x, y) && (tile.is_inside || is_inside(edges_at(tile, edges, x, y), place));
}

/// Sets the coverage of a stamp whose first pixel is `origin` of the tile: of its samples, and of its pixels' centres.
inline void cover_stamp(const TilePacket& tile, const EdgeContext& edges, const EdgePlaces& places, PixelOffset origin,
                        const Widths& widths, StampPacket& stamp) {
  const StampGrid stamps = widths.stamps;
  SampleMask mask, centre;
  for (int y = 0; y < stamps.size; ++y)
    for (int x = 0; x < stamps.size; ++x) {
      if (!is_in_box(tile, origin.x + x, origin.y + y)) continue;
      const EdgeDeltas edge = edges_at(tile, edges, origin.x + x, origin.y + y);
      const auto covers = [&](const EdgePlace& place) { return tile.is_inside || is_inside(edge, place); };
      const bool is_centre_covered = covers(places.centre);
      if (stamps.per_pixel == 1) {
        mask.set(y * stamps.size + x, is_centre_covered);
        continue;
      }
      centre.set(y * stamps.size + x, is_centre_covered);
      for (int k = 0; k < stamps.per_pixel; ++k)
        mask.set(stamps.sample_at(x, y) + k, covers(places.sample[static_cast<std::size_t>(k)]));
    }
  stamp.mask = mask;
  stamp.centre = centre;
}

/// The fields of a stamp that are its tile's.
[[nodiscard]] inline StampPacket empty_stamp(const TilePacket& tile) {
  StampPacket stamp;
  stamp.kind = tile.kind;
  stamp.key = tile.key;
  stamp.slot = tile.slot;
  stamp.anchor = tile.anchor;
  return stamp;
}

/// Calls emit(StampPacket) for every stamp of the tile that has coverage or ends a visit.
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
  StampPacket held = stamp;  // the last covered stamp of the last row so far
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
