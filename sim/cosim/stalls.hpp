// The stalls of one cycle as the RTL takes them.
#pragma once

#include "model/engines/cycle/streams.hpp"

namespace halfplane {

/// The streams of one cycle as raster_top's stall_i.
[[nodiscard]] constexpr std::uint32_t stall_bits(std::uint64_t seed, std::uint64_t cycle, std::uint64_t threshold) {
  unsigned bits = 0;
  if (threshold != 0)
    for (const Arrow arrow : kElastic)
      if (is_stalled(seed, info(arrow).flow.stall, cycle, threshold)) bits |= stall_bit(arrow);
  return bits;
}

}  // namespace halfplane
