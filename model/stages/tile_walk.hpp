// The tiles of a primitive, as coarse_raster walks them: edges at the first pixel of each, their sort into outside, cut and
// inside, the way through them, and their packets. A tile is outside when the largest value of one edge over its pixels is
// negative (trivial reject), inside when the smallest value of every edge is not (trivial accept), cut otherwise.
#pragma once

#include <algorithm>

#include "cull.hpp"
#include "triangle_setup.hpp"

namespace halfplane {

enum class TileClass { outside, cut, inside };

/// The largest value of an edge over the pixels of a tile with `value` at its first pixel. dx, dy: subpixels.
[[nodiscard]] constexpr EdgeValue largest_in_tile(EdgeValue value, EdgeValue dx, EdgeValue dy, int tile_size) {
  return value + (tile_size - 1) * ((dx > 0 ? dx : 0) + (dy < 0 ? -dy : 0));
}
[[nodiscard]] constexpr EdgeValue smallest_in_tile(EdgeValue value, EdgeValue dx, EdgeValue dy, int tile_size) {
  return value + (tile_size - 1) * ((dx < 0 ? dx : 0) + (dy > 0 ? -dy : 0));
}

/// `edge_dx`, `edge_dy`: of the three edges; `value`: at the tile's first pixel.
[[nodiscard]] constexpr TileClass classify(const EdgeDeltas& edge_dx, const EdgeDeltas& edge_dy,
                                           const EdgeValues& value, int tile_size) {
  TileClass result = TileClass::inside;
  for (std::size_t i = 0; i < 3; ++i) {
    if (largest_in_tile(value[i], edge_dx[i], edge_dy[i], tile_size) < 0) return TileClass::outside;
    if (smallest_in_tile(value[i], edge_dx[i], edge_dy[i], tile_size) < 0) result = TileClass::cut;
  }
  return result;
}

/// The edges that a tile lies outside of, a bit each.
[[nodiscard]] constexpr unsigned outside_edges(const EdgeDeltas& edge_dx, const EdgeDeltas& edge_dy,
                                               const EdgeValues& value, int tile_size) {
  unsigned edges = 0;
  for (std::size_t i = 0; i < 3; ++i)
    if (largest_in_tile(value[i], edge_dx[i], edge_dy[i], tile_size) < 0) edges |= 1U << i;
  return edges;
}

/// With several samples per pixel, the edge values moved as far out or in as a sample may lie: with them a tile is
/// outside when no sample can be inside an edge, and inside when all are.
[[nodiscard]] inline EdgeValues moved_by_samples(EdgeValues value, const EdgeDeltas& dx, const EdgeDeltas& dy,
                                                 bool outwards, const Widths& widths) {
  if (widths.has_samples == 0) return value;
  for (std::size_t i = 0; i < 3; ++i) {
    const EdgeValue reach = sample_edge_reach(dx[i], dy[i]);
    value[i] += outwards ? reach : -reach;
  }
  return value;
}

/// The edges of a primitive at its tiles, and what these have in common.
class TileEdges {
 public:
  TileEdges(const SetupPacket& setup, const Widths& widths);

  /// edges_at_tile().
  [[nodiscard]] EdgeValues at(int tile_x, int tile_y) const {
    EdgeValues value;
    for (std::size_t i = 0; i < 3; ++i) value[i] = value_[i] + step_x_[i] * tile_x + step_y_[i] * tile_y;
    return value;
  }
  /// outside_edges() and whether the tile is inside all of them, with several samples as far as a sample may lie.
  /// `value`: of the edges at the tile's first pixel.
  [[nodiscard]] unsigned outside(const EdgeValues& value) const {
    unsigned edges = 0;
    for (std::size_t i = 0; i < 3; ++i) edges |= value[i] + largest_[i] < 0 ? 1U << i : 0;
    return edges;
  }
  [[nodiscard]] bool is_inside(const EdgeValues& value) const {
    return ((value[0] + smallest_[0]) | (value[1] + smallest_[1]) | (value[2] + smallest_[2])) >= 0;
  }

 private:
  EdgeValues value_, step_x_, step_y_;  ///< at tile (0, 0); per tile
  EdgeValues largest_, smallest_;       ///< over a tile, from the value at its first pixel
};

/// The planes of a primitive at its tiles.
class TilePlanes {
 public:
  TilePlanes(const SetupPacket& setup, const Widths& widths);

  /// Their local anchors, `right` and `down` tiles from the first one.
  void set_anchors(int right, int down, PerPlane<std::int64_t>& anchor) const {
    const auto x = static_cast<std::uint64_t>(std::int64_t{right}), y = static_cast<std::uint64_t>(std::int64_t{down});
    for (std::size_t p = 0; p < planes_; ++p)
      anchor[p] = static_cast<std::int64_t>(value_[p] + step_x_[p] * x + step_y_[p] * y) >> unused_[p];
  }

 private:
  std::size_t planes_;
  PerPlane<std::uint64_t> value_, step_x_, step_y_;  ///< per tile: their bits are the upper ones
  PerPlane<std::uint8_t> unused_;                    ///< bits of 64 that a local anchor does not have
};

/// A tile that a primitive is drawn in.
struct VisitedTile {
  int x = 0, y = 0;
  EdgeValues edges{};  ///< at its first pixel
  TileBox box;         ///< pixels of the tile inside the primitive's box
  bool is_inside = false, ends_primitive = false;
};

/// The way through the tiles of a primitive's box. A row is walked to the right from its start, then from there to the
/// left, each way until the tile is outside an edge whose value does not grow in that direction, so no tile is missed
/// wherever the walk starts. It starts below the first tile of the row above that was not outside.
class TileWalk {
 public:
  /// Tiles, inclusive; edge deltas, 0 for a primitive without edges.
  TileWalk(int first_x, int first_y, int last_x, int last_y, const EdgeDeltas& edge_dy)
      : x_(first_x), y_(first_y), first_x_(first_x), last_x_(last_x), last_y_(last_y), start_x_(first_x) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (edge_dy[i] >= 0) no_better_right_ |= 1U << i;
      if (edge_dy[i] <= 0) no_better_left_ |= 1U << i;
    }
  }

  [[nodiscard]] int x() const { return x_; }
  [[nodiscard]] int y() const { return y_; }
  /// Whether the walk ends with this tile, if it is not outside.
  [[nodiscard]] bool is_last() const { return is_last_column() && !must_return_ && y_ == last_y_; }

  /// Moves from a tile that lies outside these edges to the next tile. False: there is none.
  bool next(unsigned outside) {
    if ((outside & no_better_left_) != 0) must_return_ = false;  // nothing lies to the left of it
    const bool exits = is_last_column() || (outside & (goes_left_ ? no_better_left_ : no_better_right_)) != 0;
    if (exits && !must_return_) {
      if (y_ == last_y_) return false;
      ++y_;
      x_ = start_x_;
      goes_left_ = false;
      must_return_ = start_x_ != first_x_;
      is_empty_ = true;
      return true;
    }
    if (exits) {
      x_ = start_x_ - 1;
      goes_left_ = true;
      must_return_ = false;
    } else {
      x_ += goes_left_ ? -1 : 1;
    }
    is_empty_ = is_empty_ && outside != 0;
    if (is_empty_) start_x_ = x_;
    return true;
  }

 private:
  [[nodiscard]] bool is_last_column() const { return x_ == (goes_left_ ? first_x_ : last_x_); }

  int x_, y_;
  int first_x_, last_x_, last_y_;
  int start_x_;                                        ///< of this row, then of the next
  unsigned no_better_right_ = 0, no_better_left_ = 0;  ///< edges whose value does not grow in that direction
  bool goes_left_ = false;
  bool must_return_ = false;  ///< there are tiles to the left of the start
  bool is_empty_ = true;      ///< every tile of the row so far was outside
};

[[nodiscard]] constexpr TileClass classify(const TriangleSetup& setup, const EdgeValues& value, int tile_size) {
  const auto& edge = setup.edge;
  return classify({edge[0].dx, edge[1].dx, edge[2].dx}, {edge[0].dy, edge[1].dy, edge[2].dy}, value, tile_size);
}

/// The narrow edge value of a tile packet.
[[nodiscard]] inline std::int32_t saturate_tile_edge(EdgeValue value, const Widths& widths) {
  const auto low = static_cast<EdgeValue>(widths.tile_edge.range.lo),
             high = static_cast<EdgeValue>(widths.tile_edge.range.hi);
  return static_cast<std::int32_t>(std::clamp(value, low, high));
}

/// Edge values at the first pixel of tile (tile_x, tile_y).
[[nodiscard]] inline EdgeValues edges_at_tile(const TriangleSetup& setup, int tile_x, int tile_y,
                                              const Widths& widths) {
  const int steps_x = (tile_x - (setup.left >> widths.tile_shift)) << widths.tile_shift;
  const int steps_y = (tile_y - (setup.top >> widths.tile_shift)) << widths.tile_shift;
  EdgeValues value;
  for (std::size_t i = 0; i < 3; ++i)
    value[i] = setup.edge[i].value - EdgeValue{steps_x} * setup.edge[i].dy + EdgeValue{steps_y} * setup.edge[i].dx;
  return value;
}

/// The same of a packet.
[[nodiscard]] inline EdgeValues edges_at_tile(const SetupPacket& setup, int tile_x, int tile_y, const Widths& widths) {
  const int steps_x = (tile_x - (setup.box.left >> widths.tile_shift)) << widths.tile_shift;
  const int steps_y = (tile_y - (setup.box.top >> widths.tile_shift)) << widths.tile_shift;
  EdgeValues value;
  for (std::size_t i = 0; i < 3; ++i)
    value[i] = setup.edge_value[i] - EdgeValue{steps_x} * setup.dy[i] + EdgeValue{steps_y} * setup.dx[i];
  return value;
}

/// The visit of tile (tile_x, tile_y), and its packet. `slot` is the context slot of the primitive; `ends`: no other
/// follows. The first form of the packet sets every field that `widths` uses, so that one packet serves for one tile
/// after the other.
[[nodiscard]] inline VisitedTile visited_tile(const SetupPacket& setup, const TileEdges& edges, const EdgeValues& value,
                                              int tile_x, int tile_y, bool ends, const Widths& widths) {
  const int last = (1 << widths.tile_shift) - 1, left = tile_x << widths.tile_shift, top = tile_y << widths.tile_shift;
  const auto in_tile = [last](int pixel) { return static_cast<std::uint8_t>(std::clamp(pixel, 0, last)); };
  const PixelBox& box = setup.box;
  return {tile_x,
          tile_y,
          value,
          {in_tile(box.left - left), in_tile(box.top - top), in_tile(box.right - left), in_tile(box.bottom - top)},
          edges.is_inside(value),
          ends};
}
void make_tile_packet(const SetupPacket& setup, const TilePlanes& planes, const VisitedTile& tile, std::uint8_t slot,
                      const Widths& widths, TilePacket& packet);
[[nodiscard]] TilePacket make_tile_packet(const SetupPacket& setup, int tile_x, int tile_y, std::uint8_t slot,
                                          bool ends, const Widths& widths);

/// The content of the context RAM for a primitive. The first form sets every field that `widths` uses, as above.
void make_context(const SetupPacket& setup, const Widths& widths, ContextPacket& context);
[[nodiscard]] ContextPacket make_context(const SetupPacket& setup, const Widths& widths);

}  // namespace halfplane
