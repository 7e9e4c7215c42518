// The memory after a frame of the model, and the frame's picture: for the tests of scan-out and of halfplane_detile.
#pragma once

#include <vector>

#include "model/engines/hardware.hpp"
#include "model/engines/scalar.hpp"
#include "model/host/primitive_stream.hpp"
#include "model/stages/memory_port.hpp"
#include "sim/show/image/framebuffer_files.hpp"

namespace halfplane::test {

/// Buffers at other places than in default_layout(), so that no base is 0 and rows have a gap.
inline MemoryLayout layout_of(const Config& config) {
  const Widths widths = derive_widths(config);
  const MemoryGrid& m = widths.memory;
  MemoryLayout layout = default_layout(widths);
  const std::uint32_t tile = std::uint32_t{1} << m.tile(), gap = 5 * tile;
  layout.depth_base += gap;
  layout.color_base += gap;
  layout.row_stride += tile;
  const auto rows = static_cast<std::uint32_t>(widths.tiles_y);
  const std::uint32_t end = gap + (rows + 1) * layout.row_stride;
  layout.color_flags_base = (((end - 1) >> m.flag_row) + 1) << m.flag_row;
  layout.depth_flags_base =
      layout.color_flags_base + (rows * static_cast<std::uint32_t>(widths.blocks.per_tile) << m.flag_row);
  return layout;
}

/// The memory of the hardware model after the flush of `scene`.
inline TileMemory memory_after(const Scene& scene, const Config& config) {
  PacketSink nobody;
  HardwareModel model(config, nobody, TileMemory(config, layout_of(config)));
  model.hold_textures(scene);
  HostStream host(scene, config);
  while (const auto primitive = host.next()) model.run(primitive->packet, primitive->line);
  return model.memory();
}

/// The picture of the specification, so that the hardware's own read-back is not compared with itself.
inline Picture picture_of(const Scene& scene, const Config& config) {
  return color_picture(render_scalar(scene, config).frame, config.color_format);
}

}  // namespace halfplane::test
