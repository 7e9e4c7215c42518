// The scene graph of a glTF file: the world transform of each mesh and camera.
#pragma once

#include "model/light.hpp"
#include "sim/scene/camera.hpp"
#include "sim/scene/gltf_animation.hpp"
#include "sim/scene/gltf_file.hpp"

namespace halfplane {

/// A node of the scene: its place in its parent's space.
struct GltfNode {
  std::size_t number = 0;             ///< in the file's list of nodes
  std::optional<std::size_t> parent;  ///< in GltfNodes::nodes, before this one
  std::optional<Mat4> matrix;         ///< instead of `local`
  NodeTransform local;
  bool is_copy = false;  ///< an instance of EXT_mesh_gpu_instancing, below the node in the file
};

/// A mesh at a node.
struct GltfInstance {
  std::size_t mesh = 0;
  std::size_t node = 0;             ///< in GltfNodes::nodes
  std::string name;                 ///< the node's, else the mesh's, else empty
  std::optional<std::size_t> skin;  ///< in the file's list of skins
};

/// A camera at a node: near, far, and fov or ortho. far may be infinite with fov.
struct GltfCameraNode {
  std::string name, node_name;
  std::size_t number = 0;  ///< in the file's list of cameras
  std::size_t node = 0;    ///< in GltfNodes::nodes
  CameraRequest lens;
};

/// A light of KHR_lights_punctual at a node: in the node's space at the origin, shining along -z. Its colours are the colours
/// of a white surface facing it, at a distance of 1 if the light has a place.
struct GltfLightNode {
  std::size_t node = 0;  ///< in GltfNodes::nodes
  Light light;
};

/// In the order of the nodes: a node before its children.
struct GltfNodes {
  std::vector<GltfNode> nodes;
  std::vector<GltfInstance> instances;
  std::vector<GltfCameraNode> cameras;
  std::vector<GltfLightNode> lights;
};

/// A camera of the scene, complete: eye, target, up, near, far, and fov or ortho.
struct GltfCamera {
  std::string name, node_name;
  std::size_t number = 0;
  CameraRequest request;
};

/// Walks the default scene, without nodes that KHR_node_visibility hides: `scene`, else the first one, else (a file without
/// scenes) every node that is no child. Throws InputError when the nodes are no forest, and for a degenerate camera.
[[nodiscard]] GltfNodes walk_nodes(GltfFile& file, std::vector<std::string>& warnings);

/// From each node's space to the world's; with an animation, at `time`. Throws InputError for values that exceed
/// binary64.
[[nodiscard]] std::vector<Mat4> world_matrices(const GltfFile& file, const GltfNodes& nodes,
                                               const GltfAnimation* animation, double time);

/// The cameras at their nodes. Their scale is ignored, as the format requires, and their aspect ratio too: the target's
/// is used.
[[nodiscard]] std::vector<GltfCamera> placed_cameras(const GltfFile& file, const GltfNodes& nodes,
                                                     const std::vector<Mat4>& world);

/// The lights at their nodes, which may be rotated, not scaled.
[[nodiscard]] std::vector<Light> placed_lights(const GltfNodes& nodes, const std::vector<Mat4>& world);

/// A user's request resolved in this scene: with `name=`, that camera with the user's other parts; empty, the first
/// camera; else, or without any camera, the default framing. Throws InputError for an unknown name.
[[nodiscard]] CameraRequest choose_camera(const std::vector<GltfCamera>& cameras, const CameraRequest& request);

}  // namespace halfplane
