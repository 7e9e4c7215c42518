// Two surfaces, one behind the other: the scene for testing a predicted minimum separation.
#pragma once

#include <cstdint>

#include "model/scene.hpp"
#include "sim/study/depth/error_bound.hpp"

namespace halfplane {

/// A camera and a surface's slope against it.
struct SurfaceView {
  double slope = 0;  ///< units of depth for each unit across the line of sight: 0 faces the camera
  double fov = 45;   ///< vertical, degrees
  int width = 640, height = 480;

  /// Width of a pixel at eye depth 1.
  [[nodiscard]] double pixel() const;
};

/// The predicted separation at eye depth z of two surfaces of that slope.
[[nodiscard]] DepthBound::Separation surface_separation(const DepthBound& bound, double z, const SurfaceView& view);

/// Up to 64 pairs of surfaces around eye depth z, each pair with its own depth and tessellation, with `slope` against
/// the line of sight; the farther surface `part` times the predicted separation behind the nearer one, at its largest.
/// Pairs that would reach beyond near or far are left out.
[[nodiscard]] Scene two_planes(const DepthBound& bound, double z, const SurfaceView& view, double part,
                               std::uint64_t seed);

}  // namespace halfplane
