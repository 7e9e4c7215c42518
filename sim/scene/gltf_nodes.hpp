// The scene graph of a glTF file: where each mesh and each camera stands in the world.
#pragma once

#include "sim/scene/camera.hpp"
#include "sim/scene/gltf_file.hpp"

namespace halfplane {

/// A mesh somewhere in the world.
struct GltfInstance {
  std::size_t mesh = 0;
  Mat4 world{};
  std::string name;  ///< the node's, else the mesh's, else empty
  bool is_skinned = false;
};

/// A camera of the scene, complete: eye, target, up, near, far, and fov or ortho. far may be infinite with fov.
struct GltfCamera {
  std::string name, node_name;
  std::size_t number = 0;  ///< in the file's list of cameras
  CameraRequest request;
};

/// In the order of the nodes: a node before its children.
struct GltfNodes {
  std::vector<GltfInstance> instances;
  std::vector<GltfCamera> cameras;
};

/// Walks the default scene: `scene`, else the first one, else (a file without scenes) every node that is no child.
/// Throws InputError when the nodes are no forest, for a transform beyond binary64, and for a camera that shows
/// nothing. A camera's scale is ignored, as the format says, and so is its aspect ratio: the target's is used.
[[nodiscard]] GltfNodes walk_nodes(const GltfFile& file, std::vector<std::string>& warnings);

/// What a user's request means in this scene: with `name=`, that camera with the user's other parts put in; empty, the
/// first camera; else, or without any camera, the default framing. Throws InputError for an unknown name.
[[nodiscard]] CameraRequest choose_camera(const std::vector<GltfCamera>& cameras, const CameraRequest& request);

}  // namespace halfplane
