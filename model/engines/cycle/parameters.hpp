// Parameters of what-if runs: sizes and rules that are fixed in rtl_ref. The cycle model takes other values.
#pragma once

#include <span>
#include <string_view>

#include "../../widths.hpp"

namespace halfplane {

/// The defaults are the RTL. Queues: items that wait in front of a stage, in a FIFO with a latency of one cycle; 0: no
/// queue.
struct TimingParameters {
  int triangle_queue = 0, setup_queue = 0, tile_queue = 0, fragment_queue = 0;
  int stamp_queue = 2;  ///< places in the FIFO (serial: the skid buffer) after interpolate, at least 1
  int divide_bits = 2;  ///< quotient bits a cycle of the pipelined triangle_setup
  int untested_tiles =
      kHizUntestedTiles;  ///< a triangle of at most this many tiles in x and in y never reads HiZ bounds
  int rejects = 1;        ///< 0: tiles outside an edge go to fine_raster like all others
  int fast_clear = 1;     ///< 0: clears of the whole target are drawn
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

/// Throws InputError for a value outside its range, or one that this kind of hardware does not support.
void validate(const TimingParameters& parameters, const Config& config);

/// The setting with that key; null if there is none.
[[nodiscard]] const TimingSetting* find_timing_setting(std::string_view key);

}  // namespace halfplane
