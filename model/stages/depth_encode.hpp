// Depth encode: converts the interpolated depth into the code that is stored and compared.
//
// In: plane code, u<depth.bits>. Out: code of depth.format. The identity for the format `plane`, the only one of the
// RTL. A float costs hardware a leading-zero count and a shift; the mappings w and log, which are not affine on the
// screen, a division and a logarithm for each fragment: the plane then holds the std depth, from which they are
// computed.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "../config.hpp"

namespace halfplane {

/// Near and far, eye-space units, 0 < near < far.
using DepthPlanes = std::array<double, 2>;

class DepthEncode {
 public:
  /// `planes` (Scene::planes) is needed for w and log only. Throws InputError if they lack it.
  DepthEncode(const Config& config, const std::optional<DepthPlanes>& planes);

  /// Stored codes are plane codes.
  [[nodiscard]] bool is_identity() const { return is_identity_; }

  /// The stored code of a plane code. Monotonic.
  [[nodiscard]] std::uint32_t operator()(std::uint32_t plane_code) const;

  /// The stored code of a window depth to which no mapping applies: a clear's.
  [[nodiscard]] std::uint32_t of_window(double z) const;

  /// The window depth in [0, 1] that a stored code stands for, and the plane's value there, 0...1.
  [[nodiscard]] long double window_value(std::uint32_t stored) const { return depth_value(format_, stored); }
  [[nodiscard]] long double plane_value(std::uint32_t stored) const;

  /// The stored format; `plane` is named u<depth.bits>.
  [[nodiscard]] const DepthFormat& format() const { return format_; }

 private:
  DepthMapping mapping_;
  DepthFormat format_;
  int plane_bits_;
  bool is_identity_;
  std::uint32_t plane_top_;    ///< 2^depth.bits - 1
  long double ratio_ = 1;      ///< far / near
  long double log_ratio_ = 1;  ///< its logarithm
};

/// The stored format: depth.format, with `plane` resolved.
[[nodiscard]] DepthFormat stored_format(const Config& config);

}  // namespace halfplane
