// The hardware engine: the results of the RTL, packet by packet, in program order and without time. Every packet goes
// to a PacketSink on its way; the co-simulation compares the RTL's with them. Timing is in cycle/cycle_model.hpp.
#pragma once

#include <deque>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "../host/primitive_stream.hpp"
#include "../host/texture_memory.hpp"
#include "../pipeline_graph.hpp"
#include "../stages/block_cache.hpp"
#include "../stages/fragment_path.hpp"
#include "../stages/hiz.hpp"
#include "../stages/memory_port.hpp"
#include "../stages/tile_cache.hpp"
#include "render.hpp"

namespace halfplane {

/// Initial value of a byte of memory: the same in every TileMemory, and different in neighbouring bytes.
[[nodiscard]] std::uint8_t memory_garbage(std::uint32_t address);

/// The memory downstream of the memory port: bytes, with the buffers and flags laid out by the host. Pages are allocated on
/// the first write.
class TileMemory {
 public:
  explicit TileMemory(const Config& config);
  TileMemory(const Config& config, const MemoryLayout& layout);
  /// Executes a write.
  void write(const MemoryBeat& beat);
  /// The bytes of one beat.
  void read(std::uint32_t address, MemoryBeat::Bytes& data) const;
  /// Whether a beat lies in the target.
  [[nodiscard]] bool has(const MemoryBeat& beat) const { return beat.address < end_; }
  /// The codes of a stamp, of depth with the stencil above them: the first lanes of `data`, as many as memory stores
  /// for the buffer; the others are left unchanged.
  void read(TilePlane plane, int tile_x, int tile_y, int stamp, std::span<std::uint32_t, kMaxSamples> data) const;
  /// The value of a buffer's last fast clear: that of a block whose flag is set.
  void set_clear_value(TilePlane plane, std::uint32_t code) { clear_value_[static_cast<std::size_t>(plane)] = code; }
  [[nodiscard]] std::uint32_t clear_value(bool is_color) const { return clear_value_[is_color ? 1 : 0]; }
  /// Whether the stamp is stale because its block's flag is set. After a flush.
  [[nodiscard]] bool is_cleared(bool is_color, int tile_x, int tile_y, int stamp) const;
  /// Whether its block has one colour per pixel, with compress.unit. After a flush.
  [[nodiscard]] bool is_of_pixels(int tile_x, int tile_y, int stamp) const;
  [[nodiscard]] const MemoryLayout& layout() const { return layout_; }
  [[nodiscard]] int tiles_x() const { return widths_.tiles_x; }  ///< for the widest and highest target
  [[nodiscard]] int tiles_y() const { return widths_.tiles_y; }
  [[nodiscard]] int stamps() const { return widths_.stamps.stamps(); }  ///< of a tile
  [[nodiscard]] int samples() const { return widths_.samples; }         ///< of a stamp
  [[nodiscard]] std::size_t pages() const { return page_.size(); }
  static constexpr std::uint32_t kPage = 4096;  ///< bytes
  /// All bytes of a page that was ever written; none otherwise. Two memories with equal writes agree on it.
  [[nodiscard]] std::span<const std::uint8_t> page(std::size_t n) const;

 private:
  static constexpr std::uint32_t kNone = ~0U;
  [[nodiscard]] std::uint8_t byte(std::uint32_t address) const;
  [[nodiscard]] bool flag(TilePlane flags, int tile_x, int tile_y, int stamp) const;
  Widths widths_;
  MemoryLayout layout_;
  std::uint64_t end_;              ///< one beyond the last byte
  std::array<bool, 2> has_flags_;  ///< of depth, of colour
  bool compresses_;                ///< compress.unit
  std::array<std::uint32_t, 2> clear_value_{};
  std::vector<std::uint32_t> page_;  ///< index of each page in bytes_, or kNone
  std::vector<std::uint8_t> bytes_;
};

/// The two images, as stored in memory. Padding as in an empty target: farthest depth, opaque black.
[[nodiscard]] Framebuffer to_framebuffer(const TileMemory& memory, int width, int height, const Config& config);

/// The whole chip and its memory, after reset. `sink` must outlive it.
class HardwareModel final : private MemoryPort {
 public:
  HardwareModel(const Config& config, PacketSink& sink);
  /// With a memory that may already have content.
  HardwareModel(const Config& config, PacketSink& sink, TileMemory memory);
  /// From now on the texture memory holds the textures of `scene`.
  void hold_textures(const Scene& scene) { hold_textures(TextureMemory(scene, config_)); }
  void hold_textures(TextureMemory textures) { texels_ = std::move(textures); }
  /// Runs one primitive, to its last write: every packet that follows from it. `line`: present if and only if its kind
  /// is line.
  void run(const PrimitivePacket& primitive, const std::optional<LineSetup>& line = std::nullopt);
  [[nodiscard]] const CounterPacket& counters() const { return counters_; }
  [[nodiscard]] const TileMemory& memory() const { return memory_; }

 private:
  void join(const FragmentPacket& fragment);
  void shade(const FragmentPacket& fragment);
  void request(const MemoryRequest& request) override;
  const MemoryResponse& response() override;
  void set_state(const FragmentPacket& token);
  struct StampPort;
  [[nodiscard]] TextureLine read_texels(std::uint32_t address, int beats);

  Config config_;
  Widths widths_;
  PacketSink& sink_;
  CounterPacket counters_;
  Hiz hiz_;
  std::variant<TileCache, BlockCache> cache_;
  TileMemory memory_;
  FragmentPath path_;
  TextureMemory texels_;
  PortStage port_;
  std::deque<MemoryResponse> responses_;  ///< to earlier requests
  MemoryResponse response_;
  std::uint8_t slot_ = 0;  ///< context slot of the next primitive
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
