// ROP: a fragment's colour in the stored format, and which samples of it are written.
//
// In: a FragmentPacket, and the WritePacket in which depth_test says what passed. Out: the WritePacket, complete. The
// arithmetic is fragment_ops.hpp's.
#pragma once

#include "../fragment_ops.hpp"
#include "../packets.hpp"

namespace halfplane {

/// One sample's colour as it is stored; a fast clear's comes from sample 0. `code`: of its planes.
[[nodiscard]] constexpr std::uint32_t stored_color(const PerPlane<std::uint32_t>& code, const Config& config) {
  return pack_color(config.color_format, color_channels(code));
}

/// The colour of the primitive, 8 bits a channel, R lowest: what goes into a texture unit, which stands in front of rop.
[[nodiscard]] constexpr std::uint32_t vertex_color(const PerPlane<std::uint32_t>& code, const Widths& widths) {
  std::uint32_t color = 0;
  for (int c = widths.color_planes - 1; c >= 0; --c)
    color = color << 8 | code[kColorPlane + static_cast<std::size_t>(c)];
  return color;
}

/// The stage.
[[nodiscard]] inline WritePacket rop(const FragmentPacket& fragment, const WritePacket& tested, const Config& config,
                                     const Widths& widths) {
  WritePacket packet = tested;
  for (std::size_t s = 0; s < static_cast<std::size_t>(widths.samples); ++s)
    packet.color[s] =
        has_texture_planes(config) ? vertex_color(fragment.code[s], widths) : stored_color(fragment.code[s], config);
  if (fragment.state.color_write) packet.write_color = tested.passed;
  return packet;
}

}  // namespace halfplane
