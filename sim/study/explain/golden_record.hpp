// The golden's part of an explanation.
#pragma once

#include <functional>

#include "history.hpp"
#include "model/scene.hpp"

namespace halfplane::explain {

/// Draws the golden at the pixels of `result` alone, and puts its triangles, fragments and stored values beside the entries
/// that they belong to. Clipped triangles fall into other pieces there: a piece is beside the one whose corners lie nearest.
/// `progress` gets the part done; it may throw.
void record_golden(const Scene& scene, const Config& config, const std::function<void(double)>& progress,
                   Explanation& result);

}  // namespace halfplane::explain
