// Deformation of a glTF mesh's vertices: skins with their joints, and morph targets.
#pragma once

#include "sim/scene/gltf_nodes.hpp"
#include "sim/scene/vec3.hpp"

namespace halfplane {

/// Joints, and for each the matrix from the mesh's space to the joint's.
struct GltfSkin {
  std::vector<std::size_t> joints;  ///< in GltfNodes::nodes
  std::vector<Mat4> inverse_bind;   ///< as many
};

/// How much of a joint's motion a vertex takes part in.
struct JointWeight {
  std::uint32_t joint = 0;  ///< in GltfSkin::joints
  double weight = 0;        ///< those of a vertex add up to 1
};

/// What a morph target with the weight of 1 adds to the vertices.
struct MorphTarget {
  std::vector<Vec3> positions, normals;  ///< one a vertex; empty where it has none
  double weight = 0;                     ///< at rest
};

/// Of the vertices of one primitive at a node.
struct GltfDeformation {
  std::optional<std::size_t> skin;   ///< in the file's list; none: they stand as their node does
  std::size_t joints_of_vertex = 0;  ///< as many in `joints` for each vertex
  std::vector<JointWeight> joints;
  std::vector<MorphTarget> targets;
};

/// Entry `number` of the list of skins; nothing where a joint is not in the scene. Throws InputError.
[[nodiscard]] std::optional<GltfSkin> read_skin(GltfFile& file, const GltfNodes& nodes, std::size_t number);

/// What of `primitive`, whose mesh stands at `instance`, moves the vertices that were made from the elements `sources` of
/// its accessors. `skin`: that of the instance, if it is there. Throws InputError.
[[nodiscard]] GltfDeformation read_deformation(GltfFile& file, const JsonPlace& primitive, const GltfInstance& instance,
                                               const GltfNodes& nodes, const GltfSkin* skin,
                                               const std::vector<std::uint64_t>& sources, bool has_normals);

/// The weights of `targets` at a time, of the mesh at `node` of the file; at rest without an animation.
[[nodiscard]] std::vector<double> morph_weights(const std::vector<MorphTarget>& targets, std::size_t node,
                                                const GltfAnimation* animation, double time);

/// From the space of the mesh to the world by each joint, `world` being those of the nodes.
[[nodiscard]] std::vector<Mat4> joint_matrices(const GltfSkin& skin, const std::vector<Mat4>& world);

/// The mean of what the joints of vertex `i` do, by their weights.
[[nodiscard]] Mat4 skin_matrix(const GltfDeformation& deformation, const std::vector<Mat4>& joints, std::size_t i);

}  // namespace halfplane
