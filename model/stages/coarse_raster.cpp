#include "coarse_raster.hpp"

namespace halfplane {
namespace {

/// A plane of a SetupPacket at a tile `dx`, `dy` tiles from the first one, as a local anchor.
std::int64_t local_anchor(std::int64_t value, std::int64_t step_x, std::int64_t step_y, int dx, int dy,
                          const Width& plane, const Width& local, const Widths& widths) {
  const int to_subpixels = widths.tile_shift + widths.grid_bits;
  const auto moved = [to_subpixels](std::int64_t step, int tiles) {  // modulo 2^64
    return static_cast<std::uint64_t>(step) * (static_cast<std::uint64_t>(std::int64_t{tiles}) << to_subpixels);
  };
  const auto stepped =
      static_cast<std::int64_t>(static_cast<std::uint64_t>(value) + moved(step_x, dx) + moved(step_y, dy));
  return wrap_signed(stepped >> (plane.bits - local.bits), local.bits);
}

}  // namespace

TilePacket make_tile_packet(const SetupPacket& setup, int tile_x, int tile_y, std::uint8_t slot, const Widths& widths) {
  const int last = (1 << widths.tile_shift) - 1;
  const auto inside_tile = [&](int pixel, int tile) {
    return static_cast<std::uint8_t>(std::clamp(pixel - (tile << widths.tile_shift), 0, last));
  };
  TilePacket packet;
  packet.kind = setup.kind;
  packet.is_visit = 1;
  packet.ends_primitive = tile_x == setup.right >> widths.tile_shift && tile_y == setup.bottom >> widths.tile_shift;
  packet.primitive_id = setup.primitive_id;
  packet.slot = slot;
  packet.tile_x = static_cast<std::uint16_t>(tile_x);
  packet.tile_y = static_cast<std::uint16_t>(tile_y);
  packet.left = inside_tile(setup.left, tile_x);
  packet.top = inside_tile(setup.top, tile_y);
  packet.right = inside_tile(setup.right, tile_x);
  packet.bottom = inside_tile(setup.bottom, tile_y);
  const EdgeValues value = edges_at_tile(setup, tile_x, tile_y, widths);
  packet.is_inside = classify(setup.dx, setup.dy, value, 1 << widths.tile_shift) == TileClass::inside;
  for (std::size_t i = 0; i < 3; ++i) packet.edge_value[i] = saturate_tile_edge(value[i], widths);
  const int dx = tile_x - (setup.left >> widths.tile_shift), dy = tile_y - (setup.top >> widths.tile_shift);
  packet.depth_anchor = local_anchor(setup.depth_value, setup.depth_step_x, setup.depth_step_y, dx, dy,
                                     widths.depth_plane, widths.local_depth, widths);
  for (std::size_t c = 0; c < static_cast<std::size_t>(widths.color_channels); ++c)
    packet.color_anchor[c] = local_anchor(setup.color_value[c], setup.color_step_x[c], setup.color_step_y[c], dx, dy,
                                          widths.color_plane, widths.local_color, widths);
  return packet;
}

ContextPacket make_context(const SetupPacket& setup, const Widths& widths) {
  const auto local_step = [&widths](std::int64_t step, const Width& plane, const Width& local) {  // per pixel, rounded
    return wrap_signed(round_shift(step, plane.bits - local.bits - widths.grid_bits), local.bits);
  };
  ContextPacket context;
  static_cast<PrimitiveState&>(context) = setup;
  context.depth_step_x = local_step(setup.depth_step_x, widths.depth_plane, widths.local_depth);
  context.depth_step_y = local_step(setup.depth_step_y, widths.depth_plane, widths.local_depth);
  for (std::size_t c = 0; c < static_cast<std::size_t>(widths.color_channels); ++c) {
    context.color_step_x[c] = local_step(setup.color_step_x[c], widths.color_plane, widths.local_color);
    context.color_step_y[c] = local_step(setup.color_step_y[c], widths.color_plane, widths.local_color);
  }
  context.depth_min = setup.depth_min;
  context.depth_max = setup.depth_max;
  context.color_min = setup.color_min;
  context.color_max = setup.color_max;
  return context;
}

}  // namespace halfplane
