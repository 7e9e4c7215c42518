// Depth test: compares a stamp's depth codes with the stored ones, after the stencil test, and makes the write and the
// retirement.
//
// In: a FragmentPacket and the words stored under it: depth codes, the stencil above each (stencil.bits). Out: a
// WritePacket without its colours, which rop adds, and at the end of a tile visit a RetirePacket. The arithmetic of the
// test is that of fragment_ops.hpp.
//
// Without a texture unit the alpha test is here, where the colour is known. With one it is downstream of it; then a
// draw that tests alpha and writes depth is late: passed samples are only written, and counted as written, once their
// alpha is known.
#pragma once

#include <algorithm>
#include <span>

#include "../packets/packets.hpp"
#include "fragment_ops.hpp"
#include "stencil_packets.hpp"

namespace halfplane {

/// Restricts the writes to these samples.
inline void keep(SampleMask kept, WritePacket& packet) {
  packet.write_depth = packet.write_depth & kept;
  packet.write_color = packet.write_color & kept;
}

/// Samples that are not written have the fragment's own depth in the packet.
inline void complete_depths(const FragmentPacket& fragment, WritePacket& packet, const Widths& widths) {
  for (std::size_t s = 0; s < static_cast<std::size_t>(widths.samples); ++s)
    if (!packet.write_depth.has(s)) packet.depth[s] = fragment_depth(fragment, s, widths);
}

/// A stored word: a depth code, and the stencil above it, if there is one.
class DepthWord {
 public:
  explicit DepthWord(const Widths& widths)
      : has_stencil_(widths.stencil_flags != 0),
        bits_(widths.depth().code.bits),
        mask_(static_cast<std::uint32_t>(widths.depth().code.range.hi)) {}
  [[nodiscard]] bool has_stencil() const { return has_stencil_; }
  [[nodiscard]] std::uint32_t depth(std::uint32_t word) const { return word & mask_; }
  [[nodiscard]] std::uint8_t stencil(std::uint32_t word) const {
    return has_stencil_ ? static_cast<std::uint8_t>(word >> bits_) : std::uint8_t{0};
  }
  [[nodiscard]] std::uint32_t pack(std::uint32_t depth, std::uint32_t stencil) const {
    return has_stencil_ ? stencil << bits_ | depth : depth;
  }

 private:
  bool has_stencil_;
  int bits_;  ///< of the code
  std::uint32_t mask_;
};
[[nodiscard]] inline std::uint32_t depth_of(std::uint32_t word, const Widths& widths) {
  return DepthWord(widths).depth(word);
}
[[nodiscard]] inline std::uint8_t stencil_of(std::uint32_t word, const Widths& widths) {
  return DepthWord(widths).stencil(word);
}
[[nodiscard]] inline std::uint32_t depth_word(std::uint32_t depth, std::uint32_t stencil, const Widths& widths) {
  return DepthWord(widths).pack(depth, stencil);
}

/// The covered samples of a fragment against `stored`, the words of the stamp's samples in the depth RAM. Fills all of
/// `packet` except its colours and the depths of samples that are not written.
inline void test_samples(const FragmentPacket& fragment, std::span<const std::uint32_t> stored,
                         const StencilState& stencil, const Widths& widths, WritePacket& packet) {
  const FragmentState state = fragment.state;
  const DepthWord word(widths);
  packet.key = fragment.key;
  packet.stamp = fragment.stamp;
  SampleMask passed, changed;
  const auto test = [&](const Stencil* side) {
    fragment.mask.for_each([&](std::size_t s) {
      const TestedSample sample =
          test_sample(state, side, fragment_depth(fragment, s, widths), word.depth(stored[s]), word.stencil(stored[s]));
      passed.set(static_cast<int>(s), sample.passes);
      changed.set(static_cast<int>(s), sample.changes);
      packet.depth[s] = word.pack(sample.depth, sample.stencil);
    });
  };
  if (state.tests_stencil)
    test(&stencil.side[state.is_back ? 1 : 0]);
  else
    test(nullptr);
  packet.passed = passed;
  packet.write_depth = changed;
  packet.write_color = state.color_write ? passed : SampleMask();
}

/// The stage, without the alpha test and the end of a visit.
[[nodiscard]] inline WritePacket depth_test(const FragmentPacket& fragment, std::span<const std::uint32_t> stored,
                                            const StencilState& stencil, const Widths& widths) {
  WritePacket packet;
  test_samples(fragment, stored, stencil, widths, packet);
  complete_depths(fragment, packet, widths);
  return packet;
}

/// Whether depth, or the stencil above it, is written only after the texture unit, if the alpha test passes.
[[nodiscard]] constexpr bool is_late(const PrimitiveState& state, bool tests_alpha, const Config& config) {
  return has_texture_planes(config) && tests_alpha && state.writes_word();
}

/// The effect of a visit that writes depth on its tile's bound. `is_full`: every sample of the tile was covered and
/// written, the largest depth code was `largest`; `has_passed`: at least one may be written.
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

/// Data that the stage collects over the stamps of one tile visit.
class TileVisit {
 public:
  /// `passed`: samples whose depth may be written, if the state writes any; `written`: those whose depth is certainly
  /// written.
  void add(const FragmentPacket& fragment, SampleMask passed, SampleMask written, const Widths& widths) {
    has_passed_ = has_passed_ || passed.any();
    if (written != SampleMask::all(widths.samples)) return;
    ++full_stamps_;
    passed.for_each([&](std::size_t s) { largest_ = std::max(largest_, fragment_depth(fragment, s, widths)); });
  }

  /// The end of the visit; `last` is its last stamp.
  [[nodiscard]] RetirePacket retire(const FragmentPacket& last, const Config& config, const Widths& widths) const {
    RetirePacket packet;
    packet.key = last.key;
    set_hiz_update(packet, last.state, full_stamps_ == widths.stamps.stamps(), has_passed_, largest_, config, widths);
    return packet;
  }

 private:
  int full_stamps_ = 0;  ///< stamps with every sample covered and passed
  bool has_passed_ = false;
  std::uint32_t largest_ = 0;  ///< depth code of these stamps
};

}  // namespace halfplane
