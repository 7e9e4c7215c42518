// The memory of the texture unit: the images of a scene's textures, one after the other, in the unit's format.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "../config.hpp"
#include "../scene.hpp"

namespace halfplane {

class TextureMemory {
 public:
  static constexpr std::uint32_t kAlignment = 64;  ///< alignment of an image, bytes

  TextureMemory() = default;
  /// Memory with this content.
  explicit TextureMemory(std::vector<std::uint8_t> bytes) : bytes_(std::move(bytes)) {}
  TextureMemory(const Scene& scene, const Config& config);

  /// Address of texture `n` of the scene.
  [[nodiscard]] std::uint32_t base(std::size_t n) const { return base_[n]; }
  /// After the last image: 0.
  void read(std::uint32_t address, std::span<std::uint8_t> out) const {
    for (std::uint8_t& byte : out) {
      byte = address < bytes_.size() ? bytes_[address] : std::uint8_t{0};
      ++address;
    }
  }

 private:
  std::vector<std::uint8_t> bytes_;
  std::vector<std::uint32_t> base_;
};

}  // namespace halfplane
