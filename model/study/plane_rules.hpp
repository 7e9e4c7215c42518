// Planes by other arithmetic than the pipeline's, for study: the gradients and accumulators of designs that go wrong.
// docs/numerics.md shows each of them. Triangles alone; lines and points stay as they are.
//
//   two_reciprocals  g_x = N_x R_x, g_y = N_y R_y with R_x = floor(2^k/A), R_y = ceil(2^k/A): two units for one quotient
//   truncated        g = floor(N R 2^(l+s-k)) in 2^-l LSB per pixel: one narrow accumulator over the whole triangle,
//                    with no guard bits but those of a tile, and nothing rounded
//   saturate         gradients and the value at the first anchor are held inside [-2^bits, 2^bits) LSB, the range of
//                    their registers, and the value again wherever it is stepped: down the first column of tiles, then
//                    along the row
#pragma once

#include "../stages/interpolate.hpp"
#include "rules.hpp"

namespace halfplane {

/// Makes the planes of `setup` anew by rules.gradients and rules.accumulator. `v`: its vertices in canonical order, of
/// an area that is not zero.
void set_planes(TriangleSetup& setup, const std::array<SnappedVertex, 3>& v, const StudyRules& rules,
                const Config& config, const Widths& widths);

/// interpolate_at() for planes that set_planes() made by the same rules. Saturated values depend on the setup's first
/// tile: they are what a walk over its box has, and no closed form of (triangle, tile, pixel).
[[nodiscard]] Interpolated interpolate_by_rules(const TriangleSetup& setup, const StudyRules& rules,
                                                const Widths& widths, int x, int y);

}  // namespace halfplane
