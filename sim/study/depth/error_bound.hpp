// Bounds of the error of a stored depth, and of the distance at which two surfaces keep their order.
#pragma once

#include "model/formats/depth_format.hpp"
#include "sim/study/depth/variant.hpp"

namespace halfplane {

// Eye depth and its mapped depth, in binary64: for the millions of fragments of a scene. exact_depth.hpp is the
// reference.

/// t: the interpolated window depth, 0...1, affine in 1/z (under w and log the std depth). d: the stored depth.
/// Eye-space units.
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

/// Error terms of the pipeline for a fragment's depth, each as a distance of t, the interpolated depth of 0...1.
struct DepthBudget {
  double snap = 0;      ///< half a subpixel along x and along y, times the slope of t
  double datapath = 0;  ///< the snap of the vertices' depth, half an LSB, and the interpolation
  double rounding = 0;  ///< of the interpolated depth to its LSB
};

/// Predicts errors and separations of one variant. Eye-space units.
class DepthBound {
 public:
  explicit DepthBound(const DepthVariant& variant);

  /// `slope`: |dt/dx| + |dt/dy| per pixel. `is_flat`: every vertex has the same depth code, so that there is no
  /// interpolation or rounding error.
  [[nodiscard]] DepthBudget budget(double slope, bool is_flat) const;

  /// The largest |z - reconstructed z| of a fragment at eye depth z.
  [[nodiscard]] double error(double z, const DepthBudget& budget) const;

  /// The distance behind z at which a surface with the same budget has the farther stored code at every sample: the
  /// exact form of bin (1 + 2k) + 2 snap, its value where bins hardly change. Terms in that order; infinite if no depth
  /// between z and far can be distinguished.
  struct Separation {
    double storage = 0, datapath = 0, snap = 0;
    [[nodiscard]] double total() const { return storage + datapath + snap; }
  };
  [[nodiscard]] Separation separation(double z, const DepthBudget& budget) const;

  /// Slope of t per pixel of a surface that recedes `slope` units for each unit along the screen axes together, seen by a
  /// camera whose pixels are `pixel` wide at eye depth 1: 2 tan(fov / 2) / height.
  [[nodiscard]] double screen_slope(double z, double slope, double pixel) const;

  [[nodiscard]] const DepthScale& scale() const { return scale_; }

 private:
  [[nodiscard]] double half_step(double d) const;
  [[nodiscard]] Separation separation(double z, const DepthBudget& budget, double half_step) const;

  DepthScale scale_;
  DepthFormat format_;
  bool is_identity_;
  bool is_reversed_;
  double plane_lsb_;      ///< 1 / (2^bits - 1)
  double datapath_;       ///< LSB
  double half_subpixel_;  ///< pixels
};

}  // namespace halfplane
