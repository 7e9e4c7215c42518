// Cull: drops triangles of area 0, triangles with the wrong facing, triangles without a pixel centre in the scissor,
// and small ones that cover none.
//
// In: a PrimitivePacket. Out: a TrianglePacket in canonical order with its area and box, or nothing. Positive area =
// clockwise as seen on the screen (y down). Other kinds pass unchanged, unless their box is empty; a state that
// overtakes the setup of triangles keeps only the last vertex's codes.
#pragma once

#include <algorithm>
#include <optional>
#include <utility>

#include "../packets/packets.hpp"
#include "../scene.hpp"
#include "../widths.hpp"
#include "edge_function.hpp"

namespace halfplane {

/// Twice the signed area, in square subpixels: exact.
[[nodiscard]] constexpr std::int64_t signed_area(const SnappedVertex& a, const SnappedVertex& b,
                                                 const SnappedVertex& c) {
  const std::int64_t ax = std::int64_t{b.x} - a.x, ay = std::int64_t{b.y} - a.y;
  const std::int64_t bx = std::int64_t{c.x} - a.x, by = std::int64_t{c.y} - a.y;
  return ax * by - ay * bx;
}

/// Whether a triangle of that area, in any unit, shows its back: positive is clockwise. Lines and points, a triangle's
/// outline too, show their front.
template <class Area>
[[nodiscard]] constexpr bool shows_back(const Area& area, FrontFace front) {
  return (area > 0) == (front == FrontFace::ccw);
}

enum class CullResult { keep, backface, zero_area };

/// `backface` stands for the side that `mode` removes.
[[nodiscard]] constexpr CullResult cull(std::int64_t area, Cull mode, FrontFace front) {
  if (area == 0) return CullResult::zero_area;
  const bool is_front = !shows_back(area, front);
  const bool removed = mode == Cull::both || (mode == Cull::front && is_front) || (mode == Cull::back && !is_front);
  return removed ? CullResult::backface : CullResult::keep;
}

[[nodiscard]] constexpr CullResult cull(std::int64_t area, const State& state) {
  return cull(area, state.cull, state.front);
}

/// A rectangle of pixels, inclusive, anywhere in the guard band; empty when left > right or top > bottom.
struct PixelBounds {
  int left = 0, top = 0, right = -1, bottom = -1;
  [[nodiscard]] constexpr bool is_empty() const { return left > right || top > bottom; }
  /// Number of its pixels. Precondition: not empty.
  [[nodiscard]] constexpr std::uint64_t samples() const {
    return static_cast<std::uint64_t>(right - left + 1) * static_cast<std::uint64_t>(bottom - top + 1);
  }
};

/// The smallest and the largest of three numbers; std::minmax of a list is a call.
template <class Number>
[[nodiscard]] constexpr std::pair<Number, Number> range_of(Number a, Number b, Number c) {
  return {std::min(std::min(a, b), c), std::max(std::max(a, b), c)};
}

/// The pixels whose centres lie in the triangle's bounding box and in `limit`.
[[nodiscard]] inline PixelBounds pixel_bounds(const std::array<SnappedVertex, 3>& v, const PixelBounds& limit,
                                              int grid_bits) {
  const std::int32_t half = std::int32_t{1} << (grid_bits - 1);
  const auto [x_min, x_max] = range_of(v[0].x, v[1].x, v[2].x);
  const auto [y_min, y_max] = range_of(v[0].y, v[1].y, v[2].y);
  // First pixel whose centre is >= min, last whose centre is <= max.
  return {std::max(limit.left, (x_min + half - 1) >> grid_bits), std::max(limit.top, (y_min + half - 1) >> grid_bits),
          std::min(limit.right, (x_max - half) >> grid_bits), std::min(limit.bottom, (y_max - half) >> grid_bits)};
}

/// The same for `samples` samples per pixel: with several, wherever they lie, the pixels that the bounding box touches.
[[nodiscard]] inline PixelBounds sample_bounds(const std::array<SnappedVertex, 3>& v, const PixelBounds& limit,
                                               int grid_bits, int samples) {
  if (samples == 1) return pixel_bounds(v, limit, grid_bits);
  const auto [x_min, x_max] = range_of(v[0].x, v[1].x, v[2].x);
  const auto [y_min, y_max] = range_of(v[0].y, v[1].y, v[2].y);
  return {std::max(limit.left, x_min >> grid_bits), std::max(limit.top, y_min >> grid_bits),
          std::min(limit.right, x_max >> grid_bits), std::min(limit.bottom, y_max >> grid_bits)};
}

/// Positive area and smallest (Y, X, Z) first: all six orders of the vertices become one. Returns the indices in that
/// order.
[[nodiscard]] inline std::array<std::size_t, 3> canonical_order(const std::array<SnappedVertex, 3>& v,
                                                                std::int64_t area) {
  std::size_t first = canonically_before(v[1], v[0]) ? 1 : 0;
  if (canonically_before(v[2], v[first])) first = 2;
  const std::size_t next = (first + 1) % 3, last = (first + 2) % 3;
  return area < 0 ? std::array{first, last, next} : std::array{first, next, last};
}

/// The vertices themselves.
[[nodiscard]] inline std::array<SnappedVertex, 3> canonical(const std::array<SnappedVertex, 3>& v, std::int64_t area) {
  const auto order = canonical_order(v, area);
  return {v[order[0]], v[order[1]], v[order[2]]};
}

/// The vertices as a packet holds them, and back.
[[nodiscard]] inline std::array<SnappedVertex, 3> to_snapped(const TriangleVertices& vertex) {
  std::array<SnappedVertex, 3> v;
  for (std::size_t i = 0; i < 3; ++i) v[i] = {vertex.x[i], vertex.y[i], vertex.code[i]};
  return v;
}
inline void set_vertices(TriangleVertices& vertex, const std::array<SnappedVertex, 3>& v) {
  for (std::size_t i = 0; i < 3; ++i) {
    vertex.x[i] = v[i].x;
    vertex.y[i] = v[i].y;
    vertex.code[i] = v[i].code;
  }
}

/// Bounds that lie inside the target, as a packet holds them, and back.
[[nodiscard]] constexpr PixelBox to_box(const PixelBounds& bounds) {
  return {static_cast<std::uint16_t>(bounds.left), static_cast<std::uint16_t>(bounds.top),
          static_cast<std::uint16_t>(bounds.right), static_cast<std::uint16_t>(bounds.bottom)};
}
template <class Box>
[[nodiscard]] constexpr PixelBounds to_bounds(const Box& box) {
  return {box.left, box.top, box.right, box.bottom};
}

/// With one sample per pixel: whether a triangle covers no sample and is small enough for the pipelined cull to find
/// that: its box has at most 2x2 samples, and each of its sides, in the order of `v`, the input of cull, is in [-4, 4)
/// pixels long in x and in y.
[[nodiscard]] inline bool provably_covers_no_sample(const TrianglePacket& triangle,
                                                    const std::array<SnappedVertex, 3>& v, const Widths& widths) {
  const PixelBox& box = triangle.box;
  if (box.right - box.left > 1 || box.bottom - box.top > 1) return false;
  const std::int32_t limit = std::int32_t{4} << widths.grid_bits;
  for (std::size_t i = 0; i < 3; ++i) {
    const SnappedVertex &from = v[i], &to = v[(i + 1) % 3];
    const std::int32_t dx = to.x - from.x, dy = to.y - from.y;
    if (dx < -limit || dx >= limit || dy < -limit || dy >= limit) return false;
  }
  const TriangleVertices& corner = triangle.vertex;
  const int in_tile = (1 << widths.tile_shift) - 1;
  const EdgeValue x = box.left & in_tile, y = box.top & in_tile;  // from the pixel of the edge values
  std::array<EdgeValue, 4> any{};                                 // pixels of the box: negative outside some edge
  for (std::size_t i = 0; i < 3; ++i) {
    const EdgeValue dx = corner.x[(i + 1) % 3] - corner.x[i], dy = corner.y[(i + 1) % 3] - corner.y[i];
    const EdgeValue first = triangle.edge_value[i] + y * dx - x * dy;
    any[0] |= first;
    any[1] |= first - dy;
    any[2] |= first + dx;
    any[3] |= first + dx - dy;
  }
  const bool has_two_columns = box.right != box.left, has_two_rows = box.bottom != box.top;
  return any[0] < 0 && (!has_two_columns || any[1] < 0) && (!has_two_rows || any[2] < 0) &&
         (!has_two_columns || !has_two_rows || any[3] < 0);
}

/// The stage. Each dropped triangle is counted once, by the first reason that holds. `looks_at_samples`: true for the
/// pipelined hardware, false for the serial one. Returns whether the primitive is kept; then every field of `out`
/// that `widths` uses is set, so that one packet serves for one primitive after the other.
[[nodiscard, gnu::flatten]] inline bool cull(const PrimitivePacket& in, const Widths& widths, CounterPacket& counters,
                                             bool looks_at_samples, TrianglePacket& out) {
  const auto keep = [&](const PixelBox& box) {
    out.kind = in.kind;
    out.primitive_id = in.primitive_id;
    out.state = in.state;
    out.coordinates = in.coordinates;
    out.box = box;
  };
  if (is_counted(in.kind)) ++counters.primitives_in;
  if (in.kind != PrimitiveKind::triangle) {
    if (to_bounds(in.box).is_empty()) {
      counters.empty += is_counted(in.kind) ? 1 : 0;
      return false;
    }
    out = {};
    keep(in.box);
    if (in.kind == PrimitiveKind::state && has_state_lane(widths))
      out.vertex.code[2] = in.vertex.code[2];
    else
      out.vertex = in.vertex;
    return true;
  }
  std::array<SnappedVertex, 3> v;  // positions and depth: all that the order needs
  for (std::size_t i = 0; i < 3; ++i) {
    v[i].x = in.vertex.x[i];
    v[i].y = in.vertex.y[i];
    v[i].depth() = in.vertex.code[i][kDepthPlane];
  }
  const std::int64_t area = signed_area(v[0], v[1], v[2]);
  const CullResult result = cull(area, in.cull, in.front_cw ? FrontFace::cw : FrontFace::ccw);
  if (result != CullResult::keep) {
    ++(result == CullResult::zero_area ? counters.zero_area : counters.backface);
    return false;
  }
  const PixelBounds bounds = sample_bounds(v, to_bounds(in.box), widths.grid_bits, widths.pixel_samples);
  if (bounds.is_empty()) {
    ++counters.empty;
    return false;
  }
  keep(to_box(bounds));
  out.state.is_back = in.state.tests_stencil && shows_back(area, in.front_cw ? FrontFace::cw : FrontFace::ccw);
  const auto order = canonical_order(v, area);
  const int first_x = bounds.left >> widths.tile_shift << widths.tile_shift;  // first pixel of the first tile
  const int first_y = bounds.top >> widths.tile_shift << widths.tile_shift;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t from = order[i], to = order[(i + 1) % 3];
    out.vertex.x[i] = in.vertex.x[from];
    out.vertex.y[i] = in.vertex.y[from];
    out.vertex.code[i] = in.vertex.code[from];
    out.edge_value[i] = edge_function(v[from], v[to], first_x, first_y, widths.grid_bits);
    if (widths.has_samples != 0)
      out.edge_low[i] = static_cast<std::uint16_t>(edge_low(v[from], v[to], widths.grid_bits));
  }
  out.area = static_cast<std::uint64_t>(area < 0 ? -area : area);
  if (looks_at_samples && widths.has_samples == 0 && provably_covers_no_sample(out, v, widths)) {
    ++counters.no_sample;
    return false;
  }
  return true;
}

[[nodiscard]] inline std::optional<TrianglePacket> cull(const PrimitivePacket& in, const Widths& widths,
                                                        CounterPacket& counters, bool looks_at_samples = false) {
  std::optional<TrianglePacket> kept(std::in_place);
  if (!cull(in, widths, counters, looks_at_samples, *kept)) kept.reset();
  return kept;
}

}  // namespace halfplane
