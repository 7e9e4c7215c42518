// What a scene loses whose vertices were transformed in smaller numbers (sim/scene/vertex_transform.hpp).
#pragma once

#include "model/config.hpp"
#include "model/scene.hpp"
#include "sim/study/compare/statistics.hpp"

namespace halfplane {

/// What vertices in the view are off by.
struct TransformErrors {
  ErrorMoments pixels;     ///< distance in the window
  ErrorMoments depth_lsb;  ///< window z times 2^depth.bits - 1, signed
};

/// `made` against `exact`, the same scene in binary64: vertex by vertex of those that are in the view of both.
[[nodiscard]] TransformErrors transform_errors(const Scene& made, const Scene& exact, const Config& config);

}  // namespace halfplane
