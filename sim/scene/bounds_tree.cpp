#include "sim/scene/bounds_tree.hpp"

#include <algorithm>

namespace halfplane {
namespace {

/// A box and a sphere that contain both.
ObjectBounds around(const ObjectBounds& a, const ObjectBounds& b) {
  ObjectBounds both;
  for (std::size_t i = 0; i < 3; ++i) {
    both.low[i] = std::min(a.low[i], b.low[i]);
    both.high[i] = std::max(a.high[i], b.high[i]);
  }
  both.center = scaled(add(both.low, both.high), 0.5);
  for (const ObjectBounds* of : {&a, &b})
    both.radius = std::max(both.radius, length(subtract(of->center, both.center)) + of->radius);
  both.radius *= 1 + 1e-14;  // larger than its own rounding error
  return both;
}

}  // namespace

BoundsTree::BoundsTree(std::span<const ObjectBounds> objects) : objects_(objects.size()) {
  for (std::size_t i = 0; i < objects.size(); ++i)
    if (objects[i].radius >= 0) order_.push_back(static_cast<std::uint32_t>(i));
  nodes_.reserve(2 * order_.size());
  if (!order_.empty()) (void)build(objects, 0, order_.size());
}

std::size_t BoundsTree::build(std::span<const ObjectBounds> objects, std::size_t first, std::size_t count) {
  const std::size_t number = nodes_.size();
  nodes_.push_back({objects[order_[first]], first, count, 0});
  if (count == 1) return number;
  const auto begin = order_.begin() + static_cast<std::ptrdiff_t>(first),
             middle = begin + static_cast<std::ptrdiff_t>(count / 2), end = begin + static_cast<std::ptrdiff_t>(count);
  Vec3 low = objects[*begin].center, high = low;
  for (auto at = begin; at != end; ++at)
    for (std::size_t i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], objects[*at].center[i]);
      high[i] = std::max(high[i], objects[*at].center[i]);
    }
  const Vec3 size = subtract(high, low);
  const auto axis = static_cast<std::size_t>(std::ranges::max_element(size) - size.begin());
  std::nth_element(begin, middle, end, [&](std::uint32_t a, std::uint32_t b) {
    const double at_a = objects[a].center[axis], at_b = objects[b].center[axis];
    return at_a < at_b || (at_a == at_b && a < b);
  });
  const std::size_t left = build(objects, first, count / 2),
                    right = build(objects, first + count / 2, count - count / 2);
  nodes_[number].right = right;
  nodes_[number].bounds = around(nodes_[left].bounds, nodes_[right].bounds);
  return number;
}

std::vector<std::uint8_t> BoundsTree::outside_view(const Mat4& to_clip, std::uint8_t tests, BoundsWork& work) const {
  std::vector<std::uint8_t> outside(objects_, 0);
  if (tests == 0 || nodes_.empty()) return outside;
  struct Visit {
    std::size_t node;
    std::uint8_t open;  ///< planes not yet decided
  };
  std::vector<Visit> stack{{0, tests}};
  while (!stack.empty()) {
    const auto [number, open] = stack.back();
    stack.pop_back();
    const Node& node = nodes_[number];
    ++work.tests;
    if (node.count == 1) {
      outside[order_[node.first]] |= static_cast<std::uint8_t>(halfplane::outside_view(node.bounds, to_clip) & open);
      continue;
    }
    const NodeView view = node_view(node.bounds, to_clip);
    if (view.is_inside) {
      ++work.nodes_inside;
      continue;
    }
    const auto found = static_cast<std::uint8_t>(view.outside & open);
    if (found != 0)
      for (std::size_t i = node.first; i < node.first + node.count; ++i) outside[order_[i]] |= found;
    const auto rest = static_cast<std::uint8_t>(open & ~found);
    if (rest == 0) {
      ++work.nodes_outside;
      continue;
    }
    stack.push_back({node.right, rest});
    stack.push_back({number + 1, rest});
  }
  return outside;
}

}  // namespace halfplane
