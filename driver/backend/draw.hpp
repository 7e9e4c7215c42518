// The software backend: draws a command stream on a host, with the model of the hardware.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "decode.hpp"
#include "model/stages/framebuffer.hpp"

namespace halfplane::driver {

/// The frame in memory when the stream has run, up to a STOP, of the last target. `textures`: memory from
/// hp_target::textures on. Throws as Decoder does.
[[nodiscard]] Framebuffer draw(std::span<const std::uint32_t> words, const Config& config,
                               std::vector<std::uint8_t> textures = {});

}  // namespace halfplane::driver
