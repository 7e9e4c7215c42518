// Writes what memory holds after a frame, and the frame's picture: the input of the tests of scan-out and of halfplane_detile.
//
// usage: frame_memory "CONFIG KEY=VALUE ..." SEED WIDTH HEIGHT FILE
// FILE: one line of JSON (layout, clear colour, what each page is), the bytes of the pages, and width * height * 3 bytes of
// the picture. WIDTH 0: the random scene's own size.
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "model/config.hpp"
#include "model/engines/hardware.hpp"
#include "model/engines/scalar.hpp"
#include "model/host/primitive_stream.hpp"
#include "sim/cosim/random_scene.hpp"
#include "sim/show/image/framebuffer_files.hpp"

namespace halfplane {
namespace {

/// Buffers that are not those of default_layout(), so that no base is 0 and rows have a gap.
MemoryLayout layout_of(const Config& config) {
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

void run(int argc, char** argv) {
  if (argc != 6) throw InputError("usage: frame_memory CONFIG SEED WIDTH HEIGHT FILE");
  const Config config = labelled(argv[1]);
  const std::uint64_t seed = std::strtoull(argv[2], nullptr, 10);
  Scene scene = random_scene(config, seed, 60);
  if (const int width = std::atoi(argv[3]); width > 0) {
    scene.width = width;
    scene.height = std::atoi(argv[4]);
  }
  PacketSink nobody;
  HardwareModel model(config, nobody, TileMemory(config, layout_of(config)));
  model.hold_textures(scene);
  HostStream host(scene, config);
  while (const auto primitive = host.next()) model.run(primitive->packet, primitive->line);
  const TileMemory& memory = model.memory();

  // The picture of the specification, so that the hardware's own way back from memory is not what is compared.
  const Picture picture = color_picture(render_scalar(scene, config).frame, config.color_format);
  nlohmann::json head{{"config", argv[1]},
                      {"seed", seed},
                      {"width", scene.width},
                      {"height", scene.height},
                      {"color_base", memory.layout().color_base},
                      {"color_flags_base", memory.layout().color_flags_base},
                      {"row_stride", memory.layout().row_stride},
                      {"clear_color", memory.clear_value(true)}};
  nlohmann::json pages = nlohmann::json::array();
  for (std::size_t n = 0; n < memory.pages(); ++n)
    if (!memory.page(n).empty()) pages.push_back(n);
  head["page_bytes"] = TileMemory::kPage;
  head["pages"] = pages;
  std::ofstream file(argv[5], std::ios::binary);
  file << head.dump() << '\n';
  const auto put = [&](std::span<const std::uint8_t> bytes) {
    file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  };
  for (std::size_t n = 0; n < memory.pages(); ++n) put(memory.page(n));
  put(picture.rgb);
  if (!file.flush()) throw InputError(std::string("cannot write ") + argv[5]);
}

}  // namespace
}  // namespace halfplane

int main(int argc, char** argv) {
  try {
    halfplane::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "frame_memory: %s\n", error.what());
    return 1;
  }
}
