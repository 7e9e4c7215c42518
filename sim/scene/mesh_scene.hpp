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

/// Where a mesh's objects lie: does not change from picture to picture of a mesh that stands still, for which alone a tree
/// is worth its making.
struct MeshPlaces {
  explicit MeshPlaces(const Mesh& mesh) : bounds(object_bounds(mesh)), tree(bounds) {}
  std::vector<ObjectBounds> bounds;
  BoundsTree tree;
};

/// A mesh that is kept with its places.
struct PlacedMesh {
  explicit PlacedMesh(Mesh of) : mesh(std::move(of)), places(mesh) {}
  Mesh mesh;
  MeshPlaces places;
};

/// What one picture took of the host.
struct MeshWork {
  BoundsWork bounds;
  std::size_t vertices_skipped = 0;
};

/// How vertices become what a scene has of them.
struct MeshOptions {
  LightRequest light;
  TransformNumbers transform = TransformNumbers::binary64;
  /// Objects that these tests find outside are left out: their vertices are neither transformed nor lit, and their draws,
  /// which are marked, keep their number of primitives, all at one place. None: every object is there, and those outside are
  /// marked by both tests. Where lights are asked for, or the file has its own, all vertices are lit: their range is that of
  /// all places.
  CullObjects leaves_out = CullObjects::none;
  bool has_tree = true;                       ///< false: each object is asked by itself
  const MeshPlaces* places = nullptr;         ///< of the mesh; null: bounds are found, and there is no tree
  MeshWork* work = nullptr;                   ///< of the last picture; may be null
  std::optional<PlacedMesh>* kept = nullptr;  ///< of a built-in scene: the mesh, from picture to picture; may be null
};

/// Projects a mesh: one indexed draw for each part, depth_test less, a dark background and depth 1 cleared first.
/// A lit mesh gets a light at the eye: ambient plus wrapped diffuse, two-sided, computed at the vertices in eye space; or
/// the lights that it has, or that are asked for (mesh_light.hpp).
/// Objects that lie outside the view are marked (object_cull.hpp), and left out if they may be.
/// `cull`: none where the winding is not known; a part that is not two-sided gets a state with Cull::back, one with a
/// texture a state that looks it up, in perspective, times the colour. Throws InputError if the camera throws a vertex
/// out of binary64. `framed`: whose vertices the camera is framed around, if others than the mesh's.
[[nodiscard]] Scene mesh_scene(const Mesh& mesh, const CameraRequest& request, int width, int height,
                               Cull cull = Cull::none, const MeshOptions& options = {}, const Mesh* framed = nullptr);

/// The same of a mesh that `make` makes, if MeshOptions::kept has none yet.
template <class Make>
[[nodiscard]] Scene kept_mesh_scene(Make&& make, const CameraRequest& request, int width, int height, Cull cull,
                                    const MeshOptions& options) {
  if (options.kept == nullptr) return mesh_scene(make(), request, width, height, cull, options);
  if (!*options.kept) options.kept->emplace(make());
  MeshOptions kept = options;
  kept.places = &(*options.kept)->places;
  return mesh_scene((*options.kept)->mesh, request, width, height, cull, kept);
}

/// An empty clip-space scene of that size: one state and the clear to the house's background.
[[nodiscard]] Scene cleared_scene(int width, int height);

}  // namespace halfplane
