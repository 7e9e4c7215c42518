// Deformation of a glTF mesh's vertices: skins with their joints, and morph targets.
#pragma once

#include "sim/scene/gltf_nodes.hpp"
#include "sim/scene/vec3.hpp"

namespace halfplane {

/// Joints, and for each the matrix from the mesh's space to the joint's.
struct GltfSkin {
  std::vector<std::size_t> joints;  ///< in GltfNodes::nodes
  std::vector<Mat4> inverse_bind;   ///< as many as joints
};

/// The influence of a joint on a vertex.
struct JointWeight {
  std::uint32_t joint = 0;  ///< in GltfSkin::joints
  double weight = 0;        ///< the weights of a vertex add up to 1
};

/// The displacement of vertices by a morph target with weight 1.
struct MorphTarget {
  std::vector<Vec3> positions, normals;  ///< one per vertex; empty if it has none
  double weight = 0;                     ///< at rest
};

/// Deformation of the vertices of one primitive at a node.
struct GltfDeformation {
  std::optional<std::size_t> skin;   ///< in the file's list; none: placed by their node
  std::size_t joints_of_vertex = 0;  ///< entries of `joints` per vertex
  std::vector<JointWeight> joints;
  std::vector<MorphTarget> targets;
};

/// Entry `number` of the list of skins; none if a joint is not in the scene. Throws InputError.
[[nodiscard]] std::optional<GltfSkin> read_skin(GltfFile& file, const GltfNodes& nodes, std::size_t number);

/// The deformation of `primitive`, whose mesh is at `instance`, for the vertices made from the elements `sources` of
/// its accessors. `skin`: of the instance, if present. Throws InputError.
[[nodiscard]] GltfDeformation read_deformation(GltfFile& file, const JsonPlace& primitive, const GltfInstance& instance,
                                               const GltfNodes& nodes, const GltfSkin* skin,
                                               const std::vector<std::uint64_t>& sources, bool has_normals);

/// The weights of `targets` at a time, of the mesh at `node` of the file; at rest without an animation.
[[nodiscard]] std::vector<double> morph_weights(const std::vector<MorphTarget>& targets, std::size_t node,
                                                const GltfAnimation* animation, double time);

/// The matrices from mesh space to the world by each joint, `world`: the nodes' matrices.
[[nodiscard]] std::vector<Mat4> joint_matrices(const GltfSkin& skin, const std::vector<Mat4>& world);

/// The mean of the joint matrices of vertex `i`, by its weights.
[[nodiscard]] Mat4 skin_matrix(const GltfDeformation& deformation, const std::vector<Mat4>& joints, std::size_t i);

}  // namespace halfplane
