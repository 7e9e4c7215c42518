#include "tile_walk.hpp"

namespace halfplane {
namespace {

/// Plane `p` at a tile `dx`, `dy` tiles from the first one, as a local anchor.
std::int64_t local_anchor(const SetupPacket& setup, std::size_t p, std::uint64_t dx, std::uint64_t dy,
                          const Widths& widths) {
  const AttributeWidths& attribute = widths.of_plane(p);
  const std::uint64_t moved =  // modulo 2^64
      static_cast<std::uint64_t>(setup.step_x[p]) * dx + static_cast<std::uint64_t>(setup.step_y[p]) * dy;
  const std::uint64_t stepped =
      static_cast<std::uint64_t>(setup.value[p]) + (moved << (widths.tile_shift + widths.grid_bits));
  // Its upper bits.
  return static_cast<std::int64_t>(stepped << (64 - attribute.plane.bits)) >> (64 - attribute.local.bits);
}

}  // namespace

void make_tile_packet(const SetupPacket& setup, const EdgeValues& value, const TileReach& reach, int tile_x, int tile_y,
                      std::uint8_t slot, bool ends, const Widths& widths, TilePacket& packet) {
  const int last = (1 << widths.tile_shift) - 1;
  const auto inside_tile = [&](int pixel, int tile) {
    return static_cast<std::uint8_t>(std::clamp(pixel - (tile << widths.tile_shift), 0, last));
  };
  packet.kind = setup.kind;
  packet.is_visit = true;
  packet.ends_primitive = ends;
  packet.key = {setup.primitive_id, static_cast<std::uint16_t>(tile_x), static_cast<std::uint16_t>(tile_y)};
  packet.slot = slot;
  packet.box = {inside_tile(setup.box.left, tile_x), inside_tile(setup.box.top, tile_y),
                inside_tile(setup.box.right, tile_x), inside_tile(setup.box.bottom, tile_y)};
  packet.is_inside = true;
  for (std::size_t i = 0; i < 3; ++i) packet.is_inside = packet.is_inside && value[i] + reach.smallest[i] >= 0;
  for (std::size_t i = 0; i < 3; ++i) packet.edge_value[i] = saturate_tile_edge(value[i], widths);
  const auto dx = static_cast<std::uint64_t>(std::int64_t{tile_x - (setup.box.left >> widths.tile_shift)});
  const auto dy = static_cast<std::uint64_t>(std::int64_t{tile_y - (setup.box.top >> widths.tile_shift)});
  for (std::size_t p = 0; p < static_cast<std::size_t>(widths.planes); ++p)
    packet.anchor[p] = local_anchor(setup, p, dx, dy, widths);
}

TilePacket make_tile_packet(const SetupPacket& setup, int tile_x, int tile_y, std::uint8_t slot, bool ends,
                            const Widths& widths) {
  TilePacket packet;
  make_tile_packet(setup, edges_at_tile(setup, tile_x, tile_y, widths), tile_reach(setup.dx, setup.dy, widths), tile_x,
                   tile_y, slot, ends, widths, packet);
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
