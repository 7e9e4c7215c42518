// glTF 2.0 files into meshes: positions, normals, colours, texture coordinates, indices, triangle modes, base colours
// and their textures, culling, node transforms and their animations, skins, morph targets, cameras. Unsupported features and
// the colour space: docs/gltf.md.
//
// A reader of our own on nlohmann-json; reasons: docs/adr/0008-own-gltf-reader.md.
#pragma once

#include "sim/scene/gltf_deform.hpp"
#include "sim/scene/gltf_nodes.hpp"
#include "sim/scene/mesh.hpp"
#include "sim/scene/mesh_light.hpp"

namespace halfplane {

struct GltfModel {
  Mesh mesh;                        ///< in world space; colours as display codes, 0...255
  std::vector<GltfCamera> cameras;  ///< of the scene that was read
};

/// The vertices and triangles of a primitive at a node.
struct GltfRun {
  std::size_t node = 0;  ///< in GltfNodes::nodes
  std::size_t first_vertex = 0, vertices = 0, first_triangle = 0, triangles = 0;
  bool has_normals = false;
  bool is_flat = false;  ///< three vertices for each triangle, with its face normal
  GltfDeformation deformation;
};

/// A scene before its nodes are placed.
struct GltfWorld {
  std::unique_ptr<GltfFile> file;
  Mesh mesh;                  ///< positions and normals in mesh space
  std::vector<GltfRun> runs;  ///< all of its vertices and triangles
  GltfNodes nodes;
  std::vector<std::optional<GltfSkin>> skins;  ///< of the file; none if a joint is not in the scene, or no mesh uses it
  double exposure = 1;                         ///< factor of the lights: that of the scene at rest
};

/// Limit of triangles: a small file can request any number (one mesh at many nodes).
inline constexpr std::size_t kMostGltfTriangles = std::size_t{1} << 25;

/// Reads the default scene. `file` is the name for messages. Each kind of warning comes once. Throws InputError "file:
/// place: the error; the remedy", also when the file has more than `most_triangles`, or none.
[[nodiscard]] GltfWorld parse_gltf_world(std::string bytes, const std::string& file, const BufferSource& source,
                                         std::vector<std::string>& warnings,
                                         std::size_t most_triangles = kMostGltfTriangles);

/// Reads a .gltf or .glb file (its first bytes decide which); external buffers and images are searched next to it.
[[nodiscard]] GltfWorld read_gltf_world(const std::string& path, std::vector<std::string>& warnings);

/// The world at `time` of an animation (seconds); without one (null) at rest. A mirroring node reverses its triangles.
/// Throws InputError for values that exceed binary64.
[[nodiscard]] GltfModel posed(const GltfWorld& world, const GltfAnimation* animation = nullptr, double time = 0);

/// The mesh for framing a fixed camera over a whole animation: the corners of the boxes of all runs, at times from its
/// first to its last.
[[nodiscard]] Mesh extent_over_time(const GltfWorld& world, const GltfAnimation& animation);

/// parse_gltf_world(), at rest.
[[nodiscard]] GltfModel parse_gltf(std::string bytes, const std::string& file, const BufferSource& source,
                                   std::vector<std::string>& warnings, std::size_t most_triangles = kMostGltfTriangles);

}  // namespace halfplane
