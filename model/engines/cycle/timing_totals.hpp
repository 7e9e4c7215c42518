// What a run of the cycle model took, but for the streams.
#pragma once

#include <array>
#include <cstdint>

#include "../../counters.hpp"
#include "../../enum_names.hpp"
#include "../../pipeline_graph.hpp"
#include "../../timing/stalls.hpp"

namespace halfplane {

/// The reason for moving a buffer of a tile between chip and memory.
enum class MoveCause : std::uint8_t {
  fill,   ///< a tile is needed
  evict,  ///< its line is needed, or the flush writes it back
  clear   ///< the flush writes the clear value of a tile that was never brought in again
};
inline constexpr auto kMoveCauses = kNamesOf<MoveCause>;

/// Begin and end of a run, and cycles not spent moving items.
struct TimingTotals {
  Cycle last = 0;                   ///< the last cycle in which an item crossed a boundary
  Cycle first_primitive = 0;        ///< the cycle in which the first triangle, point or line was taken
  Cycle last_write = 0;             ///< the last write into the on-chip tiles
  std::uint64_t tile_cycles = 0;    ///< between these two: the framebuffer moved tiles and served no access
  std::uint64_t hazard_cycles = 0;  ///< tiles: a fragment waited for the write of the previous fragment
  std::uint64_t move_cycles = 0;    ///< cycles of the whole run in which the framebuffer served no access
  std::uint64_t memory_cycles = 0;  ///< part of move_cycles: waiting for a request or an answer
  std::uint64_t bound_cycles = 0;   ///< coarse_raster waited for a visit to retire before it read a bound
  std::uint64_t visit_cycles = 0;   ///< the same because too many visits were under way
  std::uint64_t slot_cycles = 0;    ///< a setup waited for a context slot
  /// Cycles in which each stage was at work: its narrowest part, without waits for other stages.
  std::array<std::uint64_t, kStages> works{};
  std::array<std::array<std::uint64_t, 2>, kMoveCauses.size()> beats{};  ///< on the memory port, by cause and buffer
  std::uint64_t texel_beats = 0;                                         ///< moved on the texture unit's port
  bool has_primitive = false;                                            ///< first_primitive has been seen

  /// From the first primitive taken to the last write into the on-chip tiles; 0: no write since.
  [[nodiscard]] std::uint64_t raster_cycles() const {
    return has_primitive && last_write >= first_primitive ? last_write - first_primitive + 1 : 0;
  }
};

}  // namespace halfplane
