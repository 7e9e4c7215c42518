// The hardware engine: the results of the RTL, packet by packet, in program order and without time. Every packet goes
// to a PacketSink on its way; the co-simulation compares the RTL's with them. Timing is in cycle/cycle_model.hpp.
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "../host/primitive_stream.hpp"
#include "../host/texture_memory.hpp"
#include "../pipeline_graph.hpp"
#include "render.hpp"
#include "tile_memory.hpp"

namespace halfplane {

class HardwareWatch;  // hardware_watch.hpp

/// The whole chip and its memory, after reset. `sink` must outlive it.
class HardwareModel {
 public:
  HardwareModel(const Config& config, PacketSink& sink);
  /// With a memory that may already have content.
  HardwareModel(const Config& config, PacketSink& sink, TileMemory memory);
  ~HardwareModel();
  HardwareModel(HardwareModel&&) noexcept;
  HardwareModel& operator=(HardwareModel&&) noexcept;
  /// From now on the texture memory holds the textures of `scene`.
  void hold_textures(const Scene& scene);
  void hold_textures(TextureMemory textures);
  /// From now on `tap` gets what each stamp leaves in the framebuffer: the write's masks and words downstream of all
  /// units, in the stored formats. The RTL has no wire with all of them.
  void tap_writes(std::function<void(const WritePacket&)> tap);
  /// `watch`, which must outlive this, sees the work from now on; null: nothing does.
  void set_watch(HardwareWatch* watch);
  /// Runs one primitive, to its last write: every packet that follows from it. `line`: present if and only if its kind
  /// is line.
  void run(const PrimitivePacket& primitive, const std::optional<LineSetup>& line = std::nullopt);
  [[nodiscard]] const CounterPacket& counters() const;
  [[nodiscard]] const TileMemory& memory() const;

 private:
  class Pipeline;  // not here: an edit of a stage concerns few that draw with it
  std::unique_ptr<Pipeline> pipeline_;
};

/// The counters of the RTL after these items: `overflow` tells whether one of them has passed its width.
[[nodiscard]] CounterPacket as_counted(CounterPacket counters, const Widths& widths);

/// Events counted after `before`.
[[nodiscard]] CounterPacket since(CounterPacket now, const CounterPacket& before);

/// Adds the hardware's counts to the host's (HostStream::counters). `drawn`: input triangles of which at least one
/// piece passed cull.
void count_hardware(const CounterPacket& hardware, std::uint64_t drawn, Counters& counters);

/// Counts the input triangles of which at least one piece passes cull, where the host does not. The pieces of a
/// triangle are consecutive.
class DrawnCount {
 public:
  /// Primitives that cull has dropped so far.
  [[nodiscard]] static std::uint64_t dropped(const CounterPacket& c) { return c.zero_area + c.backface + c.empty; }
  void add(const HostPrimitive& primitive, bool is_kept) {
    if (primitive.packet.kind != PrimitiveKind::triangle || primitive.is_part || !is_kept) return;
    if (last_ == primitive.primitive) return;
    ++count_;
    last_ = primitive.primitive;
  }
  [[nodiscard]] std::uint64_t count() const { return count_; }

 private:
  std::uint64_t count_ = 0;
  std::int64_t last_ = -1;  ///< input triangle counted last
};

/// Frame after frame by one hardware model and its memory. With frame.order bins and frame.store color, bins whose
/// content equals the frame's drawing in them are skipped.
class HardwareFrames {
 public:
  explicit HardwareFrames(const Config& config) : config_(config), model_(config, nobody_) {}
  /// The next frame, flush included: frame and counters, not count, ids, visible and triangles. Uses progress of
  /// options, and of skip the switch of bins. Throws InputError as check_hardware_scene(); then, and when progress
  /// throws, nothing more can be drawn.
  [[nodiscard]] Rendering draw(const Scene& scene, const RenderOptions& options = {});

 private:
  friend Rendering render_hardware(const Scene& scene, const Config& config, const RenderOptions& options);
  /// Compares bins with their previous content, if there is any.
  [[nodiscard]] Rendering draw(const Scene& scene, const RenderOptions& options, BinContents* held);

  PacketSink nobody_;
  Config config_;
  HardwareModel model_;
  BinContents held_;
  CounterPacket counted_;  ///< up to the frame before
};

/// Renders `scene` by the hardware model, flush included. Fills frame and counters, not count, ids, visible and
/// triangles; uses progress of options. Throws InputError as check_hardware_scene().
[[nodiscard]] Rendering render_hardware(const Scene& scene, const Config& config, const RenderOptions& options = {});

}  // namespace halfplane
