// Counts samples that a mesh draws twice, and samples that it leaves out, because of a fill rule, or of edges rounded
// separately.
#pragma once

#include <cstdint>

#include "model/config.hpp"
#include "model/scene.hpp"
#include "model/study/rules.hpp"

namespace halfplane {

/// Draws of samples under some rules and under the pipeline's own, summed over meshes.
struct DrawsOfRule {
  std::uint64_t doubled = 0;  ///< max(0, n - max(1, n of the pipeline)): beyond the first, and not made by the pipeline
  std::uint64_t undrawn = 0;  ///< samples that the pipeline draws and these rules do not: cracks, and the outline
};

/// Counts mesh by mesh, before the depth test. A mesh is a run of draws of one object without a clear or the end of a
/// frame between them. The traversal has no effect.
[[nodiscard]] DrawsOfRule count_draws(const Scene& scene, const Config& config, const StudyRules& rules);

}  // namespace halfplane
