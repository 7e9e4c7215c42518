// Texture stage: runs the units in the stream of tested stamps on one stamp, through their ports.
//
// In: a fragment, and depth_test's write masks, with the primitive's own colours. Through `read`: lines of texels. Out:
// the colours of the live pixels in the format of the next packet: stored codes, or 8 bits a channel if still to be
// blended. A pixel is live if a sample of it is written, or, with an alpha test downstream of the texture, tested by
// it; all samples of a pixel have its colour.
#pragma once

#include "../packets/packets.hpp"
#include "color_packets.hpp"
#include "depth_test.hpp"
#include "fog_unit.hpp"
#include "light_unit.hpp"
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

/// The units in the stream of stamps, in the order of raster_top. Each is idle until its registers are set.
struct FragmentUnits {
  LightUnit light{};
  TextureUnit texture;
  FogUnit fog{};

  FragmentUnits(const Config& config, const Widths& widths)
      : texture(texture_settings(config, widths), perspective_format(config)) {}

  /// Sets a register from a token: its codes at a vertex, or the fragment that it has become.
  template <class Codes>
  void set(StateRegister which, const Codes& token, const Widths& widths) {
    const LevelsWord word = word_beside_texture(which, token, widths);
    if (word == LevelsWord::light)
      light.set(state_word(token, widths));
    else if (word == LevelsWord::fog || word == LevelsWord::fog_line)
      fog.set(state_word(token, widths));
    else
      set_register(texture, which, token, widths);
  }

  /// Whether any of them changes the colours of a fragment: only then the planes over w are read.
  [[nodiscard]] bool change_colors(const FragmentPacket& fragment) const {
    const bool is_triangle = fragment.kind == PrimitiveKind::triangle;
    return fragment.coordinates.divides_colors || light.is_lit(is_triangle) || fog.is_fogged(is_triangle) ||
           texture.is_textured(is_triangle, SampleMask(1));
  }
};

/// The colours of the `live` pixels, on entry the primitive's own. read(address, beats) gives a TextureLine. Returns the
/// lookups, valid until the next stamp.
template <class Read>
std::span<const TextureLookup> shade_pixels(FragmentUnits& units, const FragmentPacket& fragment, SampleMask live,
                                            const Widths& widths, std::span<Texel> color, Read&& read) {
  if (!units.change_colors(fragment)) return {};
  const StampGrid& stamps = widths.stamps;
  const PixelOffset origin = stamps.origin_of(fragment.stamp);
  const TextureFrame frame = texture_frame(fragment);
  const bool is_triangle = fragment.kind == PrimitiveKind::triangle;
  const std::span<TextureSample> pixel = units.texture.samples();
  live.for_each([&](std::size_t i) {
    const PixelOffset at = stamps.pixel_of(static_cast<int>(i) * stamps.per_pixel);
    pixel[i] = texture_sample(fragment.code[i], widths);
    pixel[i].x = (fragment.key.tile_x << widths.tile_shift) + origin.x + at.x;
    pixel[i].y = (fragment.key.tile_y << widths.tile_shift) + origin.y + at.y;
    if (frame.divides_colors) units.texture.divide_colors(pixel[i], frame, widths.color_planes, color[i]);
    if (units.light.is_lit(is_triangle)) units.light.add(pixel[i].normal, color[i]);
  });
  std::span<const TextureLookup> lookups;
  if (units.texture.is_textured(is_triangle, live)) lookups = units.texture.take(live, pixel, frame, color, read);
  if (units.fog.is_fogged(is_triangle))
    live.for_each([&](std::size_t i) { units.fog.add(pixel[i].q, fragment.coordinates.fog_octave, color[i]); });
  return lookups;
}

template <class Read>
[[nodiscard]] TexturedStamp texture_stamp(FragmentUnits& units, const FragmentPacket& fragment,
                                          const WritePacket& write, const ColorState& colors, const Config& config,
                                          const Widths& widths, Read&& read) {
  const StampGrid& stamps = widths.stamps;
  const SampleMask shaded = shaded_samples(write, colors), live = stamps.pixels_of(shaded);
  TexturedStamp result{{stamps.samples_of(live), {}}, {}, live, {}};
  if (!live.any()) return result;
  std::array<Texel, kMaxSamples> color;
  live.for_each([&](std::size_t i) {
    const std::uint32_t own = write.color[i * static_cast<std::size_t>(stamps.per_pixel)];
    for (std::size_t c = 0; c < 4; ++c) color[i][c] = static_cast<std::uint8_t>(own >> 8 * c);
  });
  result.lookups = shade_pixels(units, fragment, live, widths, color, read);
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
