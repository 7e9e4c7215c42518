// The built-in benchmark scenes: workloads for software rasterizers, and scenes that show the savings of skipping.
#pragma once

#include <cstdint>
#include <string_view>

#include "model/scene.hpp"
#include "sim/scene/camera.hpp"
#include "sim/scene/mesh_scene.hpp"

namespace halfplane {

/// Makes the work scene of that name, without ":N", of `size` layers, rings, boxes, lines or triangles. No two vertices
/// of a primitive have the same colour; everything is drawn with depth test less. `camera` as in make_builtin; scenes
/// without a camera leave it out. Throws InputError for an invalid camera.
[[nodiscard]] Scene make_work_scene(std::string_view name, int size, int width, int height, const CameraRequest& camera,
                                    std::uint64_t seed, const MeshOptions& options = {});

}  // namespace halfplane
