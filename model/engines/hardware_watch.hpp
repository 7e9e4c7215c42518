// Sees what no packet of the hardware engine shows, for coverage.
#pragma once

#include <cstdint>
#include <span>

#include "../packets/packets.hpp"
#include "../stages/cache_tags.hpp"
#include "../stages/fragment_path.hpp"

namespace halfplane {

/// Every call comes where it happens, between the packets.
class HardwareWatch {
 public:
  virtual ~HardwareWatch() = default;
  /// The framebuffer of blocks has looked up a stamp.
  virtual void looked_up(const FragmentPacket&, const TagResult&) {}
  /// A stamp meets the words stored under it, before the tests.
  virtual void meets(const FragmentPacket&, std::span<const std::uint32_t> /*stored*/, const StencilState&) {}
  /// The fate of its samples, with the colour operations that it had.
  virtual void shaded(const FragmentPacket&, const StampFate&, const ColorState&) {}
};

}  // namespace halfplane
