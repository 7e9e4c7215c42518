// Tile directory: which tiles are on the chip, which of their stamps have been written, which tiles a fast clear has flagged.
// It decides on transfers between chip and memory, and their order; a mover performs them: tile_cache.hpp the data, the cycle
// model the time.
//
// Direct mapped: a line holds both buffers of one tile. Depth is fetched with the tile, colour is only ever written.
// The functions of a mover, called in the order of the hardware:
//   look_at_line()                         a line without a dirty buffer is looked at (the walks of clears and flushes)
//   write_back(line, address, rows, fills) these stamps of a dirty buffer go to memory, all of them if memory is stale
//   fill(line, x, y, is_cleared)           a tile comes in: its depth from memory or from the clear value
//   mark_words(words)                      a fast clear sets flags, a word at a time
//   write_flags(plane, word, words, y, bits) a flush writes a word of flags, one of `words` in its row
//   look_at_tile()                         a flush looks at the flag of a tile's colour
//   write_clear_value(address, rows)       it is set: a flush writes the clear value
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "clear_flags.hpp"

namespace halfplane {

/// A buffer of one tile: the address of a request.
struct TileAddress {
  TilePlane plane;
  std::uint16_t tile_x, tile_y;
};

/// A bit for each stamp of each row of stamps of a tile.
using StampRows = std::array<std::uint32_t, 32>;

/// Stamps of the burst that a request for `stamp` begins or continues: the rest of a buffer that moves whole; otherwise
/// the stamps in `rows` that follow in its row without a gap.
[[nodiscard]] inline int run_of(const StampRows& rows, bool is_whole, int stamp, const Widths& widths) {
  const int per_row = widths.stamps.stamps_per_row;
  if (is_whole) return widths.stamps.stamps() - stamp;
  return std::countr_one(rows[static_cast<std::size_t>(stamp / per_row)] >> stamp % per_row);
}

class TileDirectory {
 public:
  TileDirectory(const Config& config, const Widths& widths)
      : widths_(widths),
        resolves_(config.frame_clears == FrameClears::resolve),
        lines_(static_cast<std::size_t>(config.cache_lines)),
        flags_(widths) {
    for (int row = 0; row < widths.stamps.stamps_per_row; ++row)
      all_[static_cast<std::size_t>(row)] = ~0U >> (32 - widths.stamps.stamps_per_row);
  }

  [[nodiscard]] std::size_t lines() const { return lines_.size(); }

  [[nodiscard]] std::size_t line_of(int tile_x, int tile_y) const {
    const auto low = [](int value, int bits) { return static_cast<std::size_t>(value & ((1 << bits) - 1)); };
    return low(tile_y, widths_.line_y_bits) << widths_.line_x_bits | low(tile_x, widths_.line_x_bits);
  }

  /// Makes the tile resident. Returns whether it already was.
  template <class Mover>
  bool access(int tile_x, int tile_y, Mover&& mover, CounterPacket& counters) {
    const std::size_t n = line_of(tile_x, tile_y);
    Line& line = lines_[n];
    const BlockAddress tile{static_cast<std::uint16_t>(tile_x), static_cast<std::uint16_t>(tile_y)};
    if (line.is_valid && line.tile == tile) return true;
    write_back(n, mover, counters);
    const std::array<bool, 2> cleared{flags_.is_set(TilePlane::depth, tile), flags_.is_set(TilePlane::color, tile)};
    (cleared[0] ? counters.tile_clears : counters.tile_fills) += stamps();
    mover.fill(n, tile_x, tile_y, cleared);
    line = {true, tile, {}, {}};
    return false;
  }

  /// Samples of a stamp of a resident tile have been written.
  void wrote(int tile_x, int tile_y, int stamp, bool depth, bool color) {
    Line& line = lines_[line_of(tile_x, tile_y)];
    const auto row = static_cast<std::size_t>(stamp / widths_.stamps.stamps_per_row);
    for (const TilePlane plane : kTilePlanes) {
      if (!(plane == TilePlane::depth ? depth : color)) continue;
      line.is_dirty[number(plane)] = true;
      line.dirty[number(plane)][row] |= 1U << stamp % widths_.stamps.stamps_per_row;
    }
  }

  /// Clears the buffers in `clears` of tiles (0, 0) to (last_x, last_y), and of tiles that share a word of flags with
  /// them.
  template <class Mover>
  void fast_clear(int last_x, int last_y, const std::array<bool, 2>& clears, Mover&& mover, CounterPacket& counters) {
    // The lines of the cleared buffer are dead, but writing them back keeps this simple.
    if (!(clears[0] && clears[1])) write_back_all(mover, counters);
    for (Line& line : lines_) line = {};
    const int word = widths_.blocks.flag_word;
    mover.mark_words((last_x / word + 1) * (last_y + 1));
    flags_.mark(last_x | (word - 1), last_y, clears);
  }

  /// Writes everything back: dirty stamps, then the flags, or the clear colour of the tiles that are still flagged.
  /// Nothing is on the chip after it.
  template <class Mover>
  void flush(int last_x, int last_y, Mover&& mover, CounterPacket& counters) {
    const int flag_word = widths_.blocks.flag_word;
    write_back_all(mover, counters);
    for (Line& line : lines_) line = {};
    for (const TilePlane plane : kTilePlanes)
      if (plane == TilePlane::depth || !resolves_)
        flags_.for_each_word(plane, last_x | (flag_word - 1), last_y, [&](int word, int y, std::uint64_t bits) {
          mover.write_flags(plane, word, last_x / flag_word + 1, y, bits);
        });
    if (resolves_) resolve(last_x, last_y, mover, counters);
  }

 private:
  struct Line {
    bool is_valid = false;
    BlockAddress tile;
    std::array<bool, 2> is_dirty{};    ///< by buffer
    std::array<StampRows, 2> dirty{};  ///< likewise: written stamps
  };

  [[nodiscard]] std::uint32_t stamps() const { return static_cast<std::uint32_t>(widths_.stamps.stamps()); }

  template <class Mover>
  void write_back(std::size_t n, Mover&& mover, CounterPacket& counters) {
    Line& line = lines_[n];
    for (const TilePlane plane : kTilePlanes) {
      if (!line.is_dirty[number(plane)]) continue;
      const bool fills = flags_.is_set(plane, line.tile);
      const StampRows& rows = fills ? all_ : line.dirty[number(plane)];
      mover.write_back(n, {plane, line.tile.x, line.tile.y}, rows, fills);
      for (const std::uint32_t row : rows) counters.tile_evictions += static_cast<std::uint32_t>(std::popcount(row));
      flags_.fall(plane, line.tile);
    }
  }

  template <class Mover>
  void write_back_all(Mover&& mover, CounterPacket& counters) {
    for (std::size_t n = 0; n < lines_.size(); ++n) {
      write_back(n, mover, counters);
      mover.look_at_line();
    }
  }

  template <class Mover>
  void resolve(int last_x, int last_y, Mover&& mover, CounterPacket& counters) {
    for (int y = 0; y <= last_y; ++y)
      for (int x = 0; x <= last_x; ++x) {
        const BlockAddress tile{static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y)};
        mover.look_at_tile();
        if (!flags_.is_set(TilePlane::color, tile)) continue;
        mover.write_clear_value({TilePlane::color, tile.x, tile.y}, all_);
        counters.tile_evictions += stamps();
        flags_.fall(TilePlane::color, tile);
      }
  }

  Widths widths_;
  bool resolves_;    ///< frame.clears
  StampRows all_{};  ///< of a tile
  std::vector<Line> lines_;
  ClearFlags flags_;
};

}  // namespace halfplane
