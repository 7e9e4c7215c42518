// The host's geometry between clip space and the snap (clip, division by w, viewport) in lower precision: binary32 and
// s15.16. The pipeline's own is binary64 (model/host/clip.hpp, viewport.hpp).
//
// binary32: the same formulas, each operation rounded. s15.16 (32-bit integers, products and sums exact in 64 bits):
//   distance    a x + b y + c z + d w, exact
//   cut         t = d_in / (d_in + |d_out|) to 31 bits, the divisor shifted to 32 bits if longer (one division of
//               64 by 32 bits); in + t (out - in), rounded once
//   window x    center + (x half_width) / w, one division of 64 by 32 bits, rounded once to 16 fraction bits
//   depth       (z + w) / (2 w), likewise, to 31 fraction bits
// Range: a corner with w <= 0 gets the smallest w (2^-16; binary32: 2^-126) and is counted, a position beyond the guard band
// is clamped to it, a depth to 0...1. So no triangle is lost. Coordinates beyond +-32768 (binary32: 2^96) are refused.
//
// The cut of an edge depends only on its ends and starts at the inside end, as in the pipeline's clip: both triangles
// on an edge get the same corner.
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

/// A vertex in the window, in the rasterizer's coordinates.
struct HostPosition {
  WindowPosition at;
  double w = 1;           ///< the divisor
  bool had_no_w = false;  ///< w was 0 or below
};

class HostGeometry {
 public:
  /// `numbers`: not binary64. For draws in that state, on a target of that size.
  HostGeometry(TransformNumbers numbers, const State& state, int width, int height, const Config& config);

  /// Position, colour, coordinates and normal rounded to the number format. Throws InputError if they do not fit.
  [[nodiscard]] HostVertex rounded(const HostVertex& v) const;

  /// The clip planes: near, far, and the guard band, whose sides are at 32767 pixels at most in s15.16.
  [[nodiscard]] const ClipPlanes& planes() const { return planes_; }

  /// One bit per plane that has the vertex outside.
  [[nodiscard]] unsigned outcode(const Vertex& v) const;

  /// The corners of the triangle's part inside all planes, in its order; empty: completely outside.
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

/// Counts of a scene's primitives.
struct HostCounts {
  std::size_t cut = 0;       ///< triangles and lines with a cut
  std::size_t outside = 0;   ///< primitives cut away completely
  std::size_t had_no_w = 0;  ///< corners, counted each time a cut triangle or a vertex has one
};

/// A mesh's scene in clip space (mesh_scene.hpp; all of its states have one viewport and one clip_z) as a scene in the
/// window, clipped, divided and mapped in that format; unchanged for binary64. The pieces of a cut triangle are
/// triangles of their own, which blend in its place; one outside keeps its number as a triangle without area, and lines
/// outside are left out. Draws that lie outside as a whole stay in clip space, as do outlines (polygon_mode line and
/// point) if one has to be cut. Throws InputError for values that do not fit the format.
[[nodiscard]] Scene in_host_numbers(Scene scene, TransformNumbers numbers, const Config& config,
                                    HostCounts* counts = nullptr);

}  // namespace halfplane
