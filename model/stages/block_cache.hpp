// Block cache: the on-chip depth and colour of blocks of 4x4 pixels, and the evicted blocks on their way to memory.
//
// In: fragments, writes, fast clears, flushes, in program order. Out: stored depths, memory requests in the order of
// cache_tags.hpp, which decides on transfers; this class holds the data.
#pragma once

#include <deque>
#include <span>

#include "cache_tags.hpp"
#include "color_packets.hpp"
#include "memory_port.hpp"
#include "pixel_colors.hpp"
#include "stencil_packets.hpp"

namespace halfplane {

class BlockCache {
 public:
  BlockCache(const Config& config, const Widths& widths);

  /// The depth codes under a fragment with covered samples, until the next call. 0 for a stamp that the test does not
  /// read.
  [[nodiscard]] std::span<const std::uint32_t> access(const FragmentPacket& fragment, MemoryPort& memory,
                                                      CounterPacket& counters);

  /// The stored colours under the fragment, where its operations read them: else 0.
  [[nodiscard]] std::span<const std::uint32_t> colors() const { return stored_color_; }

  [[nodiscard]] const TagResult& last_lookup() const { return last_; }

  /// A token has set the colour operations, or the stencil.
  void set(const ColorState& colors, const StencilState& stencil) {
    directory_.set(colors.ops.reads_stored(), colors.tests_alpha(), stencil.replaces());
  }

  /// Writes the result of the fragment of the last access.
  void write(const FragmentPacket& fragment, const WritePacket& packet);

  /// `token`: a fragment of kind fast_clear; `depth`, `color`: its depth and colour in the stored format.
  void fast_clear(const FragmentPacket& token, std::uint32_t depth, std::uint32_t color, MemoryPort& memory,
                  CounterPacket& counters);

  /// `token`: a fragment of kind flush.
  void flush(const FragmentPacket& token, MemoryPort& memory, CounterPacket& counters);

 private:
  /// An evicted block: its data for memory.
  struct Victim {
    BlockAddress block;
    std::array<std::vector<MemoryRequest>, 2> stamps;  ///< by buffer, in order
    LeavingColors colors;
  };

  [[nodiscard]] std::size_t stamp_index(std::size_t line, int stamp) const {
    return line * static_cast<std::size_t>(widths_.blocks.stamps()) + static_cast<std::size_t>(stamp);
  }
  [[nodiscard]] std::span<std::uint32_t> lanes(TilePlane plane, std::size_t stamp) {
    const auto samples = static_cast<std::size_t>(widths_.samples);
    return {lanes_[static_cast<std::size_t>(plane)].data() + stamp * samples, samples};
  }
  void read_colors(MemoryPort& memory, CounterPacket& counters);
  void capture(const Eviction& eviction);
  void resolve_stamp(MemoryRequest& request) const;
  void choose_pixels(MemoryRequest& request) const;
  void compress(Victim& victim, MemoryPort& memory, CounterPacket& counters);
  void merge(Victim& victim, MemoryPort& memory, CounterPacket& counters);
  void write_victims(int count, MemoryPort& memory, CounterPacket& counters);
  void evict_all(MemoryPort& memory, CounterPacket& counters);
  void write_cleared(int last_x, int last_y, MemoryPort& memory, CounterPacket& counters);

  Config config_;
  Widths widths_;
  CacheTags directory_;
  TagResult last_;                            ///< of the last access
  std::size_t last_stamp_ = 0;                ///< likewise, in the arrays below
  std::vector<std::uint32_t> stored_;         ///< likewise: the words that the depth test saw
  std::vector<std::uint32_t> stored_color_;   ///< likewise: the colours that operations read
  TilePlane color_plane_ = TilePlane::color;  ///< likewise: the buffer of these colours
  std::array<std::uint32_t, 2> code_mask_;    ///< bits of a code, by buffer
  std::array<std::uint32_t, 2> clear_value_{};
  std::array<std::vector<std::uint32_t>, 2> lanes_;  ///< line by line, stamp by stamp
  std::array<std::vector<SampleMask>, 2> dirty_;     ///< samples of a stamp that are newer than memory
  std::deque<Victim> victims_;                       ///< oldest first
  BlockBits of_pixels_;  ///< with compress.unit: blocks that lie in memory with one colour per pixel
};

}  // namespace halfplane
