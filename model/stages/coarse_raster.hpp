// Coarse raster: the tiles of a primitive, row by row, sorted into outside, cut and inside (tile_walk.hpp).
//
// In: a SetupPacket. Out: a TilePacket for each tile that is neither outside nor behind its HiZ bound, and the
// constants for the context RAM. The end of the walk always sends a packet: if its last tile was skipped, one without a
// visit.
//
// Edge values leave this stage narrow: inside a tile they change by at most M = (T-1)(|dx| + |dy|), so saturating the
// value at the first pixel to [-M_max - 1, M_max] preserves the sign at every sample. A tile that an edge accepts or
// rejects as a whole needs no case of its own. With several samples per pixel M includes the increment to a sample, and
// tiles are classified by edges moved by sample_edge_reach(): to the farthest possible sample.
#pragma once

#include "hiz.hpp"
#include "tile_walk.hpp"

namespace halfplane {

/// Watches the steps of a walk; the cycle model has a watch that gives them times.
struct UnwatchedWalk {
  static constexpr bool rejects = true;  ///< false: tiles outside an edge are processed like all others
  void skip_outside() const {}           ///< a tile is outside
  void read_bound() const {}             ///< the bound of the tile is read
  void skip_behind() const {}            ///< a tile is behind its bound
};

/// The walk: calls visit(VisitedTile) in its order, which retires the visit, and, if its last tile is skipped or the
/// primitive is a token, end(tile_x, tile_y) with that tile.
template <class Visit, class End, class Watch>
void walk_tiles(const SetupPacket& setup, Hiz& hiz, const Widths& widths, CounterPacket& counters, Visit&& visit,
                End&& end, Watch&& watch) {
  const int first_x = setup.box.left >> widths.tile_shift, last_x = setup.box.right >> widths.tile_shift;
  const int first_y = setup.box.top >> widths.tile_shift, last_y = setup.box.bottom >> widths.tile_shift;
  const PrimitiveKind kind = setup.kind;
  if (is_token(kind)) {
    if (kind == PrimitiveKind::fast_clear && setup.state.depth_write)
      hiz.clear(last_x, last_y, setup.range.high[kDepthPlane]);
    if (kind == PrimitiveKind::line) hiz.pass_line(setup);
    end(last_x, last_y);
    return;
  }
  std::uint64_t visited = 0, outside_tiles = 0, behind = 0, inside = 0, tested = 0;  // counted for triangles
  const bool asks_hiz = hiz.is_eligible(setup, widths);
  TileWalk walk(first_x, first_y, last_x, last_y, setup.dy);
  const TileEdges edges(setup, widths);
  bool has_ended = false;
  unsigned outside = 0;
  do {
    ++visited;
    const EdgeValues value = edges.at(walk.x(), walk.y());
    outside = edges.outside(value);
    if (!watch.rejects) outside = 0;
    if (asks_hiz && outside == 0) watch.read_bound();
    if (outside != 0) {
      ++outside_tiles;
      watch.skip_outside();
    } else if (asks_hiz && hiz.rejects(setup, walk.x(), walk.y())) {
      ++behind;
      watch.skip_behind();
    } else {
      has_ended = walk.is_last();
      const VisitedTile tile = visited_tile(setup, edges, value, walk.x(), walk.y(), has_ended, widths);
      hiz.begin_visit(setup.state);
      if (tile.is_inside)
        ++inside;
      else
        tested += to_bounds(tile.box).samples() * static_cast<std::uint64_t>(widths.pixel_samples);
      visit(tile);
    }
  } while (walk.next(outside));
  if (kind == PrimitiveKind::triangle) {
    counters.tiles_visited += visited;
    counters.tiles_outside += outside_tiles;
    counters.tiles_hiz += behind;
    counters.trivially_accepted += inside;
    counters.samples_tested += tested;
  }
  if (!has_ended) end(walk.x(), walk.y());
}

/// The stage: calls emit(TilePacket) in the order of the walk; emit retires the visit.
template <class Emit, class Watch = UnwatchedWalk>
void coarse_raster(const SetupPacket& setup, std::uint8_t slot, Hiz& hiz, const Widths& widths, CounterPacket& counters,
                   Emit&& emit, Watch&& watch = {}) {
  const TilePlanes planes(setup, widths);
  TilePacket packet;
  walk_tiles(
      setup, hiz, widths, counters,
      [&](const VisitedTile& tile) {
        make_tile_packet(setup, planes, tile, slot, widths, packet);
        emit(packet);
      },
      [&](int tile_x, int tile_y) {  // the end of the primitive without a visit
        TilePacket end = make_tile_packet(setup, tile_x, tile_y, slot, true, widths);
        end.is_visit = end.is_inside = false;
        emit(end);
      },
      watch);
}

}  // namespace halfplane
