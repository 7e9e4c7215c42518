// Tile directory: which tiles are on the chip, which of their planes are dirty, which tiles a fast clear has flagged. It
// decides what moves between chip and memory, and in what order; a mover moves it: tile_cache.hpp the data, the cycle
// model the time.
//
// Direct mapped: a line holds both planes of one tile. A mover has, called in the order in which the hardware works:
//   look_at_line()                  a line without a dirty plane is looked at (the walks of clears and flushes)
//   write_back(line, address)       a dirty plane goes to memory
//   fill(line, x, y, is_cleared)    both planes of a tile come in, each from memory or from the clear value
//   mark_tile()                     a fast clear flags one tile
//   look_at_tile()                  a flush finds no flag left at a tile
//   write_clear_value(address)      a flush writes the clear value of a flagged plane
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "../packets.hpp"

namespace halfplane {

/// A plane of one tile: where a request goes.
struct TileAddress {
  TilePlane plane;
  std::uint16_t tile_x, tile_y;
};

class TileDirectory {
 public:
  TileDirectory(const Config& config, const Widths& widths)
      : line_x_bits_(widths.line_x_bits),
        line_y_bits_(widths.line_y_bits),
        tiles_x_(static_cast<std::size_t>(widths.tiles_x)),
        lines_(static_cast<std::size_t>(config.cache_lines)) {
    for (auto& plane : is_cleared_) plane.resize(tiles_x_ * static_cast<std::size_t>(widths.tiles_y));
  }

  [[nodiscard]] std::size_t lines() const { return lines_.size(); }

  [[nodiscard]] std::size_t line_of(int tile_x, int tile_y) const {
    const auto low = [](int value, int bits) { return static_cast<std::size_t>(value & ((1 << bits) - 1)); };
    return low(tile_y, line_y_bits_) << line_x_bits_ | low(tile_x, line_x_bits_);
  }

  /// Makes the tile resident. Returns whether it was.
  template <class Mover>
  bool access(int tile_x, int tile_y, Mover&& mover, CounterPacket& counters) {
    const std::size_t n = line_of(tile_x, tile_y);
    Line& line = lines_[n];
    if (line.is_valid && line.tile_x == tile_x && line.tile_y == tile_y) return true;
    write_back(n, mover, counters);
    const auto x = static_cast<std::uint16_t>(tile_x), y = static_cast<std::uint16_t>(tile_y);
    std::array<bool, 2> cleared;
    for (const TilePlane plane : kTilePlanes) {
      cleared[number(plane)] = is_cleared({plane, x, y}) != 0;
      ++(cleared[number(plane)] ? counters.tile_clears : counters.tile_fills);
    }
    mover.fill(n, tile_x, tile_y, cleared);
    line = {true, x, y, {}};
    return false;
  }

  /// Planes of a resident tile have been written.
  void wrote(int tile_x, int tile_y, bool depth, bool color) {
    Line& line = lines_[line_of(tile_x, tile_y)];
    line.is_dirty[0] = line.is_dirty[0] || depth;
    line.is_dirty[1] = line.is_dirty[1] || color;
  }

  /// Of the planes in `clears`, tiles (0, 0) to (last_x, last_y).
  template <class Mover>
  void fast_clear(int last_x, int last_y, const std::array<bool, 2>& clears, Mover&& mover, CounterPacket& counters) {
    // What the cleared plane's lines hold is dead, but writing it back keeps this simple.
    if (!(clears[0] && clears[1])) write_back_all(mover, counters);
    for (Line& line : lines_) line = {};
    for_each_tile(last_x, last_y, [&](std::uint16_t x, std::uint16_t y) {
      mover.mark_tile();
      for (const TilePlane plane : kTilePlanes)
        if (clears[number(plane)]) is_cleared({plane, x, y}) = 1;
    });
  }

  /// Writes everything back: dirty planes, then the clear value of the tiles that are still flagged.
  template <class Mover>
  void flush(int last_x, int last_y, Mover&& mover, CounterPacket& counters) {
    write_back_all(mover, counters);
    for_each_tile(last_x, last_y, [&](std::uint16_t x, std::uint16_t y) {
      for (const TilePlane plane : kTilePlanes) {
        const TileAddress address{plane, x, y};
        if (is_cleared(address) == 0) continue;
        mover.write_clear_value(address);
        ++counters.tile_evictions;
        is_cleared(address) = 0;
      }
      mover.look_at_tile();
    });
  }

 private:
  struct Line {
    bool is_valid = false;
    std::uint16_t tile_x = 0, tile_y = 0;
    std::array<bool, 2> is_dirty{};
  };

  [[nodiscard]] static constexpr std::size_t number(TilePlane plane) { return static_cast<std::size_t>(plane); }
  [[nodiscard]] std::uint8_t& is_cleared(const TileAddress& address) {
    return is_cleared_[number(address.plane)][address.tile_y * tiles_x_ + address.tile_x];
  }

  template <class Visit>
  static void for_each_tile(int last_x, int last_y, Visit&& visit) {
    for (int y = 0; y <= last_y; ++y)
      for (int x = 0; x <= last_x; ++x) visit(static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y));
  }

  template <class Mover>
  void write_back(std::size_t n, Mover&& mover, CounterPacket& counters) {
    Line& line = lines_[n];
    for (const TilePlane plane : kTilePlanes) {
      if (!line.is_valid || !line.is_dirty[number(plane)]) continue;
      const TileAddress address{plane, line.tile_x, line.tile_y};
      mover.write_back(n, address);
      ++counters.tile_evictions;
      is_cleared(address) = 0;
      line.is_dirty[number(plane)] = false;
    }
  }

  template <class Mover>
  void write_back_all(Mover&& mover, CounterPacket& counters) {
    for (std::size_t n = 0; n < lines_.size(); ++n) {
      write_back(n, mover, counters);
      mover.look_at_line();
    }
  }

  int line_x_bits_, line_y_bits_;
  std::size_t tiles_x_;
  std::vector<Line> lines_;
  std::array<std::vector<std::uint8_t>, 2> is_cleared_;  ///< by plane and tile: memory holds garbage
};

}  // namespace halfplane
