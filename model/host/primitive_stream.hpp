// The host's output to the hardware for a scene: snapped primitives with their states, one packet each.
//
// First a fast clear of both buffers, unless the scene begins with one, then the scene's commands, at the end a flush.
// In program order (frame.order program) primitives are sent as they are made: the host clips; the hardware tests
// facing, area and box, except for a clipped polygon, which the host culls as a whole. In bins the host culls, sorts
// the rest (frame_bins.hpp), and sends it bin by bin: at the flush, and where the depth of the whole target is cleared,
// which begins new bins. Other clears after the first primitive of the bins go into them.
//
// A frame that follows another on the same hardware, with BinContents between them, skips bins whose content equals
// their draws. Of its initial clears then remain colours, bin by bin, and depth as a whole.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "../counters.hpp"
#include "../scene.hpp"
#include "frame_bins.hpp"
#include "host_primitive.hpp"

namespace halfplane {

/// Whether all clears of the whole target come before everything else, except clears of colours only: then its bins
/// begin once.
[[nodiscard]] bool begins_once(const Scene& scene);

/// The primitives of a scene, pulled one at a time. `scene` must outlive the stream.
class HostStream {
 public:
  /// Throws InputError for a scene that the hardware does not support. `held`: the content of a target in the
  /// hardware's memory; it must outlive the stream, and describes memory once all has been drawn. Null: everything is
  /// drawn.
  HostStream(const Scene& scene, const Config& config, BinContents* held = nullptr);
  ~HostStream();

  /// The next primitive, valid until the next call of pull() or next(); null after the flush.
  /// Throws InputError for a vertex that cannot be snapped.
  [[nodiscard]] const HostPrimitive* pull();
  /// A copy of the next primitive; none after the flush.
  [[nodiscard]] std::optional<HostPrimitive> next();

  /// The host's own counts so far: primitives_in, clipped, and culled primitives, by reason; bins and pairs.
  [[nodiscard]] const Counters& counters() const;

  /// 0...1: the fraction of the scene that has been sent, by commands.
  [[nodiscard]] double progress() const;

 private:
  class Host;
  std::unique_ptr<Host> host_;
};

/// Rules that the hardware relies on and does not check: after reset and state tokens, a fast clear of both buffers,
/// without which the flags of tiles are undefined, and a setup for the place of every line, for which primitive_join
/// would wait forever. Returns the rule that a primitive breaks, or an empty text; `is_first`: the first one after
/// reset.
[[nodiscard]] std::string stream_fault(const HostPrimitive& primitive, bool is_first);

/// Throws InputError, one line naming the state, when `scene` needs a feature that the hardware lacks.
void check_hardware_scene(const Scene& scene, const Config& config);

}  // namespace halfplane
