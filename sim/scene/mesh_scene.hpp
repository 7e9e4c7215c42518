// A mesh seen by a camera: a Scene in clip space.
#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "model/scene.hpp"
#include "sim/scene/bounds_tree.hpp"
#include "sim/scene/camera.hpp"
#include "sim/scene/mesh.hpp"
#include "sim/scene/mesh_light.hpp"
#include "sim/scene/object_cull.hpp"
#include "sim/scene/vertex_transform.hpp"

namespace halfplane {

/// Bounds of a mesh's objects: constant over the pictures of a static mesh, for which alone building a tree pays off.
struct MeshPlaces {
  explicit MeshPlaces(const Mesh& mesh) : bounds(object_bounds(mesh)), tree(bounds) {}
  std::vector<ObjectBounds> bounds;
  BoundsTree tree;
};

/// A mesh stored with its bounds.
struct PlacedMesh {
  explicit PlacedMesh(Mesh of) : mesh(std::move(of)), places(mesh) {}
  Mesh mesh;
  MeshPlaces places;
};

/// The host's work for one picture.
struct MeshWork {
  BoundsWork bounds;
  std::size_t vertices_skipped = 0;
};

/// Conversion of vertices to a scene.
struct MeshOptions {
  LightRequest light;
  TransformNumbers transform = TransformNumbers::binary64;
  /// Objects that these tests find outside are left out: their vertices are neither transformed nor lit, and their
  /// draws, which are marked, keep their number of primitives, all at one place. None: all objects are kept, and
  /// outside objects are marked by both tests. With lights requested, or in the file, all vertices are lit: the range
  /// of places is that of all vertices.
  CullObjects leaves_out = CullObjects::none;
  bool has_tree = true;                       ///< false: each object is tested separately
  const MeshPlaces* places = nullptr;         ///< places of the mesh; null: bounds are computed, without a tree
  MeshWork* work = nullptr;                   ///< work of the last picture; may be null
  std::optional<PlacedMesh>* kept = nullptr;  ///< for a built-in scene: the mesh, from picture to picture; may be null
};

/// Projects a mesh: one indexed draw for each part, depth_test less, a dark background and depth 1 cleared first. A lit
/// mesh gets a light at the eye: ambient plus wrapped diffuse, two-sided, computed at the vertices in eye space; or its
/// own or the requested lights (mesh_light.hpp). Objects outside the view are marked (object_cull.hpp), and left out if
/// allowed. `cull`: none if the winding is unknown; a part that is not two-sided gets a state with Cull::back, a
/// textured part a state with the texture, in perspective, times the colour. Throws InputError if a transformed vertex
/// exceeds binary64. `framed`: the mesh that the camera is framed around, if it is another.
[[nodiscard]] Scene mesh_scene(const Mesh& mesh, const CameraRequest& request, int width, int height,
                               Cull cull = Cull::none, const MeshOptions& options = {}, const Mesh* framed = nullptr);

/// The same for a mesh made by `make`, if MeshOptions::kept has none yet.
template <class Make>
[[nodiscard]] Scene kept_mesh_scene(Make&& make, const CameraRequest& request, int width, int height, Cull cull,
                                    const MeshOptions& options) {
  if (options.kept == nullptr) return mesh_scene(make(), request, width, height, cull, options);
  if (!*options.kept) options.kept->emplace(make());
  MeshOptions kept = options;
  kept.places = &(*options.kept)->places;
  return mesh_scene((*options.kept)->mesh, request, width, height, cull, kept);
}

/// An empty clip-space scene of that size: one state and the clear to the default background.
[[nodiscard]] Scene cleared_scene(int width, int height);

}  // namespace halfplane
