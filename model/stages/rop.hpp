// ROP: a fragment's colour in the stored format, and its written samples.
//
// In: a FragmentPacket, and the WritePacket with depth_test's write masks. Out: the complete WritePacket; blended or
// dithered colours go through written_colors() when they are written. The arithmetic is color_ops.hpp's.
#pragma once

#include "../packets/packets.hpp"
#include "clear_flags.hpp"
#include "fragment_ops.hpp"

namespace halfplane {

/// One sample's colour in the stored format; a fast clear's comes from sample 0. `code`: of its planes.
[[nodiscard]] constexpr std::uint32_t stored_color(const PerPlane<std::uint32_t>& code, const Config& config) {
  return pack_color(config.color_format, color_channels(code));
}

/// Adds the fragment's colours of `samples` to its packet.
inline void add_colors(const FragmentPacket& fragment, SampleMask samples, const Config& config, const Widths& widths,
                       WritePacket& packet) {
  const bool is_packed = !has_texture_planes(config) && !packs_at_write(config);
  samples.for_each([&](std::size_t s) {
    packet.color[s] = is_packed ? stored_color(fragment_code(fragment, s, widths), config)
                                : vertex_color(fragment_code(fragment, s, widths), widths);
  });
}

/// The stage.
[[nodiscard]] inline WritePacket rop(const FragmentPacket& fragment, const WritePacket& tested, const Config& config,
                                     const Widths& widths) {
  WritePacket packet = tested;
  add_colors(fragment, SampleMask::all(widths.samples), config, widths, packet);
  return packet;
}

/// Converts the colours of `samples` of a stamp for the write: `color` holds vertex_color()s on entry, stored codes on
/// return. `stored`: the codes before, of samples whose operations read them.
inline void written_colors(const ColorOps& ops, const StampAddress& at, SampleMask samples,
                           std::span<const std::uint32_t> stored, WritePacket::Codes& color, const Config& config,
                           const Widths& widths) {
  const PixelOffset origin = widths.stamps.origin_of(at.stamp);
  samples.for_each([&](std::size_t s) {
    const PixelOffset pixel = widths.stamps.pixel_of(static_cast<int>(s));
    const int x = (at.tile_x << widths.tile_shift) + origin.x + pixel.x,
              y = (at.tile_y << widths.tile_shift) + origin.y + pixel.y;
    const auto channels = unpack_color<std::uint32_t>(ColorFormat::rgba8888, color[s]);  // vertex_color()'s format
    color[s] = store_color<std::uint32_t>(ops, config.color_format, channels, stored[s], dither_threshold(x, y));
  });
}

}  // namespace halfplane
