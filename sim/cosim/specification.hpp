// Compares the hardware model, the reference of co-simulation, with the specification: the scalar engine's picture of
// the same scene. Otherwise faults common to RTL and model would stay unseen.
#pragma once

#include <functional>
#include <string>

#include "model/config.hpp"
#include "model/engines/render.hpp"
#include "model/scene.hpp"
#include "sim/cosim/reduce.hpp"
#include "sim/scene/random.hpp"

namespace halfplane {

/// Draws the picture to be compared: the hardware model, or another engine; a test puts a faulty one here.
using PictureOf = std::function<Framebuffer(const Scene&, const Config&)>;
[[nodiscard]] Framebuffer hardware_picture(const Scene& scene, const Config& config);

/// The first difference of the pictures, in words: the buffer, the pixel, the sample and both codes; empty: none.
/// Compares colours, and if all buffers are stored depths and stencils. The scene is drawn alone, without an earlier
/// frame.
[[nodiscard]] std::string difference_from_specification(const Scene& scene, const Config& config,
                                                        const PictureOf& model = hardware_picture);

/// The difference as a test for reduce(): a mismatch of the stage "specification" with the words as its hint.
[[nodiscard]] FailTest specification_test(const Config& config, const PictureOf& model = hardware_picture);

/// A random legal configuration with several samples per pixel and all units that shade over w: texture unit and lanes,
/// colours over w, fog, light, alpha test; from `tiny`, `embedded` or `full`.
[[nodiscard]] Config random_shading_config(Random& random);

}  // namespace halfplane
