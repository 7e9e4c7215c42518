// The stalls of one cycle as the RTL takes them.
#pragma once

#include "model/engines/cycle/streams.hpp"

namespace halfplane {

/// The streams of one cycle as raster_top's stall_i.
[[nodiscard]] constexpr std::uint32_t stall_bits(std::uint64_t seed, std::uint64_t cycle, std::uint64_t threshold) {
  unsigned bits = 0;
  if (threshold != 0)
    for (int stream = 0; stream < stall_memory; ++stream)
      bits |= (is_stalled(seed, stream, cycle, threshold) ? 1U : 0U) << stream;
  return bits;
}

}  // namespace halfplane
