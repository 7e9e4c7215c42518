// Tile cache: the on-chip depth and colour of a few tiles, written back to memory, and the flags of fast-cleared tiles.
//
// In: accesses to tiles, writes, fast clears, flushes, in program order. Out: memory requests in program order: on a
// miss the old tile's dirty planes, then the new tile's reads. A tile whose plane is flagged as cleared is filled on the
// chip; the flag falls when that plane goes to memory. What moves is for tile_directory.hpp to say; here is the data.
#pragma once

#include <span>

#include "memory_port.hpp"
#include "tile_directory.hpp"

namespace halfplane {

class TileCache {
 public:
  TileCache(const Config& config, const Widths& widths);

  /// Makes the fragment's tile resident. Returns the depth codes under it.
  std::span<const std::uint32_t> access(const FragmentPacket& fragment, MemoryPort& memory, CounterPacket& counters);

  /// The codes of one stamp of a resident tile.
  [[nodiscard]] std::span<const std::uint32_t> stored(TilePlane plane, int tile_x, int tile_y, int stamp) const;

  /// Writes what came of a fragment into its tile, which is resident.
  void write(const FragmentPacket& fragment, const WritePacket& packet);

  /// `token`: a fragment of kind fast_clear; `color`: its colour as it is stored.
  void fast_clear(const FragmentPacket& token, std::uint32_t color, MemoryPort& memory, CounterPacket& counters);

  /// `token`: a fragment of kind flush.
  void flush(const FragmentPacket& token, MemoryPort& memory, CounterPacket& counters);

 private:
  struct DataMover;

  [[nodiscard]] std::size_t first_lane(std::size_t line, int stamp) const;
  [[nodiscard]] std::span<std::uint32_t> lanes(TilePlane plane, std::size_t line, int stamp);

  int stamps_, samples_;                    ///< of a tile, of a stamp
  std::array<std::uint32_t, 2> code_mask_;  ///< bits of a code of each plane
  std::array<std::uint32_t, 2> clear_value_{};
  TileDirectory directory_;
  std::array<std::vector<std::uint32_t>, 2> lanes_;  ///< line by line, stamp by stamp
};

}  // namespace halfplane
