// A mesh seen by a camera: a Scene in clip space.
#pragma once

#include "model/scene.hpp"
#include "sim/scene/camera.hpp"
#include "sim/scene/mesh.hpp"
#include "sim/scene/mesh_light.hpp"
#include "sim/scene/vertex_transform.hpp"

namespace halfplane {

/// How vertices become what a scene has of them.
struct MeshOptions {
  LightRequest light;
  TransformNumbers transform = TransformNumbers::binary64;
};

/// Projects a mesh: one indexed draw for each part, depth_test less, a dark background and depth 1 cleared first.
/// A lit mesh gets a light at the eye: ambient plus wrapped diffuse, two-sided, computed at the vertices in eye space; or
/// the lights that it has, or that are asked for (mesh_light.hpp).
/// Objects that lie outside the view are marked (object_cull.hpp).
/// `cull`: none where the winding is not known; a part that is not two-sided gets a state with Cull::back, one with a
/// texture a state that looks it up, in perspective, times the colour. Throws InputError if the camera throws a vertex
/// out of binary64. `framed`: whose vertices the camera is framed around, if others than the mesh's.
[[nodiscard]] Scene mesh_scene(const Mesh& mesh, const CameraRequest& request, int width, int height,
                               Cull cull = Cull::none, const MeshOptions& options = {}, const Mesh* framed = nullptr);

/// An empty clip-space scene of that size: one state and the clear to the house's background.
[[nodiscard]] Scene cleared_scene(int width, int height);

}  // namespace halfplane
