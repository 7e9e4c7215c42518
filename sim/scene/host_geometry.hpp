// The host's geometry between clip space and the snap (clip, division by w, viewport) in smaller numbers: binary32 and s15.16.
// The pipeline's own is binary64 (model/host/clip.hpp, viewport.hpp).
//
// binary32: the same formulas, each operation rounded. s15.16 (32-bit integers, products and sums exact in 64 bits):
//   distance    a x + b y + c z + d w, exact
//   cut         t = d_in / (d_in + |d_out|) to 31 bits, the divisor shifted to 32 bits where it has more (one division of
//               64 by 32 bits); in + t (out - in), rounded once
//   window x    center + (x half_width) / w, one division of 64 by 32 bits, rounded once to 16 fraction bits
//   depth       (z + w) / (2 w), likewise, to 31 fraction bits
// Range: a corner with w <= 0 gets the smallest w (2^-16; binary32: 2^-126) and is counted, a position beyond the guard band
// is clamped to it, a depth to 0...1. So no triangle is lost. Coordinates beyond +-32768 (binary32: 2^96) are refused.
//
// The cut of an edge depends on its ends alone and starts at the inside end, as in the pipeline's clip: both triangles on
// an edge get the same corner.
#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "model/config.hpp"
#include "model/host/clip.hpp"
#include "model/host/viewport.hpp"
#include "model/scene.hpp"
#include "sim/scene/vec3.hpp"
#include "sim/scene/vertex_transform.hpp"

namespace halfplane {

/// A vertex in clip space and its normal, if it has one.
struct HostVertex {
  Vertex vertex;
  Vec3 normal{};
};

/// A vertex in the window, as the rasterizer counts.
struct HostPosition {
  WindowPosition at;
  double w = 1;           ///< that was divided by
  bool had_no_w = false;  ///< it came out at 0 or below
};

class HostGeometry {
 public:
  /// `numbers`: not binary64. Of draws in that state, on a target of that size.
  HostGeometry(TransformNumbers numbers, const State& state, int width, int height, const Config& config);

  /// Position, colour, coordinates and normal as the numbers hold them. Throws InputError where they do not.
  [[nodiscard]] HostVertex rounded(const HostVertex& v) const;

  /// That cut: near, far, and the guard band, whose sides s15.16 has at 32767 pixels at most.
  [[nodiscard]] const ClipPlanes& planes() const { return planes_; }

  /// One bit per plane that the vertex lies outside of.
  [[nodiscard]] unsigned outcode(const Vertex& v) const;

  /// The corners of the triangle's part inside all planes, in its order; empty: it lies outside.
  [[nodiscard]] std::vector<HostVertex> clip(const HostVertex& a, const HostVertex& b, const HostVertex& c) const;

  /// The part of the line inside all planes, from `a` towards `b`.
  [[nodiscard]] std::optional<std::pair<HostVertex, HostVertex>> clip(const HostVertex& a, const HostVertex& b) const;

  /// Division, viewport and depth range of a vertex inside all planes.
  [[nodiscard]] HostPosition window(const Vertex& v) const;

 private:
  TransformNumbers numbers_;
  ClipZ clip_z_;
  std::array<double, 2> depth_range_;
  Viewport viewport_;
  double limit_;  ///< pixels
  ClipPlanes planes_;
};

/// What became of a scene's primitives.
struct HostCounts {
  std::size_t cut = 0;       ///< triangles and lines that were cut
  std::size_t outside = 0;   ///< those of which nothing was left
  std::size_t had_no_w = 0;  ///< corners, each time a cut triangle or a vertex has one
};

/// A mesh's scene in clip space (mesh_scene.hpp; all of its states have one viewport and one clip_z) as a scene in the
/// window, clipped, divided and mapped in those numbers; of binary64 as it is. The pieces of a cut triangle are triangles of
/// their own, which blend in its place; one outside keeps its number as a triangle without area, and lines outside are left
/// out. Draws that lie outside as a whole stay in clip space, as do outlines (polygon_mode line and point) of which one has
/// to be cut. Throws InputError for what the numbers cannot hold.
[[nodiscard]] Scene in_host_numbers(Scene scene, TransformNumbers numbers, const Config& config,
                                    HostCounts* counts = nullptr);

}  // namespace halfplane
