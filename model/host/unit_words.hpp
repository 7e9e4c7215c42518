// The state of the texture, fog, light, colour and stencil units that a primitive needs: what the host stream fills in,
// frames in bins keep and compare, and the hardware receives as tokens.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

#include "../packets/state_packets.hpp"
#include "../signature.hpp"

namespace halfplane {

class FogTable;    // stages/fog.hpp
class PhongLight;  // stages/phong.hpp

/// The unit registers that a primitive needs, as words of tokens.
struct UnitWords {
  std::uint64_t texture_state = 0;                  ///< of a triangle: TextureState
  std::uint32_t texture_levels = 0;                 ///< likewise TextureLevels
  std::optional<TextureLines> texture_lines{};      ///< if its samples have a level of detail
  std::optional<std::uint64_t> texture_constant{};  ///< if it blends by its texels: TextureConstant
  std::optional<std::uint64_t> texture_border{};    ///< if a side of it has one: TextureBorder
  bool looks_at_fog = false;                        ///< triangle whose colours are written, with a fog unit
  std::shared_ptr<const FogTable> fog{};            ///< then: its fog; null: none
  bool looks_at_light = false;                      ///< likewise
  std::shared_ptr<const PhongLight> light{};        ///< then: its light; null: none
  ColorWords colors{};                              ///< of the draw
  StencilWords stencil{};                           ///< likewise; for a fast clear: its value
  Signature texels{};                               ///< of the texture of a triangle, where bins are compared
};

/// The signature of data shared by draws, computed again only when the data change.
template <class Shared>
class SharedSignature {
 public:
  /// `add`: adds the data that count to a hash.
  [[nodiscard]] const Signature& signature_of(const std::shared_ptr<const Shared>& shared, const auto& add) {
    if (shared != last_) {
      last_ = shared;
      SignatureHash hash;
      add(*shared, hash);
      signature_ = hash.signature();
    }
    return signature_;
  }

 private:
  std::shared_ptr<const Shared> last_;
  Signature signature_;
};

/// Adds everything that pixels depend on to a hash.
class UnitSignatures {
 public:
  void add(const UnitWords& units, SignatureHash& hash);

 private:
  SharedSignature<FogTable> fog_;
  SharedSignature<PhongLight> light_;
};

}  // namespace halfplane
