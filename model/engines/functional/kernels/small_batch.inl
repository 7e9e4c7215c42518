// Sixteen pending small or medium triangles: their records, corners and edges, a triangle a lane.
#pragma once

#include "cull.inl"
#include "lane_memory.inl"
#include "leaf.inl"

namespace halfplane::functional::HALFPLANE_ISA_NAME {
namespace {

/// Two by two blocks in lanes of 16 bits.
struct Quad {
  static constexpr int kBlocks = 4, kPartBlocks = HALFPLANE_ISA == 512 ? 2 : 1, kParts = kBlocks / kPartBlocks;
  static constexpr std::uint64_t kPixels = std::uint64_t{kBlocks} * kBlockPixels;
  using Part = Pack<std::int16_t, kPartBlocks * kBlockPixels>;  ///< a block, or two side by side
  std::array<Part, static_cast<std::size_t>(kParts)> part;

  /// A bit for each lane whose sign is set, block after block.
  [[nodiscard]] HALFPLANE_INLINE std::uint64_t bits() const {
#if HALFPLANE_ISA == 512
    return bits_of(part[0]) | std::uint64_t{bits_of(part[1])} << 32;
#else
    return bits_of(part[0], part[1]) | std::uint64_t{bits_of(part[2], part[3])} << 32;
#endif
  }
};

/// Pending triangles of a slice, each clipped to a window of two by two tiles; and after set_up_small() their
/// constants: fields of lanes, one for each triangle.
struct SmallBatch {
  using Lane = std::array<std::int32_t, 16>;
  template <std::size_t N>
  using LaneArray = std::array<Lane, N>;
  using FourChannels = std::array<std::uint64_t, 16>;  ///< one per lane, 16 bits a channel
  static constexpr std::size_t kTiles = std::size_t{kSmallTiles} * kSmallTiles;

  int count = 0;
  std::array<const Record*, 16> records;
  alignas(64) Lane window{};  ///< from the box's first tile to the window's, pixels: column low, row high
  bool has_samples = true;    ///< the few covered samples are known for all of them

  alignas(64) LaneArray<3> corner;            ///< bytes from the slice's first vertex
  std::uint32_t live = 0;                     ///< lanes that draw something in this bin
  alignas(64) Lane left, top, right, bottom;  ///< of the part of a box that lies in the window, pixels of the bin
  alignas(64) Lane samples;                   ///< Record::samples() of the part of its box that lies in the bin

  alignas(64) LaneArray<3> edge;                    ///< at the first pixel of the first quad
  alignas(64) LaneArray<3> edge_x, edge_y;          ///< from pixel to pixel
  alignas(64) LaneArray<3> edge_aside, edge_below;  ///< from block to block; in both halves where 16 bits hold them
  alignas(64) Lane first_block;                     ///< of the first quad, among the four by four of the window
  alignas(64) Lane columns_rows;                    ///< columns and rows of blocks, less 1: two bits each
  alignas(64) Lane place;                           ///< place of the window's first tile in the bin's memory
  /// Planes at the anchors of the window's tiles, centred; colours with 16 bits a channel.
  struct alignas(256) Tile {
    Lane depth;
    FourChannels color;
  };
  std::array<Tile, kTiles> tile;
  alignas(64) Lane z_step_x, z_step_y, z_step_below;  ///< the last for block_rows<I16> rows
  alignas(64) Lane z_low, z_high;                     ///< centred, in both halves where 16 bits do
  alignas(64) FourChannels c_step_x, c_step_y;
  alignas(64) Lane c_low, c_high;  ///< a byte a channel, R lowest

  /// True if the batch is full now.
  HALFPLANE_INLINE bool add(const Record& record, std::int32_t at_window) {
    records[static_cast<std::size_t>(count)] = &record;
    window[static_cast<std::size_t>(count)] = at_window;
    return ++count == 16;
  }
};

/// Four words of each pending record, from word `from` on.
HALFPLANE_INLINE Columns words_of(const SmallBatch& batch, int from) {
  return turned_rows([&batch, from](int i) HALFPLANE_LAMBDA {
    return reinterpret_cast<const std::int32_t*>(batch.records[static_cast<std::size_t>(i)]) + from;
  });
}

/// Of sixteen records that follow each other.
HALFPLANE_INLINE Columns words_of(const Record* records, int from) {
  return turned_rows([records, from](int i)
                         HALFPLANE_LAMBDA { return reinterpret_cast<const std::int32_t*>(records + i) + from; });
}

/// Stores the words of its records in a batch; sets live.
HALFPLANE_INLINE void place_records(SmallBatch& batch, const Columns& lower, const Columns& upper, int first_x,
                                    int first_y) {
  constexpr int kRowBits = 4;
  static_assert(sizeof(VertexRow) == 1 << kRowBits);
  (lower.first << kRowBits).store(batch.corner[0].data());
  (lower.second << kRowBits).store(batch.corner[1].data());
  (lower.third << kRowBits).store(batch.corner[2].data());
  const I16 &left_top = upper.second, &right_bottom = upper.third, &traits = upper.fourth;
  const I16 covered = traits >> Record::kSamplesShift;
  batch.has_samples = !is_any(covered == 0);
  const I16 x0 = (left_top << 16 >> 16) - first_x, y0 = (left_top >> 16) - first_y;
  const I16 box_x = max(x0, I16(0)), box_y = max(y0, I16(0));
  const I16 window = I16::load(batch.window.data());
  const I16 window_x = (box_x & ~(kTileSize - 1)) + (window & 0xffff),
            window_y = (box_y & ~(kTileSize - 1)) + (window >> 16);
  max(box_x, window_x).store(batch.left.data());
  max(box_y, window_y).store(batch.top.data());
  const auto last_in = [](const I16& last, const I16& first) HALFPLANE_LAMBDA {
    return min(min(last, I16(kBinSize - 1)), first + (kSmallTiles * kTileSize - 1));
  };
  last_in((right_bottom << 16 >> 16) - first_x, window_x).store(batch.right.data());
  last_in((right_bottom >> 16) - first_y, window_y).store(batch.bottom.data());
  // The bin may hold only one column or row of two by two samples: the left one, or the right one moved there.
  constexpr std::int32_t kLeft = 1 | 4, kUpper = 1 | 2;
  const I16 in_columns =
      select(x0 < 0, shift_right_logical(covered, 1) & kLeft, select(x0 == kBinSize - 1, covered & kLeft, covered));
  const I16 in_bin = select(y0 < 0, shift_right_logical(in_columns, 2) & kUpper,
                            select(y0 == kBinSize - 1, in_columns & kUpper, in_columns));
  in_bin.store(batch.samples.data());
  batch.live =
      ((1U << batch.count) - 1) & ~bits_of(((traits & Record::kDrawsNothing) != 0) | ((covered != 0) & (in_bin == 0)));
}

/// Loads the fields of the pending records.
HALFPLANE_NOINLINE void load_records(SmallBatch& batch, int first_x, int first_y) {
  for (std::size_t i = static_cast<std::size_t>(batch.count); i < 16; ++i) batch.records[i] = batch.records[0];
  place_records(batch, words_of(batch, 0), words_of(batch, 4), first_x, first_y);
}

/// The corners of a batch's triangles in their order, b and c also relative to a; the first corner in the order of (Y,
/// X), where the planes start; and twice the area.
struct SmallCorners {
  SnappedLanes a, b, c, origin;
  I16 ax, ay, bx, by;
  I16 area, is_turned;  ///< its magnitude; a mask: it was negative
  I16 z_low, z_high;
};

/// `corner`, `live`: as SmallBatch has them; removes triangles without area from `live`. Extents of less than 2^14
/// subpixels.
HALFPLANE_INLINE SmallCorners small_corners(const SmallBatch::LaneArray<3>& corner, std::uint32_t& live,
                                            const Slice& slice) {
  const auto fetch = [&corner, vertices = reinterpret_cast<const char*>(slice.vertices.data())](std::size_t k)
                         HALFPLANE_LAMBDA {
                           return load_vertices([&corner, vertices, k](int i) HALFPLANE_LAMBDA {
                             return vertices + static_cast<std::uint32_t>(corner[k][static_cast<std::size_t>(i)]);
                           });
                         };
  const auto choose = [](const I16& sign, const SnappedLanes& p, const SnappedLanes& q) HALFPLANE_LAMBDA {
    return SnappedLanes{select_by_sign(sign, p.x, q.x), select_by_sign(sign, p.y, q.y), select_by_sign(sign, p.z, q.z),
                        select_by_sign(sign, p.rgba, q.rgba)};
  };
  const SnappedLanes a = fetch(0), b = fetch(1), c = fetch(2);
  const I16 ax = b.x - a.x, ay = b.y - a.y, bx = c.x - a.x, by = c.y - a.y;
  const I16 area = cross(ax, ay, bx, by), is_turned = area >> 31;
  live &= ~bits_of(area == 0);
  // (Y, X) relative to a, as one number.
  const I16 b_key = (ay << 16) + ax, c_key = (by << 16) + bx;
  return {a,
          b,
          c,
          choose(c_key - min(b_key, I16(0)), c, choose(b_key, b, a)),
          ax,
          ay,
          bx,
          by,
          turned(area, is_turned),
          is_turned,
          min(min(a.z, b.z), c.z),
          max(max(a.z, b.z), c.z)};
}

/// Whether 16 bits hold the edges of small and medium triangles in the quads that their boxes touch. A box of n pixels
/// has an extent below n + 1; a quad reaches less than its size beyond it.
HALFPLANE_INLINE bool are_short_edges(const Widths& widths) {
  constexpr std::int64_t kExtent = kMediumTiles * kTileSize + 1, kReach = kExtent + std::int64_t{2} * kBlockSize;
  return (2 * kExtent * kReach << widths.grid_bits) < 1 << 15;
}

/// With one sample per pixel the setup at the centres is complete. SmallSamples receives the rest.
struct OnlyCentres {
  HALFPLANE_INLINE void move_edge(std::size_t, const I16&, const I16&, const I16&, bool) {}
  template <class Steps>
  HALFPLANE_INLINE void move_depth(const Steps&, const LaneFormat&) {}
  template <class Steps>
  HALFPLANE_INLINE void move_channel(std::size_t, const Steps&, const LaneFormat&) {}
  HALFPLANE_INLINE void keep_channel(std::size_t) {}
  HALFPLANE_INLINE void join_channels() {}
};

/// `s`: bits of the subpixel grid. `is_short`: are_short_edges(). `samples`: OnlyCentres or SmallSamples.
template <class Samples>
HALFPLANE_INLINE void set_up_small_edges(SmallBatch& batch, const SmallCorners& corners, int s, bool is_short,
                                         int first_x, int first_y, Samples& samples) {
  const int half = 1 << (s - 1);
  const auto first_of_block = [&](const SmallBatch::Lane& box, int first) HALFPLANE_LAMBDA {
    return (((I16::load(box.data()) & ~(kBlockSize - 1)) + first) << s) + half;
  };
  const I16 px = first_of_block(batch.left, first_x), py = first_of_block(batch.top, first_y);
  // Swapped so that no area is negative.
  const auto& [a, b, c, origin, ax, ay, bx, by, area, is_turned, z_low, z_high] = corners;
  const std::array<I16, 4> x{a.x, select(is_turned, c.x, b.x), select(is_turned, b.x, c.x), a.x},
      y{a.y, select(is_turned, c.y, b.y), select(is_turned, b.y, c.y), a.y};
  for (std::size_t e = 0; e < 3; ++e) {
    const I16 dx = x[e + 1] - x[e], dy = y[e + 1] - y[e];
    const I16 exact = cross(dx, dy, px - x[e], py - y[e]) + ~is_top_left(dx, dy), value = exact >> s;
    samples.move_edge(e, exact, dx, dy, is_short);
    const auto store = [is_short](const I16& lanes, SmallBatch::Lane& to)
                           HALFPLANE_LAMBDA { (is_short ? doubled(lanes) : lanes).store(to.data()); };
    store(value, batch.edge[e]);
    store(-dy, batch.edge_x[e]);
    store(dx, batch.edge_y[e]);
    store(-(dy << kBlockShift), batch.edge_aside[e]);
    store(dx << kBlockShift, batch.edge_below[e]);
  }
}

/// Finds the places of the windows, and their boxes in blocks.
HALFPLANE_INLINE void find_places(SmallBatch& batch) {
  const auto block_of = [](const SmallBatch::Lane& at) HALFPLANE_LAMBDA { return I16::load(at.data()) >> kBlockShift; };
  const I16 column = block_of(batch.left), row = block_of(batch.top);
  constexpr auto kPixels = static_cast<std::int32_t>(kTilePixels);
  ((column >> 1) * kPixels + (row >> 1) * (kBinTiles * kPixels)).store(batch.place.data());
  ((column & 1) + (row & 1) * 4).store(batch.first_block.data());
  ((block_of(batch.right) - column) + (block_of(batch.bottom) - row) * 4).store(batch.columns_rows.data());
}

}  // namespace
}  // namespace halfplane::functional::HALFPLANE_ISA_NAME
