// ROP: packs a fragment's colour into the stored format. The write masks are one AND each, in the engines.
//
// In: 8-bit colour codes of a fragment that passed. Out: the stored code. rgb565 keeps the nearest 5- or 6-bit code:
// floor(c * 31 / 255 + 1/2) as one multiply, add and shift (exact for all 256 inputs; tested).
#pragma once

#include <array>
#include <cstdint>

#include "../config.hpp"

namespace halfplane {

template <class Lane>
[[nodiscard]] constexpr Lane to_5_bits(const Lane& c) {
  return (c * 249 + 1014) >> 11;
}
template <class Lane>
[[nodiscard]] constexpr Lane to_6_bits(const Lane& c) {
  return (c * 253 + 505) >> 10;
}

/// Lane: std::uint32_t or a vector of them.
template <class Lane>
[[nodiscard]] constexpr Lane pack_rgb565(const Lane& r, const Lane& g, const Lane& b) {
  return to_5_bits(r) << 11 | to_6_bits(g) << 5 | to_5_bits(b);
}
template <class Lane>
[[nodiscard]] constexpr Lane pack_rgba8888(const Lane& r, const Lane& g, const Lane& b, const Lane& a) {
  return r | g << 8 | b << 16 | a << 24;
}

[[nodiscard]] constexpr std::uint32_t pack_color(ColorFormat format, const std::array<std::uint8_t, 4>& c) {
  const std::uint32_t r = c[0], g = c[1], b = c[2], a = c[3];
  return format == ColorFormat::rgb565 ? pack_rgb565(r, g, b) : pack_rgba8888(r, g, b, a);
}

}  // namespace halfplane
