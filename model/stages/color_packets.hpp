// Color packets: the states of the colour units in tokens: colour operations, the blend constant, and the alpha test
// (state_packets.hpp gives the place of the words).
#pragma once

#include "../packets/state_packets.hpp"
#include "fragment_ops.hpp"

namespace halfplane {

namespace color_packets_detail {
inline constexpr int kFactor = 4, kEquation = 3, kFunction = 3, kByte = 8;  // bits
inline constexpr unsigned kLogic = 5;  // no equation: the first factor is a logic operation
}  // namespace color_packets_detail

/// ColorOps without the constant, lowest first: four factors, two equations, channels to write, dithers, blends, reads
/// stored colours. The last two follow from the rest, stored for readers that need no other field. A logic operation,
/// with which nothing blends, is in the place of the first factor; the first equation says so.
[[nodiscard]] constexpr std::uint32_t pack(const ColorOps& ops) {
  using namespace color_packets_detail;
  std::uint32_t word = 0;
  int at = 0;
  const auto put = [&](auto value, int bits) {
    word |= static_cast<std::uint32_t>(value) << at;
    at += bits;
  };
  const bool is_logic = ops.logic != LogicOp::copy;
  put(is_logic ? static_cast<unsigned>(ops.logic) : static_cast<unsigned>(ops.factors.src), kFactor);
  put(ops.factors.dst, kFactor);
  put(ops.factors.src_alpha, kFactor);
  put(ops.factors.dst_alpha, kFactor);
  put(is_logic ? kLogic : static_cast<unsigned>(ops.equation[0]), kEquation);
  put(ops.equation[1], kEquation);
  for (const bool writes : ops.writes) put(writes, 1);
  put(ops.dithers, 1);
  put(ops.blends(), 1);
  put(ops.reads_stored(), 1);
  return word;
}

/// The inverse; the constant is unchanged.
constexpr void unpack(std::uint64_t word, ColorOps& ops) {
  using namespace color_packets_detail;
  const auto take = [&word](int bits) {
    const std::uint64_t value = word & ((std::uint64_t{1} << bits) - 1);
    word >>= bits;
    return value;
  };
  const auto first = take(kFactor);
  ops.factors.dst = static_cast<BlendFactor>(take(kFactor));
  ops.factors.src_alpha = static_cast<BlendFactor>(take(kFactor));
  ops.factors.dst_alpha = static_cast<BlendFactor>(take(kFactor));
  const auto equation = take(kEquation);
  const bool is_logic = equation == kLogic;
  ops.logic = is_logic ? static_cast<LogicOp>(first) : LogicOp::copy;
  ops.factors.src = is_logic ? BlendFactor::one : static_cast<BlendFactor>(first);
  ops.equation[0] = is_logic ? BlendEquation::add : static_cast<BlendEquation>(equation);
  ops.equation[1] = static_cast<BlendEquation>(take(kEquation));
  for (bool& writes : ops.writes) writes = take(1) != 0;
  ops.dithers = take(1) != 0;
}

/// The constant, R lowest.
[[nodiscard]] constexpr std::uint32_t pack(const BlendColor& constant) {
  std::uint32_t word = 0;
  for (std::size_t c = 4; c-- > 0;) word = word << color_packets_detail::kByte | constant[c];
  return word;
}
[[nodiscard]] constexpr BlendColor unpack_constant(std::uint64_t word) {
  BlendColor constant{};
  for (std::size_t c = 0; c < 4; ++c) constant[c] = static_cast<std::uint8_t>(word >> 8 * c);
  return constant;
}

/// The function, above it the reference, and above that alpha to coverage.
[[nodiscard]] constexpr std::uint32_t pack(const AlphaTest& alpha, bool covers = false) {
  using namespace color_packets_detail;
  return static_cast<std::uint32_t>(alpha.func) | std::uint32_t{alpha.reference} << kFunction |
         std::uint32_t{covers} << (kFunction + kByte);
}
[[nodiscard]] constexpr AlphaTest unpack_alpha(std::uint64_t word) {
  using namespace color_packets_detail;
  return {static_cast<DepthFunc>(word & ((1U << kFunction) - 1)), static_cast<std::uint8_t>(word >> kFunction)};
}
[[nodiscard]] constexpr bool unpack_alpha_covers(std::uint64_t word) {
  using namespace color_packets_detail;
  return (word >> (kFunction + kByte) & 1) != 0;
}

/// The words of a draw for the units of this hardware.
[[nodiscard]] inline ColorWords color_words(const FragmentOps& ops, const Config& config) {
  ColorWords words;
  if (packs_at_write(config) && ops.state.color_write) {
    words.ops = pack(ops.color);
    if (ops.color.reads_constant()) words.constant = pack(ops.color.constant);
  }
  if (tests_alpha(config)) words.alpha = pack(ops.alpha, ops.alpha_samples != 0);
  return words;
}

/// The registers.
struct ColorState {
  ColorOps ops;
  AlphaTest alpha;
  bool alpha_covers = false;  ///< alpha to coverage

  /// Whether a fragment may be dropped by its alpha.
  [[nodiscard]] constexpr bool tests_alpha() const { return alpha.func != DepthFunc::always || alpha_covers; }
  /// Whether the fragment is kept at sample `k` of its pixel's `samples`.
  [[nodiscard]] constexpr bool keeps(std::uint32_t value, std::uint32_t k, int samples) const {
    return alpha_keeps(alpha, alpha_covers ? samples : 0, value, k);
  }

  /// A token sets one of the registers.
  constexpr void set(StateRegister which, std::uint64_t word) {
    if (which == StateRegister::color_ops) unpack(word, ops);
    if (which == StateRegister::blend_constant) ops.constant = unpack_constant(word);
    if (which == StateRegister::alpha_test) {
      alpha = unpack_alpha(word);
      alpha_covers = unpack_alpha_covers(word);
    }
  }
};

/// The samples of a stamp that their alpha keeps. `alpha_of(s)`: the code of sample s.
template <class AlphaOf>
[[nodiscard]] SampleMask alpha_passes(const ColorState& colors, SampleMask samples, const Widths& widths,
                                      AlphaOf&& alpha_of) {
  const int n = widths.pixel_samples;
  SampleMask kept;
  samples.for_each([&](std::size_t s) {
    const int sample = static_cast<int>(s);
    kept.set(sample, colors.keeps(alpha_of(s), static_cast<std::uint32_t>(sample % n), n));
  });
  return kept;
}

/// The samples of a fragment that its own alpha keeps.
[[nodiscard]] inline SampleMask opaque_samples(const FragmentPacket& fragment, const ColorState& colors,
                                               const Widths& widths) {
  return alpha_passes(colors, fragment.mask, widths,
                      [&](std::size_t s) { return color_channels(fragment_code(fragment, s, widths))[3]; });
}

/// A token may set one of the registers.
inline void set_colors(const FragmentPacket& fragment, ColorState& colors, const Widths& widths) {
  if (fragment.kind != PrimitiveKind::state) return;
  const StateRegister which = state_register(fragment.state);
  if (!is_of_texture(which)) colors.set(which, state_word(fragment, widths));
}

}  // namespace halfplane
