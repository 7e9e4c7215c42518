// Formats of depth buffers for a depth in [0, 1], and the meaning of a depth in eye space.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace halfplane {

/// The meaning of a stored depth d. `projection`: given by the scene's own projection. The others, for eye depth z in
/// [n, f]: std f(z-n)/(z(f-n)), rev n(f-z)/(z(f-n)), stdinf 1-n/z, revinf n/z, w (z-n)/(f-n), log ln(z/n)/ln(f/n).
enum class DepthMapping : int { projection, std, rev, stdinf, revinf, w, log };

/// The names, in that order.
[[nodiscard]] std::span<const std::string_view> depth_mapping_names();

/// Near is the largest code, far is 0: the depth test and the clear value are reversed.
[[nodiscard]] constexpr bool is_reversed(DepthMapping mapping) {
  return mapping == DepthMapping::rev || mapping == DepthMapping::revinf;
}

/// Affine in 1/z, so that a plane in eye space is a plane in window space and the interpolated value is stored
/// unchanged.
[[nodiscard]] constexpr bool is_screen_linear(DepthMapping mapping) {
  return mapping != DepthMapping::w && mapping != DepthMapping::log;
}

/// A stored format. Every one has codes 0...top_code() whose values rise with the code, so that hardware compares codes
/// as unsigned integers in every format.
struct DepthFormat {
  /// plane: the code that interpolate computes, u<depth.bits>. unorm: `u16`, value code / (2^b - 1), nearest. bins:
  /// `bins16`, floor(d 2^b), value (code + 1/2) / 2^b. small_float: `uf4.12`, unsigned, gradual underflow, no infinity,
  /// scaled so that the top code is 1. ieee: `f16`, `f32`, codes up to that of 1.
  enum class Kind : int { plane, unorm, bins, small_float, ieee };

  Kind kind = Kind::plane;
  int bits = 0;           ///< of storage; 0 for `plane`
  int exponent_bits = 0;  ///< floats only
  int mantissa_bits = 0;  ///< floats only, without the hidden one

  [[nodiscard]] bool is_float() const { return kind == Kind::small_float || kind == Kind::ieee; }
  bool operator==(const DepthFormat&) const = default;
};

/// Reads `plane`, `uB` and `binsB` for B of 2...32 bits, `f16`, `f32`, `ufE.M` of at most 32 bits with E in 1...8 and M
/// in 1...24. Throws InputError that lists the formats.
[[nodiscard]] DepthFormat parse_depth_format(std::string_view text);
[[nodiscard]] std::string to_string(const DepthFormat& format);

/// The code of d = 1.
[[nodiscard]] std::uint32_t top_code(const DepthFormat& format);

/// A float's code as an integer multiple of its smallest step: significand * 2^shift.
struct FloatSteps {
  std::uint32_t significand = 0;
  int shift = 0;
};
[[nodiscard]] FloatSteps float_steps(const DepthFormat& format, std::uint32_t code);

/// The value in [0, 1] that a code stands for, with one rounding to long double. For `plane` pass its unorm.
[[nodiscard]] long double depth_value(const DepthFormat& format, std::uint32_t code);

/// The code of numerator / denominator in [0, 1]: exact, ties of unorm upwards, of floats to the even code.
/// denominator < 2^32.
[[nodiscard]] std::uint32_t depth_code(const DepthFormat& format, std::uint64_t numerator, std::uint64_t denominator);

/// The code of d in [0, 1], with one more rounding if d is not exact.
[[nodiscard]] std::uint32_t depth_code(const DepthFormat& format, long double d);

}  // namespace halfplane
