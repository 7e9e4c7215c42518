#include "draw.hpp"

#include <utility>

#include "model/engines/hardware.hpp"

namespace halfplane::driver {

Framebuffer draw(std::span<const std::uint32_t> words, const Config& config, std::vector<std::uint8_t> textures) {
  Decoder decoder(config);
  if (words.empty()) throw InputError("there are no words");
  decoder.read(words);
  if (decoder.primitives().empty()) throw InputError("the words draw nothing, so there is no picture");
  PacketSink nobody;
  HardwareModel model(config, nobody);
  model.hold_textures(TextureMemory(std::move(textures)));
  for (const DecodedPrimitive& primitive : decoder.primitives()) model.run(primitive.packet, primitive.line);
  return to_framebuffer(model.memory(), decoder.width(), decoder.height(), config);
}

}  // namespace halfplane::driver
