// Cull: drops triangles of no area, those that face the wrong way, and those without a pixel centre in the scissor.
//
// In: a PrimitivePacket. Out: a TrianglePacket in canonical order with its area and box, or nothing. Positive area =
// clockwise as seen on the screen (y down). Other kinds than triangles pass as they are, unless their box is empty.
#pragma once

#include <algorithm>
#include <optional>

#include "../packets.hpp"
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

enum class CullResult { keep, backface, zero_area };

/// `backface` stands for whichever side `mode` removes.
[[nodiscard]] constexpr CullResult cull(std::int64_t area, Cull mode, FrontFace front) {
  if (area == 0) return CullResult::zero_area;
  const bool is_front = (area > 0) == (front == FrontFace::cw);
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
  /// Pixels of it. Precondition: not empty.
  [[nodiscard]] constexpr std::uint64_t samples() const {
    return static_cast<std::uint64_t>(right - left + 1) * static_cast<std::uint64_t>(bottom - top + 1);
  }
};

/// The pixels whose centres lie in the triangle's bounding box and in `limit`.
[[nodiscard]] inline PixelBounds pixel_bounds(const std::array<SnappedVertex, 3>& v, const PixelBounds& limit,
                                              int grid_bits) {
  const std::int32_t half = std::int32_t{1} << (grid_bits - 1);
  const auto [x_min, x_max] = std::minmax({v[0].x, v[1].x, v[2].x});
  const auto [y_min, y_max] = std::minmax({v[0].y, v[1].y, v[2].y});
  // First pixel whose centre is >= min, last whose centre is <= max.
  return {std::max(limit.left, (x_min + half - 1) >> grid_bits), std::max(limit.top, (y_min + half - 1) >> grid_bits),
          std::min(limit.right, (x_max - half) >> grid_bits), std::min(limit.bottom, (y_max - half) >> grid_bits)};
}

/// Positive area and smallest (Y, X, Z) first: all six orders of the vertices become one.
[[nodiscard]] inline std::array<SnappedVertex, 3> canonical(const std::array<SnappedVertex, 3>& v, std::int64_t area) {
  const auto first = static_cast<std::size_t>(std::min_element(v.begin(), v.end(), canonically_before) - v.begin());
  std::array<SnappedVertex, 3> order{v[first], v[(first + 1) % 3], v[(first + 2) % 3]};
  if (area < 0) std::swap(order[1], order[2]);
  return order;
}

/// The vertices of a PrimitivePacket or TrianglePacket. A channel that is not stored is 0.
template <class Packet>
[[nodiscard]] std::array<SnappedVertex, 3> vertices_of(const Packet& packet) {
  std::array<SnappedVertex, 3> v;
  for (std::size_t i = 0; i < 3; ++i) {
    v[i] = {packet.x[i], packet.y[i], packet.z[i], {}};
    for (std::size_t c = 0; c < 4; ++c) v[i].rgba[c] = static_cast<std::uint8_t>(packet.rgba[i] >> 8 * c);
  }
  return v;
}

/// The channels as a packet holds them: R lowest, those that are not stored left out.
[[nodiscard]] inline std::uint32_t packet_color(const std::array<std::uint8_t, 4>& rgba, const Widths& widths) {
  std::uint32_t packed = 0;
  for (std::size_t c = 0; c < static_cast<std::size_t>(widths.color_channels); ++c)
    packed |= std::uint32_t{rgba[c]} << 8 * c;
  return packed;
}

/// The other way: makes `v` the vertices of the packet.
template <class Packet>
void set_vertices(Packet& packet, const std::array<SnappedVertex, 3>& v, const Widths& widths) {
  for (std::size_t i = 0; i < 3; ++i) {
    packet.x[i] = v[i].x;
    packet.y[i] = v[i].y;
    packet.z[i] = v[i].z;
    packet.rgba[i] = packet_color(v[i].rgba, widths);
  }
}

/// Takes bounds that lie inside the target.
inline void set_box(PixelBox& box, const PixelBounds& bounds) {
  box.left = static_cast<std::uint16_t>(bounds.left);
  box.top = static_cast<std::uint16_t>(bounds.top);
  box.right = static_cast<std::uint16_t>(bounds.right);
  box.bottom = static_cast<std::uint16_t>(bounds.bottom);
}

/// The stage. Each dropped triangle is counted once, by the first reason that holds.
[[nodiscard]] inline std::optional<TrianglePacket> cull(const PrimitivePacket& in, const Widths& widths,
                                                        CounterPacket& counters) {
  TrianglePacket out;
  static_cast<PrimitiveState&>(out) = in;
  out.kind = in.kind;
  out.primitive_id = in.primitive_id;
  const auto v = vertices_of(in);
  if (is_counted(in.kind)) ++counters.primitives_in;
  if (in.kind != static_cast<std::uint8_t>(PrimitiveKind::triangle)) {
    if (in.left > in.right || in.top > in.bottom) {
      if (is_counted(in.kind)) ++counters.empty;
      return std::nullopt;
    }
    static_cast<PixelBox&>(out) = in;
    set_vertices(out, v, widths);
    return out;
  }
  const std::int64_t area = signed_area(v[0], v[1], v[2]);
  const CullResult result = cull(area, static_cast<Cull>(in.cull), in.front_cw != 0 ? FrontFace::cw : FrontFace::ccw);
  if (result != CullResult::keep) {
    ++(result == CullResult::zero_area ? counters.zero_area : counters.backface);
    return std::nullopt;
  }
  const PixelBounds bounds = pixel_bounds(v, {in.left, in.top, in.right, in.bottom}, widths.grid_bits);
  if (bounds.is_empty()) {
    ++counters.empty;
    return std::nullopt;
  }
  set_box(out, bounds);
  const auto order = canonical(v, area);
  set_vertices(out, order, widths);
  const int first_x = out.left >> widths.tile_shift << widths.tile_shift;  // first pixel of the first tile
  const int first_y = out.top >> widths.tile_shift << widths.tile_shift;
  for (std::size_t i = 0; i < 3; ++i)
    out.edge_value[i] = edge_function(order[i], order[(i + 1) % 3], first_x, first_y, widths.grid_bits);
  out.area = static_cast<std::uint64_t>(area < 0 ? -area : area);
  return out;
}

}  // namespace halfplane
