// Whole-object culling: an object that lies outside the view costs one test instead of one for each of its primitives.
//
// A mesh's objects are tested by their bounding sphere and by their axis-aligned box, in world space, against the six
// planes of the view volume, which are rows of the matrix that takes points to clip space (Gribb and Hartmann, 2001):
// without a division by w, so that the near plane and points behind the eye need no special case. Homogeneous coordinates
// have no box; there the outcodes of all vertices decide.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "model/scene.hpp"
#include "sim/scene/camera.hpp"
#include "sim/scene/mesh.hpp"

namespace halfplane {

/// Which tests may cull.
enum class CullObjects { none, sphere, box, both };

/// Throws InputError that lists the words.
[[nodiscard]] CullObjects parse_cull_objects(std::string_view text);

/// The tests that found an object outside: bits of Draw::outside. Without a box its bit stands for the vertices.
inline constexpr std::uint8_t kSphereOutside = 1, kBoxOutside = 2;

/// Where a mesh's object lies, in world space.
struct ObjectBounds {
  Vec3 low{}, high{};  ///< the axis-aligned box
  Vec3 center{};       ///< of the box and of the sphere
  double radius = -1;  ///< of the sphere round `center` that holds every vertex; below 0: nothing in it
};

/// The bounds of each of the mesh's objects.
[[nodiscard]] std::vector<ObjectBounds> object_bounds(const Mesh& mesh);

/// Which tests find the bounds outside of the view volume -w <= x, y, z <= w of `to_clip`. Never one that holds a point
/// inside: a test must pass by 10^-12 of its terms, which is far above their rounding.
[[nodiscard]] std::uint8_t outside_view(const ObjectBounds& bounds, const Mat4& to_clip);

/// The same of bounds that hold those of several objects.
struct NodeView {
  std::uint8_t outside = 0;  ///< tests that find each of the objects outside
  bool is_inside = false;    ///< no test finds any of them outside
};

/// What outside_view() says of everything inside the bounds, if it says the same of all: it is asked by twice the margin,
/// so that what it says of each of them cannot round otherwise.
[[nodiscard]] NodeView node_view(const ObjectBounds& bounds, const Mat4& to_clip);

/// Marks the draws of every object all of whose draws lie outside one plane of the view volume each, by the vertices
/// themselves. Window space is never outside; of lines and points, whose pixels can reach beyond their vertices, only
/// near and far planes are asked. Linear in the indices at worst; a draw in view stops at its first few.
void mark_outside_objects(Scene& scene);

/// The bits of Draw::outside that stand for those tests.
[[nodiscard]] std::uint8_t bits_of(CullObjects tests);

struct ObjectCounts {
  std::size_t in = 0;                             ///< objects with a draw
  std::size_t culled_sphere = 0, culled_box = 0;  ///< of those, what each test that was asked for found outside
  std::size_t primitives_skipped = 0;
  /// Of a mesh, whose objects are asked by a tree (bounds_tree.hpp): tests against the view, nodes of several objects that
  /// one of them decided, vertices that were neither transformed nor lit.
  std::size_t tests = 0, nodes_outside = 0, nodes_inside = 0, vertices_skipped = 0;
};

/// Leaves the marks of those tests only that may cull, and counts.
ObjectCounts select_object_culling(Scene& scene, CullObjects tests);

}  // namespace halfplane
