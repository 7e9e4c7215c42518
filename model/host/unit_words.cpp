#include "unit_words.hpp"

#include "../stages/fog_unit.hpp"
#include "../stages/light_unit.hpp"

namespace halfplane {

void UnitSignatures::add(const UnitWords& units, SignatureHash& hash) {
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

}  // namespace halfplane
