// validate() for scenes that are drawn again and again with the same textures, whose texels are most of the work.
#pragma once

#include <cstddef>

#include "scene.hpp"

namespace halfplane {

/// validate(scene) for a scene whose first textures have been validated with an earlier one.
void validate(const Scene& scene, std::size_t known_textures);

}  // namespace halfplane
