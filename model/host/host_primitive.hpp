// A primitive on its way from the host to the hardware.
#pragma once

#include <optional>

#include "../packets/packets.hpp"
#include "unit_words.hpp"

namespace halfplane {

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

}  // namespace halfplane
