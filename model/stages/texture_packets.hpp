// Texture unit inputs from packets: samples and texture constants.
#pragma once

#include "../packets/packets.hpp"
#include "../packets/state_packets.hpp"
#include "texture_unit.hpp"

namespace halfplane {

/// Stamps between the depth stage and the colour stage: with several lanes one enters per clock, and leaves about
/// twenty clocks later.
[[nodiscard]] inline int texture_stamps(const Config& config) {
  return config.texture_lanes == 1 ? config.texture_queue / 2 : config.texture_queue;
}

[[nodiscard]] inline TextureSettings texture_settings(const Config& config, const Widths& widths) {
  const bool has_levels = config.texture_unit == TextureUnitKind::trilinear;
  return {config.texture_cache_kb * 1024 / kTextureLine,
          8 * widths.texture_port_bytes,
          texture_stamps(config),
          config.texture_queue,
          has_levels || config.texture_unit == TextureUnitKind::bilinear,
          has_levels,
          line_part_bits(state_word_bits(widths)),
          config.texture_lanes,
          config.stamp_size,
          config.texture_ways};
}

/// Q and P at the shading place of a pixel; not the place.
[[nodiscard]] inline TextureSample texture_sample(const PerPlane<std::uint32_t>& code, const Widths& widths) {
  const std::size_t q = widths.q_plane;
  const auto p = [&](std::size_t plane) { return wrap_signed(code[plane], widths.of_plane(plane).local.bits); };
  TextureSample sample{code[q], {p(q + 1), p(q + 2)}, 0, 0, {}};
  for (std::size_t c = 0; c < static_cast<std::size_t>(widths.colors_over_w); ++c)
    sample.color_p[c] = p(widths.color_over_w_plane() + c);
  for (std::size_t c = 0; c < static_cast<std::size_t>(widths.normals); ++c)
    sample.normal[c] = p(widths.normal_plane() + c);
  return sample;
}

/// Tokens that pass through the texture unit in the time of a stamp without texture: tokens of the light and fog units,
/// and the constant, which is set where they leave; and the border, which waits for the samples in front of it.
template <class Codes>
[[nodiscard]] LevelsWord word_beside_texture(StateRegister which, const Codes& token, const Widths& widths) {
  return which == StateRegister::texture_levels ? levels_word(state_word(token, widths)) : LevelsWord::levels;
}

/// Sets one of the texture unit's registers from a token. `token`: its codes at a vertex, or the fragment that it has
/// become.
template <class Codes>
void set_register(TextureUnit& unit, StateRegister which, const Codes& token, const Widths& widths) {
  const LevelsWord beside = word_beside_texture(which, token, widths);
  if (which == StateRegister::texture_lines)
    unit.move_in(wide_state_word(token, widths));
  else if (beside == LevelsWord::constant)
    unit.set_constant(TextureConstant::unpack(state_word(token, widths)));
  else if (beside == LevelsWord::border)
    unit.set_border(TextureBorder::unpack(state_word(token, widths)));
  else if (which == StateRegister::texture_levels)
    unit.set_levels(TextureLevels::unpack(static_cast<std::uint32_t>(state_word(token, widths))));
  else
    unit.set(TextureState::unpack(state_word(token, widths)));
}

/// Counts the use as the hardware does.
inline void count(const TextureUse& use, CounterPacket& counters) {
  counters.texture_samples += use.samples;
  counters.texture_hits += use.hits;
  counters.texture_fills += use.fills;
}

/// `least` and `greatest`: vertex_color() of the range of the vertices' codes.
[[nodiscard]] inline TextureFrame texture_frame(const CoordinateFrame& frame, std::uint32_t least,
                                                std::uint32_t greatest) {
  TextureFrame result{{OverWScale{frame.shift[0], frame.reach[0]}, OverWScale{frame.shift[1], frame.reach[1]}},
                      frame.origin,
                      frame.divides_colors,
                      {},
                      {},
                      {}};
  for (std::size_t c = 0; c < 4; ++c) {
    result.color_scale[c] = {frame.color_shift[c], frame.color_reach[c]};
    result.least[c] = static_cast<std::uint8_t>(least >> 8 * c);
    result.greatest[c] = static_cast<std::uint8_t>(greatest >> 8 * c);
  }
  return result;
}
[[nodiscard]] inline TextureFrame texture_frame(const FragmentPacket& fragment) {
  return texture_frame(fragment.coordinates, fragment.least_color, fragment.greatest_color);
}

}  // namespace halfplane
