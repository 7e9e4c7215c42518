#include "coarse_raster.hpp"

namespace halfplane {

TilePacket make_tile_packet(const TriangleSetup& setup, int tile_x, int tile_y, std::uint8_t slot,
                            const Widths& widths) {
  const int last = (1 << widths.tile_shift) - 1;
  const auto inside_tile = [&](int pixel, int tile) {
    return static_cast<std::uint8_t>(std::clamp(pixel - (tile << widths.tile_shift), 0, last));
  };
  TilePacket packet;
  packet.primitive_id = static_cast<std::uint32_t>(wrap_unsigned(setup.primitive, widths.primitive_id.bits));
  packet.slot = slot;
  packet.tile_x = static_cast<std::uint16_t>(tile_x);
  packet.tile_y = static_cast<std::uint16_t>(tile_y);
  packet.left = inside_tile(setup.left, tile_x);
  packet.top = inside_tile(setup.top, tile_y);
  packet.right = inside_tile(setup.right, tile_x);
  packet.bottom = inside_tile(setup.bottom, tile_y);
  const EdgeValues value = edges_at_tile(setup, tile_x, tile_y, widths);
  for (std::size_t i = 0; i < 3; ++i) packet.edge_value[i] = saturate_tile_edge(value[i], widths);
  return packet;
}

}  // namespace halfplane
