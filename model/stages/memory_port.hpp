// Memory, as a cache on the chip sees it: one stamp of one plane at a time.
#pragma once

#include "../packets.hpp"

namespace halfplane {

struct MemoryPort {
  virtual void write(const MemoryRequest& request) = 0;
  /// Valid until the next read: 64 lanes are much to copy.
  [[nodiscard]] virtual const MemoryResponse& read(const MemoryRequest& request) = 0;

 protected:
  ~MemoryPort() = default;
};

/// A word of flags, in the lanes of a request: bit n of the word is bit n of the data.
inline void set_flag_word(MemoryRequest& request, std::uint64_t bits, const Widths& widths) {
  for (int n = 0; n < widths.blocks.flag_word; ++n)
    request.data[static_cast<std::size_t>(n / widths.memory_lane.bits)] |= static_cast<std::uint32_t>(bits >> n & 1)
                                                                           << n % widths.memory_lane.bits;
}
[[nodiscard]] inline std::uint64_t flag_word(const MemoryRequest& request, const Widths& widths) {
  std::uint64_t bits = 0;
  for (int n = 0; n < widths.blocks.flag_word; ++n)
    bits |=
        std::uint64_t{
            request.data[static_cast<std::size_t>(n / widths.memory_lane.bits)] >> n % widths.memory_lane.bits & 1}
        << n;
  return bits;
}

}  // namespace halfplane
