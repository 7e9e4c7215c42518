#include "tile_memory.hpp"

#include <algorithm>
#include <bit>

#include "../stages/depth_test.hpp"
#include "../stages/fragment_ops.hpp"
#include "../stages/memory_port.hpp"
#include "../stages/pixel_colors.hpp"
#include "../stages/resolve.hpp"

namespace halfplane {

std::uint8_t memory_garbage(std::uint32_t address) {
  const std::uint32_t mixed = (address ^ 0xDEADBEEFU) * 0x9E3779B1U;  // an odd factor: no bit is lost
  return static_cast<std::uint8_t>(mixed >> 24);
}

TileMemory::TileMemory(const Config& config) : TileMemory(config, default_layout(derive_widths(config))) {}

TileMemory::TileMemory(const Config& config, const MemoryLayout& layout)
    : widths_(derive_widths(config)),
      layout_(layout),
      end_(layout_end(layout, widths_)),
      has_flags_{true, config.frame_clears == FrameClears::flags},
      compresses_(config.compress_units != 0),
      page_((end_ - 1) / kPage + 1, kNone) {}

std::uint8_t TileMemory::byte(std::uint32_t address) const {
  const std::uint32_t page = page_[address / kPage];
  return page == kNone ? memory_garbage(address) : bytes_[std::size_t{page} * kPage + address % kPage];
}

std::span<const std::uint8_t> TileMemory::page(std::size_t n) const {
  if (page_[n] == kNone) return {};
  return std::span(bytes_).subspan(std::size_t{page_[n]} * kPage, kPage);
}

void TileMemory::read(std::uint32_t address, MemoryBeat::Bytes& data) const {
  for (int n = 0; n < widths_.port_bytes; ++n)
    data[static_cast<std::size_t>(n)] = byte(address + static_cast<std::uint32_t>(n));
}

void TileMemory::read(std::uint32_t address, std::span<std::uint8_t> bytes) const {
  for (std::uint8_t& out : bytes) out = byte(address++);
}

void TileMemory::write(const MemoryBeat& beat) {
  if (beat.strobe == 0) return;
  std::uint32_t& page = page_[beat.address / kPage];
  if (page == kNone) {
    page = static_cast<std::uint32_t>(bytes_.size() / kPage);
    const std::uint32_t first = beat.address / kPage * kPage;
    for (std::uint32_t n = 0; n < kPage; ++n) bytes_.push_back(memory_garbage(first + n));
  }
  std::uint8_t* bytes = bytes_.data() + std::size_t{page} * kPage + beat.address % kPage;
  for (std::uint64_t left = beat.strobe; left != 0; left &= left - 1) {
    const auto n = static_cast<std::size_t>(std::countr_zero(left));
    bytes[n] = beat.data[n];
  }
}

void TileMemory::read(TilePlane plane, int tile_x, int tile_y, int stamp,
                      std::span<std::uint32_t, kMaxSamples> data) const {
  const bool is_color = halfplane::is_of_color(plane);
  const Width& code = is_color ? widths_.stored_color : widths_.stored_depth;
  std::uint32_t address = byte_address(plane, tile_x, tile_y, stamp, layout_, widths_);
  for (int s = 0; s < codes_of_stamp(plane, widths_); ++s) {
    std::uint32_t value = 0;
    for (int n = 0; n < 1 << widths_.memory.sample[is_color ? 1 : 0]; ++n)
      value |= std::uint32_t{byte(address++)} << 8 * n;
    data[static_cast<std::size_t>(s)] = static_cast<std::uint32_t>(wrap_unsigned(value, code.bits));
  }
}

bool TileMemory::is_cleared(bool is_color, int tile_x, int tile_y, int stamp) const {
  return has_flags_[is_color ? 1 : 0] &&
         flag(is_color ? TilePlane::color_flags : TilePlane::depth_flags, tile_x, tile_y, stamp);
}

bool TileMemory::is_of_pixels(int tile_x, int tile_y, int stamp) const {
  return compresses_ && flag(TilePlane::pixel_flags, tile_x, tile_y, stamp);
}

bool TileMemory::flag(TilePlane flags, int tile_x, int tile_y, int stamp) const {
  const BlockAddress block = block_stamp({static_cast<std::uint16_t>(tile_x), static_cast<std::uint16_t>(tile_y),
                                          static_cast<std::uint16_t>(stamp)},
                                         widths_)
                                 .block;
  const std::uint32_t row = byte_address(flags, 0, tile_y, block.y % widths_.blocks.per_tile, layout_, widths_);
  return (byte(row + block.x / 8U) >> block.x % 8U & 1) != 0;
}

Framebuffer to_framebuffer(const TileMemory& memory, int width, int height, const Config& config) {
  Framebuffer frame(width, height, config.tile_size);
  std::ranges::fill(frame.depth, snap_depth(1.0, config.depth_bits));
  std::ranges::fill(frame.color, pack_color(config.color_format, {0, 0, 0, 255}));
  const bool has_samples = config.msaa_samples > 1 && config.resolve_units == 0;
  frame.samples.assign(has_samples ? static_cast<std::size_t>(config.msaa_samples) : 0, frame);
  const Widths widths = derive_widths(config);
  const int tile = config.tile_size, size = config.stamp_size;
  const StampGrid& stamps = widths.stamps;
  std::array<std::uint32_t, kMaxSamples> data;
  const auto copy_stamp = [&](bool is_color, int x, int y) {
    const int stamp = stamps.stamp_at(x % tile, y % tile);
    const bool of_pixels = is_color && (config.resolve_units != 0 || memory.is_of_pixels(x / tile, y / tile, stamp));
    const TilePlane plane = !is_color                                 ? TilePlane::depth
                            : of_pixels && config.compress_units != 0 ? TilePlane::pixel_color
                                                                      : TilePlane::color;
    if (memory.is_cleared(is_color, x / tile, y / tile, stamp))
      data.fill(memory.clear_value(is_color));
    else
      memory.read(plane, x / tile, y / tile, stamp, data);
    for (int s = 0; s < stamps.samples(); ++s) {
      const PixelOffset pixel = stamps.pixel_of(s);
      if (x + pixel.x >= width || y + pixel.y >= height) continue;
      Framebuffer& of_sample =
          frame.samples.empty() ? frame : frame.samples[static_cast<std::size_t>(s % stamps.per_pixel)];
      const std::size_t at = frame.at(x + pixel.x, y + pixel.y);
      const std::uint32_t code = data[static_cast<std::size_t>(of_pixels ? s / stamps.per_pixel : s)];
      if (is_color) {
        of_sample.color[at] = code;
      } else {
        of_sample.depth[at] = depth_of(code, widths);
        of_sample.stencil[at] = stencil_of(code, widths);
      }
    }
  };
  for (int y = 0; y < height; y += size)
    for (int x = 0; x < width; x += size) {
      copy_stamp(false, x, y);
      copy_stamp(true, x, y);
    }
  resolve(frame, config.color_format);
  return frame;
}

}  // namespace halfplane
