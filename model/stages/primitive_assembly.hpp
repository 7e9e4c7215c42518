// Primitive assembly: indices and a topology in, triangles out, in program order.
//
// In: a Draw and the scene's indices. Out: three vertex indices per triangle, the provoking vertex first.
// Host side; it takes no cycles of the pipeline.
#pragma once

#include "../scene.hpp"

namespace halfplane {

/// The triangles of one draw, in order: calls visit(a, b, c) with indices into Scene::vertices, the provoking vertex first.
/// Odd triangles of a strip swap their last two vertices, so that all of a strip faces one way.
template <class Visit>
void for_each_triangle(const Scene& scene, const Draw& draw, Visit&& visit) {
  const std::uint32_t* index = scene.indices.data() + draw.first;
  switch (draw.topology) {
    case Topology::triangles:
      for (std::size_t i = 0; i + 2 < draw.count; i += 3) visit(index[i], index[i + 1], index[i + 2]);
      break;
    case Topology::triangle_strip:
      for (std::size_t i = 0; i + 2 < draw.count; ++i) visit(index[i], index[i + 1 + i % 2], index[i + 2 - i % 2]);
      break;
    case Topology::triangle_fan:
      for (std::size_t i = 1; i + 1 < draw.count; ++i) visit(index[i], index[i + 1], index[0]);
      break;
  }
}

}  // namespace halfplane
