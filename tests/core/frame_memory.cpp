// Writes the memory after a frame, and the frame's picture: the input of the tests of scan-out and of halfplane_detile.
//
// usage: frame_memory "CONFIG KEY=VALUE ..." SEED WIDTH HEIGHT FILE
// FILE: one line of JSON (layout, clear colour, the kind of each page), the bytes of the pages, and width * height * 3 bytes of
// the picture. WIDTH 0: the random scene's own size.
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "frame_memory.hpp"
#include "sim/cosim/random_scene.hpp"

namespace halfplane {
namespace {

void run(int argc, char** argv) {
  if (argc != 6) throw InputError("usage: frame_memory CONFIG SEED WIDTH HEIGHT FILE");
  const Config config = labelled(argv[1]);
  const std::uint64_t seed = std::strtoull(argv[2], nullptr, 10);
  Scene scene = random_scene(config, seed, 60);
  if (const int width = std::atoi(argv[3]); width > 0) {
    scene.width = width;
    scene.height = std::atoi(argv[4]);
  }
  const TileMemory memory = test::memory_after(scene, config);
  const Picture picture = test::picture_of(scene, config);
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
