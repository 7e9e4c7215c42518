// Double draws: how often a mesh draws a sample again that it should draw once, because of a fill rule,
// or of edges that are rounded one by one.
#pragma once

#include <cstdint>

#include "model/config.hpp"
#include "model/rules.hpp"
#include "model/scene.hpp"

namespace halfplane {

/// Counts the draws of every sample under `rules` and under the pipeline's own, mesh by mesh, before the depth test,
/// and sums max(0, under `rules` - max(1, under its own)): draws beyond the first that the pipeline does not make. A
/// mesh is a run of draws of one object without a clear or the end of a frame between them. The traversal changes nothing.
[[nodiscard]] std::uint64_t count_double_draws(const Scene& scene, const Config& config, const StudyRules& rules);

}  // namespace halfplane
