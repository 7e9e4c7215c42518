// ROP: packs a fragment's colour into the stored format and writes what the masks allow.
//
// In: 8-bit colour codes of a fragment that passed. Out: the stored code. rgb565 keeps the nearest 5- or 6-bit code:
// floor(c * 31 / 255 + 1/2) as one multiply, add and shift (exact for all 256 inputs; tested).
#pragma once

#include <array>
#include <cstdint>

#include "../config.hpp"

namespace halfplane {

[[nodiscard]] constexpr std::uint32_t to_5_bits(std::uint32_t c) { return (c * 249 + 1014) >> 11; }
[[nodiscard]] constexpr std::uint32_t to_6_bits(std::uint32_t c) { return (c * 253 + 505) >> 10; }

[[nodiscard]] constexpr std::uint32_t pack_rgb565(std::uint32_t r, std::uint32_t g, std::uint32_t b) {
  return to_5_bits(r) << 11 | to_6_bits(g) << 5 | to_5_bits(b);
}

[[nodiscard]] constexpr std::uint32_t pack_rgba8888(std::uint32_t r, std::uint32_t g, std::uint32_t b, std::uint32_t a) {
  return r | g << 8 | b << 16 | a << 24;
}

[[nodiscard]] constexpr std::uint32_t pack_color(ColorFormat format, const std::array<std::uint8_t, 4>& c) {
  return format == ColorFormat::rgb565 ? pack_rgb565(c[0], c[1], c[2]) : pack_rgba8888(c[0], c[1], c[2], c[3]);
}

}  // namespace halfplane
