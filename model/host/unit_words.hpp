// The state of the texture, fog, light, colour and stencil units that a primitive needs: what the host stream fills in,
// frames in bins keep and compare, and the hardware receives as tokens.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

#include "../signature.hpp"
#include "../stages/color_packets.hpp"
#include "../stages/fog_unit.hpp"
#include "../stages/light_unit.hpp"
#include "../stages/stencil_packets.hpp"
#include "../stages/texture_levels.hpp"

namespace halfplane {

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
  void add(const UnitWords& units, SignatureHash& hash) {
    const auto add_optional = [&hash](const auto& word) {
      hash.add(word.has_value());
      if (word) hash.add(*word);
    };
    hash.add(units.texture_state);
    hash.add(units.texture_levels);
    add_optional(units.texture_constant);
    add_optional(units.texture_border);
    hash.add(units.texels);
    if (units.texture_lines)
      for (const uint128 part : {units.texture_lines->low, units.texture_lines->high}) {
        hash.add(static_cast<std::uint64_t>(part));
        hash.add(static_cast<std::uint64_t>(part >> 64));
      }
    hash.add(units.looks_at_fog);
    if (units.fog != nullptr) {
      hash.add(fog_.signature_of(units.fog, [](const FogTable& fog, SignatureHash& table) {
        table.add(static_cast<std::uint64_t>(fog.octave_bits()));
        for (const std::uint8_t channel : fog.color()) table.add(channel);
        for (const FogLine& entry : fog.lines()) {
          table.add(static_cast<std::uint64_t>(entry.start));
          table.add(static_cast<std::uint64_t>(entry.rise));
        }
      }));
    }
    hash.add(units.looks_at_light);
    if (units.light != nullptr) {
      hash.add(light_.signature_of(units.light, [](const PhongLight& light, SignatureHash& registers) {
        for (const std::uint64_t word : light_words(light.registers())) registers.add(word);
        for (const FallingLine& entry : light.lines()) {
          registers.add(static_cast<std::uint64_t>(entry.start));
          registers.add(static_cast<std::uint64_t>(entry.fall));
        }
      }));
    }
    for (const auto& word : {units.colors.ops, units.colors.constant, units.colors.alpha}) add_optional(word);
    for (const std::size_t side : {0U, 1U}) {
      add_optional(units.stencil.test[side]);
      add_optional(units.stencil.update[side]);
    }
  }

 private:
  SharedSignature<FogTable> fog_;
  SharedSignature<PhongLight> light_;
};

}  // namespace halfplane
