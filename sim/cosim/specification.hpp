// The hardware model, to which co-simulation holds the RTL, held to the specification: the scalar engine's picture of the same
// scene. Packets that both RTL and model have wrong in the same way would else go unseen.
#pragma once

#include <functional>
#include <string>

#include "model/config.hpp"
#include "model/engines/render.hpp"
#include "model/scene.hpp"
#include "sim/cosim/reduce.hpp"
#include "sim/scene/random.hpp"

namespace halfplane {

/// Draws what is held to the specification: the hardware model, or another engine; a test puts a faulty one here.
using PictureOf = std::function<Framebuffer(const Scene&, const Config&)>;
[[nodiscard]] Framebuffer hardware_picture(const Scene& scene, const Config& config);

/// Where the pictures differ first, in words: the plane, the pixel, the sample and both codes; empty: nowhere. Colours, and
/// where all planes are stored depths and stencils. A scene of its own: what a frame before it left is not there.
[[nodiscard]] std::string difference_from_specification(const Scene& scene, const Config& config,
                                                        const PictureOf& model = hardware_picture);

/// That difference as a test for reduce(): a mismatch of the stage "specification" with the words as its hint.
[[nodiscard]] FailTest specification_test(const Config& config, const PictureOf& model = hardware_picture);

/// A random configuration with several samples a pixel and all that shades over w: texture unit and lanes, colours over w, fog,
/// light, alpha test; of `tiny`, `embedded` or `full`. Legal.
[[nodiscard]] Config random_shading_config(Random& random);

}  // namespace halfplane
