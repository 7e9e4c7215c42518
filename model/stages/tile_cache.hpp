// Tile cache: the on-chip depth and colour of a few tiles, written back to memory, and the flags of fast-cleared tiles.
//
// In: accesses to tiles, writes, fast clears, flushes, in program order. Out: memory requests in program order: on a
// miss the old tile's dirty planes, then the new tile's reads. Direct mapped: a line holds both planes of one tile. A
// tile whose plane is flagged as cleared is filled on the chip; the flag falls when that plane goes to memory.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "../packets.hpp"

namespace halfplane {

/// Memory, as the cache sees it: one stamp of one plane at a time.
struct MemoryPort {
  virtual void write(const MemoryRequest& request) = 0;
  /// Valid until the next read: 64 lanes are much to copy.
  [[nodiscard]] virtual const MemoryResponse& read(const MemoryRequest& request) = 0;

 protected:
  ~MemoryPort() = default;
};

/// What a tile has of each pixel.
enum class TilePlane : std::uint8_t { depth, color };

class TileCache {
 public:
  TileCache(const Config& config, const Widths& widths);

  /// Makes the tile resident.
  void access(int tile_x, int tile_y, MemoryPort& memory, CounterPacket& counters);

  /// The codes of one stamp of a resident tile.
  [[nodiscard]] std::span<const std::uint32_t> stored(TilePlane plane, int tile_x, int tile_y, int stamp) const;

  /// Writes into a resident tile.
  void write(const WritePacket& packet);

  /// `token`: a fragment of kind fast_clear; `color`: its colour as it is stored.
  void fast_clear(const FragmentPacket& token, std::uint32_t color, MemoryPort& memory, CounterPacket& counters);

  /// `token`: a fragment of kind flush.
  void flush(const FragmentPacket& token, MemoryPort& memory, CounterPacket& counters);

 private:
  static constexpr std::array kPlanes{TilePlane::depth, TilePlane::color};
  struct Line {
    bool is_valid = false;
    std::uint16_t tile_x = 0, tile_y = 0;
    std::array<bool, 2> is_dirty{};
  };
  /// A plane of one tile: where a request goes.
  struct Address {
    TilePlane plane;
    std::uint16_t tile_x, tile_y;
  };

  [[nodiscard]] std::size_t line_of(int tile_x, int tile_y) const;
  [[nodiscard]] std::size_t first_lane(std::size_t line, int stamp) const;
  [[nodiscard]] std::span<std::uint32_t> lanes(TilePlane plane, std::size_t line, int stamp);
  [[nodiscard]] std::uint8_t& is_cleared(const Address& address);
  [[nodiscard]] static MemoryRequest request(const Address& address, bool is_write);
  void evict(std::size_t line, MemoryPort& memory, CounterPacket& counters);
  void fill(std::size_t line, const Address& address, MemoryPort& memory, CounterPacket& counters);
  void write_clear_value(const Address& address, MemoryPort& memory, CounterPacket& counters);

  int stamps_, samples_;  ///< of a tile, of a stamp
  int line_x_bits_, line_y_bits_;
  std::size_t tiles_x_;
  std::array<std::uint32_t, 2> code_mask_;  ///< bits of a code of each plane
  std::array<std::uint32_t, 2> clear_value_{};
  std::vector<Line> lines_;
  std::array<std::vector<std::uint32_t>, 2> lanes_;      ///< line by line, stamp by stamp
  std::array<std::vector<std::uint8_t>, 2> is_cleared_;  ///< by tile: memory holds garbage, the value is clear_value_
};

}  // namespace halfplane
