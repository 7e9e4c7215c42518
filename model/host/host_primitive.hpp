// A primitive on its way from the host to the hardware.
#pragma once

#include <memory>
#include <optional>

#include "../packets/packets.hpp"
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
  Signature texels{};                               ///< signature of a triangle's texture, where bins are compared
};

/// The packet, and its origin.
struct HostPrimitive {
  static constexpr std::uint32_t kNoCommand = ~0U;

  PrimitivePacket packet;
  std::optional<LineSetup> line;  ///< with a packet of kind line
  std::uint32_t primitive = 0;    ///< number of the input primitive over the whole scene; otherwise of the next one
  std::uint32_t command = kNoCommand;  ///< index into Scene::commands; kNoCommand: the first clear and the flush
  bool is_part = false;                ///< the part in one bin: the host has counted the whole
  UnitWords units{};
};

/// The stencil value that a fast clear of depth leaves.
[[nodiscard]] inline std::uint8_t clear_stencil(const HostPrimitive& clear) {
  StencilState state;
  if (const auto& test = clear.units.stencil.test[0]) state.set(StateRegister::stencil_test, front_only(*test));
  return state.clear_value();
}

}  // namespace halfplane
