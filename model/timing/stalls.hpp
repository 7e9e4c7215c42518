// Injected back-pressure: a function of seed, stream and cycle, so that the seed determines every stall. The co-simulation
// stalls the RTL with it, and the cycle model waits accordingly.
#pragma once

#include <cmath>
#include <cstdint>

namespace halfplane {

using Cycle = std::uint64_t;  ///< number of a clock cycle since reset

/// A probability in [0, 1) as the threshold of is_stalled(), in 2^-32.
[[nodiscard]] inline std::uint64_t stall_threshold(double probability) {
  return static_cast<std::uint64_t>(std::ldexp(probability, 32));
}

/// Whether `stream` moves nothing in `cycle`. The cycle counts steps of SplitMix64's constant and the stream steps of
/// another odd constant, both through its finaliser (Steele, Lea, Flood 2014); the top 32 bits are compared with the
/// threshold.
[[nodiscard]] constexpr bool is_stalled(std::uint64_t seed, int stream, Cycle cycle, std::uint64_t threshold) {
  if (threshold == 0) return false;
  std::uint64_t z =
      seed + cycle * 0x9e3779b97f4a7c15ULL + static_cast<std::uint64_t>(stream + 1) * 0xd1342543de82ef95ULL;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return ((z ^ (z >> 31)) >> 32) < threshold;
}

/// The stalls of one run.
struct Stalls {
  std::uint64_t seed = 1;
  std::uint64_t threshold = 0;  ///< 0: none

  /// The first cycle from `cycle` on in which none of `streams` (a bit each) is stalled.
  [[nodiscard]] constexpr Cycle next_free(unsigned streams, Cycle cycle) const {
    return threshold == 0 ? cycle : next_not_stalled(streams, cycle);
  }

 private:
  [[nodiscard]] constexpr Cycle next_not_stalled(unsigned streams, Cycle cycle) const {
    for (;; ++cycle) {
      bool is_free = true;
      for (int s = 0; streams >> s != 0; ++s)
        is_free = is_free && ((streams >> s & 1) == 0 || !is_stalled(seed, s, cycle, threshold));
      if (is_free) return cycle;
    }
  }
};

}  // namespace halfplane
