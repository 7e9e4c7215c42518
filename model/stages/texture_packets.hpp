// What the texture unit sees of the packets: samples, their frame, and the word of a token that sets it.
#pragma once

#include "../packets.hpp"
#include "texture_unit.hpp"

namespace halfplane {

[[nodiscard]] inline TextureSettings texture_settings(const Config& config, const Widths& widths) {
  return {config.texture_cache_kb * 1024 / kTextureLine, 8 * widths.texture_port_bytes, config.texture_queue / 2,
          config.texture_queue, config.texture_unit == TextureUnitKind::bilinear};
}

/// Q and P of a sample.
[[nodiscard]] inline TextureSample texture_sample(const PerPlane<std::uint32_t>& code, const Widths& widths) {
  const std::size_t q = widths.q_plane;
  const auto p = [&](std::size_t plane) { return wrap_signed(code[plane], widths.of_plane(plane).local.bits); };
  return {code[q], {p(q + 1), p(q + 2)}};
}

[[nodiscard]] inline TextureFrame texture_frame(const CoordinateFrame& frame) {
  return {{OverWScale{frame.shift[0], frame.reach[0]}, OverWScale{frame.shift[1], frame.reach[1]}}, frame.origin};
}

/// A token's word over the codes of a vertex, lowest plane first, and back from the fragment that it has become.
inline void set_texture_word(PerPlane<std::uint32_t>& code, std::uint64_t word, const Widths& widths) {
  for (std::size_t p = 0; p < static_cast<std::size_t>(widths.planes); ++p) {
    const int bits = widths.of_plane(p).code.bits;
    code[p] = static_cast<std::uint32_t>(wrap_unsigned(word, bits));
    word >>= bits;
  }
}
[[nodiscard]] inline std::uint64_t texture_word(const PerPlane<std::uint32_t>& code, const Widths& widths) {
  std::uint64_t word = 0;
  for (int p = widths.planes - 1; p >= 0; --p) {
    const int bits = widths.of_plane(static_cast<std::size_t>(p)).code.bits;
    word = word << bits | wrap_unsigned(code[static_cast<std::size_t>(p)], bits);
  }
  return word;
}
[[nodiscard]] inline std::uint64_t texture_word(const FragmentPacket& token, const Widths& widths) {
  PerPlane<std::uint32_t> code = token.code[0];
  for (auto p = static_cast<std::size_t>(widths.affine_planes); p < static_cast<std::size_t>(widths.planes); ++p)
    code[p] >>= widths.of_plane(p).guard_bits();
  return texture_word(code, widths);
}

}  // namespace halfplane
