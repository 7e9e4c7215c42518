// Fill rules for study: the owner of a sample exactly on an edge. A rule is one bit per edge, the bias of
// edge_function; no other part of the pipeline depends on it.
#pragma once

#include "../stages/cull.hpp"
#include "../stages/triangle_setup.hpp"
#include "../widths.hpp"
#include "rules.hpp"

namespace halfplane {

/// The bias of the edge from `from` to `to` of a triangle of positive area: 0 when samples on it belong to the
/// triangle, otherwise 1. offset_point (Shirley, Fundamentals of Computer Graphics: triangle rasterization): samples
/// belong to it when the window point (-1, -1), in pixels, lies strictly on its side. An edge whose line passes through
/// that point owns nothing, in either of the two triangles that share it.
[[nodiscard]] constexpr int edge_bias(const SnappedVertex& from, const SnappedVertex& to, FillRule rule,
                                      int grid_bits) {
  const std::int64_t dx = std::int64_t{to.x} - from.x, dy = std::int64_t{to.y} - from.y;
  const std::int64_t offset = -(std::int64_t{1} << grid_bits);  // subpixels
  switch (rule) {
    case FillRule::top_left: return is_top_left(from, to) ? 0 : 1;
    case FillRule::offset_point: return dx * (offset - from.y) - dy * (offset - from.x) > 0 ? 0 : 1;
    case FillRule::inclusive: break;
    case FillRule::exclusive: return 1;
  }
  return 0;
}

/// Sets another fill rule for the edges of `setup`, made from the vertices `v` in canonical order.
inline void set_fill_rule(TriangleSetup& setup, const std::array<SnappedVertex, 3>& v, FillRule rule,
                          const Widths& widths) {
  const int first_x = setup.left >> widths.tile_shift << widths.tile_shift;  // first pixel of the first tile
  const int first_y = setup.top >> widths.tile_shift << widths.tile_shift;
  for (std::size_t i = 0; i < 3; ++i) {
    const SnappedVertex &from = v[i], &to = v[(i + 1) % 3];
    const int bias = edge_bias(from, to, rule, widths.grid_bits);
    setup.edge[i].value = edge_function(from, to, first_x, first_y, widths.grid_bits, bias);
  }
}

}  // namespace halfplane
