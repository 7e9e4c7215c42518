// Golden primitive assembly: which three vertices make triangle i of a draw, the provoking vertex first.
#pragma once

#include <array>
#include <cstddef>

#include "../scene.hpp"

namespace halfplane::golden {

/// How many triangles the draw holds; left-over indices make none.
[[nodiscard]] inline std::size_t triangle_count(const Draw& draw) {
  if (draw.topology == Topology::triangles) return draw.count / 3;
  return draw.count < 3 ? 0 : draw.count - 2;
}

/// The vertices of triangle `i`, i < triangle_count(draw).
[[nodiscard]] inline std::array<Vertex, 3> triangle_vertices(const Scene& scene, const Draw& draw, std::size_t i) {
  std::array<std::size_t, 3> corner{3 * i, 3 * i + 1, 3 * i + 2};
  if (draw.topology == Topology::triangle_fan) corner = {i + 1, i + 2, 0};
  if (draw.topology == Topology::triangle_strip) {
    corner = i % 2 == 0 ? std::array{i, i + 1, i + 2} : std::array{i, i + 2, i + 1};  // odd ones face the same way
  }
  const auto vertex = [&](std::size_t k) { return scene.vertices[scene.indices[draw.first + k]]; };
  return {vertex(corner[0]), vertex(corner[1]), vertex(corner[2])};
}

}  // namespace halfplane::golden
