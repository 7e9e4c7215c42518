// Fog unit: fog.hpp in hardware, downstream of the texture unit. Its table, the fog's colour and its enable are
// registers, set by tokens, a line of the table each; a triangle brings the octave of Q = 1 in the table.
//
// Its tokens use the number of a texture's levels (LevelsWord).
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "fog.hpp"
#include "texture_filter.hpp"
#include "texture_levels.hpp"

namespace halfplane {

inline constexpr int kFogOctaveLow = -32, kFogOctaveHigh = 31;  ///< Widths::fog_octave

/// The unit's state for a draw, without the table.
struct FogState {
  bool enable = false;
  int octave_bits = 0;  ///< FogTable::octave_bits()
  std::array<std::uint8_t, 3> color{};

  /// From the lowest bit: R, G, B, octave_bits 3, enable.
  [[nodiscard]] constexpr std::uint64_t pack() const {
    return tag_of(LevelsWord::fog) | std::uint64_t{enable ? 1U : 0U} << 27 |
           static_cast<std::uint64_t>(octave_bits) << 24 | std::uint64_t{color[2]} << 16 |
           std::uint64_t{color[1]} << 8 | color[0];
  }
  [[nodiscard]] static constexpr FogState unpack(std::uint64_t word) {
    return {
        (word >> 27 & 1) != 0,
        static_cast<int>(word >> 24 & 7),
        {static_cast<std::uint8_t>(word), static_cast<std::uint8_t>(word >> 8), static_cast<std::uint8_t>(word >> 16)}};
  }
  bool operator==(const FogState&) const = default;
};

/// A line of the table, from the lowest bit: rise 17, start 18, its number 8.
[[nodiscard]] constexpr std::uint64_t fog_line_word(std::size_t number, const FogLine& line) {
  return tag_of(LevelsWord::fog_line) | std::uint64_t{number} << 35 |
         (static_cast<std::uint64_t>(line.start) & 0x3ffff) << 17 | static_cast<std::uint64_t>(line.rise);
}

/// The octave of Q = 1 in the table of a fog, for Q in 2^-scale; where a packet cannot express it, all Q lie beyond an
/// end as well.
[[nodiscard]] inline int fog_octave(const FogTable& table, int scale) {
  return std::clamp(-scale - table.first(), kFogOctaveLow, kFogOctaveHigh);
}

class FogUnit {
 public:
  /// Executes a token for fog.
  void set(std::uint64_t word) {
    if (levels_word(word) == LevelsWord::fog) {
      state_ = FogState::unpack(word);
      return;
    }
    const auto start = static_cast<std::int32_t>(word >> 17 & 0x3ffff);
    line_[word >> 35 & 0xff] = {start >= 1 << 17 ? start - (1 << 18) : start,
                                static_cast<std::int32_t>(word & 0x1ffff)};
  }
  /// Whether fog changes colours of a primitive.
  [[nodiscard]] bool is_fogged(bool is_triangle) const { return state_.enable && is_triangle; }
  /// Blends a sample's colour with fog.
  void add(std::uint64_t q, int octave, Texel& color) const {
    const int place_bits = kFogPlaceBits + state_.octave_bits - kFogLines;
    const std::int32_t position = fog_position(q, octave, state_.octave_bits);
    const std::uint32_t factor = fog_factor_on(line_[static_cast<std::size_t>(position >> place_bits)],
                                               position & ((1 << place_bits) - 1), place_bits);
    for (std::size_t c = 0; c < 3; ++c)
      color[c] = static_cast<std::uint8_t>(fogged<std::uint32_t>(color[c], state_.color[c], factor));
  }

 private:
  FogState state_;
  std::array<FogLine, std::size_t{1} << kFogLines> line_{};
};

}  // namespace halfplane
