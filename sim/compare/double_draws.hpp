// Double draws: how often a mesh draws a sample again that it should draw once, because of a fill rule.
#pragma once

#include <cstdint>

#include "../../model/config.hpp"
#include "../../model/rules.hpp"
#include "../../model/scene.hpp"

namespace halfplane {

/// Counts the draws of every sample under `rule` and under top_left, mesh by mesh, before the depth test, and sums
/// max(0, under `rule` - max(1, under top_left)): draws beyond the first that top_left does not make. A mesh is a run
/// of draws of one object without a clear or the end of a frame between them. 0 for top_left.
[[nodiscard]] std::uint64_t count_double_draws(const Scene& scene, const Config& config, FillRule rule);

}  // namespace halfplane
