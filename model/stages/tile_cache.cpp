#include "tile_cache.hpp"

#include <algorithm>
#include <bit>

namespace halfplane {
namespace {

std::size_t number(TilePlane plane) { return static_cast<std::size_t>(plane); }

/// Of stamp 0, all of it.
MemoryRequest request(const TileAddress& address, bool is_write, int samples) {
  MemoryRequest request;
  request.is_write = is_write;
  request.plane = address.plane;
  if (is_write) request.strobe = SampleMask::all(samples);
  request.tile_x = address.tile_x;
  request.tile_y = address.tile_y;
  return request;
}

}  // namespace

/// Moves the codes of whole planes between the lines and `memory`.
struct TileCache::DataMover {
  TileCache& cache;
  MemoryPort& memory;

  void look_at_line() const {}
  void mark_tile() const {}
  void look_at_tile() const {}

  void write_back(std::size_t line, const TileAddress& address) {
    MemoryRequest packet = request(address, true, cache.samples_);
    for (int stamp = 0; stamp < cache.stamps_; ++stamp) {
      packet.stamp = static_cast<std::uint16_t>(stamp);
      std::ranges::copy(cache.lanes(address.plane, line, stamp), packet.data.begin());
      memory.write(packet);
    }
  }

  void fill(std::size_t line, int x, int y, const std::array<bool, 2>& is_cleared) {
    for (const TilePlane plane : kTilePlanes) {
      MemoryRequest packet =
          request({plane, static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y)}, false, cache.samples_);
      for (int stamp = 0; stamp < cache.stamps_; ++stamp) {
        const auto to = cache.lanes(plane, line, stamp);
        if (is_cleared[number(plane)]) {
          std::ranges::fill(to, cache.clear_value_[number(plane)]);
          continue;
        }
        packet.stamp = static_cast<std::uint16_t>(stamp);
        const MemoryResponse& response = memory.read(packet);
        std::ranges::transform(std::span(response.data).first(to.size()), to.begin(),
                               [mask = cache.code_mask_[number(plane)]](std::uint32_t lane) { return lane & mask; });
      }
    }
  }

  void write_clear_value(const TileAddress& address) {
    MemoryRequest packet = request(address, true, cache.samples_);
    std::fill_n(packet.data.begin(), cache.samples_, cache.clear_value_[number(address.plane)]);
    for (int stamp = 0; stamp < cache.stamps_; ++stamp) {
      packet.stamp = static_cast<std::uint16_t>(stamp);
      memory.write(packet);
    }
  }
};

TileCache::TileCache(const Config& config, const Widths& widths)
    : stamps_(widths.stamps.stamps()),
      samples_(widths.samples),
      code_mask_{static_cast<std::uint32_t>(widths.depth().code.range.hi),
                 static_cast<std::uint32_t>(widths.stored_color.range.hi)},
      directory_(config, widths) {
  const auto pixels = static_cast<std::size_t>(config.tile_size) * static_cast<std::size_t>(config.tile_size);
  for (auto& plane : lanes_) plane.resize(directory_.lines() * pixels);
}

std::size_t TileCache::first_lane(std::size_t line, int stamp) const {
  return (line * static_cast<std::size_t>(stamps_) + static_cast<std::size_t>(stamp)) *
         static_cast<std::size_t>(samples_);
}

std::span<std::uint32_t> TileCache::lanes(TilePlane plane, std::size_t line, int stamp) {
  return {lanes_[number(plane)].data() + first_lane(line, stamp), static_cast<std::size_t>(samples_)};
}

std::span<const std::uint32_t> TileCache::stored(TilePlane plane, int tile_x, int tile_y, int stamp) const {
  return {lanes_[number(plane)].data() + first_lane(directory_.line_of(tile_x, tile_y), stamp),
          static_cast<std::size_t>(samples_)};
}

std::span<const std::uint32_t> TileCache::access(const FragmentPacket& fragment, MemoryPort& memory,
                                                 CounterPacket& counters) {
  const TileKey& key = fragment.key;
  directory_.access(key.tile_x, key.tile_y, DataMover{*this, memory}, counters);
  return stored(TilePlane::depth, key.tile_x, key.tile_y, fragment.stamp);
}

void TileCache::write(const FragmentPacket&, const WritePacket& packet) {
  const std::size_t line = directory_.line_of(packet.key.tile_x, packet.key.tile_y);
  const auto masked_copy = [&](TilePlane plane, SampleMask mask, const WritePacket::Codes& from) {
    const auto to = lanes(plane, line, packet.stamp);
    mask.for_each([&](std::size_t sample) { to[sample] = from[sample]; });
  };
  masked_copy(TilePlane::depth, packet.write_depth, packet.depth);
  masked_copy(TilePlane::color, packet.write_color, packet.color);
  directory_.wrote(packet.key.tile_x, packet.key.tile_y, packet.write_depth.any(), packet.write_color.any());
}

void TileCache::fast_clear(const FragmentPacket& token, std::uint32_t color, MemoryPort& memory,
                           CounterPacket& counters) {
  const std::array<bool, 2> clears{token.state.depth_write, token.state.color_write};
  directory_.fast_clear(token.key.tile_x, token.key.tile_y, clears, DataMover{*this, memory}, counters);
  if (clears[0]) clear_value_[0] = token.code[0][kDepthPlane];
  if (clears[1]) clear_value_[1] = color;
}

void TileCache::flush(const FragmentPacket& token, MemoryPort& memory, CounterPacket& counters) {
  directory_.flush(token.key.tile_x, token.key.tile_y, DataMover{*this, memory}, counters);
}

}  // namespace halfplane
