// Depth mappings: restates a scene for `depth.mapping`, as with another projection matrix, depth test and clear value.
#pragma once

#include "model/formats/depth_format.hpp"
#include "model/scene.hpp"

namespace halfplane {

/// The same scene under another mapping. Clip space: z is recomputed from the eye depth, which is w, so that window z
/// is the mapping's d (under w and log the std depth, from which depth_encode makes d); a reversed mapping reverses
/// tests, depth ranges, polygon offsets and clears. Window space: z is already d, from which w and log compute the std
/// depth; tests and clears stay. `projection` changes nothing. Throws InputError for a scene without the planes that a
/// mapping needs, one in both spaces, and a depth range other than 0...1 under w and log.
[[nodiscard]] Scene in_depth_mapping(Scene scene, DepthMapping mapping);

}  // namespace halfplane
