#include "scalar.hpp"

#include "commands.hpp"

namespace halfplane {
namespace {

/// One covered sample through interpolate, depth_test and rop.
void shade_sample(const DrawContext& context, const TriangleSetup& setup, const Widths& widths, std::uint32_t index,
                  int x, int y, const Skip& skip, Rendering& rendering) {
  const State& state = context.state;
  const std::size_t pixel = rendering.frame.at(x, y);
  const auto plain =
      static_cast<std::size_t>(y) * static_cast<std::size_t>(rendering.frame.width) + static_cast<std::size_t>(x);
  ++rendering.counters.covered;
  if (!rendering.count.empty()) ++rendering.count[plain];
  const Interpolated value = interpolate_at(setup, widths, x, y);
  if (!depth_passes(state.depth_test, value.depth_code, rendering.frame.depth[pixel])) {
    rendering.counters.skipped.fragments_early_z += skip.fragments_early_z ? 1 : 0;
    return;
  }
  ++rendering.counters.depth_passed;
  if (!state.depth_write && !state.color_write) return;
  ++rendering.counters.written;
  if (state.depth_write) rendering.frame.depth[pixel] = value.depth_code;
  if (state.color_write) rendering.frame.color[pixel] = pack_color(context.config.color_format, value.color_code);
  if (!rendering.ids.empty()) rendering.ids[plain] = static_cast<std::int32_t>(setup.primitive);
  if (!rendering.visible.empty()) rendering.visible[plain] = static_cast<std::int32_t>(index);
}

}  // namespace

Rendering render_scalar(const Scene& scene, const Config& config, const RenderOptions& options) {
  validate(config);
  const Widths widths = derive_widths(config);
  const int stamp = config.stamp_size, shift = widths.tile_shift;
  const Skip& skip = options.skip;
  return run_commands(
      scene, config, options,
      [&](const DrawContext& context, const Triangle& triangle, std::uint32_t index, Rendering& rendering) {
        const TriangleSetup setup = setup_triangle(triangle, config, widths, context.rect);
        if (setup.is_empty()) return;
        const SetupPacket packet = to_setup_packet(setup, widths);
        const EdgeContext edges = make_edge_context(setup);
        Counters& counters = rendering.counters;
        for (int tile_y = setup.top >> shift; tile_y <= setup.bottom >> shift; ++tile_y) {
          for (int tile_x = setup.left >> shift; tile_x <= setup.right >> shift; ++tile_x) {
            ++counters.tiles_visited;
            const TileClass kind = classify(setup, edges_at_tile(setup, tile_x, tile_y, widths), config.tile_size);
            if (kind == TileClass::outside && skip.tiles_outside) {
              ++counters.skipped.tiles_outside;
              continue;
            }
            TilePacket tile = make_tile_packet(packet, tile_x, tile_y, 0, widths);
            tile.is_inside = tile.is_inside != 0 && skip.trivially_accepted;
            if (tile.is_inside != 0)
              ++counters.skipped.trivially_accepted;
            else
              counters.samples_tested +=
                  static_cast<std::uint64_t>((tile.right - tile.left + 1) * (tile.bottom - tile.top + 1));
            TileMask mask{};
            fine_raster(tile, edges, config, widths, [&](const StampPacket& covered) {
              const int column = covered.stamp % widths.stamps_per_row * stamp,
                        row = covered.stamp / widths.stamps_per_row * stamp;
              for (int s = 0; s < stamp * stamp; ++s) {
                if ((covered.mask >> s & 1) == 0) continue;
                const int i = column + s % stamp, j = row + s / stamp;
                mask[static_cast<std::size_t>(j)] |= 1U << i;
                shade_sample(context, setup, widths, index, (tile_x << shift) + i, (tile_y << shift) + j, skip,
                             rendering);
              }
            });
            if (options.coverage_tap) options.coverage_tap(index, tile_x, tile_y, mask);
          }
        }
      });
}

}  // namespace halfplane
