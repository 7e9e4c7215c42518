// Block cache: the on-chip depth and colour of blocks of 4x4 pixels, and those that are on their way to memory.
//
// In: fragments, writes, fast clears, flushes, in program order. Out: stored depths, memory requests in the order of
// cache_tags.hpp, which decides what moves; here is the data.
#pragma once

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

  /// The depth codes under a fragment with covered samples, until the next call. Those of a stamp that the test does not
  /// look at are 0.
  [[nodiscard]] std::span<const std::uint32_t> access(const FragmentPacket& fragment, MemoryPort& memory,
                                                      CounterPacket& counters);

  /// The stored colours under it, where its operations read them: else 0.
  [[nodiscard]] std::span<const std::uint32_t> colors() const { return stored_color_; }

  /// A token has set what is done with colours, or with the stencil.
  void set(const ColorState& colors, const StencilState& stencil) {
    directory_.set(colors.ops.reads_stored(), colors.tests_alpha(), stencil.replaces());
  }

  /// Writes what came of the fragment of the last access.
  void write(const FragmentPacket& fragment, const WritePacket& packet);

  /// `token`: a fragment of kind fast_clear; `depth`, `color`: its depth and colour as they are stored.
  void fast_clear(const FragmentPacket& token, std::uint32_t depth, std::uint32_t color, MemoryPort& memory,
                  CounterPacket& counters);

  /// `token`: a fragment of kind flush.
  void flush(const FragmentPacket& token, MemoryPort& memory, CounterPacket& counters);

 private:
  /// A block that has left its line: what of it goes to memory.
  struct Victim {
    BlockAddress block;
    std::array<std::vector<MemoryRequest>, 2> stamps;  ///< by plane, in order
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
  std::vector<std::uint32_t> stored_;         ///< likewise: what the depth test saw
  std::vector<std::uint32_t> stored_color_;   ///< likewise: what operations on colours see
  TilePlane color_plane_ = TilePlane::color;  ///< likewise: where they come from
  std::array<std::uint32_t, 2> code_mask_;    ///< bits of a code of each plane
  std::array<std::uint32_t, 2> clear_value_{};
  std::array<std::vector<std::uint32_t>, 2> lanes_;  ///< line by line, stamp by stamp
  std::array<std::vector<SampleMask>, 2> dirty_;     ///< samples of a stamp that memory does not have
  std::deque<Victim> victims_;                       ///< oldest first
  BlockBits of_pixels_;  ///< with compress.unit: blocks that memory has with one colour a pixel
};

}  // namespace halfplane
