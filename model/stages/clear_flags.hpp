// Clear flags: a bit for each block and plane, set: memory holds garbage there, and what counts is the value of the last fast
// clear. A block is what a cache line holds (BlockGrid): 4x4 pixels, or with cache.kind tiles a tile. A fast clear sets
// flags a word at a time; one falls when its block goes to memory; the others survive a flush, which writes the words, or
// the clear colours themselves.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "../packets.hpp"

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
  const int x = at.stamp % widths.stamps.stamps_per_row, y = at.stamp / widths.stamps.stamps_per_row;
  return {{static_cast<std::uint16_t>(at.tile_x * grid.per_tile + x / grid.side),
           static_cast<std::uint16_t>(at.tile_y * grid.per_tile + y / grid.side)},
          y % grid.side * grid.side + x % grid.side};
}

[[nodiscard]] inline StampAddress stamp_address(const BlockStamp& at, const Widths& widths) {
  const BlockGrid& grid = widths.blocks;
  const int x = at.block.x % grid.per_tile * grid.side + at.stamp % grid.side;
  const int y = at.block.y % grid.per_tile * grid.side + at.stamp / grid.side;
  return {static_cast<std::uint16_t>(at.block.x / grid.per_tile),
          static_cast<std::uint16_t>(at.block.y / grid.per_tile),
          static_cast<std::uint16_t>(y * widths.stamps.stamps_per_row + x)};
}

/// Where a request for a word of flags goes: word x of the row y of blocks.
[[nodiscard]] inline StampAddress flag_word_address(int word, int y, const Widths& widths) {
  const int per_tile = widths.blocks.per_tile;
  return {static_cast<std::uint16_t>(word), static_cast<std::uint16_t>(y / per_tile),
          static_cast<std::uint16_t>(y % per_tile)};
}
[[nodiscard]] constexpr TilePlane flags_of(TilePlane plane) {
  return plane == TilePlane::color ? TilePlane::color_flags : TilePlane::depth_flags;
}

class ClearFlags {
 public:
  explicit ClearFlags(const Widths& widths)
      : per_tile_(widths.blocks.per_tile),
        word_(widths.blocks.flag_word),
        row_((static_cast<std::size_t>(widths.tiles_x * per_tile_ - 1) / static_cast<std::size_t>(word_) + 1) *
             static_cast<std::size_t>(word_)) {
    for (auto& plane : is_set_) plane.resize(row_ * static_cast<std::size_t>(widths.tiles_y * per_tile_));
  }

  [[nodiscard]] bool is_set(TilePlane plane, const BlockAddress& block) const {
    return is_set_[number(plane)][index(block.x, block.y)] != 0;
  }
  /// Memory holds the block from now on.
  void fall(TilePlane plane, const BlockAddress& block) { is_set_[number(plane)][index(block.x, block.y)] = 0; }

  /// A fast clear of the planes in `clears`, tiles (0, 0) to (last_x, last_y).
  void mark(int last_x, int last_y, const std::array<bool, 2>& clears) {
    for (const TilePlane plane : kTilePlanes)
      if (clears[number(plane)]) set(plane, last_x, last_y, 1);
  }
  /// A fast clear of the colours of the blocks `first` to `last`.
  void mark_colors(const BlockAddress& first, const BlockAddress& last) {
    for (int y = first.y; y <= last.y; ++y)
      for (int x = first.x; x <= last.x; ++x) is_set_[number(TilePlane::color)][index(x, y)] = 1;
  }
  /// The clear values of a plane have been written to memory.
  void resolve(TilePlane plane, int last_x, int last_y) { set(plane, last_x, last_y, 0); }

  /// The words of a plane: visit(x, y, word), word x of the row y of blocks.
  template <class Visit>
  void for_each_word(TilePlane plane, int last_x, int last_y, Visit&& visit) const {
    const int blocks = (last_x + 1) * per_tile_;
    for (int y = 0; y < (last_y + 1) * per_tile_; ++y)
      for (int word = 0; word * word_ < blocks; ++word) {
        std::uint64_t bits = 0;
        for (int x = word * word_; x < std::min(blocks, (word + 1) * word_); ++x)
          bits |= std::uint64_t{is_set_[number(plane)][index(x, y)]} << (x - word * word_);
        visit(word, y, bits);
      }
  }

 private:
  [[nodiscard]] static constexpr std::size_t number(TilePlane plane) { return static_cast<std::size_t>(plane); }
  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * row_ + static_cast<std::size_t>(x);
  }
  void set(TilePlane plane, int last_x, int last_y, std::uint8_t value) {
    for (int y = 0; y < (last_y + 1) * per_tile_; ++y)
      std::fill_n(is_set_[number(plane)].begin() + static_cast<std::ptrdiff_t>(index(0, y)), (last_x + 1) * per_tile_,
                  value);
  }

  int per_tile_, word_;                              ///< blocks along the side of a tile, flags of a word
  std::size_t row_;                                  ///< flags of a row, in whole words
  std::array<std::vector<std::uint8_t>, 2> is_set_;  ///< by plane and block
};

}  // namespace halfplane
