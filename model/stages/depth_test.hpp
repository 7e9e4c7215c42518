// Depth test: a stamp's depth codes against the stored ones, and what follows from the result.
//
// In: a FragmentPacket and the codes stored under it. Out: the part of a WritePacket that the tests own (which samples
// pass, the depth plane; rop adds the colour), and at the end of a tile visit a RetirePacket. The arithmetic of the test
// is fragment_ops.hpp's.
#pragma once

#include <algorithm>
#include <span>

#include "../fragment_ops.hpp"
#include "../packets.hpp"

namespace halfplane {

/// The stage, without the end of a visit. `stored`: the depth codes of the stamp's samples in the tile RAM.
[[nodiscard]] inline WritePacket depth_test(const FragmentPacket& fragment, std::span<const std::uint32_t> stored,
                                            const Widths& widths) {
  const FragmentState& state = fragment.state;
  WritePacket packet;
  packet.key = fragment.key;
  packet.stamp = fragment.stamp;
  for (std::size_t s = 0; s < static_cast<std::size_t>(widths.samples); ++s) {
    packet.depth[s] = fragment.code[s][kDepthPlane];
    const bool passes = fragment.mask.has(s) && depth_passes(state.depth_test, packet.depth[s], stored[s]);
    packet.passed.set(static_cast<int>(s), passes);
  }
  if (state.depth_write) packet.write_depth = packet.passed;
  return packet;
}

/// What a visit that writes depth does to its tile's bound. `is_full`: every sample of the tile was covered and passed,
/// the largest depth code was `largest`; `has_passed`: one at least.
inline void set_hiz_update(RetirePacket& packet, const PrimitiveState& state, bool is_full, bool has_passed,
                           std::uint32_t largest, const Config& config, const Widths& widths) {
  if (config.hiz_bits == 0 || !state.depth_write) return;
  if (is_full) {
    packet.update = HizUpdate::set;
    packet.hiz_code = largest >> (config.depth_bits - hiz_code_bits(config));
  } else if (has_passed && can_raise_depth(state.depth_test)) {
    packet.update = HizUpdate::clear;
    packet.hiz_code = static_cast<std::uint32_t>(widths.hiz_code.range.hi);
  }
}

/// What the stage gathers over the stamps of one tile visit.
class TileVisit {
 public:
  void add(const FragmentPacket& fragment, SampleMask passed, const Widths& widths) {
    full_stamps_ += passed.count() == widths.samples ? 1 : 0;
    has_passed_ = has_passed_ || passed.any();
    passed.for_each([&](std::size_t s) { largest_ = std::max(largest_, fragment.code[s][kDepthPlane]); });
  }

  /// The end of the visit; `last` is its last stamp.
  [[nodiscard]] RetirePacket retire(const FragmentPacket& last, const Config& config, const Widths& widths) const {
    RetirePacket packet;
    packet.key = last.key;
    set_hiz_update(packet, last.state, full_stamps_ == widths.stamps.stamps(), has_passed_, largest_, config, widths);
    return packet;
  }

 private:
  int full_stamps_ = 0;  ///< stamps of which every sample was covered and passed
  bool has_passed_ = false;
  std::uint32_t largest_ = 0;  ///< depth code
};

}  // namespace halfplane
