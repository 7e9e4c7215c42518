// Scanline traversal, for study: the covered span of each row from two edges walked down the triangle.
//
// In: three vertices, a box, a fill rule. Out: spans of covered pixels, row by row. The vertices are sorted by y; the
// long edge (top to bottom) bounds one side, the upper and the lower edge the other. An edge is walked by an integer
// DDA: the first or last covered pixel of a row is a quotient, and a row down adds the quotient and the remainder of
// dx over dy, with one carry, as Bresenham does. All integers, so the spans are exact at any length; no edge function
// per pixel.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "../stages/cull.hpp"
#include "fill_rule.hpp"
#include "rules.hpp"

namespace halfplane {

/// floor(a / b), b > 0.
[[nodiscard]] constexpr std::int64_t floor_div(std::int64_t a, std::int64_t b) {
  const std::int64_t quotient = a / b;
  return a % b < 0 ? quotient - 1 : quotient;
}

/// One edge on its way down. `x` is the first covered pixel of the row on a left edge, the last one on a right edge.
struct EdgeWalk {
  int first_row = 0, last_row = -1;  ///< rows whose centre lies on the closed edge's range of y
  std::int64_t x = 0;                ///< pixels
  std::int64_t error = 0;            ///< remainder, 0...height - 1 subpixels
  std::int64_t step = 0, step_error = 0;
  std::int64_t height = 1;  ///< |dy|, subpixels

  void next_row() {
    x += step;
    error += step_error;
    if (error >= height) {
      error -= height;
      ++x;
    }
  }
};

/// The edge between `upper` and `lower`, upper.y < lower.y, at its first row not above `top`. `bias` as in
/// edge_function. On a right edge E = dx (py - y) - dy (px - x) >= bias, solved for the pixel X of px, is
///   X <= floor((dx (py - y) + dy (x - 1/2 pixel) - bias) / (dy 2^s)),
/// on a left one X >= the ceiling of the same with + bias. Products below 2^(2V + 2), V the bits of a coordinate: 64 bits
/// hold them. The low s bits drop before the division.
[[nodiscard]] inline EdgeWalk walk_edge(const SnappedVertex& upper, const SnappedVertex& lower, bool is_left, int bias,
                                        int top, int grid_bits) {
  const std::int64_t half = std::int64_t{1} << (grid_bits - 1);
  const std::int64_t dx = std::int64_t{lower.x} - upper.x;
  EdgeWalk walk;
  walk.height = std::int64_t{lower.y} - upper.y;
  walk.first_row = std::max(top, static_cast<int>((upper.y + half - 1) >> grid_bits));
  walk.last_row = static_cast<int>((lower.y - half) >> grid_bits);
  const std::int64_t row_centre = (std::int64_t{walk.first_row} << grid_bits) + half;
  const std::int64_t crossing = dx * (row_centre - upper.y) + walk.height * (upper.x - half);
  const std::int64_t to_ceiling = (walk.height << grid_bits) - 1;
  const std::int64_t numerator = (is_left ? crossing + bias + to_ceiling : crossing - bias) >> grid_bits;
  walk.x = floor_div(numerator, walk.height);
  walk.error = numerator - walk.x * walk.height;
  walk.step = floor_div(dx, walk.height);
  walk.step_error = dx - walk.step * walk.height;
  return walk;
}

/// Calls emit(x, y) for every covered pixel of `box`. `v`: positive area, as canonical() gives it; `box` as
/// pixel_bounds() gives it. Returns the samples visited, all of which are covered.
template <class Emit>
std::uint64_t traverse_scanline(const std::array<SnappedVertex, 3>& v, const PixelBounds& box, FillRule rule,
                                int grid_bits, Emit&& emit) {
  std::array<SnappedVertex, 3> sorted = v;
  std::sort(sorted.begin(), sorted.end(), [](const SnappedVertex& a, const SnappedVertex& b) { return a.y < b.y; });
  const SnappedVertex &top = sorted[0], &middle = sorted[1], &bottom = sorted[2];
  const bool long_is_left = signed_area(top, middle, bottom) > 0;  // clockwise: the middle vertex is on the right

  const std::int64_t half = std::int64_t{1} << (grid_bits - 1);
  int first = box.top, last = box.bottom;
  // Clockwise, a right edge runs downwards and a left one upwards; horizontal edges run in the order of their chain.
  const auto bias_of = [&](const SnappedVertex& upper, const SnappedVertex& lower, bool is_left) {
    return is_left ? edge_bias(lower, upper, rule, grid_bits) : edge_bias(upper, lower, rule, grid_bits);
  };
  const auto walk = [&](const SnappedVertex& upper, const SnappedVertex& lower, bool is_left) {
    const int bias = bias_of(upper, lower, is_left);
    if (upper.y < lower.y) return walk_edge(upper, lower, is_left, bias, box.top, grid_bits);
    // A horizontal edge bounds no span, but a row of centres exactly on it is drawn only if the edge owns them.
    const bool is_on_row = ((upper.y - half) & ((std::int64_t{1} << grid_bits) - 1)) == 0;
    const int row = static_cast<int>((upper.y - half) >> grid_bits);
    if (is_on_row && bias != 0) {
      if (&upper == &top) first = std::max(first, row + 1);
      if (&lower == &bottom) last = std::min(last, row - 1);
    }
    return EdgeWalk{};
  };
  EdgeWalk far_side = walk(top, bottom, long_is_left);
  EdgeWalk upper_edge = walk(top, middle, !long_is_left), lower_edge = walk(middle, bottom, !long_is_left);

  std::uint64_t visited = 0;
  std::int64_t left = 0, right = 0;
  const auto bound_by = [&](EdgeWalk& edge, bool is_left, int y) {
    if (y < edge.first_row || y > edge.last_row) return;
    (is_left ? left : right) = is_left ? std::max(left, edge.x) : std::min(right, edge.x);
    edge.next_row();
  };
  for (int y = box.top; y <= last; ++y) {
    left = box.left;
    right = box.right;
    bound_by(far_side, long_is_left, y);
    bound_by(upper_edge, !long_is_left, y);  // a row through the middle vertex is bound by both
    bound_by(lower_edge, !long_is_left, y);
    if (y < first || left > right) continue;
    visited += static_cast<std::uint64_t>(right - left + 1);
    for (auto x = static_cast<int>(left); x <= right; ++x) emit(x, y);
  }
  return visited;
}

}  // namespace halfplane
