// Fixed-point leaf arithmetic: the few operations from which every stage is built.
//
// All values are two's complement integers; the unit (subpixels, LSB, ...) is named where the value is declared.
// Rounding is always `floor(x + 1/2)`: it is translation-invariant, so moving a scene by whole units moves the result.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

namespace halfplane {

__extension__ using int128 = __int128;
__extension__ using uint128 = unsigned __int128;

/// floor(log2(value)), value > 0.
[[nodiscard]] constexpr int floor_log2(uint128 value) {
  const auto high = static_cast<std::uint64_t>(value >> 64);
  return high != 0 ? 127 - std::countl_zero(high) : 63 - std::countl_zero(static_cast<std::uint64_t>(value));
}

/// ceil(log2(value)), value > 0: the bits needed to count `value` different things.
[[nodiscard]] constexpr int ceil_log2(uint128 value) { return value <= 1 ? 0 : floor_log2(value - 1) + 1; }

/// floor(sqrt(v)), bit by bit.
[[nodiscard]] constexpr std::uint64_t integer_sqrt(uint128 v) {
  std::uint64_t root = 0;
  for (int bit = 63; bit >= 0; --bit) {
    const std::uint64_t next = root | std::uint64_t{1} << bit;
    if (uint128{next} * next <= v) root = next;
  }
  return root;
}

/// floor(value / 2^bits + 1/2); a negative `bits` shifts left. The one rounding of the pipeline.
template <class Integer>
[[nodiscard]] constexpr Integer round_shift(Integer value, int bits) {
  if (bits <= 0) return value << -bits;
  return ((value >> (bits - 1)) + 1) >> 1;
}

/// `value` modulo 2^bits, as a signed number in [-2^(bits-1), 2^(bits-1)). 1 <= bits <= 64.
[[nodiscard]] constexpr std::int64_t wrap_signed(std::int64_t value, int bits) {
  const int unused = 64 - bits;
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(value) << unused) >> unused;
}

/// `value` modulo 2^bits, as an unsigned number. 1 <= bits <= 64.
[[nodiscard]] constexpr std::uint64_t wrap_unsigned(std::uint64_t value, int bits) {
  return value & (~0ULL >> (64 - bits));
}

/// floor(value * scale + 1/2) in binary64: the snap. The caller checks the range first.
[[nodiscard]] inline std::int64_t snap(double value, double scale) {
  // floor(x + 0.5) rounds 0.49999999999999994 up, because the sum itself rounds; comparing the fraction does not.
  const double scaled = value * scale;
  const double whole = std::floor(scaled);
  return static_cast<std::int64_t>(whole) + (scaled - whole >= 0.5 ? 1 : 0);
}

/// A window depth in [0, 1] as its code of `depth_bits` bits.
[[nodiscard]] inline std::uint32_t snap_depth(double z, int depth_bits) {
  return static_cast<std::uint32_t>(snap(z, static_cast<double>((std::int64_t{1} << depth_bits) - 1)));
}

}  // namespace halfplane
