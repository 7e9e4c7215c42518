// A binary tree of bounding volumes over a mesh's objects: a subtree that lies wholly outside or inside the view costs one
// test.
//
// The objects of a node are split at the median of their centres, along the axis of the largest extent. The tree is
// built over the positions of objects of any origin: groups of an OBJ, nodes of a glTF file (whose own tree is
// structural, not spatial), or vertices moved by a skin. A node's box holds its objects' boxes, its sphere their
// spheres.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "sim/scene/object_cull.hpp"

namespace halfplane {

/// Work of one traversal of a tree.
struct BoundsWork {
  std::size_t tests = 0;          ///< of nodes and objects against the view
  std::size_t nodes_outside = 0;  ///< with several objects, all outside by one test
  std::size_t nodes_inside = 0;   ///< with several objects, all inside by one test
};

class BoundsTree {
 public:
  BoundsTree() = default;
  explicit BoundsTree(std::span<const ObjectBounds> objects);

  /// outside_view() for each object, with `tests` (bits of Draw::outside): the same bits for any tree.
  [[nodiscard]] std::vector<std::uint8_t> outside_view(const Mat4& to_clip, std::uint8_t tests, BoundsWork& work) const;

 private:
  struct Node {
    ObjectBounds bounds;
    std::size_t first = 0, count = 0;  ///< in order_
    std::size_t right = 0;             ///< the left half is the next node; 0: one object
  };
  std::size_t build(std::span<const ObjectBounds> objects, std::size_t first, std::size_t count);

  std::size_t objects_ = 0;
  std::vector<Node> nodes_;           ///< each before its halves
  std::vector<std::uint32_t> order_;  ///< objects, ordered so that a node's are adjacent
};

}  // namespace halfplane
