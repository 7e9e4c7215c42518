// Texture stage: what texture_unit makes of one stamp, over its ports.
//
// In: a fragment, and what depth_test lets be written of it, with the primitive's own colours. Through `read`: lines of texels.
// Out: the colours of the live samples as the packet behind has them: as they are stored, or 8 bits a channel where they are
// yet to be blended. Live are those that are written, or, where an alpha test stands behind the texture, all that it looks at.
#pragma once

#include "../packets.hpp"
#include "color_packets.hpp"
#include "depth_test.hpp"
#include "texture_packets.hpp"

namespace halfplane {

/// The samples of a stamp that get a colour.
[[nodiscard]] inline SampleMask shaded_samples(const WritePacket& write, const AlphaTest& alpha) {
  return alpha.func != DepthFunc::always ? write.passed | write.write_depth : write.write_color;
}

struct TexturedStamp {
  ColorPacket packet;  ///< sent only if it has a sample
  SampleMask opaque;   ///< those of its samples that the alpha test behind lets pass
  TextureUse use;
};

/// read(address, beats) gives a TextureLine.
template <class Read>
[[nodiscard]] TexturedStamp texture_stamp(TextureUnit& unit, const FragmentPacket& fragment, const WritePacket& write,
                                          const AlphaTest& alpha, const Config& config, const Widths& widths,
                                          Read&& read) {
  TexturedStamp result{{shaded_samples(write, alpha), {}}, {}, {}};
  const SampleMask live = result.packet.mask;
  const PixelOffset origin = widths.stamps.origin_of(fragment.stamp);
  const TextureFrame frame = texture_frame(fragment);
  const bool is_triangle = fragment.kind == PrimitiveKind::triangle;
  std::array<TextureSample, kMaxSamples> sample;
  std::array<Texel, kMaxSamples> color;
  live.for_each([&](std::size_t s) {
    sample[s] = texture_sample(fragment.code[s], widths);
    const PixelOffset pixel = widths.stamps.pixel_of(static_cast<int>(s));
    sample[s].x = (fragment.key.tile_x << widths.tile_shift) + origin.x + pixel.x;
    sample[s].y = (fragment.key.tile_y << widths.tile_shift) + origin.y + pixel.y;
    for (std::size_t c = 0; c < 4; ++c) color[s][c] = static_cast<std::uint8_t>(write.color[s] >> 8 * c);
    if (frame.divides_colors) unit.divide_colors(sample[s], frame, widths.color_planes, color[s]);
    if (unit.light().is_lit(is_triangle)) unit.light().add(sample[s].normal, color[s]);
  });
  if (unit.is_textured(is_triangle, live)) result.use = use_of(unit.take(live, sample, frame, color, read));
  add_fog(unit, is_triangle, live, sample, fragment.coordinates, color);
  live.for_each([&](std::size_t s) {
    const Channels<std::uint32_t> c{color[s][0], color[s][1], color[s][2], color[s][3]};
    result.packet.color[s] =
        packs_at_write(config)
            ? static_cast<std::uint32_t>(wrap_unsigned(pack_rgba8888(c[0], c[1], c[2], c[3]), widths.shaded_color.bits))
            : pack_color(config.color_format, c);
  });
  result.opaque = alpha_passes(alpha, live, [&](std::size_t s) { return std::uint32_t{color[s][3]}; });
  return result;
}

}  // namespace halfplane
