// The independent checker: depth errors of a drawn scene in GMP rationals, from the vertices as given. Its own snap, its own
// plane (normal and point, not barycentric weights), no code of the stages, the oracle or the other checks.
#pragma once

#include <optional>

#include "sim/study/compare/compare.hpp"

namespace halfplane::stress {

/// The largest |stored depth - exact plane through the snapped vertices| over the pixels that show a triangle, in LSB.
/// None if the scene has unsupported features: clip space, other topologies than lists of triangles, polygon offset,
/// another depth format than `plane`, conventions.
[[nodiscard]] std::optional<double> measured_depth_error(const Scene& scene, const Config& config,
                                                         const Engine& engine);

}  // namespace halfplane::stress
