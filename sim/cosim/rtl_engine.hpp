// The RTL as an engine: a scene in, its image, counters and cycles out; nothing is compared.
#pragma once

#include "model/engines/render.hpp"
#include "sim/cosim/lockstep.hpp"

namespace halfplane {

struct RtlRendering {
  Rendering rendering;  ///< frame and counters; no count, ids and triangles
  LockstepResult run;   ///< cycles and use of the streams
};

/// Renders `scene` by `dut`, flush included. Uses progress of `options`. Throws InputError for a scene that the
/// hardware does not support, std::runtime_error when the RTL hangs.
[[nodiscard]] RtlRendering render_rtl(Dut& dut, const Scene& scene, const Config& config, const RenderOptions& options);

/// Frame after frame through one design, without a reset between them. With frame.order bins and frame.store color,
/// bins whose content equals the draws of a frame are skipped.
class RtlFrames {
 public:
  /// `dut` must outlive this.
  RtlFrames(Dut& dut, const Config& config);
  /// Draws the next frame. Its counters are the specification's: the RTL counts from reset on, and its overflow flag
  /// stays set. Uses progress of `options`, and of skip the switch of bins. Throws as render_rtl(); then nothing more
  /// can be drawn.
  [[nodiscard]] RtlRendering draw(const Scene& scene, const RenderOptions& options);

 private:
  Config config_;
  std::function<void(double)> progress_;
  Lockstep lockstep_;
  HardwareFrames specification_;
};

struct FaultyFrame {
  std::optional<Framebuffer> frame;  ///< none: it hangs, or has not ended within the cycles
  std::uint64_t cycles = 0;
};

/// The image of `scene` by `dut` with a fault in it (0: none), limited to about `most_cycles`.
[[nodiscard]] FaultyFrame render_faulty(Dut& dut, const Scene& scene, const Config& config, std::uint16_t mutant,
                                        std::uint64_t most_cycles);

}  // namespace halfplane
