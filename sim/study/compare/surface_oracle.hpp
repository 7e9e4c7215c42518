// The exact surface at a sample, in real arithmetic through the snapped vertices, and the error of the shown one, step
// by step.
//
// Real is binary64: edge values of snapped vertices are exact, all weights have one sign, coordinates are relative to a
// vertex, so that nothing cancels; the error is 2^-30 texel for a triangle of 2^20 texels. The filter is the golden's.
//
//   S  filtered at the exact coordinate and level
//   C  at the hardware's coordinate and the exact level
//   L  at the hardware's coordinate and level
//   W  the same with weights of 8 bits, not rounded
//   D  the texel
//
// coordinate = C - S, level_of_detail = L - C, weights = W - L, rounding = D - W: integers of 2^-20 LSB, so that they sum to
// D - S exactly.
#pragma once

#include <array>

#include "model/golden/interpolate.hpp"
#include "model/scene.hpp"
#include "model/stages/surface.hpp"
#include "sim/study/compare/surface_errors.hpp"

namespace halfplane {

class SurfaceOracle {
 public:
  /// A triangle of `scene` with has_surface(), not of zero area; at a sample, `offset` from pixel centres, the triangle moved
  /// there (moved_to_sample).
  SurfaceOracle(const Scene& scene, const Config& config, const Triangle& triangle, const SampleOffset& offset = {});
  [[nodiscard]] SurfaceErrors errors(const SurfaceSample& sample, int x, int y) const;
  /// Distance of coordinates that are affine on the screen from coordinates over w, texels; 0 if the state has the latter.
  [[nodiscard]] double affine_texels(int x, int y) const;

 private:
  void set_q(const std::array<double, 3>& w, const PerspectiveFormat& format, int roundings);
  void compare_light(const SurfaceSample& sample, const std::array<double, 3>& normal, double inverse_w,
                     SurfaceErrors& errors) const;
  void compare_fog(const SurfaceSample& sample, double inverse_w, SurfaceErrors& errors) const;
  void compare_texels(const SurfaceSample& sample, const golden::Fragment<double>& exact, double lod,
                      SurfaceErrors& errors) const;
  [[nodiscard]] golden::Fragment<double> exact_at(double x, double y, const golden::Setup<double>& setup,
                                                  const golden::InterpolationRules& rules) const;
  [[nodiscard]] double exact_level(golden::Fragment<double> exact, int x, int y) const;

  const State& state_;
  const Texture* texture_;
  Sampler sampler_;
  golden::InterpolationRules rules_;
  std::array<double, 2> offset_{};         ///< of the sample, pixels
  golden::Setup<double> setup_, normals_;  ///< the latter with normals as colours, if lit
  double color_bound_ = HUGE_VAL, level_bound_ = HUGE_VAL;
  std::array<double, 2> coordinate_bound_{};
  std::shared_ptr<const FogTable> fog_;              ///< none: no fog
  std::shared_ptr<const PhongLight> phong_;          ///< none: no light
  double normal_code_ = 0, normal_lost_ = 0;         ///< one code of P as a normal over w; its error in codes
  double q_code_ = 0, q_lost_ = 0, q_relative_ = 0;  ///< one code of Q; its error in codes, and its relative error
};

/// Error bound of an attribute over w, texels or LSB: coordinate_error_bound(), which is first order in the errors of
/// Q, to all orders. If Q may be below its error, the range of its bits.
[[nodiscard]] double over_w_bound(double extent, double w_ratio, const PerspectiveFormat& format,
                                  const OverWFormat& attribute, int roundings);

/// The largest w ratio for which the error of a level of detail is at most 0.1: a code of Q is then at most 2^-9 of the
/// smallest.
[[nodiscard]] double largest_level_w_ratio(const PerspectiveFormat& format);

}  // namespace halfplane
