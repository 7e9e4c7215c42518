#include "texture_memory.hpp"

#include "../stages/texture_unit.hpp"

namespace halfplane {

TextureMemory::TextureMemory(const Scene& scene, const Config& config) {
  const bool has_levels = config.texture_unit == TextureUnitKind::trilinear;
  for (const Texture& texture : scene.textures) {
    bytes_.resize((bytes_.size() + kAlignment - 1) / kAlignment * kAlignment);
    base_.push_back(static_cast<std::uint32_t>(bytes_.size()));
    const auto image = texture_bytes(texture, has_levels);
    bytes_.insert(bytes_.end(), image.begin(), image.end());
  }
}

}  // namespace halfplane
