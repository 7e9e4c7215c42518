// The hardware engine: what the RTL computes, packet by packet, in program order and without time. Every packet goes to
// a PacketSink on its way; the co-simulation compares the RTL's with them. Time is in cycle/cycle_model.hpp.
#pragma once

#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "../host_stream.hpp"
#include "../pipeline_graph.hpp"
#include "../stages/block_cache.hpp"
#include "../stages/depth_test.hpp"
#include "../stages/hiz.hpp"
#include "../stages/tile_cache.hpp"
#include "render.hpp"

namespace halfplane {

/// The lanes of a stamp that nobody has written yet: different everywhere, and the same for every TileMemory.
[[nodiscard]] std::uint32_t memory_garbage(bool is_color, int tile_x, int tile_y, int stamp, int sample,
                                           const Widths& widths);

/// The memory behind the memory port: both planes, tile-major, a stamp at a time, and the flags of cleared blocks. Tiles
/// are allocated when written.
class TileMemory {
 public:
  explicit TileMemory(const Config& config);
  /// The first `samples` lanes of `data`; the others are left alone.
  void read(bool is_color, int tile_x, int tile_y, int stamp, std::span<std::uint32_t, kMaxSamples> data) const;
  void write(const MemoryRequest& request);
  /// Whether the target has what a request asks for.
  [[nodiscard]] bool has(const MemoryRequest& request) const;
  /// The value that the last fast clear gave a plane: that of a block whose flag is set.
  void set_clear_value(TilePlane plane, std::uint32_t code) { clear_value_[static_cast<std::size_t>(plane)] = code; }
  [[nodiscard]] std::uint32_t clear_value(bool is_color) const { return clear_value_[is_color ? 1 : 0]; }
  /// Whether memory's own stamp is garbage because its block's flag is set.
  [[nodiscard]] bool is_cleared(bool is_color, int tile_x, int tile_y, int stamp) const;
  /// Flags by block, rows of the widest target.
  [[nodiscard]] const std::vector<std::uint8_t>& flags(bool is_color) const { return flags_[is_color ? 1 : 0]; }
  [[nodiscard]] int tiles_x() const { return widths_.tiles_x; }  ///< of the widest and highest target
  [[nodiscard]] int tiles_y() const { return widths_.tiles_y; }
  [[nodiscard]] int stamps() const { return widths_.stamps.stamps(); }  ///< of a tile
  [[nodiscard]] int samples() const { return widths_.samples; }         ///< of a stamp
  /// Whether any stamp of the tile was ever written. Two memories with equal writes agree on it.
  [[nodiscard]] bool is_written(bool is_color, int tile_x, int tile_y) const {
    return block_[index(is_color, tile_x, tile_y)] != kNone;
  }

 private:
  static constexpr std::uint32_t kNone = ~0U;
  [[nodiscard]] std::size_t index(bool is_color, int tile_x, int tile_y) const {
    return (static_cast<std::size_t>(is_color ? widths_.tiles_y : 0) + static_cast<std::size_t>(tile_y)) *
               static_cast<std::size_t>(widths_.tiles_x) +
           static_cast<std::size_t>(tile_x);
  }
  [[nodiscard]] std::ptrdiff_t first_lane(std::uint32_t block, int stamp) const {
    return (static_cast<std::ptrdiff_t>(block) * stamps() + stamp) * samples();
  }
  Widths widths_;
  std::array<std::uint32_t, 2> clear_value_{};
  std::array<std::vector<std::uint8_t>, 2> flags_;  ///< as the last flush wrote them
  std::vector<std::uint32_t> block_;                ///< of each tile of each plane: which tile of lanes_, or kNone
  std::uint32_t blocks_ = 0;                        ///< tiles in lanes_
  std::vector<std::uint32_t> lanes_;                ///< stamp by stamp
};

/// The two images, as the memory holds them. Padding as in an empty target: farthest depth, opaque black.
[[nodiscard]] Framebuffer to_framebuffer(const TileMemory& memory, int width, int height, const Config& config);

/// The whole chip and the memory behind it, after reset. `sink` must outlive it.
class HardwareModel final : private MemoryPort {
 public:
  HardwareModel(const Config& config, PacketSink& sink);
  /// One primitive, to its last write: every packet that follows from it. `line`: there if and only if its kind is line.
  void run(const PrimitivePacket& primitive, const std::optional<LineSetup>& line = std::nullopt);
  [[nodiscard]] const CounterPacket& counters() const { return counters_; }
  [[nodiscard]] const TileMemory& memory() const { return memory_; }

 private:
  void join(const FragmentPacket& fragment);
  void shade(const FragmentPacket& fragment);
  void write(const MemoryRequest& request) override;
  const MemoryResponse& read(const MemoryRequest& request) override;

  Config config_;
  Widths widths_;
  PacketSink& sink_;
  CounterPacket counters_;
  Hiz hiz_;
  TileVisit visit_;  ///< what the stamps of the current tile visit have done so far
  std::variant<TileCache, BlockCache> cache_;
  TileMemory memory_;
  MemoryResponse response_;
  std::uint8_t slot_ = 0;  ///< context slot of the next primitive
};

/// Adds what the hardware counted to what the host did (HostStream::counters). `drawn`: input triangles of which at
/// least one piece passed cull.
void count_hardware(const CounterPacket& hardware, std::uint64_t drawn, Counters& counters);

/// Counts the input triangles of which at least one piece passes cull. Their pieces come one after the other.
class DrawnCount {
 public:
  /// Primitives that cull has dropped so far.
  [[nodiscard]] static std::uint32_t dropped(const CounterPacket& c) { return c.zero_area + c.backface + c.empty; }
  void add(const HostPrimitive& primitive, bool is_kept) {
    if (primitive.packet.kind != PrimitiveKind::triangle || !is_kept) return;
    if (last_ == primitive.primitive) return;
    ++count_;
    last_ = primitive.primitive;
  }
  [[nodiscard]] std::uint64_t count() const { return count_; }

 private:
  std::uint64_t count_ = 0;
  std::int64_t last_ = -1;  ///< input triangle that was counted last
};

/// Renders `scene` by the hardware model, flush included. Fills frame and counters, not count, ids, visible and
/// triangles; of options it takes progress. Throws InputError as check_hardware_scene().
[[nodiscard]] Rendering render_hardware(const Scene& scene, const Config& config, const RenderOptions& options = {});

}  // namespace halfplane
