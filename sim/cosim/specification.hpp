// The hardware model, to which co-simulation holds the RTL, held to the specification: the scalar engine's picture of the same
// scene. Packets that both RTL and model have wrong in the same way would else go unseen.
#pragma once

#include <string>

#include "model/config.hpp"
#include "model/scene.hpp"

namespace halfplane {

/// Where the pictures differ first, in words: the plane, the pixel, the sample and both codes; empty: nowhere. Colours, and
/// where all planes are stored depths and stencils. A scene of its own: what a frame before it left is not there.
[[nodiscard]] std::string difference_from_specification(const Scene& scene, const Config& config);

}  // namespace halfplane
