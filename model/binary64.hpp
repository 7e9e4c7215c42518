// Powers of two and exponents of binary64 by its bits: what std::ldexp() and std::ilogb() answer, without a call for
// normal numbers; lengths whose bits do not depend on the standard library.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace halfplane {

inline constexpr int kBinary64Bias = 1023, kBinary64Fraction = 52;

[[nodiscard]] inline double power_of_two(int exponent) {
  if (exponent <= -kBinary64Bias || exponent > kBinary64Bias) return std::ldexp(1.0, exponent);
  return std::bit_cast<double>(static_cast<std::uint64_t>(exponent + kBinary64Bias) << kBinary64Fraction);
}

/// number * 2^exponent.
[[nodiscard]] inline double scaled(double number, int exponent) {
  if (exponent <= -kBinary64Bias || exponent > kBinary64Bias) return std::ldexp(number, exponent);
  return number * power_of_two(exponent);
}

/// floor(log2(|number|)) of a number that is finite and not 0.
[[nodiscard]] inline int floor_log2_of(double number) {
  const auto exponent = static_cast<int>(std::bit_cast<std::uint64_t>(number) >> kBinary64Fraction & 0x7ff);
  return exponent == 0 ? std::ilogb(number) : exponent - kBinary64Bias;
}

/// sqrt(x^2 + y^2 + z^2) without intermediate overflow. std::hypot() of three numbers is rounded as each library likes.
[[nodiscard]] inline double length3(double x, double y, double z) {
  const double largest = std::max({std::abs(x), std::abs(y), std::abs(z)});
  if (largest == 0) return 0;
  return largest *
         std::sqrt((x / largest) * (x / largest) + (y / largest) * (y / largest) + (z / largest) * (z / largest));
}

}  // namespace halfplane
