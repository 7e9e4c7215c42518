// Tile cache: the on-chip depth and colour of a few tiles, written back to memory, and the flags of fast-cleared tiles.
//
// In: accesses to tiles, writes, fast clears, flushes, in program order. Out: memory requests in program order: on a
// miss the written stamps of the old tile, with one strobe per sample, then reads of the new tile's depth. If a buffer
// is flagged as cleared the tile begins with the clear value, and all of it goes to memory: then the flag falls.
// tile_directory.hpp decides on transfers; this class holds the data.
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

  /// Writes a fragment's result into its tile, which is resident.
  void write(const FragmentPacket& fragment, const WritePacket& packet);

  /// `token`: a fragment of kind fast_clear; `depth`, `color`: its depth and colour in the stored format.
  void fast_clear(const FragmentPacket& token, std::uint32_t depth, std::uint32_t color, MemoryPort& memory,
                  CounterPacket& counters);

  /// `token`: a fragment of kind flush.
  void flush(const FragmentPacket& token, MemoryPort& memory, CounterPacket& counters);

 private:
  struct DataMover;

  [[nodiscard]] std::size_t stamp_index(std::size_t line, int stamp) const {
    return line * static_cast<std::size_t>(stamps_) + static_cast<std::size_t>(stamp);
  }
  [[nodiscard]] std::span<std::uint32_t> lanes(TilePlane plane, std::size_t line, int stamp) {
    const auto samples = static_cast<std::size_t>(widths_.samples);
    return {lanes_[static_cast<std::size_t>(plane)].data() + stamp_index(line, stamp) * samples, samples};
  }

  Widths widths_;
  int stamps_;               ///< of a tile
  std::uint32_t code_mask_;  ///< bits of a depth code
  std::array<std::uint32_t, 2> clear_value_{};
  TileDirectory directory_;
  std::array<std::vector<std::uint32_t>, 2> lanes_;  ///< line by line, stamp by stamp
  std::array<std::vector<SampleMask>, 2> dirty_;     ///< samples of a stamp that were written since the tile came in
};

}  // namespace halfplane
