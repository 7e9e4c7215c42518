// Small and medium triangles: the blocks of 4 x 4 pixels that they cover, or their samples.
#pragma once

#include "bin.inl"
#include "deferred.inl"
#include "fragments.inl"
#include "layers.inl"
#include "small_batch.inl"
#include "small_setup.inl"
#include "texture.inl"
#include "tile_memory.inl"
#include "tiny.inl"
#include "waiting.inl"

namespace halfplane::functional::HALFPLANE_ISA_NAME {
namespace {

/// Batches after which a tile's range is found again.
constexpr std::uint8_t kTouches = 4;

/// Sets up the planes of a batch. `samples`: OnlyCentres or SmallSamples.
template <class Samples>
HALFPLANE_INLINE void set_up_batch(Bin& bin, const Slice& slice, Samples& samples) {
  const auto set_up = bin.is_short ? set_up_small<ShortArithmetic, Samples> : set_up_small<LongArithmetic, Samples>;
  set_up(bin.small, slice, bin.widths, bin.centred_depth, bin.centred_color, bin.first_x, bin.first_y, samples);
}

/// The tiles that the boxes of the batch touch in their windows, a bit each.
HALFPLANE_INLINE std::uint64_t batch_tiles(Bin& bin) {
  const auto tile_of = [](const SmallBatch::Lane& at) HALFPLANE_LAMBDA { return I16::load(at.data()) >> kTileShift; };
  const I16 left = tile_of(bin.small.left), top = tile_of(bin.small.top);
  const I16 has_right = tile_of(bin.small.right) > left, has_below = tile_of(bin.small.bottom) > top;
  const std::uint32_t live = bin.small.live, right = bits_of(has_right) & live, below = bits_of(has_below) & live;
  bin.job.counters.tiles_visited += static_cast<unsigned>(std::popcount(live) + std::popcount(right) +
                                                          std::popcount(below) + std::popcount(right & below));
  const I16 row = (has_right & 2) | 1;
  return or_of_bits(row | ((row << kBinTiles) & has_below), top * kBinTiles + left, live);
}

/// Ranges of tiles that a batch is about to write: wide from now on, but every kTouches batches `find` finds a tile's
/// range again. Returns whether it did for any.
template <class Fragments, class Find>
HALFPLANE_INLINE bool widen_ranges(Bin& bin, std::uint64_t tiles, Find&& find) {
  if (!bin.state.depth_write) return false;
  bool is_changed = false;
  for (std::uint64_t rest = tiles; rest != 0; rest &= rest - 1) {
    const auto at = static_cast<std::size_t>(std::countr_zero(rest));
    if (++bin.touches[at] == kTouches) {
      bin.touches[at] = 0;
      find(static_cast<int>(at));
      is_changed = true;
    }
    forget_range<Fragments>(bin, static_cast<int>(at));
  }
  return is_changed;
}

/// Brings the tiles of a batch to memory. Returns whether the range of one was found again.
template <class Fragments>
HALFPLANE_INLINE bool touch_tiles(Bin& bin, std::uint64_t tiles) {
  const bool is_color = bin.state.color_write && (!bin.state.has_surface || bin.has_operations);
  for (std::uint64_t rest = tiles & ~bin.in_memory; rest != 0; rest &= rest - 1) {
    const int at = std::countr_zero(rest);
    need_depth(bin, at);
    if (is_color) need_color(bin, at);
  }
  if (is_color) bin.in_memory |= tiles;
  if (bin.sees_surfaces() && !bin.has_operations)
    for (std::uint64_t rest = tiles; rest != 0; rest &= rest - 1) need_numbers(bin, std::countr_zero(rest));
  return widen_ranges<Fragments>(bin, tiles, [&bin](int tile) HALFPLANE_LAMBDA { find_range(bin, tile); });
}

/// Coverage of the triangles of a batch: for each quad that a box touches, a bit per pixel.
struct Coverage {
  static constexpr std::size_t kMost = 64;  ///< quads: four of each window
  using Blocks = std::array<std::uint16_t, kMost * Quad::kBlocks>;
  std::size_t quads = 0;
  unsigned pixels = 0;
  std::array<std::uint8_t, kMost> lane, first;  ///< and the quad's first block, among the window's blocks
  alignas(64) Blocks block;

  HALFPLANE_INLINE Coverage() = default;

  template <class Words>
  HALFPLANE_INLINE static void set_blocks(Words& blocks, std::size_t quad, std::uint64_t bits) {
    std::uint16_t* const to = &blocks[Quad::kBlocks * quad];
    if constexpr (std::endian::native == std::endian::little)
      std::memcpy(to, &bits, sizeof bits);
    else
      for (std::size_t k = 0; k < Quad::kBlocks; ++k) to[k] = static_cast<std::uint16_t>(bits >> 16 * k);
  }

  /// Quad number `at`. `bits`: block after block.
  HALFPLANE_INLINE void set(std::size_t at, std::size_t of_lane, std::int32_t first_block, std::uint64_t bits) {
    lane[at] = static_cast<std::uint8_t>(of_lane);
    first[at] = static_cast<std::uint8_t>(first_block);
    set_blocks(block, at, bits);
  }
  /// The blocks with a covered pixel in quads `from` to `from` + 15, a bit each.
  [[nodiscard]] HALFPLANE_INLINE std::uint64_t blocks(std::size_t from) const {
    const std::uint64_t some = ~bits_equal(U64::load(block.data() + Quad::kBlocks * from), U64(0));
    const std::size_t there = Quad::kBlocks * (quads - from);
    return there < 64 ? some & ((std::uint64_t{1} << there) - 1) : some;
  }
};

/// The quads of a window, two by two.
struct WindowQuads {
  std::array<std::int32_t, 4> first;                    ///< block number, from the first one
  std::array<std::array<std::uint64_t, 4>, 16> in_box;  ///< their pixels, a bit each, by SmallBatch::columns_rows
};
static constexpr WindowQuads kWindowQuads = [] {
  WindowQuads quads{};
  for (std::size_t q = 0; q < 4; ++q) {
    quads.first[q] = static_cast<std::int32_t>(q % 2 * 2 + q / 2 * 8);
    for (std::size_t box = 0; box < 16; ++box)
      for (std::size_t k = 0; k < 4; ++k)
        if (q % 2 * 2 + k % 2 <= box % 4 && q / 2 * 2 + k / 2 <= box / 4)
          quads.in_box[box][q] |= std::uint64_t{0xffff} << 16 * k;
  }
  return quads;
}();

/// A bit for each pixel of quad `q` of a window outside the triangle; where 16 bits hold its edges.
HALFPLANE_INLINE std::uint64_t outside_short(const Bin& bin, std::size_t i, std::size_t q) {
  using Part = Quad::Part;
  const Part &column = bin.position.quad_x[q % 2], &row = bin.position.quad_y[q / 2];
  Quad outside;
  HALFPLANE_EACH_PART(Quad::kParts, k, outside.part[k] = Part(0))
  for (std::size_t e = 0; e < 3; ++e) {
    const auto both = [i](const SmallBatch::Lane& of) HALFPLANE_LAMBDA { return repeated<Part>(of[i]); };
    const Part below = both(bin.small.edge_below[e]);
    Part value = column * both(bin.small.edge_x[e]) + row * both(bin.small.edge_y[e]) + both(bin.small.edge[e]);
    constexpr std::size_t kLower = Quad::kParts / 2;
    outside.part[0] |= value;
    outside.part[kLower] |= value + below;
    if constexpr (Quad::kPartBlocks == 1) {
      value += both(bin.small.edge_aside[e]);
      outside.part[1] |= value;
      outside.part[kLower + 1] |= value + below;
    }
  }
  return outside.bits();
}

/// The same in 32 bits.
HALFPLANE_INLINE std::uint64_t outside_long(const Bin& bin, std::size_t i, std::size_t q) {
  constexpr int kSize = 2 * kBlockSize;
  const I16 column = bin.position.block_x + static_cast<std::int32_t>(q % 2) * kSize,
            row = bin.position.block_y + static_cast<std::int32_t>(q / 2) * kSize;
  std::array<I16, Quad::kBlocks> outside;
  for (I16& block : outside) block = I16(0);
  for (std::size_t e = 0; e < 3; ++e) {
    const I16 aside = I16(bin.small.edge_aside[e][i]), below = I16(bin.small.edge_below[e][i]),
              value = column * bin.small.edge_x[e][i] + row * bin.small.edge_y[e][i] + bin.small.edge[e][i];
    outside[0] |= value;
    outside[1] |= value + aside;
    outside[2] |= value + below;
    outside[3] |= value + below + aside;
  }
  std::uint64_t bits = 0;
  for (std::size_t k = 0; k < outside.size(); ++k) bits |= std::uint64_t{bits_of(outside[k])} << 16 * k;
  return bits;
}

template <bool kShort>
HALFPLANE_INLINE void find_covered(const Bin& bin, std::uint64_t quads, Coverage& covered) {
  std::size_t at = 0;  // not in memory: the compiler must assume that byte stores change it
  unsigned pixels = 0;
  for (; quads != 0; quads &= quads - 1, ++at) {
    const auto number = static_cast<std::size_t>(std::countr_zero(quads)), i = number / 4, q = number % 4;
    const std::uint64_t in_box = kWindowQuads.in_box[static_cast<std::size_t>(bin.small.columns_rows[i])][q],
                        bits = in_box & ~(kShort ? outside_short(bin, i, q) : outside_long(bin, i, q));
    covered.set(at, i, bin.small.first_block[i] + kWindowQuads.first[q], bits);
    pixels += static_cast<unsigned>(std::popcount(bits));
  }
  covered.quads = at;
  covered.pixels = pixels;
}
/// The quads that boxes touch: four bits for each lane.
HALFPLANE_INLINE std::uint64_t live_quads(const Bin& bin) {
  const I16 columns_rows = I16::load(bin.small.columns_rows.data());
  // A second column of quads, a second row, and both.
  const I16 aside = shift_right_logical(columns_rows, 1) & 1, below = shift_right_logical(columns_rows, 3);
  const I16 is_live = (I16::of([](int i) { return 1 << i; }) & static_cast<std::int32_t>(bin.small.live)) != 0;
  return nibbles_of(((aside << 1) + 1) * ((below << 2) + 1) & is_live);
}
/// Finds the coverage, triangle by triangle.
HALFPLANE_INLINE void find_covered(Bin& bin, Coverage& covered) {
  const std::uint64_t quads = live_quads(bin);
  bin.has_short_edges ? find_covered<true>(bin, quads, covered) : find_covered<false>(bin, quads, covered);
  bin.job.counters.samples_tested += Quad::kPixels * covered.quads;
}

/// A block's depths in lanes of 32 bits while they are tested. `Memory`: BinMemory or SampleMemory.
struct WideTest {
  static constexpr unsigned kCount = 1;  ///< bits of count() per pixel
  const Bin& bin;
  std::int32_t bias;
  bool is_narrow;
  std::uint16_t* narrow;
  std::int32_t* wide;

  template <class Memory>
  HALFPLANE_INLINE WideTest(const Bin& bin_, Memory& memory)
      : bin(bin_),
        bias(bin_.depth_format.bias),
        is_narrow(bin_.is_narrow),
        narrow(memory.narrow_depth.data()),
        wide(memory.depth.data()) {}
  /// All three values centred.
  HALFPLANE_INLINE I16 codes(const I16& code, std::int32_t low, std::int32_t high) const {
    return min(max(code, I16(low)), I16(high)) + bias;
  }
  HALFPLANE_INLINE I16 load(std::size_t at) const {
    return is_narrow ? load_narrow(narrow + at) : I16::load(wide + at);
  }
  HALFPLANE_INLINE void store(std::size_t at, const I16& depth) const {
    if (is_narrow)
      store_narrow(depth, narrow + at);
    else
      depth.store(wide + at);
  }
#if HALFPLANE_ISA == 512
  using Passed = std::uint32_t;
  /// Covered and passing pixels: a bit each.
  template <class Fragments>
  HALFPLANE_INLINE static std::uint32_t passed(const SliceState& state, std::uint32_t covered, const I16& depth,
                                               const I16& stored) {
    if (Fragments::kIsLess) return bits_below(covered, depth, stored);
    return covered & bits_of(Fragments::passes(state, depth, stored));
  }
  HALFPLANE_INLINE static unsigned count(std::uint32_t pixels) { return static_cast<unsigned>(std::popcount(pixels)); }
  HALFPLANE_INLINE static std::uint32_t bits(std::uint32_t pixels) { return pixels; }
  HALFPLANE_INLINE I16 choose(std::uint32_t pixels, const I16& a, const I16& b) const {
    return select_by_bits(pixels, a, b, bin.position.to_sign);
  }
  /// Writes a triangle's number. The old number is not read: the next triangle need not wait for it.
  HALFPLANE_INLINE static void put_number(std::uint32_t pixels, std::int32_t number, std::uint16_t* to) {
    _mm256_mask_storeu_epi16(to, static_cast<__mmask16>(pixels), _mm256_set1_epi16(static_cast<std::int16_t>(number)));
  }
#else
  using Passed = I16;
  /// Covered and passing pixels: the signs of lanes.
  template <class Fragments>
  HALFPLANE_INLINE I16 passed(const SliceState& state, std::uint32_t covered, const I16& depth,
                              const I16& stored) const {
    return (I16(static_cast<std::int32_t>(covered)) << bin.position.to_sign) & Fragments::passes(state, depth, stored);
  }
  HALFPLANE_INLINE static unsigned count(const I16& pixels) {
    return static_cast<unsigned>(std::popcount(bits_of(pixels)));
  }
  HALFPLANE_INLINE static std::uint32_t bits(const I16& pixels) { return bits_of(pixels); }
  HALFPLANE_INLINE static I16 choose(const I16& pixels, const I16& a, const I16& b) {
    return select_by_sign(pixels, a, b);
  }
  /// Writes a triangle's number.
  HALFPLANE_INLINE static void put_number(const I16& pixels, std::int32_t number, std::uint16_t* to) {
    store_narrow(choose(pixels, I16(number), load_narrow(to)), to);
  }
#endif
  template <class Pixels>
  HALFPLANE_INLINE I16 choose_color(const Pixels& pixels, const I16& a, const I16& b) const {
    return choose(pixels, a, b);
  }
};

#if HALFPLANE_ISA == 512
using NarrowTest = WideTest;
#else
/// The same in 16 bits, with half as many registers: for bins that keep depths in 16 bits.
struct NarrowTest {
  static constexpr unsigned kCount = kCountOfLane;
  using Passed = S16;
  std::uint16_t* depths;
  std::int16_t bias;

  template <class Memory>
  HALFPLANE_INLINE NarrowTest(const Bin& bin, Memory& memory)
      : depths(memory.narrow_depth.data()), bias(static_cast<std::int16_t>(bin.depth_format.bias)) {}
  /// `low`, `high`: in both halves.
  HALFPLANE_INLINE static S16 codes(const I16& code, std::int32_t low, std::int32_t high) {
    return min(max(saturated(code), repeated<S16>(low)), repeated<S16>(high));
  }
  HALFPLANE_INLINE S16 load(std::size_t at) const { return S16::load(depths + at) - bias; }
  HALFPLANE_INLINE void store(std::size_t at, const S16& depth) const { (depth + bias).store(depths + at); }
  template <class Fragments>
  HALFPLANE_INLINE static S16 passed(const SliceState& state, std::uint32_t covered, const S16& depth,
                                     const S16& stored) {
    return block_lanes_of(covered) & Fragments::passes(state, depth, stored);
  }
  HALFPLANE_INLINE static unsigned count(const S16& pixels) { return count_of(pixels); }
  HALFPLANE_INLINE static std::uint32_t bits(const S16& pixels) { return bits_of(widened(pixels)); }
  HALFPLANE_INLINE static S16 choose(const S16& pixels, const S16& a, const S16& b) { return select(pixels, a, b); }
  HALFPLANE_INLINE static I16 choose_color(const S16& pixels, const I16& a, const I16& b) {
    return select(widened(pixels), a, b);
  }
  HALFPLANE_INLINE static void put_number(const S16& pixels, std::int32_t number, std::uint16_t* to) {
    store_narrow(choose_color(pixels, I16(number), load_narrow(to)), to);
  }
};
#endif

/// The blocks of a window, row after row.
struct alignas(16) WindowBlock {
  std::uint32_t place;        ///< from the window's first tile in the bin's memory
  std::uint32_t tile, block;  ///< index in the window, in its tile
};
/// By the first block of a quad; blocks beyond the window are touched by no box.
static constexpr std::array<std::array<WindowBlock, Quad::kBlocks>, 16> kWindowBlocks = [] {
  std::array<std::array<WindowBlock, Quad::kBlocks>, 16> blocks{};
  for (std::uint32_t first = 0; first < 16; ++first)
    for (std::uint32_t k = 0; k < Quad::kBlocks; ++k) {
      const std::uint32_t column = first % 4 + k % 2, row = first / 4 + k / 2, block = column % 2 + row % 2 * 2;
      blocks[first][k] = {(column / 2 + row / 2 * kBinTiles) * kTileSize * kTileSize + block * kBlockPixels,
                          column / 2 + row / 2 * kSmallTiles, block};
    }
  return blocks;
}();

/// Colours of a block of lane i.
template <Writes kColor>
HALFPLANE_INLINE I16 small_colors(const Bin& bin, std::size_t i, const SmallBatch::Tile& tile,
                                  const LanePositions::Block& block, int down) {
  const SmallBatch& batch = bin.small;
  const S32 step_x = repeated(batch.c_step_x[i]), step_y = repeated(batch.c_step_y[i]);
  const S32 left = block_plane(block.channel_column, block.channel_row, step_x, step_y, step_y * block_rows<S32>,
                               repeated(tile.color[i])),
            right = left + (step_x << 1);
  const I16 rgba =
      ColorRange::clamped(saturated(left >> down, right >> down), I16(batch.c_low[i]), I16(batch.c_high[i]));
  return kColor == Writes::other ? packed_at(bin.position.lane, rgba, bin.packing) : rgba;
}

/// Colours of a draw with is_over(), blended upon the stored ones.
HALFPLANE_INLINE I16 blended_colors(const I16& rgba, const I16& stored, std::int32_t own_factor,
                                    const Packing& packing) {
  const ColorPairs mixed = laid_over(ColorPairs(rgba), widened(stored, packing.format), own_factor);
  return packed(mixed.red_blue, mixed.green_alpha, packing);
}

/// Depth, test and colour of the partially covered blocks. The state says which buffers are written.
template <class Fragments, class Test, bool kDepth, Writes kColor>
HALFPLANE_INLINE void draw_blocks(Bin& bin, const Coverage& covered) {
  const SmallBatch& batch = bin.small;
  const SliceState state = bin.state;
  const LanePositions& position = bin.position;
  const Test test(bin, bin.memory);
  std::uint32_t* const colors = bin.memory.color.data();
  std::uint16_t* const surfaces = bin.memory.surface.data();
  const int depth_down = bin.centred_depth.down, color_down = bin.centred_color.down;
  std::uint32_t* const sources = bin.memory.source.data();
  const bool is_skipping = kColor == Writes::laid_over || kColor == Writes::operated ? bin.skip.operations_early_z
                                                                                     : bin.skip.fragments_early_z;
  const Packing packing = bin.packing;
  const std::int32_t own_factor = own_factor_bits(bin.ops->color);
  unsigned passed_pixels = 0;
  for (std::size_t first = 0; first < covered.quads; first += 16)
    for (std::uint64_t rest = covered.blocks(first); rest != 0; rest &= rest - 1) {
      const std::size_t number = Quad::kBlocks * first + static_cast<std::size_t>(std::countr_zero(rest));
      const std::size_t quad = number / Quad::kBlocks, i = covered.lane[quad];
      const WindowBlock& in_window = kWindowBlocks[covered.first[quad]][number % Quad::kBlocks];
      const SmallBatch::Tile& tile = batch.tile[in_window.tile];
      const LanePositions::Block& block = position.block[in_window.block];
      const auto at = static_cast<std::size_t>(batch.place[i]) + in_window.place;
      const I16 value = block_plane(block.column, block.row, I16(batch.z_step_x[i]), I16(batch.z_step_y[i]),
                                    I16(batch.z_step_below[i]), I16(tile.depth[i]));
      const auto depth = test.codes(value >> depth_down, batch.z_low[i], batch.z_high[i]), stored = test.load(at);
      const auto passed = test.template passed<Fragments>(state, covered.block[number], depth, stored);
      const unsigned count = test.count(passed);
      passed_pixels += count;
      if (count == 0 && is_skipping) continue;
      if (kDepth) test.store(at, test.choose(passed, depth, stored));
      if (kColor == Writes::nothing) continue;
      if (kColor == Writes::operated) wait_for_operations(bin, at, test.bits(passed));
      if (kColor == Writes::surface || (kColor == Writes::operated && state.has_surface)) {
        test.put_number(passed, bin.batch_surface + static_cast<std::int32_t>(i), surfaces + at);
        continue;
      }
      std::uint32_t* const to = (kColor == Writes::operated ? sources : colors) + at;
      const I16 color = small_colors<kColor>(bin, i, tile, block, color_down), old = I16::load(to);
      if constexpr (kColor == Writes::laid_over)
        test.choose_color(passed, blended_colors(color, old, own_factor, packing), old).store(to);
      else
        test.choose_color(passed, color, old).store(to);
    }
  count_fragments(bin, covered.pixels, passed_pixels / Test::kCount);
}
template <class Fragments, class Test, bool kDepth>
HALFPLANE_INLINE void draw_blocks(Bin& bin, const Coverage& covered) {
  if (!bin.state.color_write) return draw_blocks<Fragments, Test, kDepth, Writes::nothing>(bin, covered);
  if (bin.is_operated()) return draw_blocks<Fragments, Test, kDepth, Writes::operated>(bin, covered);
  if (bin.has_operations) return draw_blocks<Fragments, Test, kDepth, Writes::laid_over>(bin, covered);
  if (bin.state.has_surface) return draw_blocks<Fragments, Test, kDepth, Writes::surface>(bin, covered);
  bin.config.color_format == ColorFormat::rgba8888
      ? draw_blocks<Fragments, Test, kDepth, Writes::rgba8888>(bin, covered)
      : draw_blocks<Fragments, Test, kDepth, Writes::other>(bin, covered);
}
template <class Fragments, class Test>
HALFPLANE_INLINE void draw_blocks(Bin& bin, const Coverage& covered) {
  bin.state.depth_write ? draw_blocks<Fragments, Test, true>(bin, covered)
                        : draw_blocks<Fragments, Test, false>(bin, covered);
}

}  // namespace
}  // namespace halfplane::functional::HALFPLANE_ISA_NAME
