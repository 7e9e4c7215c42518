#include "tile_walk.hpp"

namespace halfplane {

TileEdges::TileEdges(const SetupPacket& setup, const Widths& widths)
    : value_(edges_at_tile(setup, 0, 0, widths)),
      largest_(moved_by_samples({}, setup.dx, setup.dy, true, widths)),
      smallest_(moved_by_samples({}, setup.dx, setup.dy, false, widths)) {
  for (std::size_t i = 0; i < 3; ++i) {
    step_x_[i] = -(EdgeValue{setup.dy[i]} << widths.tile_shift);
    step_y_[i] = EdgeValue{setup.dx[i]} << widths.tile_shift;
    largest_[i] = largest_in_tile(largest_[i], setup.dx[i], setup.dy[i], 1 << widths.tile_shift);
    smallest_[i] = smallest_in_tile(smallest_[i], setup.dx[i], setup.dy[i], 1 << widths.tile_shift);
  }
}

TilePlanes::TilePlanes(const SetupPacket& setup, const Widths& widths)
    : planes_(static_cast<std::size_t>(widths.planes)) {
  for (std::size_t p = 0; p < planes_; ++p) {
    const AttributeWidths& attribute = widths.of_plane(p);
    const int upper = 64 - attribute.plane.bits, tile = widths.tile_shift + widths.grid_bits;
    value_[p] = static_cast<std::uint64_t>(setup.value[p]) << upper;
    step_x_[p] = static_cast<std::uint64_t>(setup.step_x[p]) << tile << upper;
    step_y_[p] = static_cast<std::uint64_t>(setup.step_y[p]) << tile << upper;
    unused_[p] = static_cast<std::uint8_t>(64 - attribute.local.bits);
  }
}

void make_tile_packet(const SetupPacket& setup, const TilePlanes& planes, const VisitedTile& tile, std::uint8_t slot,
                      const Widths& widths, TilePacket& packet) {
  packet.kind = setup.kind;
  packet.is_visit = true;
  packet.ends_primitive = tile.ends_primitive;
  packet.key = {setup.primitive_id, static_cast<std::uint16_t>(tile.x), static_cast<std::uint16_t>(tile.y)};
  packet.slot = slot;
  packet.box = tile.box;
  packet.is_inside = tile.is_inside;
  for (std::size_t i = 0; i < 3; ++i) packet.edge_value[i] = saturate_tile_edge(tile.edges[i], widths);
  planes.set_anchors(tile.x - (setup.box.left >> widths.tile_shift), tile.y - (setup.box.top >> widths.tile_shift),
                     packet.anchor);
}

TilePacket make_tile_packet(const SetupPacket& setup, int tile_x, int tile_y, std::uint8_t slot, bool ends,
                            const Widths& widths) {
  const TileEdges edges(setup, widths);
  TilePacket packet;
  make_tile_packet(setup, TilePlanes(setup, widths),
                   visited_tile(setup, edges, edges.at(tile_x, tile_y), tile_x, tile_y, ends, widths), slot, widths,
                   packet);
  return packet;
}

void make_context(const SetupPacket& setup, const Widths& widths, ContextPacket& context) {
  context.state = setup.state;
  context.range = setup.range;
  context.coordinates = setup.coordinates;
  for (std::size_t p = 0; p < static_cast<std::size_t>(widths.planes); ++p) {
    const AttributeWidths& attribute = widths.of_plane(p);
    const int drop = attribute.plane.bits - attribute.local.bits - widths.grid_bits, bits = attribute.step.bits;
    const auto per_pixel = [&](std::int64_t step) { return wrap_signed(round_shift(step, drop), bits); };  // rounded
    context.step_x[p] = per_pixel(setup.step_x[p]);
    context.step_y[p] = per_pixel(setup.step_y[p]);
  }
}

ContextPacket make_context(const SetupPacket& setup, const Widths& widths) {
  ContextPacket context;
  make_context(setup, widths, context);
  return context;
}

}  // namespace halfplane
