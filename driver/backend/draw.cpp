#include "draw.hpp"

#include <utility>

#include "model/engines/hardware.hpp"

namespace halfplane::driver {

Framebuffer draw(std::span<const std::uint32_t> words, const Config& config, std::vector<std::uint8_t> textures) {
  Decoder decoder(config);
  decoder.read(words);
  PacketSink nobody;
  HardwareModel model(config, nobody);
  model.hold_textures(TextureMemory(std::move(textures)));
  for (const DecodedPrimitive& primitive : decoder.primitives()) model.run(primitive.packet, primitive.line);
  return to_framebuffer(model.memory(), decoder.width(), decoder.height(), config);
}

}  // namespace halfplane::driver
