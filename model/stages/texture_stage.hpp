// Texture stage: what texture_unit makes of one stamp, over its ports.
//
// In: a fragment, and what depth_test lets be written of it, with the primitive's own colours. Through `read`: lines of texels.
// Out: the colours of the live pixels as the packet behind has them: as they are stored, or 8 bits a channel where they are
// yet to be blended. Live are those with a sample that is written, or, where an alpha test stands behind the texture, one that
// it looks at; all samples of a pixel have its colour.
#pragma once

#include "../packets.hpp"
#include "color_packets.hpp"
#include "depth_test.hpp"
#include "texture_packets.hpp"

namespace halfplane {

/// The samples of a stamp that get a colour.
[[nodiscard]] inline SampleMask shaded_samples(const WritePacket& write, const ColorState& colors) {
  return colors.tests_alpha() ? write.passed | write.write_depth : write.write_color;
}

struct TexturedStamp {
  ColorPacket packet;  ///< sent only if it has a sample
  SampleMask opaque;   ///< those that get a colour and that the alpha test behind lets pass
  TextureUse use;
};

/// read(address, beats) gives a TextureLine.
template <class Read>
[[nodiscard]] TexturedStamp texture_stamp(TextureUnit& unit, const FragmentPacket& fragment, const WritePacket& write,
                                          const ColorState& colors, const Config& config, const Widths& widths,
                                          Read&& read) {
  const StampGrid& stamps = widths.stamps;
  const SampleMask shaded = shaded_samples(write, colors), live = stamps.pixels_of(shaded);
  TexturedStamp result{{stamps.samples_of(live), {}}, {}, {}};
  const PixelOffset origin = stamps.origin_of(fragment.stamp);
  const TextureFrame frame = texture_frame(fragment);
  const bool is_triangle = fragment.kind == PrimitiveKind::triangle;
  std::array<TextureSample, kMaxSamples> pixel;
  std::array<Texel, kMaxSamples> color;
  live.for_each([&](std::size_t i) {
    const int first = static_cast<int>(i) * stamps.per_pixel;
    const PixelOffset at = stamps.pixel_of(first);
    pixel[i] = texture_sample(fragment.code[i], widths);
    pixel[i].x = (fragment.key.tile_x << widths.tile_shift) + origin.x + at.x;
    pixel[i].y = (fragment.key.tile_y << widths.tile_shift) + origin.y + at.y;
    for (std::size_t c = 0; c < 4; ++c)
      color[i][c] = static_cast<std::uint8_t>(write.color[static_cast<std::size_t>(first)] >> 8 * c);
    if (frame.divides_colors) unit.divide_colors(pixel[i], frame, widths.color_planes, color[i]);
    if (unit.light().is_lit(is_triangle)) unit.light().add(pixel[i].normal, color[i]);
  });
  if (unit.is_textured(is_triangle, live)) result.use = use_of(unit.take(live, pixel, frame, color, read));
  add_fog(unit, is_triangle, live, pixel, fragment.coordinates, color);
  const auto color_at = [&](std::size_t s) { return color[s / static_cast<std::size_t>(stamps.per_pixel)]; };
  result.packet.mask.for_each([&](std::size_t s) {
    const Texel of_pixel = color_at(s);
    const Channels<std::uint32_t> c{of_pixel[0], of_pixel[1], of_pixel[2], of_pixel[3]};
    result.packet.color[s] =
        packs_at_write(config)
            ? static_cast<std::uint32_t>(wrap_unsigned(pack_rgba8888(c[0], c[1], c[2], c[3]), widths.shaded_color.bits))
            : pack_color(config.color_format, c);
  });
  result.opaque = alpha_passes(colors, shaded, widths, [&](std::size_t s) { return std::uint32_t{color_at(s)[3]}; });
  return result;
}

}  // namespace halfplane
