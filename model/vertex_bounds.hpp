// Bounds of many vertices' numbers, for what checks scenes.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <span>

#include "scene.hpp"

namespace halfplane {

/// Whether all numbers of the vertices are within low...high; false of NaN. Two numbers at a time, without an early end.
[[nodiscard]] inline bool are_within(std::span<const Vertex> vertices, const VertexNumbers& low,
                                     const VertexNumbers& high) {
  using Pair __attribute__((vector_size(2 * sizeof(double)))) = double;
  using Pairs = std::array<Pair, VertexNumbers().size() / 2>;
  const auto lows = std::bit_cast<Pairs>(low), highs = std::bit_cast<Pairs>(high);
  auto is_within = Pair{} == Pair{};
  for (const Vertex& vertex : vertices) {
    const auto pairs = std::bit_cast<Pairs>(vertex);
    for (std::size_t i = 0; i < pairs.size(); ++i) is_within &= (pairs[i] >= lows[i]) & (pairs[i] <= highs[i]);
  }
  return is_within[0] != 0 && is_within[1] != 0;
}

}  // namespace halfplane
