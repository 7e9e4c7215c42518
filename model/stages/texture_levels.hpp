// Texture levels in hardware: the unit's state about a draw's levels, their place in memory, and the tokens that bring
// the lines of a triangle (level_of_detail.hpp).
//
// Levels are consecutive in memory, the largest first, each as rows of blocks. With 2^w x 2^h texels, level n has 2^a
// blocks, a = max(0, w-2-n) + max(0, h-2-n). Down to the first level of one block these are decreasing powers of two,
// so their sum up to a level is the bits of one number above bit a. No adder is needed to find a level, or a block in
// it. Of the two levels that may follow, the first has the next block, and the second, of 1x1 texels, is texel (2, 2)
// of that block.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "../fixed.hpp"
#include "../packets/state_packets.hpp"
#include "texture_sample.hpp"

namespace halfplane {

/// Kinds of words for the register texture_levels. All eight token registers are in use, and the levels word is short,
/// so fog, light and the texture's constant and border share it; two upper bits tell them apart, and of the first kind
/// two more.
enum class LevelsWord : std::uint8_t { levels, fog, fog_line, light, constant, border };
inline constexpr int kLevelsWordBit = 43;    ///< the lower of the two bits
inline constexpr int kConstantWordBit = 42;  ///< the third one: the constant, not levels
inline constexpr int kBorderWordBit = 41;    ///< the fourth one: the border
[[nodiscard]] constexpr LevelsWord levels_word(std::uint64_t word) {
  const auto which = static_cast<LevelsWord>(word >> kLevelsWordBit & 3);
  if (which != LevelsWord::levels) return which;
  if ((word >> kConstantWordBit & 1) != 0) return LevelsWord::constant;
  return (word >> kBorderWordBit & 1) != 0 ? LevelsWord::border : which;
}
/// The bits of a kind.
[[nodiscard]] constexpr std::uint64_t tag_of(LevelsWord which) {
  if (which == LevelsWord::constant) return std::uint64_t{1} << kConstantWordBit;
  if (which == LevelsWord::border) return std::uint64_t{1} << kBorderWordBit;
  return std::uint64_t{static_cast<std::uint8_t>(which)} << kLevelsWordBit;
}

/// The levels of a draw.
struct TextureLevels {
  static constexpr int kBits = 31;
  TextureMin min = TextureMin::nearest;
  int last = 0;                ///< number of the smallest level
  Lod least = 0, largest = 0;  ///< 0 to kLargest

  /// A greater level of detail has the effect of this limit.
  static constexpr Lod kLargest = (1 << 12) - 1;

  /// From the lowest bit: min 3 (its lowest: linear; the others: none, the nearest level, two levels), last 4, least 12,
  /// largest 12.
  [[nodiscard]] std::uint32_t pack() const;
  [[nodiscard]] static TextureLevels unpack(std::uint32_t word);
  /// Whether any sample may read two levels. Then even and odd levels share the cache.
  [[nodiscard]] constexpr bool has_two() const { return min >= TextureMin::nearest_mipmap_linear; }
  bool operator==(const TextureLevels&) const = default;
};

[[nodiscard]] TextureLevels texture_levels(const Texture& texture, const State& state);

/// Whether its samples have a level of detail that matters.
[[nodiscard]] bool needs_level(const TextureLevels& levels, TextureMag mag);

/// The start of a level.
struct LevelPlace {
  std::uint32_t block = 0;  ///< from the first of level 0
  bool is_corner = false;   ///< at texel (2, 2) of it
};
/// Sides in texels, log2; 0 <= level <= the larger of the two.
[[nodiscard]] constexpr LevelPlace level_place(const std::array<int, 2>& log2_size, int level) {
  const int w = std::max(0, log2_size[0] - 2), h = std::max(0, log2_size[1] - 2);
  const int first_of_one = std::max(w, h);
  LevelPlace place;
  for (int n = 0; n < std::min(level, first_of_one); ++n)
    place.block += std::uint32_t{1} << (std::max(0, w - n) + std::max(0, h - n));
  if (level > first_of_one) ++place.block;
  place.is_corner = level == first_of_one + 2;
  return place;
}

/// Bits of the lines in a token with `code_bits` bits of codes, and the number of tokens. Codes have at least 70 bits.
[[nodiscard]] constexpr int line_part_bits(int code_bits) { return code_bits >= 104 ? 104 : 70; }
[[nodiscard]] constexpr int line_parts(int part_bits) { return (TextureLines::kBits + part_bits - 1) / part_bits; }
/// Part n, the lowest first.
[[nodiscard]] uint128 line_part(const TextureLines& lines, int part_bits, int n);

/// The unit's copy of the lines: the last parts that came, the last one highest.
class LineRegister {
 public:
  explicit LineRegister(int part_bits) : part_bits_(part_bits) {}
  void move_in(uint128 part);
  [[nodiscard]] TextureLines lines() const;

 private:
  int part_bits_;
  std::array<uint128, 3> part_{};  ///< parts of a triangle's lines
};

}  // namespace halfplane
