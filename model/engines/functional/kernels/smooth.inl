// Coverage of the pixels of a smooth line, sixteen at a time: RowAreas of host/smooth_raster, the same operations in the same
// order.
#pragma once

#include "lane_moves.inl"

namespace halfplane::functional::HALFPLANE_ISA_NAME {
namespace {

/// A SmoothLanes.
static void smooth_coverage(const SmoothSides& sides, const std::int32_t* x, const std::int32_t* y, std::size_t count,
                            std::int32_t* coverage) {
  for (std::size_t first = 0; first < count; first += 16) {
    const D16 center_x = convert<double>(I16::load(x + first)) + 0.5,
              center_y = convert<double>(I16::load(y + first)) + 0.5;
    D16 area(1.0);
    L16 is_outside(0);
    std::array<L16, 2> cuts{L16(0), L16(0)};  // by the first and third side, by the others
    for (std::size_t i = 0; i < sides.size(); ++i) {
      const SmoothSide& side = sides[i];
      const D16 distance = center_x * side.a + center_y * side.b + side.c;
      is_outside |= distance <= -side.reach;
      const L16 is_cut = distance < side.reach;
      if (!is_any(convert<std::int32_t>(is_cut))) continue;  // mostly the ends of the line
      cuts[i % 2] |= is_cut;
      // Where the side cuts nothing off, the height is 0.
      const D16 height = max(D16(side.reach) - max(distance, -distance), D16(0.0));
      const L16 is_triangle = height < side.flat;
      const D16 smaller = select(is_triangle, height * height, height - side.flat / 2) /
                          select(is_triangle, D16(side.doubled_product), D16(side.steep));
      const D16 inside = select(distance < 0.0, smaller, D16(1.0) - smaller);
      area = area - (D16(1.0) - inside);
    }
    const D16 codes = max(select(is_outside, D16(0.0), area), D16(0.0)) * static_cast<double>(kWholePixel);
    const I16 whole = convert<std::int32_t>(codes);
    const I16 rounded = whole - convert<std::int32_t>(codes - convert<double>(whole) >= 0.5);
    const I16 meets = convert<std::int32_t>(cuts[0] & cuts[1] & ~is_outside);
    select(meets, I16(-1), rounded).store(coverage + first);
  }
}

}  // namespace
}  // namespace halfplane::functional::HALFPLANE_ISA_NAME
