// Primitive assembly: indices and a topology in; triangles, lines or points out, in program order.
//
// In: a Draw and the scene's indices. Out: the vertex indices of each primitive. kRestart among the indices ends a run;
// left-over indices at the end of a run make no primitive. Host side; no cycles of the pipeline.
#pragma once

#include <algorithm>
#include <array>
#include <span>

#include "../scene.hpp"

namespace halfplane {

enum class PrimitiveType { triangle, line, point };

/// The primitive type of a topology, before polygon_mode.
[[nodiscard]] constexpr PrimitiveType primitive_type(Topology topology) {
  switch (topology) {
    case Topology::triangles:
    case Topology::triangle_strip:
    case Topology::triangle_fan: return PrimitiveType::triangle;
    case Topology::lines:
    case Topology::line_strip:
    case Topology::line_loop: return PrimitiveType::line;
    case Topology::points: break;
  }
  return PrimitiveType::point;
}

/// Calls visit(indices) for each run of indices between restarts.
template <class Visit>
void for_each_run(const Scene& scene, const Draw& draw, Visit&& visit) {
  std::span<const std::uint32_t> rest(scene.indices.data() + draw.first, draw.count);
  while (!rest.empty()) {
    const auto length = static_cast<std::size_t>(std::ranges::find(rest, kRestart) - rest.begin());
    if (length > 0) visit(rest.first(length));
    rest = rest.subspan(std::min(length + 1, rest.size()));
  }
}

/// The triangles of one draw, in order: calls visit(a, b, c) with indices into Scene::vertices, the provoking vertex
/// first, the others in the order that keeps the facing. Odd triangles of a strip are reversed, so that the whole strip
/// has one facing.
template <class Visit>
void for_each_triangle(const Scene& scene, const Draw& draw, Provoking provoking, Visit&& visit) {
  const bool is_first = provoking == Provoking::first;
  for_each_run(scene, draw, [&](std::span<const std::uint32_t> v) {
    const std::size_t step = draw.topology == Topology::triangles ? 3 : 1;
    for (std::size_t i = 0; i + 2 < v.size(); i += step) {
      // In the order of the facing, and the vertices that the rules `first` and `last` name.
      std::size_t a = i, b = i + 1, c = i + 2;
      if (draw.topology == Topology::triangle_fan) a = i + 1, b = i + 2, c = 0;
      if (draw.topology == Topology::triangle_strip && i % 2 == 1) std::swap(b, c);
      if (is_first)
        visit(v[a], v[b], v[c]);
      else if (b == i + 2)
        visit(v[b], v[c], v[a]);
      else
        visit(v[c], v[a], v[b]);
    }
  });
}

/// The lines of one draw, in order: calls visit(start, end). The last line of a loop runs from its last vertex to its first.
template <class Visit>
void for_each_line(const Scene& scene, const Draw& draw, Visit&& visit) {
  for_each_run(scene, draw, [&](std::span<const std::uint32_t> v) {
    const std::size_t step = draw.topology == Topology::lines ? 2 : 1;
    for (std::size_t i = 0; i + 1 < v.size(); i += step) visit(v[i], v[i + 1]);
    if (draw.topology == Topology::line_loop && v.size() > 1) visit(v.back(), v.front());
  });
}

/// The points of one draw, in order: calls visit(vertex).
template <class Visit>
void for_each_point(const Scene& scene, const Draw& draw, Visit&& visit) {
  for_each_run(scene, draw, [&](std::span<const std::uint32_t> v) {
    for (const std::uint32_t index : v) visit(index);
  });
}

/// One assembled primitive: `type` gives the number of indices.
struct AssembledPrimitive {
  PrimitiveType type = PrimitiveType::triangle;
  std::array<std::uint32_t, 3> index{};
};

/// All of the above: calls visit(AssembledPrimitive).
template <class Visit>
void for_each_primitive(const Scene& scene, const Draw& draw, Provoking provoking, Visit&& visit) {
  switch (primitive_type(draw.topology)) {
    case PrimitiveType::triangle:
      return for_each_triangle(scene, draw, provoking, [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        visit(AssembledPrimitive{PrimitiveType::triangle, {a, b, c}});
      });
    case PrimitiveType::line:
      return for_each_line(scene, draw, [&](std::uint32_t start, std::uint32_t end) {
        visit(AssembledPrimitive{PrimitiveType::line, {start, end, end}});
      });
    case PrimitiveType::point:
      return for_each_point(scene, draw, [&](std::uint32_t index) {
        visit(AssembledPrimitive{PrimitiveType::point, {index, index, index}});
      });
  }
}

/// Number of primitives of a draw: lines and points of polygon_mode do not count.
[[nodiscard]] inline std::size_t primitive_count(const Scene& scene, const Draw& draw) {
  std::size_t count = 0;
  for_each_primitive(scene, draw, Provoking::first, [&count](const AssembledPrimitive&) { ++count; });
  return count;
}

}  // namespace halfplane
