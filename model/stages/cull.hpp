// Cull: decides by the signed area, after the snap, whether a triangle faces the right way.
//
// In: the signed area of a triangle or of a clipped polygon. Out: keep or drop. Positive area = clockwise as seen on the screen (y down).
#pragma once

#include "../packets.hpp"
#include "../scene.hpp"

namespace halfplane {

/// Twice the signed area, in square subpixels: exact.
[[nodiscard]] constexpr std::int64_t signed_area(const SnappedVertex& a, const SnappedVertex& b,
                                                 const SnappedVertex& c) {
  const std::int64_t ax = std::int64_t{b.x} - a.x, ay = std::int64_t{b.y} - a.y;
  const std::int64_t bx = std::int64_t{c.x} - a.x, by = std::int64_t{c.y} - a.y;
  return ax * by - ay * bx;
}

enum class CullResult { keep, backface, zero_area };

/// `backface` stands for whichever side `state.cull` removes.
[[nodiscard]] constexpr CullResult cull(std::int64_t area, const State& state) {
  if (area == 0) return CullResult::zero_area;
  const bool is_front = (area > 0) == (state.front == FrontFace::cw);
  const bool removed =
      state.cull == Cull::both || (state.cull == Cull::front && is_front) || (state.cull == Cull::back && !is_front);
  return removed ? CullResult::backface : CullResult::keep;
}

}  // namespace halfplane
