// Light unit: phong.hpp in hardware, upstream of the texture unit: a colour is lit before it is combined with a
// texture. Normals come with a triangle, as planes; light, half, colours and the table of the power are registers, set
// by tokens.
//
// Tokens use the number of a texture's levels, like the fog's tokens (LevelsWord): above 40 bits three bits select the
// register.
#pragma once

#include <array>
#include <cstdint>

#include "../fixed.hpp"
#include "phong.hpp"
#include "texture_filter.hpp"
#include "texture_levels.hpp"

namespace halfplane {

inline constexpr int kLightWordBit = 40;  ///< bit of a token's word: LightWord, three bits

/// Registers set by a word of light, each with its fields from the lowest bit.
enum class LightWord : std::uint8_t {
  state,       ///< the highlight's colour, 8 each; enable; narrow 3
  ambient,     ///< 13 each of red, green and blue
  diffuse,     ///< likewise
  direction,   ///< x and y, 16 each
  directions,  ///< z, and x of the half
  half,        ///< y and z
  line,        ///< of the power's table: fall 11, start 16, its number 8
};
inline constexpr std::size_t kLightWords = 6;  ///< without the lines

namespace light_unit_detail {

inline constexpr int kByte = 8, kFactor = kLightFraction + 1, kComponent = kNormalFraction + 1;  // bits
inline constexpr int kFall = 11, kStart = 16;

[[nodiscard]] constexpr std::uint64_t word_of(LightWord which) {
  return tag_of(LevelsWord::light) | std::uint64_t{static_cast<std::uint8_t>(which)} << kLightWordBit;
}
/// Fields of `bits` bits, the first one lowest.
template <std::size_t N, class T>
[[nodiscard]] constexpr std::uint64_t fields(const std::array<T, N>& value, int bits) {
  std::uint64_t word = 0;
  for (std::size_t n = N; n-- > 0;) word = word << bits | wrap_unsigned(static_cast<std::uint64_t>(value[n]), bits);
  return word;
}
/// Field of such a word.
[[nodiscard]] constexpr std::uint32_t field(std::uint64_t word, std::size_t n, int bits) {
  return static_cast<std::uint32_t>(wrap_unsigned(word >> (static_cast<int>(n) * bits), bits));
}

}  // namespace light_unit_detail

/// All registers of a light except its lines, by LightWord.
[[nodiscard]] inline std::array<std::uint64_t, kLightWords> light_words(const LightRegisters& light) {
  using namespace light_unit_detail;
  using Pair = std::array<std::int32_t, 2>;
  const auto& [x, y, z] = light.direction;
  const auto& [half_x, half_y, half_z] = light.half;
  return {word_of(LightWord::state) | fields(light.specular, kByte) | std::uint64_t{1} << 3 * kByte |
              static_cast<std::uint64_t>(light.narrow) << (3 * kByte + 1),
          word_of(LightWord::ambient) | fields(light.ambient, kFactor),
          word_of(LightWord::diffuse) | fields(light.diffuse, kFactor),
          word_of(LightWord::direction) | fields(Pair{x, y}, kComponent),
          word_of(LightWord::directions) | fields(Pair{z, half_x}, kComponent),
          word_of(LightWord::half) | fields(Pair{half_y, half_z}, kComponent)};
}
/// The state of a draw without light.
[[nodiscard]] constexpr std::uint64_t no_light_word() { return light_unit_detail::word_of(LightWord::state); }

[[nodiscard]] constexpr std::uint64_t light_line_word(std::size_t number, const FallingLine& line) {
  using namespace light_unit_detail;
  return word_of(LightWord::line) | std::uint64_t{number} << (kStart + kFall) |
         static_cast<std::uint64_t>(line.start) << kFall | static_cast<std::uint64_t>(line.fall);
}

class LightUnit {
 public:
  /// Executes a token for light.
  void set(std::uint64_t word) {
    using namespace light_unit_detail;
    const auto component = [word](std::size_t n) {
      return static_cast<std::int32_t>(wrap_signed(field(word, n, kComponent), kComponent));
    };
    switch (static_cast<LightWord>(word >> kLightWordBit & 7)) {
      case LightWord::state:
        for (std::size_t c = 0; c < 3; ++c) registers_.specular[c] = static_cast<std::uint8_t>(field(word, c, kByte));
        enable_ = (word >> 3 * kByte & 1) != 0;
        registers_.narrow = static_cast<int>(word >> (3 * kByte + 1) & 7);
        return;
      case LightWord::ambient:
        for (std::size_t c = 0; c < 3; ++c) registers_.ambient[c] = field(word, c, kFactor);
        return;
      case LightWord::diffuse:
        for (std::size_t c = 0; c < 3; ++c) registers_.diffuse[c] = field(word, c, kFactor);
        return;
      case LightWord::direction:
        registers_.direction[0] = component(0);
        registers_.direction[1] = component(1);
        return;
      case LightWord::directions:
        registers_.direction[2] = component(0);
        registers_.half[0] = component(1);
        return;
      case LightWord::half:
        registers_.half[1] = component(0);
        registers_.half[2] = component(1);
        return;
      case LightWord::line:
        registers_.line[word >> (kStart + kFall) & 0xff] = {
            static_cast<std::int32_t>(wrap_unsigned(word >> kFall, kStart)),
            static_cast<std::int32_t>(wrap_unsigned(word, kFall))};
        return;
    }
  }
  /// Whether light changes colours of a primitive.
  [[nodiscard]] bool is_lit(bool is_triangle) const { return enable_ && is_triangle; }
  /// A sample's colour in the light, by its P of a normal, local to its tile.
  void add(const std::array<std::int64_t, 3>& p, Texel& color) const {
    const LightFactors factors = registers_.factors(block_normal(p));
    for (std::size_t c = 0; c < 3; ++c) color[c] = static_cast<std::uint8_t>(registers_.lit(c, color[c], factors));
  }

 private:
  bool enable_ = false;
  LightRegisters registers_;
};

}  // namespace halfplane
