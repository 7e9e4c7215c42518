// Texture stage: runs texture_unit on one stamp, through its ports.
//
// In: a fragment, and depth_test's write masks, with the primitive's own colours. Through `read`: lines of texels. Out:
// the colours of the live pixels in the format of the next packet: stored codes, or 8 bits a channel if still to be
// blended. A pixel is live if a sample of it is written, or, with an alpha test downstream of the texture, tested by
// it; all samples of a pixel have its colour.
#pragma once

#include "../packets/packets.hpp"
#include "color_packets.hpp"
#include "depth_test.hpp"
#include "texture_packets.hpp"

namespace halfplane {

/// The samples of a stamp that get a colour.
[[nodiscard]] inline SampleMask shaded_samples(const WritePacket& write, const ColorState& colors) {
  return colors.tests_alpha() ? write.passed | write.write_depth : write.write_color;
}

struct TexturedStamp {
  ColorPacket packet;                      ///< sent only if it has a sample
  SampleMask opaque;                       ///< samples that get a colour and pass the alpha test downstream
  SampleMask live;                         ///< pixels that get a colour
  std::span<const TextureLookup> lookups;  ///< until the next stamp
};

/// Whether any of these units changes the colours of a fragment: only then the planes over w are read.
[[nodiscard]] inline bool changes_colors(const TextureUnit& unit, const FragmentPacket& fragment) {
  const bool is_triangle = fragment.kind == PrimitiveKind::triangle;
  return fragment.coordinates.divides_colors || unit.light().is_lit(is_triangle) || unit.fog().is_fogged(is_triangle) ||
         unit.is_textured(is_triangle, SampleMask(1));
}

/// Light, the texture unit and fog: the colours of the `live` pixels, on entry the primitive's own. read(address,
/// beats) gives a TextureLine. Returns the lookups, valid until the next stamp.
template <class Read>
std::span<const TextureLookup> shade_pixels(TextureUnit& unit, const FragmentPacket& fragment, SampleMask live,
                                            const Widths& widths, std::span<Texel> color, Read&& read) {
  if (!changes_colors(unit, fragment)) return {};
  const StampGrid& stamps = widths.stamps;
  const PixelOffset origin = stamps.origin_of(fragment.stamp);
  const TextureFrame frame = texture_frame(fragment);
  const bool is_triangle = fragment.kind == PrimitiveKind::triangle;
  const std::span<TextureSample> pixel = unit.samples();
  live.for_each([&](std::size_t i) {
    const PixelOffset at = stamps.pixel_of(static_cast<int>(i) * stamps.per_pixel);
    pixel[i] = texture_sample(fragment.code[i], widths);
    pixel[i].x = (fragment.key.tile_x << widths.tile_shift) + origin.x + at.x;
    pixel[i].y = (fragment.key.tile_y << widths.tile_shift) + origin.y + at.y;
    if (frame.divides_colors) unit.divide_colors(pixel[i], frame, widths.color_planes, color[i]);
    if (unit.light().is_lit(is_triangle)) unit.light().add(pixel[i].normal, color[i]);
  });
  std::span<const TextureLookup> lookups;
  if (unit.is_textured(is_triangle, live)) lookups = unit.take(live, pixel, frame, color, read);
  add_fog(unit, is_triangle, live, pixel, fragment.coordinates, color);
  return lookups;
}

template <class Read>
[[nodiscard]] TexturedStamp texture_stamp(TextureUnit& unit, const FragmentPacket& fragment, const WritePacket& write,
                                          const ColorState& colors, const Config& config, const Widths& widths,
                                          Read&& read) {
  const StampGrid& stamps = widths.stamps;
  const SampleMask shaded = shaded_samples(write, colors), live = stamps.pixels_of(shaded);
  TexturedStamp result{{stamps.samples_of(live), {}}, {}, live, {}};
  if (!live.any()) return result;
  std::array<Texel, kMaxSamples> color;
  live.for_each([&](std::size_t i) {
    const std::uint32_t own = write.color[i * static_cast<std::size_t>(stamps.per_pixel)];
    for (std::size_t c = 0; c < 4; ++c) color[i][c] = static_cast<std::uint8_t>(own >> 8 * c);
  });
  result.lookups = shade_pixels(unit, fragment, live, widths, color, read);
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
