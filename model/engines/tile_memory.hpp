// The memory downstream of the memory port, and the picture in it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "../packets/packets.hpp"
#include "../stages/framebuffer.hpp"

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
  /// Any bytes before end().
  void read(std::uint32_t address, std::span<std::uint8_t> bytes) const;
  [[nodiscard]] std::uint64_t end() const { return end_; }  ///< one beyond the last byte
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
  std::uint64_t end_;
  std::array<bool, 2> has_flags_;  ///< of depth, of colour
  bool compresses_;                ///< compress.unit
  std::array<std::uint32_t, 2> clear_value_{};
  std::vector<std::uint32_t> page_;  ///< index of each page in bytes_, or kNone
  std::vector<std::uint8_t> bytes_;
};

/// The two images, as stored in memory. Padding as in an empty target: farthest depth, opaque black.
[[nodiscard]] Framebuffer to_framebuffer(const TileMemory& memory, int width, int height, const Config& config);

}  // namespace halfplane
