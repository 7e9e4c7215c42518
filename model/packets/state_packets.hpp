// State packets: tokens that set a register of a unit downstream of the depth test. They travel in the packet stream,
// in order, so no other packet carries a state. The value takes the place of a vertex's codes, and passes interpolate
// unchanged.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "../fixed.hpp"
#include "packets.hpp"

namespace halfplane {

/// The words of the colour registers that a draw needs; none: it does not use that register.
struct ColorWords {
  std::optional<std::uint32_t> ops, constant, alpha;
};

/// The words of the stencil registers that a draw needs, front and back; none: it does not use that register.
struct StencilWords {
  std::array<std::optional<std::uint32_t>, 2> test, update;
};

struct LodSetup;  // stages/level_of_detail.hpp

/// The lines of a triangle in tokens: bits of along_y (at_zero of u, of v), along_x (likewise), the steps of u and of
/// v, and 16 of the offset.
struct TextureLines {
  static constexpr int kBits = 208;
  static constexpr int kOffsetBits = 16;  ///< +-2^7 levels: beyond that every level of detail is clamped
  uint128 low = 0, high = 0;

  /// `bias` is included in the offset.
  [[nodiscard]] static TextureLines pack(const LodSetup& setup, std::int32_t bias);
  [[nodiscard]] LodSetup unpack() const;
  bool operator==(const TextureLines&) const = default;
};

/// Register that a token of kind state sets; stored in the field of the depth test.
[[nodiscard]] constexpr StateRegister state_register(const PrimitiveState& state) {
  return static_cast<StateRegister>(state.depth_test);
}
[[nodiscard]] constexpr PrimitiveState sets_register(StateRegister which) {
  return {static_cast<DepthFunc>(which), false, false};
}

/// Bits of a token's codes; a value has at most 128.
[[nodiscard]] inline int state_word_bits(const Widths& widths) {
  int bits = 0;
  for (int p = 0; p < widths.token_planes(); ++p) bits += widths.of_plane(static_cast<std::size_t>(p)).code.bits;
  return bits;
}

/// Spreads a value over the codes of a vertex, lowest plane first, and reads it back from the resulting fragment.
inline void set_state_word(PerPlane<std::uint32_t>& code, uint128 word, const Widths& widths) {
  for (std::size_t p = 0; p < static_cast<std::size_t>(widths.token_planes()); ++p) {
    const int bits = widths.of_plane(p).code.bits;
    code[p] = static_cast<std::uint32_t>(wrap_unsigned(static_cast<std::uint64_t>(word), bits));
    word >>= bits;
  }
}
[[nodiscard]] inline uint128 wide_state_word(const PerPlane<std::uint32_t>& code, const Widths& widths) {
  uint128 word = 0;
  for (int p = widths.token_planes() - 1; p >= 0; --p) {
    const int bits = widths.of_plane(static_cast<std::size_t>(p)).code.bits;
    word = word << bits | wrap_unsigned(code[static_cast<std::size_t>(p)], bits);
  }
  return word;
}
[[nodiscard]] inline uint128 wide_state_word(const FragmentPacket& token, const Widths& widths) {
  PerPlane<std::uint32_t> code = token.code[0];
  for (auto p = static_cast<std::size_t>(widths.affine_planes); p < static_cast<std::size_t>(widths.token_planes());
       ++p)
    code[p] >>= widths.of_plane(p).guard_bits();
  return wide_state_word(code, widths);
}
/// The lowest 64 bits, enough for most registers.
template <class Codes>
[[nodiscard]] std::uint64_t state_word(const Codes& token, const Widths& widths) {
  return static_cast<std::uint64_t>(wide_state_word(token, widths));
}

}  // namespace halfplane
