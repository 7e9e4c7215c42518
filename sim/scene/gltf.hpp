// glTF 2.0 files into meshes: positions, normals, colours, texture coordinates, indices, triangle modes, base colours
// and their textures, culling, node transforms and their animations, skins, morph targets, cameras. Unsupported features and
// the colour space: docs/gltf.md.
//
// An own reader on nlohmann-json; reasons: docs/adr/0008-own-gltf-reader.md.
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

/// What a primitive at a node made.
struct GltfRun {
  std::size_t node = 0;  ///< in GltfNodes::nodes
  std::size_t first_vertex = 0, vertices = 0, first_triangle = 0, triangles = 0;
  bool has_normals = false;
  bool is_flat = false;  ///< three vertices for each triangle, whose normal is its face's
  GltfDeformation deformation;
};

/// A scene whose nodes have not been put in their places yet.
struct GltfWorld {
  std::unique_ptr<GltfFile> file;
  Mesh mesh;                  ///< places and normals in the spaces of their meshes
  std::vector<GltfRun> runs;  ///< all of its vertices and triangles
  GltfNodes nodes;
  std::vector<std::optional<GltfSkin>>
      skins;            ///< of the file; none where a joint is not in the scene, or no mesh has it
  double exposure = 1;  ///< by which the lights are multiplied: that of the scene at rest
};

/// A small file can ask for any number of triangles (one mesh at many nodes): at most so many are made.
inline constexpr std::size_t kMostGltfTriangles = std::size_t{1} << 25;

/// Reads the default scene. `file` is the name for messages. Each kind of warning comes once. Throws InputError
/// "file: place: what; the mend", also when the file has more than `most_triangles`, or none.
[[nodiscard]] GltfWorld parse_gltf_world(std::string bytes, const std::string& file, const BufferSource& source,
                                         std::vector<std::string>& warnings,
                                         std::size_t most_triangles = kMostGltfTriangles);

/// Reads a .gltf or .glb file (its first bytes decide which); external buffers and images are looked for beside it.
[[nodiscard]] GltfWorld read_gltf_world(const std::string& path, std::vector<std::string>& warnings);

/// The world at `time` of an animation (seconds); without one (null) as the file has it at rest. A node that mirrors turns
/// its triangles round. Throws InputError for what leaves binary64.
[[nodiscard]] GltfModel posed(const GltfWorld& world, const GltfAnimation* animation = nullptr, double time = 0);

/// What a camera is framed around that stays for the whole of an animation: the corners of the boxes of all runs, at times
/// from its first to its last.
[[nodiscard]] Mesh extent_over_time(const GltfWorld& world, const GltfAnimation& animation);

/// parse_gltf_world(), at rest.
[[nodiscard]] GltfModel parse_gltf(std::string bytes, const std::string& file, const BufferSource& source,
                                   std::vector<std::string>& warnings, std::size_t most_triangles = kMostGltfTriangles);

}  // namespace halfplane
