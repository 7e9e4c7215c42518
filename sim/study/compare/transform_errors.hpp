// The errors of a scene whose vertices are transformed, clipped and divided in lower precision
// (sim/scene/vertex_transform.hpp, host_geometry.hpp).
#pragma once

#include <cstddef>

#include "model/config.hpp"
#include "model/scene.hpp"
#include "sim/scene/vertex_transform.hpp"
#include "sim/study/compare/statistics.hpp"

namespace halfplane {

/// Errors of window positions.
struct HostErrors {
  ErrorMoments pixels;     ///< distance in the window
  ErrorMoments depth_lsb;  ///< window z times 2^depth.bits - 1, signed
};

struct TransformErrors {
  HostErrors whole;      ///< vertices in view in both: transformed and divided
  HostErrors transform;  ///< the same, divided in binary64
  HostErrors divide;     ///< the same, against binary64's division of the transformed vertices
  HostErrors clip;  ///< new corners of cut triangles, against binary64's cut of the same vertices; divided in binary64
  std::size_t cut = 0;            ///< triangles that were cut
  std::size_t cut_otherwise = 0;  ///< triangles of these that binary64 cuts into another number of corners
  std::size_t without_w = 0;      ///< corners and vertices with w of 0 or below
};

/// Compares `made` in `numbers` with `exact`, the same scene in binary64, both in clip space.
[[nodiscard]] TransformErrors transform_errors(const Scene& made, const Scene& exact, TransformNumbers numbers,
                                               const Config& config);

}  // namespace halfplane
