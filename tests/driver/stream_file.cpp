// A random frame of the driver, of the configuration `textured`, for the test bench of the core: words, texels and the
// model's picture as JSON.
//
// usage: stream_file SEED PRIMITIVES PIXELS >FILE; the first seed from SEED on whose target has at most PIXELS, 24 or more
// a side, and that shows texels in 200 colours
#include <cstdlib>
#include <iostream>
#include <nlohmann/json.hpp>
#include <set>

#include "driver/backend/draw.hpp"
#include "model/engines/hardware.hpp"
#include "sim/scene/host_geometry.hpp"
#include "stream_case.hpp"

int main(int argc, char** argv) {
  using namespace halfplane;
  if (argc != 4) return 2;
  const Config& config = test::driver_config();
  for (auto seed = static_cast<std::uint32_t>(std::atoi(argv[1]));; ++seed) {
    const test::StreamCase made = test::random_case(seed, std::atoi(argv[2]));
    if (made.scene.width * made.scene.height > std::atoi(argv[3]) || made.scene.width < 24 || made.scene.height < 24)
      continue;
    std::vector<std::uint8_t> others = made.textures;
    for (std::uint8_t& byte : others) byte = static_cast<std::uint8_t>(~byte);
    const Framebuffer frame = driver::draw(made.words, config, made.textures),
                      other = driver::draw(made.words, config, others);
    int textured = 0;
    std::set<std::uint32_t> colors;
    for (std::size_t i = 0; i < frame.color.size(); ++i)
      if (frame.color[i] != other.color[i]) ++textured, colors.insert(frame.color[i]);
    if (colors.size() < 200) continue;
    driver::Decoder decoder(config);
    decoder.read(made.words);
    std::uint32_t cleared_depth = 0;
    for (const auto& [packet, line] : decoder.primitives())
      if (packet.kind == PrimitiveKind::fast_clear && packet.state.depth_write)
        cleared_depth = packet.vertex.code[0][kDepthPlane];
    const Rendering wanted = render_hardware(in_host_numbers(made.scene, TransformNumbers::s15_16, config), config);
    std::vector<std::uint32_t> color, depth;
    for (int y = 0; y < made.scene.height; ++y)
      for (int x = 0; x < made.scene.width; ++x) {
        color.push_back(wanted.frame.color[wanted.frame.at(x, y)]);
        depth.push_back(wanted.frame.depth[wanted.frame.at(x, y)]);
      }
    std::cout << nlohmann::json{{"seed", seed},
                                {"width", made.scene.width},
                                {"height", made.scene.height},
                                {"words", made.words},
                                {"textures", made.textures},
                                {"textured_pixels", textured},
                                {"cleared_depth", cleared_depth},
                                {"color", color},
                                {"depth", depth}};
    return std::cout.flush() ? 0 : 1;
  }
}
