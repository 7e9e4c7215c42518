// What-if: sizes and rules of the hardware that rtl_ref has one value of. The cycle model takes others.
#pragma once

#include <span>
#include <string_view>

#include "../../stages/hiz.hpp"

namespace halfplane {

/// The defaults are the RTL. Queues: items that wait in front of a stage, in a FIFO of a cycle's latency; 0: none.
struct TimingParameters {
  int triangle_queue = 0, setup_queue = 0, tile_queue = 0, fragment_queue = 0;
  int stamp_queue = 2;  ///< places in the FIFO (serial: the skid buffer) after interpolate, at least 1
  int divide_bits = 2;  ///< quotient bits a cycle of the pipelined triangle_setup
  int untested_tiles =
      Hiz::kUntestedTiles;  ///< a triangle of at most so many tiles in x and in y never reads HiZ bounds
  int rejects = 1;          ///< 0: tiles outside an edge go to fine_raster like all others
  int fast_clear = 1;       ///< 0: clears of the whole target are drawn
  bool operator==(const TimingParameters&) const = default;
};

struct TimingSetting {
  std::string_view key;      ///< "queue.stamp"
  std::string_view meaning;  ///< one line
  int min, max;
  int TimingParameters::*member;
  bool is_pipelined_only;
};

[[nodiscard]] std::span<const TimingSetting> timing_settings();

/// Throws InputError for a value outside its range, and for one that this kind of hardware does not have.
void validate(const TimingParameters& parameters, const Config& config);

/// The setting of that key; null if there is none.
[[nodiscard]] const TimingSetting* find_timing_setting(std::string_view key);

}  // namespace halfplane
