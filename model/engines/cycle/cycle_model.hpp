// The cycle model: the bits of the stages and the cycle in which every item crosses every boundary between them. Exact
// against rtl_ref, and without a clock: one primitive at a time goes all the way through, because an item waits only
// for earlier items.
#pragma once

#include <memory>

#include "../../host/frame_bins.hpp"
#include "../../timing/memory.hpp"
#include "../../timing/stream.hpp"
#include "../render.hpp"
#include "parameters.hpp"
#include "streams.hpp"
#include "timing_totals.hpp"

namespace halfplane {

struct CycleOptions {
  Stalls stalls;                              ///< injected back-pressure
  TimingParameters parameters;                ///< sizes of buffers; the default is the RTL
  TransferSink* sink = nullptr;               ///< sees every crossing; slows the model down. Must outlive the model
  std::optional<MemoryLayout> layout;         ///< addresses of the buffers in memory; default_layout() unless given
  MemorySettings textures;                    ///< of the texture unit's memory, if there is one; without its traffic
  bool want_count = false, want_ids = false;  ///< fill Rendering::count (without tiles that HiZ skips), ids
  bool want_cost = false;                     ///< fill CycleRendering::cost
  bool want_misses = false;                   ///< fill CycleRendering::misses
};

/// The whole chip after reset, and its memory.
class CycleModel {
 public:
  virtual ~CycleModel() = default;
  /// Begins the next frame, of any size: pixels that the host does not clear stay, if the size stays. The host offers
  /// its next primitive from `cycle` on. With more than one thread, and without a sink, the times of the frame are
  /// computed by a thread of their own; nothing depends on it.
  virtual void begin(int width, int height, Cycle cycle, int threads = 1) = 0;
  /// From now on the texture memory holds the textures of `scene`.
  virtual void hold_textures(const Scene& scene) = 0;
  /// Runs one primitive, to its last write. With a sink its times have been seen then. Returns false if cull dropped it.
  virtual bool run(const HostPrimitive& primitive) = 0;
  /// No primitive follows in this frame: rendering() is complete, and times may still be under way.
  virtual void end() = 0;
  /// The times of all primitives so far. What follows is up to this. Throws what the memory throws, as run() may.
  virtual void complete() = 0;
  [[nodiscard]] virtual const CounterPacket& counters() const = 0;  ///< as the RTL's, since reset
  [[nodiscard]] virtual TimingTotals totals() const = 0;
  [[nodiscard]] virtual const Stream& stream(Arrow boundary) const = 0;
  /// The frame; count and ids since begin().
  [[nodiscard]] virtual Rendering& rendering() = 0;
  /// Cycles of each pixel since begin(), width * height of them; empty unless wanted.
  [[nodiscard]] virtual std::vector<float>& cost() = 0;
  /// Likewise the texture lines requested from memory.
  [[nodiscard]] virtual std::vector<float>& misses() = 0;
};

/// `memory` must outlive the model. Throws InputError for a configuration or parameters that no hardware supports.
[[nodiscard]] std::unique_ptr<CycleModel> make_cycle_model(const Config& config, MemoryTiming& memory,
                                                           const CycleOptions& options = {});

/// The cost of a frame.
struct CycleRun {
  Cycle cycles = 0;                 ///< to the last item that crossed any boundary, memory included
  std::uint64_t raster_cycles = 0;  ///< from the first primitive taken to the last write into the on-chip tiles
  std::uint64_t tile_cycles = 0;    ///< cycles among them in which the framebuffer moved tiles and served no access
  TimingTotals totals;
  std::array<StreamUse, kArrows> use{};  ///< of each elastic arrow
  MemoryUse others;                      ///< the memory traffic of other masters
};

struct CycleRendering {
  Rendering rendering;
  CycleRun run;
  /// Cycles of each pixel: the time between the last fragments of two successive tile visits is shared by the pixels
  /// that the visit covered (or, if there are none, by the pixels of its box). Width * height, or empty.
  std::vector<float> cost;
  /// Lines of texels requested from memory by the samples of each pixel; their sum is Counters::texture.fills.
  /// Likewise.
  std::vector<float> misses;
};

/// Frame after frame through one chip and its memory. With frame.order bins and frame.store color, bins whose content
/// equals the frame's drawing in them are skipped.
class CycleFrames {
 public:
  /// `memory` and the objects that `options` points to must outlive this. Throws InputError as make_cycle_model().
  CycleFrames(const Config& config, MemoryTiming& memory, const CycleOptions& options = {});

  /// Renders the next frame, to the end of its flush. Throws InputError as check_hardware_scene(); then, and when
  /// progress throws, nothing more can be drawn. Uses `render.progress`, and of skip the switch of bins.
  [[nodiscard]] CycleRendering draw(const Scene& scene, const RenderOptions& render = {});

 private:
  friend CycleRendering render_cycle(const Scene& scene, const Config& config, MemoryTiming& memory,
                                     const RenderOptions& render, const CycleOptions& options);
  /// Compares bins with their previous content, if there is any.
  [[nodiscard]] CycleRendering draw(const Scene& scene, const RenderOptions& render, BinContents* held);

  Config config_;
  MemoryTiming& memory_;
  std::unique_ptr<CycleModel> model_;
  BinContents held_;
  CounterPacket counted_;  ///< up to the frame before, like the members below
  TimingTotals totals_;
  std::array<StreamUse, kArrows> use_{};
  MemoryUse others_;
  Cycle start_ = 0;
};

/// Renders `scene` from reset to the end of its flush. Throws InputError as check_hardware_scene(). Uses progress,
/// want_count and want_ids of `render`.
[[nodiscard]] CycleRendering render_cycle(const Scene& scene, const Config& config, MemoryTiming& memory,
                                          const RenderOptions& render = {}, const CycleOptions& options = {});

}  // namespace halfplane
