// Depth test: a stamp's depth codes against the stored ones, and what follows from the result.
//
// In: a FragmentPacket and the codes stored under it. Out: a WritePacket but for its colours, which rop adds, and at the end of
// a tile visit a RetirePacket. The arithmetic of the test is fragment_ops.hpp's.
//
// The alpha test stands here where the colour is known: without a texture unit. With one it comes behind that; then a draw
// that tests alpha and writes depth is late: what passes here is only written, and counted as written, once its alpha is known.
#pragma once

#include <algorithm>
#include <span>

#include "../fragment_ops.hpp"
#include "../packets.hpp"

namespace halfplane {

/// Of a stamp's samples those that the alpha test lets pass. `alpha_of(s)`: the code of sample s.
template <class AlphaOf>
[[nodiscard]] SampleMask alpha_passes(const AlphaTest& alpha, SampleMask samples, AlphaOf&& alpha_of) {
  SampleMask kept;
  samples.for_each([&](std::size_t s) {
    kept.set(static_cast<int>(s), depth_passes(alpha.func, alpha_of(s), std::uint32_t{alpha.reference}));
  });
  return kept;
}

/// Only these samples are written.
inline void keep(SampleMask kept, WritePacket& packet) {
  packet.write_depth = packet.write_depth & kept;
  packet.write_color = packet.write_color & kept;
}

/// The stage, without the alpha test and the end of a visit. `stored`: the depth codes of the stamp's samples in the tile RAM.
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
  if (state.color_write) packet.write_color = packet.passed;
  return packet;
}

/// Whether depth is written behind the texture: the alpha test decides there whether it is.
[[nodiscard]] constexpr bool is_late(const PrimitiveState& state, const AlphaTest& alpha, const Config& config) {
  return has_texture_planes(config) && alpha.func != DepthFunc::always && state.depth_write;
}

/// What a visit that writes depth does to its tile's bound. `is_full`: every sample of the tile was covered and written,
/// the largest depth code was `largest`; `has_passed`: one at least may be.
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
  /// `passed`: samples whose depth may be written, if the state writes any; `written`: those of them where it surely is.
  void add(const FragmentPacket& fragment, SampleMask passed, SampleMask written, const Widths& widths) {
    full_stamps_ += written.count() == widths.samples ? 1 : 0;
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
