// Reciprocal of a normalised 1/w: the factor of every attribute over w at a pixel.
//
// In: m, the highest k bits of q, so 2^(k-1) <= m < 2^k. m stands for all q that begin with these bits; their middle is
// d / 2, d = 2m + 1. Out: a value, not an algorithm,
//
//   r(m) = floor(2^(2k) / d), 2^(k-1) <= r < 2^k
//
// which is 2^(2k-1) / q with a relative error of at most 3 * 2^-k: the middle is off by 2^-k, the floor by 2^(1-k). d
// is odd and no power of two is a multiple of it, so a guess g is too large exactly when g d - 2^(2k) > 0, and if g is
// known to be right or one too large the sign of the low bits of g d decides, so the full product is never computed.
//
// Three algorithms give it: the division itself, in hardware one bit per clock (rtl_ref/lib/reciprocal_restoring.sv); a
// division in binary32, for lanes; a table of 2^ceil(k/2) nodes with straight lines between (reciprocal_table.sv).
#pragma once

#include <cstdint>
#include <vector>

#include "../fixed.hpp"

namespace halfplane {

inline constexpr int kMinMantissaBits = 8, kMaxMantissaBits = 20;  ///< bounds of k

/// 2m + 1: twice the middle of the values that `mantissa` stands for.
[[nodiscard]] constexpr std::uint32_t reciprocal_divisor(std::uint32_t mantissa) { return 2 * mantissa + 1; }

/// r(m), the specification. k = `bits`, mantissa in [2^(k-1), 2^k).
[[nodiscard]] constexpr std::uint32_t mantissa_reciprocal(std::uint32_t mantissa, int bits) {
  return static_cast<std::uint32_t>((std::uint64_t{1} << (2 * bits)) / reciprocal_divisor(mantissa));
}

/// r(m) from a guess that is right or one too large: |guess d - 2^(2k)| <= d < 2^31, so its low 32 bits have its sign.
/// From k = 16 on, 2^(2k) is 0 modulo 2^32.
[[nodiscard]] constexpr std::uint32_t corrected_reciprocal(std::uint32_t guess, std::uint32_t divisor, int bits) {
  const std::uint32_t whole = bits < 16 ? std::uint32_t{1} << (2 * bits) : 0;
  return guess - (static_cast<std::int32_t>(guess * divisor - whole) > 0 ? 1 : 0);
}

/// r(m) as lanes without 64-bit products compute it: one division in binary32, whose rounding may reach the next integer.
[[nodiscard]] inline std::uint32_t lane_reciprocal(std::uint32_t mantissa, int bits) {
  const std::uint32_t divisor = reciprocal_divisor(mantissa);
  const float quotient = static_cast<float>(std::uint64_t{1} << (2 * bits)) / static_cast<float>(divisor);
  return corrected_reciprocal(static_cast<std::uint32_t>(quotient), divisor, bits);
}

/// The table of the hardware. The upper I = ceil(k/2) bits of the mantissa below its highest choose an interval, the s
/// = k - 1 - I bits below them the place in it. Nodes are 2^(2k) / d in halves, rounded; between two nodes the curve
/// lies at most 1/4 below the line. So the line, with a half added, is at least r and less than r + 2 after truncation.
class ReciprocalTable {
 public:
  struct Line {
    std::uint32_t start = 0;  ///< at the interval's first mantissa, halves; its highest bit, 2^k, is always set
    std::uint32_t drop = 0;   ///< from there to the next interval, halves
  };

  explicit ReciprocalTable(int bits) : bits_(bits), place_bits_(bits - 1 - (bits + 1) / 2) {
    const std::uint32_t first = std::uint32_t{1} << (bits - 1), step = std::uint32_t{1} << place_bits_;
    for (std::uint32_t m = first; m < 2 * first; m += step) line_.push_back({node(m) + 1, node(m) - node(m + step)});
  }

  [[nodiscard]] const std::vector<Line>& lines() const { return line_; }

  /// r(m) or r(m) + 1.
  [[nodiscard]] std::uint32_t guess(std::uint32_t mantissa) const {
    const std::uint32_t place = mantissa & ((std::uint32_t{1} << place_bits_) - 1);
    const Line& line = line_[(mantissa >> place_bits_) - line_.size()];
    return ((line.start << place_bits_) - line.drop * place) >> (place_bits_ + 1);
  }

  [[nodiscard]] std::uint32_t reciprocal(std::uint32_t mantissa) const {
    return corrected_reciprocal(guess(mantissa), reciprocal_divisor(mantissa), bits_);
  }

 private:
  /// floor(2 * 2^(2k) / d + 1/2).
  [[nodiscard]] std::uint32_t node(std::uint32_t mantissa) const {
    return static_cast<std::uint32_t>(
        round_shift((std::uint64_t{1} << (2 * bits_ + 2)) / reciprocal_divisor(mantissa), 1));
  }

  int bits_;                ///< k
  int place_bits_;          ///< s
  std::vector<Line> line_;  ///< 2^I lines
};

}  // namespace halfplane
