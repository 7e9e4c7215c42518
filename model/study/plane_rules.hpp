// Planes with arithmetic other than the pipeline's, for study: the gradients and accumulators of faulty designs.
// docs/numerics.md shows each of them. Triangles only; lines and points are unchanged.
//
//   two_reciprocals  g_x = N_x R_x, g_y = N_y R_y with R_x = floor(2^k/A), R_y = ceil(2^k/A): two units for one quotient
//   truncated        g = floor(N R 2^(l+s-k)) in 2^-l LSB per pixel: one narrow accumulator over the whole triangle,
//                    with no guard bits but the tile's, and no rounding
//   saturate         gradients and the value at the first anchor are clamped to [-2^bits, 2^bits) LSB, the range of
//                    their registers, and the value again wherever it is stepped: down the first column of tiles, then
//                    along the row
#pragma once

#include "../stages/interpolate.hpp"
#include "rules.hpp"

namespace halfplane {

/// Recomputes the planes of `setup` by rules.gradients and rules.accumulator. `v`: its vertices in canonical order,
/// with nonzero area.
void set_planes(TriangleSetup& setup, const std::array<SnappedVertex, 3>& v, const StudyRules& rules,
                const Config& config, const Widths& widths);

/// interpolate_at() for planes from set_planes() with the same rules. Saturated values depend on the setup's first
/// tile: they result from a walk over its box, not from a closed form of (triangle, tile, pixel).
[[nodiscard]] Interpolated interpolate_by_rules(const TriangleSetup& setup, const StudyRules& rules,
                                                const Widths& widths, int x, int y);

}  // namespace halfplane
