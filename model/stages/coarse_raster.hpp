// Coarse raster: the tiles of a primitive's box, row by row, sorted into outside, cut and inside.
//
// In: a SetupPacket. Out: a TilePacket for each tile that is neither outside nor behind its HiZ bound, and the
// constants that wait in the context RAM. The last tile of the box always sends one: if it was left out, one without a
// visit. A tile is outside when the largest value of one edge over its pixels is negative (trivial reject), inside
// when the smallest value of every edge is not (trivial accept), cut otherwise.
//
// Edge values leave here narrow: inside a tile they move by at most M = (T-1)(|dx| + |dy|), so saturating the value at the
// first pixel to [-M_max - 1, M_max] leaves the sign of every sample as it was. A tile that an edge accepts or rejects
// as a whole needs no case of its own.
#pragma once

#include <algorithm>

#include "cull.hpp"
#include "hiz.hpp"
#include "triangle_setup.hpp"

namespace halfplane {

enum class TileClass { outside, cut, inside };

/// `edge_dx`, `edge_dy`: of the three edges, subpixels; `value`: at the tile's first pixel.
[[nodiscard]] constexpr TileClass classify(const EdgeDeltas& edge_dx, const EdgeDeltas& edge_dy,
                                           const EdgeValues& value, int tile_size) {
  const EdgeValue extent = tile_size - 1;
  TileClass result = TileClass::inside;
  for (std::size_t i = 0; i < 3; ++i) {
    const EdgeValue dx = edge_dx[i], dy = edge_dy[i];
    const EdgeValue largest = value[i] + extent * ((dx > 0 ? dx : 0) + (dy < 0 ? -dy : 0));
    const EdgeValue smallest = value[i] + extent * ((dx < 0 ? dx : 0) + (dy > 0 ? -dy : 0));
    if (largest < 0) return TileClass::outside;
    if (smallest < 0) result = TileClass::cut;
  }
  return result;
}

[[nodiscard]] constexpr TileClass classify(const TriangleSetup& setup, const EdgeValues& value, int tile_size) {
  const auto& edge = setup.edge;
  return classify({edge[0].dx, edge[1].dx, edge[2].dx}, {edge[0].dy, edge[1].dy, edge[2].dy}, value, tile_size);
}

/// The narrow edge value of a tile packet.
[[nodiscard]] inline std::int32_t saturate_tile_edge(EdgeValue value, const Widths& widths) {
  const auto low = static_cast<EdgeValue>(widths.tile_edge.range.lo),
             high = static_cast<EdgeValue>(widths.tile_edge.range.hi);
  return static_cast<std::int32_t>(std::clamp(value, low, high));
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

/// From the first tile to another one, subpixels, modulo 2^64.
struct TileOffset {
  std::uint64_t dx, dy;
};
[[nodiscard]] inline TileOffset tile_offset(const TriangleSetup& setup, int tile_x, int tile_y, const Widths& widths) {
  const auto subpixels = [&widths](int tiles) {
    return static_cast<std::uint64_t>(std::int64_t{tiles} << (widths.tile_shift + widths.grid_bits));
  };
  return {subpixels(tile_x - (setup.left >> widths.tile_shift)), subpixels(tile_y - (setup.top >> widths.tile_shift))};
}

/// A plane at the anchor of the tile there, modulo 2^bits.
[[nodiscard]] inline PlaneValue plane_at_tile(const Plane& plane, const TileOffset& offset, int bits) {
  return wrap_signed(static_cast<std::int64_t>(static_cast<std::uint64_t>(plane.value) +
                                               static_cast<std::uint64_t>(plane.step_x) * offset.dx +
                                               static_cast<std::uint64_t>(plane.step_y) * offset.dy),
                     bits);
}

/// The same for a packet.
[[nodiscard]] inline EdgeValues edges_at_tile(const SetupPacket& setup, int tile_x, int tile_y, const Widths& widths) {
  const int steps_x = (tile_x - (setup.box.left >> widths.tile_shift)) << widths.tile_shift;
  const int steps_y = (tile_y - (setup.box.top >> widths.tile_shift)) << widths.tile_shift;
  EdgeValues value;
  for (std::size_t i = 0; i < 3; ++i)
    value[i] = setup.edge_value[i] - EdgeValue{steps_x} * setup.dy[i] + EdgeValue{steps_y} * setup.dx[i];
  return value;
}

/// The packet of a visit to tile (tile_x, tile_y). `slot` is the context slot of the primitive.
[[nodiscard]] TilePacket make_tile_packet(const SetupPacket& setup, int tile_x, int tile_y, std::uint8_t slot,
                                          const Widths& widths);

/// The part of a primitive's box that lies in tile (tile_x, tile_y), in pixels of the tile.
[[nodiscard]] inline PixelBounds tile_box(const TriangleSetup& setup, int tile_x, int tile_y, const Widths& widths) {
  const int x0 = tile_x << widths.tile_shift, y0 = tile_y << widths.tile_shift, last = (1 << widths.tile_shift) - 1;
  return {std::max(setup.left - x0, 0), std::max(setup.top - y0, 0), std::min(setup.right - x0, last),
          std::min(setup.bottom - y0, last)};
}

/// What coarse_raster writes into the context RAM when it takes a primitive.
[[nodiscard]] ContextPacket make_context(const SetupPacket& setup, const Widths& widths);

/// The stage: calls emit(TilePacket) in the order of the walk, which retires the visit.
template <class Emit>
void coarse_raster(const SetupPacket& setup, std::uint8_t slot, Hiz& hiz, const Widths& widths, CounterPacket& counters,
                   Emit&& emit) {
  const int first_x = setup.box.left >> widths.tile_shift, last_x = setup.box.right >> widths.tile_shift;
  const int first_y = setup.box.top >> widths.tile_shift, last_y = setup.box.bottom >> widths.tile_shift;
  const auto emit_end = [&] {  // the end of the primitive without a visit
    TilePacket packet = make_tile_packet(setup, last_x, last_y, slot, widths);
    packet.is_visit = packet.is_inside = false;
    emit(packet);
  };
  const PrimitiveKind kind = setup.kind;
  if (kind == PrimitiveKind::fast_clear || kind == PrimitiveKind::flush || kind == PrimitiveKind::line) {
    if (kind == PrimitiveKind::fast_clear && setup.state.depth_write)
      hiz.clear(last_x, last_y, setup.range.high[kDepthPlane]);
    if (kind == PrimitiveKind::line) hiz.pass_line(setup);
    emit_end();
    return;
  }
  CounterPacket uncounted;
  CounterPacket& count = kind == PrimitiveKind::triangle ? counters : uncounted;
  const bool asks_hiz = hiz.is_eligible(setup, widths);
  for (int tile_y = first_y; tile_y <= last_y; ++tile_y)
    for (int tile_x = first_x; tile_x <= last_x; ++tile_x) {
      ++count.tiles_visited;
      const EdgeValues edges = edges_at_tile(setup, tile_x, tile_y, widths);
      const TileClass tile_class = classify(setup.dx, setup.dy, edges, 1 << widths.tile_shift);
      const bool is_outside = tile_class == TileClass::outside;
      if (is_outside || (asks_hiz && hiz.rejects(setup, tile_x, tile_y))) {
        ++(is_outside ? count.tiles_outside : count.tiles_hiz);
        if (tile_x == last_x && tile_y == last_y) emit_end();
        continue;
      }
      const TilePacket packet = make_tile_packet(setup, tile_x, tile_y, slot, widths);
      hiz.begin_visit(setup.state);
      if (tile_class == TileClass::inside)
        ++count.trivially_accepted;
      else
        count.samples_tested += static_cast<std::uint32_t>(to_bounds(packet.box).samples());
      emit(packet);
    }
}

}  // namespace halfplane
