#include "tile_cache.hpp"

#include <algorithm>
#include <bit>

namespace halfplane {
namespace {

std::size_t number(TilePlane plane) { return static_cast<std::size_t>(plane); }

}  // namespace

TileCache::TileCache(const Config& config, const Widths& widths)
    : stamps_(widths.stamps_per_row * widths.stamps_per_row),
      samples_(widths.samples),
      line_x_bits_(widths.line_x_bits),
      line_y_bits_(widths.line_y_bits),
      tiles_x_(static_cast<std::size_t>(widths.tiles_x)),
      code_mask_{static_cast<std::uint32_t>(widths.depth_code.range.hi),
                 static_cast<std::uint32_t>(widths.stored_color.range.hi)},
      lines_(static_cast<std::size_t>(config.cache_lines)) {
  const auto pixels = static_cast<std::size_t>(config.tile_size) * static_cast<std::size_t>(config.tile_size);
  for (auto& plane : lanes_) plane.resize(lines_.size() * pixels);
  for (auto& plane : is_cleared_) plane.resize(tiles_x_ * static_cast<std::size_t>(widths.tiles_y));
}

std::size_t TileCache::line_of(int tile_x, int tile_y) const {
  const auto low = [](int value, int bits) { return static_cast<std::size_t>(value & ((1 << bits) - 1)); };
  return low(tile_y, line_y_bits_) << line_x_bits_ | low(tile_x, line_x_bits_);
}

std::size_t TileCache::first_lane(std::size_t line, int stamp) const {
  return (line * static_cast<std::size_t>(stamps_) + static_cast<std::size_t>(stamp)) *
         static_cast<std::size_t>(samples_);
}

std::span<std::uint32_t> TileCache::lanes(TilePlane plane, std::size_t line, int stamp) {
  return {lanes_[number(plane)].data() + first_lane(line, stamp), static_cast<std::size_t>(samples_)};
}

std::span<const std::uint32_t> TileCache::stored(TilePlane plane, int tile_x, int tile_y, int stamp) const {
  return {lanes_[number(plane)].data() + first_lane(line_of(tile_x, tile_y), stamp),
          static_cast<std::size_t>(samples_)};
}

std::uint8_t& TileCache::is_cleared(const Address& address) {
  return is_cleared_[number(address.plane)][address.tile_y * tiles_x_ + address.tile_x];
}

/// Of stamp 0.
MemoryRequest TileCache::request(const Address& address, bool is_write) {
  MemoryRequest request;
  request.is_write = is_write ? 1 : 0;
  request.is_color = address.plane == TilePlane::color ? 1 : 0;
  request.tile_x = address.tile_x;
  request.tile_y = address.tile_y;
  return request;
}

void TileCache::access(int tile_x, int tile_y, MemoryPort& memory, CounterPacket& counters) {
  const std::size_t n = line_of(tile_x, tile_y);
  Line& line = lines_[n];
  if (line.is_valid && line.tile_x == tile_x && line.tile_y == tile_y) return;
  if (line.is_valid) evict(n, memory, counters);
  const auto x = static_cast<std::uint16_t>(tile_x), y = static_cast<std::uint16_t>(tile_y);
  for (const TilePlane plane : kPlanes) fill(n, {plane, x, y}, memory, counters);
  line = {true, x, y, {}};
}

void TileCache::evict(std::size_t line, MemoryPort& memory, CounterPacket& counters) {
  Line& old = lines_[line];
  for (const TilePlane plane : kPlanes) {
    if (!old.is_dirty[number(plane)]) continue;
    const Address address{plane, old.tile_x, old.tile_y};
    MemoryRequest packet = request(address, true);
    for (int stamp = 0; stamp < stamps_; ++stamp) {
      packet.stamp = static_cast<std::uint16_t>(stamp);
      std::ranges::copy(lanes(plane, line, stamp), packet.data.begin());
      memory.write(packet);
    }
    ++counters.tile_evictions;
    is_cleared(address) = 0;
    old.is_dirty[number(plane)] = false;
  }
}

void TileCache::fill(std::size_t line, const Address& address, MemoryPort& memory, CounterPacket& counters) {
  const std::size_t plane = number(address.plane);
  if (is_cleared(address) != 0) {
    ++counters.tile_clears;
    for (int stamp = 0; stamp < stamps_; ++stamp)
      std::ranges::fill(lanes(address.plane, line, stamp), clear_value_[plane]);
    return;
  }
  ++counters.tile_fills;
  MemoryRequest packet = request(address, false);
  for (int stamp = 0; stamp < stamps_; ++stamp) {
    packet.stamp = static_cast<std::uint16_t>(stamp);
    const MemoryResponse& response = memory.read(packet);
    std::ranges::transform(std::span(response.data).first(static_cast<std::size_t>(samples_)),
                           lanes(address.plane, line, stamp).begin(),
                           [mask = code_mask_[plane]](std::uint32_t lane) { return lane & mask; });
  }
}

void TileCache::write(const WritePacket& packet) {
  const std::size_t line = line_of(packet.tile_x, packet.tile_y);
  const auto masked_copy = [&](TilePlane plane, std::uint64_t mask, const std::array<std::uint32_t, 64>& from) {
    const auto to = lanes(plane, line, packet.stamp);
    lines_[line].is_dirty[number(plane)] = lines_[line].is_dirty[number(plane)] || mask != 0;
    for (; mask != 0; mask &= mask - 1) {
      const auto sample = static_cast<std::size_t>(std::countr_zero(mask));
      to[sample] = from[sample];
    }
  };
  masked_copy(TilePlane::depth, packet.write_depth, packet.depth);
  masked_copy(TilePlane::color, packet.write_color, packet.color);
}

void TileCache::fast_clear(const FragmentPacket& token, std::uint32_t color, MemoryPort& memory,
                           CounterPacket& counters) {
  const std::array<bool, 2> clears{token.depth_write != 0, token.color_write != 0};
  if (!(clears[0] && clears[1]))  // what the cleared plane's lines hold is dead, but writing it back keeps this simple
    for (std::size_t line = 0; line < lines_.size(); ++line) evict(line, memory, counters);
  for (Line& line : lines_) line = {};
  const std::array<std::uint32_t, 2> value{token.depth[0], color};
  for (const TilePlane plane : kPlanes) {
    if (!clears[number(plane)]) continue;
    clear_value_[number(plane)] = value[number(plane)];
    for (std::uint16_t y = 0; y <= token.tile_y; ++y)
      for (std::uint16_t x = 0; x <= token.tile_x; ++x) is_cleared({plane, x, y}) = 1;
  }
}

void TileCache::flush(const FragmentPacket& token, MemoryPort& memory, CounterPacket& counters) {
  for (std::size_t line = 0; line < lines_.size(); ++line) evict(line, memory, counters);
  for (std::uint16_t y = 0; y <= token.tile_y; ++y)
    for (std::uint16_t x = 0; x <= token.tile_x; ++x)
      for (const TilePlane plane : kPlanes) write_clear_value({plane, x, y}, memory, counters);
}

void TileCache::write_clear_value(const Address& address, MemoryPort& memory, CounterPacket& counters) {
  if (is_cleared(address) == 0) return;
  MemoryRequest packet = request(address, true);
  std::fill_n(packet.data.begin(), samples_, clear_value_[number(address.plane)]);
  for (int stamp = 0; stamp < stamps_; ++stamp) {
    packet.stamp = static_cast<std::uint16_t>(stamp);
    memory.write(packet);
  }
  ++counters.tile_evictions;
  is_cleared(address) = 0;
}

}  // namespace halfplane
