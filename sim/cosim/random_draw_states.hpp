// Draw states of random scenes, and the textures, fogs, lights and normals that they need.
#pragma once

#include <cstdint>

#include "model/config.hpp"
#include "model/scene.hpp"
#include "sim/cosim/random_profile.hpp"

namespace halfplane {

/// Sets the draw states of a finished scene that random_scene() has not chosen: one pass for each unit of the hardware,
/// each from random numbers of its own. So the scenes of a seed, which tests hold by hashes and cycle counts, stay what
/// they are when a unit is added. `has_shapes`: lines get widths and rectangles, points become round.
void set_draw_states(Scene& scene, const Config& config, const RandomProfile& profile, std::uint64_t seed,
                     bool has_shapes);

}  // namespace halfplane
