// Clear flags: a bit for each block and buffer; set: memory is stale there, and the value of the last fast clear
// counts. A block is the content of a cache line (BlockGrid): 4x4 pixels, or with cache.kind tiles a tile. A fast clear
// sets flags a word at a time; a flag falls when its block goes to memory; the others survive a flush, which writes the
// words, or the clear colours themselves.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "../packets/packets.hpp"

namespace halfplane {

/// A block of the target, in blocks.
struct BlockAddress {
  std::uint16_t x = 0, y = 0;
  bool operator==(const BlockAddress&) const = default;
};

/// A stamp, by its tile or by its block.
struct StampAddress {
  std::uint16_t tile_x = 0, tile_y = 0, stamp = 0;
};
struct BlockStamp {
  BlockAddress block;
  int stamp = 0;  ///< row-major number in the block
};

[[nodiscard]] inline BlockStamp block_stamp(const StampAddress& at, const Widths& widths) {
  const BlockGrid& grid = widths.blocks;
  const int x = widths.stamps.column_of(at.stamp), y = widths.stamps.row_of(at.stamp), last = grid.side - 1;
  return {{static_cast<std::uint16_t>((at.tile_x << grid.per_tile_log2) + (x >> grid.side_log2)),
           static_cast<std::uint16_t>((at.tile_y << grid.per_tile_log2) + (y >> grid.side_log2))},
          ((y & last) << grid.side_log2) + (x & last)};
}

[[nodiscard]] inline StampAddress stamp_address(const BlockStamp& at, const Widths& widths) {
  const BlockGrid& grid = widths.blocks;
  const int last = grid.per_tile - 1;  // block of a tile
  const int x = ((at.block.x & last) << grid.side_log2) + (at.stamp & (grid.side - 1));
  const int y = ((at.block.y & last) << grid.side_log2) + (at.stamp >> grid.side_log2);
  return {static_cast<std::uint16_t>(at.block.x >> grid.per_tile_log2),
          static_cast<std::uint16_t>(at.block.y >> grid.per_tile_log2),
          static_cast<std::uint16_t>(widths.stamps.stamp_number(x, y))};
}

/// The address of a request for a word of flags: word x of the row y of blocks.
[[nodiscard]] inline StampAddress flag_word_address(int word, int y, const Widths& widths) {
  const int per_tile = widths.blocks.per_tile;
  return {static_cast<std::uint16_t>(word), static_cast<std::uint16_t>(y / per_tile),
          static_cast<std::uint16_t>(y % per_tile)};
}

/// Index of a buffer in arrays over both.
[[nodiscard]] constexpr std::size_t number(TilePlane plane) { return static_cast<std::size_t>(plane); }

[[nodiscard]] constexpr TilePlane flags_of(TilePlane plane) {
  return static_cast<TilePlane>(static_cast<unsigned>(plane) | 2U);
}

/// A bit for each block of the widest target.
class BlockBits {
 public:
  explicit BlockBits(const Widths& widths)
      : per_tile_(widths.blocks.per_tile),
        word_(widths.blocks.flag_word),
        row_((static_cast<std::size_t>(widths.tiles_x * per_tile_ - 1) / static_cast<std::size_t>(word_) + 1) *
             static_cast<std::size_t>(word_)),
        is_set_(row_ * static_cast<std::size_t>(widths.tiles_y * per_tile_)) {}

  [[nodiscard]] bool is_set(const BlockAddress& block) const { return is_set_[index(block.x, block.y)] != 0; }
  void set(const BlockAddress& block, bool value) { is_set_[index(block.x, block.y)] = value ? 1 : 0; }
  /// Sets the bits of tiles (0, 0) to (last_x, last_y).
  void set_tiles(int last_x, int last_y, bool value) {
    for (int y = 0; y < (last_y + 1) * per_tile_; ++y)
      std::fill_n(is_set_.begin() + static_cast<std::ptrdiff_t>(index(0, y)), (last_x + 1) * per_tile_, value ? 1 : 0);
  }

  void set_blocks(const BlockAddress& first, const BlockAddress& last, bool value) {
    for (int y = first.y; y <= last.y; ++y)
      std::fill_n(is_set_.begin() + static_cast<std::ptrdiff_t>(index(first.x, y)), last.x - first.x + 1,
                  value ? 1 : 0);
  }

  /// The words of these tiles: visit(x, y, word), word x of the row y of blocks.
  template <class Visit>
  void for_each_word(int last_x, int last_y, Visit&& visit) const {
    const int blocks = (last_x + 1) * per_tile_;
    for (int y = 0; y < (last_y + 1) * per_tile_; ++y)
      for (int word = 0; word * word_ < blocks; ++word) {
        std::uint64_t bits = 0;
        for (int x = word * word_; x < std::min(blocks, (word + 1) * word_); ++x)
          bits |= std::uint64_t{is_set_[index(x, y)]} << (x - word * word_);
        visit(word, y, bits);
      }
  }

 private:
  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * row_ + static_cast<std::size_t>(x);
  }

  int per_tile_, word_;  ///< blocks along the side of a tile, bits of a word
  std::size_t row_;      ///< bits of a row, in whole words
  std::vector<std::uint8_t> is_set_;
};

class ClearFlags {
 public:
  explicit ClearFlags(const Widths& widths) : depth_(widths), color_(widths) {}

  [[nodiscard]] bool is_set(TilePlane plane, const BlockAddress& block) const { return of(plane).is_set(block); }
  /// The block is in memory from now on.
  void fall(TilePlane plane, const BlockAddress& block) { of(plane).set(block, false); }

  /// A fast clear of the buffers in `clears`, tiles (0, 0) to (last_x, last_y).
  void mark(int last_x, int last_y, const std::array<bool, 2>& clears) {
    for (const TilePlane plane : kTilePlanes)
      if (clears[static_cast<std::size_t>(plane)]) of(plane).set_tiles(last_x, last_y, true);
  }
  /// A fast clear of the colours of the blocks `first` to `last`.
  void mark_colors(const BlockAddress& first, const BlockAddress& last) {
    of(TilePlane::color).set_blocks(first, last, true);
  }
  /// The clear values of a buffer have been written to memory.
  void resolve(TilePlane plane, int last_x, int last_y) { of(plane).set_tiles(last_x, last_y, false); }

  /// The words of a buffer: visit(x, y, word), word x of the row y of blocks.
  template <class Visit>
  void for_each_word(TilePlane plane, int last_x, int last_y, Visit&& visit) const {
    of(plane).for_each_word(last_x, last_y, visit);
  }

 private:
  [[nodiscard]] const BlockBits& of(TilePlane plane) const { return plane == TilePlane::depth ? depth_ : color_; }
  [[nodiscard]] BlockBits& of(TilePlane plane) { return plane == TilePlane::depth ? depth_ : color_; }

  BlockBits depth_, color_;
};

}  // namespace halfplane
