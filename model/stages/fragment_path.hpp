// Fragment path: a stamp's path from depth_test to the framebuffer, for every engine that computes the bits of the RTL.
// The hardware engine sends the packets of each stage on the way; the cycle engine reads the fate of the stamp and adds
// times.
//
// In: a fragment with covered samples, and tokens. Through a Port: the stored words under the stamp, lines of texels,
// and the writes. Out: the fate of the samples, the counters, the end of a tile visit.
//
// A Port has
//   kSendsPackets           true: packets have the values of all samples; false: of written or shaded samples only
//   stored()                the words under the stamp's covered samples, as depth_test takes them
//   interpolate_colors(samples), interpolate_over_w(samples)
//                           makes these codes of the fragment, for the pixels of these samples, if missing
//   read(address, beats)    a TextureLine
//   stored_colors(samples)  the codes under these samples, if the operations on colours read them
//   send(packet)            a WritePacket upstream of the texture, a ColorPacket downstream of it
//   write(packet)           the written values, in the stored format
#pragma once

#include "color_packets.hpp"
#include "depth_test.hpp"
#include "rop.hpp"
#include "surface.hpp"
#include "texture_stage.hpp"

namespace halfplane {

struct StampFate {
  SampleMask passed;                       ///< by both tests
  SampleMask kept;                         ///< samples of these that the alpha test has kept
  SampleMask changed;                      ///< samples whose stored word the tests change, before the alpha test
  SampleMask written;                      ///< samples of these whose word is written
  SampleMask shaded;                       ///< pixels that a texture unit colours
  std::span<const TextureLookup> lookups;  ///< of the shaded pixels, until the next stamp
};

class FragmentPath {
 public:
  FragmentPath(const Config& config, const Widths& widths) : config_(config), widths_(widths) {
    if (has_texture_planes(config)) units_.emplace(config, widths);
  }

  [[nodiscard]] const ColorState& colors() const { return colors_; }
  [[nodiscard]] const StencilState& stencil() const { return stencil_; }
  [[nodiscard]] const std::optional<FragmentUnits>& units() const { return units_; }

  /// A token sets one of the registers; of a texture unit that is not there it sets nothing, as in raster_top.
  /// `codes`: of its vertex, or of the fragment that it has become.
  template <class Codes>
  void set(StateRegister which, const Codes& codes) {
    if (is_of_texture(which)) {
      if (units_) units_->set(which, codes, widths_);
      return;
    }
    stencil_.set(which, state_word(codes, widths_));
    colors_.set(which, state_word(codes, widths_));
  }
  /// Sets the registers of colours and stencil, without a token.
  void set(const ColorState& colors, const StencilState& stencil) {
    colors_ = colors;
    stencil_ = stencil;
  }

  /// A stamp with a covered sample, from depth_test to the framebuffer.
  template <class Port>
  StampFate shade(const FragmentPacket& fragment, CounterPacket& counters, Port&& port) {
    const bool tests_alpha = colors_.tests_alpha();
    test_samples(fragment, port.stored(), stencil_, widths_, packet_);
    StampFate fate;
    fate.passed = fate.kept = packet_.passed;
    fate.changed = packet_.write_depth;
    port.interpolate_colors(tests_alpha ? fragment.mask : packet_.write_color);
    if (!units_ && tests_alpha) drop(opaque_samples(fragment, colors_, widths_), fate);
    // The texture unit takes a pixel's colour from its first sample.
    SampleMask colored = packet_.write_color;
    if (units_) colored = widths_.stamps.samples_of(widths_.stamps.pixels_of(shaded_samples(packet_, colors_)));
    if constexpr (std::remove_cvref_t<Port>::kSendsPackets) {
      complete_depths(fragment, packet_, widths_);
      colored = SampleMask::all(widths_.samples);
    }
    add_colors(fragment, colored, config_, widths_, packet_);
    port.send(packet_);
    if (config_.hiz_bits != 0 && fragment.kind != PrimitiveKind::line) {
      const bool may_fail = is_late(fragment.state, tests_alpha, config_);
      visit_.add(fragment, fate.kept, may_fail ? SampleMask() : fate.kept, widths_);
    }
    if (units_) texture(fragment, counters, fate, port);
    if (packs_at_write(config_) && packet_.write_color.any())
      written_colors(colors_.ops, {fragment.key.tile_x, fragment.key.tile_y, fragment.stamp}, packet_.write_color,
                     port.stored_colors(packet_.write_color), packet_.color, config_, widths_);
    port.write(packet_);
    fate.written = packet_.write_depth;
    if (is_counted(fragment.kind)) count(fragment, fate, counters);
    return fate;
  }

  /// The end of a tile visit, with its last stamp `last`.
  [[nodiscard]] RetirePacket retire(const FragmentPacket& last) {
    return std::exchange(visit_, {}).retire(last, config_, widths_);
  }

 private:
  void drop(SampleMask opaque, StampFate& fate) {
    keep(opaque, packet_);
    fate.kept = fate.kept & opaque;
  }

  /// Light, texture unit and fog, and the alpha test after them.
  template <class Port>
  void texture(const FragmentPacket& fragment, CounterPacket& counters, StampFate& fate, Port& port) {
    if (units_->change_colors(fragment)) port.interpolate_over_w(shaded_samples(packet_, colors_));
    const TexturedStamp shaded =
        texture_stamp(*units_, fragment, packet_, colors_, config_, widths_,
                      [&port](std::uint32_t address, int beats) { return port.read(address, beats); });
    halfplane::count(use_of(shaded.lookups), counters);
    fate.shaded = shaded.live;
    fate.lookups = shaded.lookups;
    if (shaded.packet.mask.any()) port.send(shaded.packet);
    shaded.packet.mask.for_each([&](std::size_t s) { packet_.color[s] = shaded.packet.color[s]; });
    if (colors_.tests_alpha()) drop(shaded.opaque, fate);
  }

  static void count(const FragmentPacket& fragment, const StampFate& fate, CounterPacket& counters) {
    const auto passed = static_cast<std::uint64_t>(fate.passed.count());
    const auto kept = fate.kept == fate.passed ? passed : static_cast<std::uint64_t>(fate.kept.count());
    counters.covered += static_cast<std::uint64_t>(fragment.mask.count());
    counters.depth_passed += passed;
    counters.alpha_killed += passed - kept;
    if (fragment.state.writes()) counters.written += kept;
  }

  Config config_;
  Widths widths_;
  StencilState stencil_;
  ColorState colors_;
  std::optional<FragmentUnits> units_;
  TileVisit visit_;     ///< state of the current tile visit after its stamps so far
  WritePacket packet_;  ///< of the current stamp
};

}  // namespace halfplane
