// Random back-pressure that is a function of the cycle: whoever knows seed and probability knows every stall.
#pragma once

#include <cmath>
#include <cstdint>

namespace halfplane {

/// The streams that can be stalled. All but the last are the bits of raster_top's stall_i, the last is the memory's own.
enum StallStream : int {
  stall_primitive,
  stall_triangle,
  stall_setup,
  stall_tile,
  stall_stamp,
  stall_fragment,
  stall_request,
  stall_response,
  stall_line,
  stall_line_pixel,
  stall_memory,  ///< the memory takes no request
};
inline constexpr int kStallStreams = stall_memory + 1;

/// A probability in [0, 1) as the threshold that is_stalled() takes, in 2^-32.
[[nodiscard]] inline std::uint64_t stall_threshold(double probability) {
  return static_cast<std::uint64_t>(std::ldexp(probability, 32));
}

/// Whether `stream` moves nothing in `cycle`. The cycle is one step of SplitMix64's counter and the stream one of another
/// odd constant, both through its finaliser (Steele, Lea, Flood 2014); the top 32 bits are compared with the threshold.
[[nodiscard]] constexpr bool is_stalled(std::uint64_t seed, int stream, std::uint64_t cycle, std::uint64_t threshold) {
  if (threshold == 0) return false;
  std::uint64_t z =
      seed + cycle * 0x9e3779b97f4a7c15ULL + static_cast<std::uint64_t>(stream + 1) * 0xd1342543de82ef95ULL;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return ((z ^ (z >> 31)) >> 32) < threshold;
}

/// The streams of one cycle as raster_top's stall_i.
[[nodiscard]] constexpr std::uint32_t stall_bits(std::uint64_t seed, std::uint64_t cycle, std::uint64_t threshold) {
  unsigned bits = 0;
  if (threshold != 0)
    for (int stream = 0; stream < stall_memory; ++stream)
      bits |= (is_stalled(seed, stream, cycle, threshold) ? 1U : 0U) << stream;
  return bits;
}

}  // namespace halfplane
