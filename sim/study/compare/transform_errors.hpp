// What a scene loses whose vertices are transformed, clipped and divided in smaller numbers (sim/scene/vertex_transform.hpp,
// host_geometry.hpp).
#pragma once

#include <cstddef>

#include "model/config.hpp"
#include "model/scene.hpp"
#include "sim/scene/vertex_transform.hpp"
#include "sim/study/compare/statistics.hpp"

namespace halfplane {

/// What places in the window are off by.
struct HostErrors {
  ErrorMoments pixels;     ///< distance in the window
  ErrorMoments depth_lsb;  ///< window z times 2^depth.bits - 1, signed
};

struct TransformErrors {
  HostErrors whole;      ///< vertices in the view of both: transformed and divided
  HostErrors transform;  ///< the same, divided in binary64
  HostErrors divide;     ///< the same, against binary64's division of what was transformed
  HostErrors clip;  ///< new corners of cut triangles, against binary64's cut of the same vertices; divided in binary64
  std::size_t cut = 0;            ///< triangles that were cut
  std::size_t cut_otherwise = 0;  ///< of those, ones that binary64 cuts into another number of corners
  std::size_t without_w = 0;      ///< corners and vertices whose w came out at 0 or below
};

/// `made` in `numbers` against `exact`, the same scene in binary64, both in clip space.
[[nodiscard]] TransformErrors transform_errors(const Scene& made, const Scene& exact, TransformNumbers numbers,
                                               const Config& config);

}  // namespace halfplane
