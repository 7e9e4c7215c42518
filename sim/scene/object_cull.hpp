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

/// Bounds of a mesh's object, in world space.
struct ObjectBounds {
  Vec3 low{}, high{};  ///< the axis-aligned box
  Vec3 center{};       ///< of the box and of the sphere
  double radius = -1;  ///< of the sphere around `center` that contains every vertex; below 0: empty
};

[[nodiscard]] std::vector<ObjectBounds> object_bounds(const Mesh& mesh);

/// The tests that find the bounds outside the view volume -w <= x, y, z <= w of `to_clip`. Conservative: a test must
/// pass by 10^-12 of its terms, which is far above their rounding.
[[nodiscard]] std::uint8_t outside_view(const ObjectBounds& bounds, const Mat4& to_clip);

/// The same for the bounds of several objects.
struct NodeView {
  std::uint8_t outside = 0;  ///< tests that find every object outside
  bool is_inside = false;    ///< no test finds any object outside
};

/// The result of outside_view() for everything inside the bounds, if it is the same for all: it is tested with twice
/// the margin, so that rounding cannot change the result for any object.
[[nodiscard]] NodeView node_view(const ObjectBounds& bounds, const Mat4& to_clip);

/// Marks the draws of every object all of whose draws lie outside one plane of the view volume each, by the vertices
/// themselves. Window space is never outside; lines and points, whose pixels can reach beyond their vertices, are only
/// tested against the near and far planes. Linear in the indices at worst; a draw in view needs only its first few.
void mark_outside_objects(Scene& scene);

/// The bits of Draw::outside for those tests.
[[nodiscard]] std::uint8_t bits_of(CullObjects tests);

struct ObjectCounts {
  std::size_t in = 0;                             ///< objects with a draw
  std::size_t culled_sphere = 0, culled_box = 0;  ///< objects of these found outside by each requested test
  std::size_t primitives_skipped = 0;
  /// For a mesh tested with a tree (bounds_tree.hpp): tests against the view, nodes of several objects decided by one
  /// test, vertices neither transformed nor lit.
  std::size_t tests = 0, nodes_outside = 0, nodes_inside = 0, vertices_skipped = 0;
};

/// Keeps only the marks of the selected tests, and counts.
ObjectCounts select_object_culling(Scene& scene, CullObjects tests);

}  // namespace halfplane
