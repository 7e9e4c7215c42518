// Stencil packets: the stencil tests of the depth test in tokens (state_packets.hpp gives the place of the words). A
// token sets one side of triangles or both. A primitive carries flags that say whether it uses them.
#pragma once

#include <array>
#include <cstdint>

#include "../packets/state_packets.hpp"
#include "fragment_ops.hpp"

namespace halfplane {

/// Whether the hardware has a stencil.
[[nodiscard]] constexpr bool has_stencil(const Config& config) { return config.stencil_bits != 0; }

namespace stencil_packets_detail {
inline constexpr int kFunction = 3, kOp = 3, kByte = 8, kTest = kFunction + 2 * kByte,
                     kUpdate = 3 * kOp + kByte;  // bits
}

/// The comparison of a side, lowest first: function, reference, read mask.
[[nodiscard]] constexpr std::uint32_t pack_test(const Stencil& s) {
  using namespace stencil_packets_detail;
  return static_cast<std::uint32_t>(s.func) | std::uint32_t{s.reference} << kFunction |
         std::uint32_t{s.read_mask} << (kFunction + kByte);
}
/// The update of the stored value, lowest first: sfail, zfail, zpass, write mask.
[[nodiscard]] constexpr std::uint32_t pack_update(const Stencil& s) {
  using namespace stencil_packets_detail;
  return static_cast<std::uint32_t>(s.stencil_fails) | static_cast<std::uint32_t>(s.depth_fails) << kOp |
         static_cast<std::uint32_t>(s.passes) << 2 * kOp | std::uint32_t{s.write_mask} << 3 * kOp;
}
/// The same for a token: for the sides in `sides`, bit 0 the front.
[[nodiscard]] constexpr std::uint32_t with_sides(StateRegister which, std::uint32_t word, std::uint32_t sides) {
  using namespace stencil_packets_detail;
  return word | sides << (which == StateRegister::stencil_test ? kTest : kUpdate);
}

[[nodiscard]] constexpr std::uint32_t front_only(std::uint32_t test) {
  return with_sides(StateRegister::stencil_test, test, 1);
}

/// The registers.
struct StencilState {
  StencilSides side{};

  /// A token sets one of the registers.
  constexpr void set(StateRegister which, std::uint64_t word) {
    using namespace stencil_packets_detail;
    if (which != StateRegister::stencil_test && which != StateRegister::stencil_update) return;
    const auto take = [&word](int bits) {
      const std::uint64_t value = word & ((std::uint64_t{1} << bits) - 1);
      word >>= bits;
      return value;
    };
    Stencil s;
    if (which == StateRegister::stencil_test) {
      s.func = static_cast<DepthFunc>(take(kFunction));
      s.reference = static_cast<std::uint8_t>(take(kByte));
      s.read_mask = static_cast<std::uint8_t>(take(kByte));
    } else {
      s.stencil_fails = static_cast<StencilOp>(take(kOp));
      s.depth_fails = static_cast<StencilOp>(take(kOp));
      s.passes = static_cast<StencilOp>(take(kOp));
      s.write_mask = static_cast<std::uint8_t>(take(kByte));
    }
    for (const std::size_t n : {0U, 1U}) {
      if ((word >> n & 1) == 0) continue;
      Stencil& held = side[n];
      if (which == StateRegister::stencil_test)
        held = {s.func, s.reference, s.read_mask, held.write_mask, held.stencil_fails, held.depth_fails, held.passes};
      else
        held = {held.func, held.reference, held.read_mask, s.write_mask, s.stencil_fails, s.depth_fails, s.passes};
    }
  }

  /// By side: every value passes, and a passing value is fully replaced.
  [[nodiscard]] constexpr std::array<bool, 2> replaces() const {
    const auto replaces = [](const Stencil& s) {
      return s.func == DepthFunc::always && (s.passes == StencilOp::zero || s.passes == StencilOp::replace) &&
             s.write_mask == 255;
    };
    return {replaces(side[0]), replaces(side[1])};
  }

  /// The stencil that a fast clear of depth leaves above it.
  [[nodiscard]] constexpr std::uint8_t clear_value() const { return side[0].reference; }
};

/// Sets the flags of a draw with these sides in its primitives, except is_back. Returns whether any is set: a test that
/// every fragment passes and that changes nothing needs none.
constexpr bool set_stencil_flags(PrimitiveState& state, const StencilSides& sides) {
  for (const Stencil& s : sides) {
    state.writes_stencil = state.writes_stencil || writes_stencil(s);
    state.tests_stencil = state.tests_stencil || writes_stencil(s) || s.func != DepthFunc::always;
    state.marks_failed =
        state.marks_failed ||
        (s.write_mask != 0 && (s.stencil_fails != StencilOp::keep || s.depth_fails != StencilOp::keep));
  }
  return state.tests_stencil;
}

/// The registers that the draw needs.
[[nodiscard]] constexpr StencilWords stencil_words(const StencilSides& sides) {
  StencilWords words;
  for (const std::size_t n : {0U, 1U}) {
    words.test[n] = pack_test(sides[n]);
    words.update[n] = pack_update(sides[n]);
  }
  return words;
}

/// Every fragment replaces the stored value: how a clear is drawn.
[[nodiscard]] constexpr Stencil replacing_stencil(std::uint8_t value) {
  Stencil s;
  s.reference = value;
  s.stencil_fails = s.depth_fails = s.passes = StencilOp::replace;
  return s;
}

}  // namespace halfplane
