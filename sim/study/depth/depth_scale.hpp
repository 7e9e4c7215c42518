// Eye depth and what a mapping makes of it, in binary64: for the millions of fragments of a scene. exact_depth.hpp is
// the reference.
#pragma once

#include "model/formats/depth_format.hpp"

namespace halfplane {

/// t: the window depth that is interpolated, 0...1, affine in 1/z (under w and log the std depth). d: the depth that is
/// stored. Eye-space units.
class DepthScale {
 public:
  /// 0 < near < far; far may be infinite for stdinf and revinf.
  DepthScale(DepthMapping mapping, double near, double far);

  [[nodiscard]] double t_of_z(double z) const { return offset_ + slope_ / z; }
  /// Infinite, or negative, at and beyond infinity.
  [[nodiscard]] double z_of_t(double t) const { return slope_ / (t - offset_); }
  [[nodiscard]] double d_of_z(double z) const;
  [[nodiscard]] double z_of_d(double d) const;

  /// dt / d(1/z).
  [[nodiscard]] double t_per_inverse_z() const { return slope_; }

  [[nodiscard]] double near() const { return near_; }
  [[nodiscard]] double far() const { return far_; }

 private:
  DepthMapping mapping_;
  double near_, far_;
  double offset_, slope_;  // t = offset + slope / z
};

}  // namespace halfplane
