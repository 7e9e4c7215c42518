// Golden depth formats: the value of a stored code, and the code nearest to a real depth, by bisection. Deliberately
// slow and plain: the reference for stages/depth_encode.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>

#include "../config.hpp"

namespace halfplane::golden {

/// A depth buffer's format, with the near and far of its mapping.
class DepthBuffer {
 public:
  DepthBuffer(const Config& config, const std::optional<std::array<double, 2>>& planes)
      : mapping_(config.depth_mapping), format_(config.depth_format) {
    if (format_.kind == DepthFormat::Kind::plane) format_ = {DepthFormat::Kind::unorm, config.depth_bits, 0, 0};
    if (planes) near_ = (*planes)[0], far_ = (*planes)[1];
  }

  /// The value of a code, 0...1.
  [[nodiscard]] double value(std::uint32_t code) const {
    switch (format_.kind) {
      case DepthFormat::Kind::bins: return (code + 0.5) / std::exp2(format_.bits);
      case DepthFormat::Kind::unorm: return code / (std::exp2(format_.bits) - 1);
      case DepthFormat::Kind::ieee: return number(code, (1 << (format_.exponent_bits - 1)) - 1);
      default: return number(code, 0) / number(largest(), 0);
    }
  }

  /// The largest code.
  [[nodiscard]] std::uint32_t largest() const {
    if (format_.kind != DepthFormat::Kind::ieee) return static_cast<std::uint32_t>(std::exp2(format_.bits) - 1);
    return ((1U << (format_.exponent_bits - 1)) - 1) << format_.mantissa_bits;
  }

  /// The code of a stored depth d.
  [[nodiscard]] std::uint32_t code(double d) const {
    // The last code whose lower boundary is at or below d.
    std::uint32_t low = 0, high = largest();
    while (low < high) {
      const std::uint32_t middle = low + (high - low) / 2 + 1;
      if (d >= lower_boundary(middle))
        low = middle;
      else
        high = middle - 1;
    }
    return low;
  }

  /// The stored depth for a window depth: under w and log a window depth is the std depth of the fragment.
  [[nodiscard]] double stored_depth(double window) const {
    if (is_screen_linear(mapping_)) return window;
    const double z = near_ * far_ / (far_ - window * (far_ - near_));
    return mapping_ == DepthMapping::w ? (z - near_) / (far_ - near_) : std::log(z / near_) / std::log(far_ / near_);
  }

  /// The inverse.
  [[nodiscard]] double window_depth(double stored) const {
    if (is_screen_linear(mapping_)) return stored;
    const double z =
        mapping_ == DepthMapping::w ? near_ + stored * (far_ - near_) : near_ * std::pow(far_ / near_, stored);
    return far_ * (z - near_) / (z * (far_ - near_));
  }

 private:
  /// A float, gradual underflow, no infinities.
  [[nodiscard]] double number(std::uint32_t code, int bias) const {
    const double fraction = std::fmod(code, std::exp2(format_.mantissa_bits)) / std::exp2(format_.mantissa_bits);
    const int field = static_cast<int>(code >> format_.mantissa_bits);
    return field == 0 ? std::ldexp(fraction, 1 - bias) : std::ldexp(1 + fraction, field - bias);
  }

  [[nodiscard]] double lower_boundary(std::uint32_t code) const {
    if (format_.kind == DepthFormat::Kind::bins) return code / std::exp2(format_.bits);
    return (value(code - 1) + value(code)) / 2;
  }

  DepthMapping mapping_;
  DepthFormat format_;
  double near_ = 0, far_ = 1;
};

}  // namespace halfplane::golden
