#include "tile_cache.hpp"

#include <algorithm>

namespace halfplane {

/// Moves the codes of stamps between the lines and `memory`.
struct TileCache::DataMover {
  TileCache& cache;
  MemoryPort& memory;

  void look_at_line() const {}
  void mark_words(int) const {}
  void look_at_tile() const {}

  void write_back(std::size_t line, const TileAddress& address, const StampRows& rows, bool fills) {
    const std::size_t p = number(address.plane);
    for_each_stamp(address, rows, fills, [&](MemoryRequest& request) {
      if (!fills) request.strobe = cache.dirty_[p][cache.stamp_index(line, request.stamp)];
      const auto codes = cache.lanes(address.plane, line, request.stamp);
      request.strobe.for_each([&](std::size_t sample) { request.data[sample] = codes[sample]; });
    });
  }

  void fill(std::size_t line, int x, int y, const std::array<bool, 2>& is_cleared) {
    if (!is_cleared[0]) {
      MemoryRequest request =
          request_of(TilePlane::depth, {static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y), 0});
      request.run = static_cast<std::uint16_t>(cache.stamps_);
      memory.request(request);
    }
    for (int stamp = 0; stamp < cache.stamps_; ++stamp) {
      for (const TilePlane plane : kTilePlanes) {
        cache.dirty_[number(plane)][cache.stamp_index(line, stamp)] = {};
        if (is_cleared[number(plane)])
          std::ranges::fill(cache.lanes(plane, line, stamp), cache.clear_value_[number(plane)]);
      }
      if (is_cleared[0]) continue;
      const auto to = cache.lanes(TilePlane::depth, line, stamp);
      const MemoryResponse& response = memory.response();
      std::ranges::transform(std::span(response.data).first(to.size()), to.begin(),
                             [mask = cache.code_mask_](std::uint32_t lane) { return lane & mask; });
    }
  }

  void write_flags(TilePlane plane, int word, int words, int y, std::uint64_t bits) {
    memory.request(flag_word_request(plane, word, words, y, bits, cache.widths_));
  }

  void write_clear_value(const TileAddress& address, const StampRows& rows) {
    for_each_stamp(address, rows, true, [&](MemoryRequest& request) {
      std::fill_n(request.data.begin(), cache.widths_.samples, cache.clear_value_[number(address.plane)]);
    });
  }

 private:
  /// Writes the stamps in `rows`, all of each; change(request) sets the data.
  template <class Change>
  void for_each_stamp(const TileAddress& address, const StampRows& rows, bool is_whole, Change&& change) {
    for (int stamp = 0; stamp < cache.stamps_; ++stamp) {
      const int per_row = cache.widths_.stamps.stamps_per_row;
      if ((rows[static_cast<std::size_t>(stamp / per_row)] >> stamp % per_row & 1) == 0) continue;
      MemoryRequest request =
          request_of(address.plane, {address.tile_x, address.tile_y, static_cast<std::uint16_t>(stamp)});
      request.is_write = true;
      request.run = static_cast<std::uint16_t>(run_of(rows, is_whole, stamp, cache.widths_));
      request.strobe = SampleMask::all(cache.widths_.samples);
      change(request);
      memory.request(request);
    }
  }
};

TileCache::TileCache(const Config& config, const Widths& widths)
    : widths_(widths),
      stamps_(widths.stamps.stamps()),
      code_mask_(static_cast<std::uint32_t>(widths.depth().code.range.hi)),
      directory_(config, widths) {
  const std::size_t stamps = stamp_index(directory_.lines(), 0);
  for (const TilePlane plane : kTilePlanes) {
    lanes_[number(plane)].resize(stamps * static_cast<std::size_t>(widths.samples));
    dirty_[number(plane)].resize(stamps);
  }
}

std::span<const std::uint32_t> TileCache::access(const FragmentPacket& fragment, MemoryPort& memory,
                                                 CounterPacket& counters) {
  const TileKey& key = fragment.key;
  directory_.access(key.tile_x, key.tile_y, DataMover{*this, memory}, counters);
  return lanes(TilePlane::depth, directory_.line_of(key.tile_x, key.tile_y), fragment.stamp);
}

void TileCache::write(const FragmentPacket&, const WritePacket& packet) {
  const std::size_t line = directory_.line_of(packet.key.tile_x, packet.key.tile_y);
  const auto masked_copy = [&](TilePlane plane, SampleMask mask, const WritePacket::Codes& from) {
    const auto to = lanes(plane, line, packet.stamp);
    mask.for_each([&](std::size_t sample) { to[sample] = from[sample]; });
    SampleMask& dirty = dirty_[number(plane)][stamp_index(line, packet.stamp)];
    dirty = dirty | mask;
  };
  masked_copy(TilePlane::depth, packet.write_depth, packet.depth);
  masked_copy(TilePlane::color, packet.write_color, packet.color);
  directory_.wrote(packet.key.tile_x, packet.key.tile_y, packet.stamp, packet.write_depth.any(),
                   packet.write_color.any());
}

void TileCache::fast_clear(const FragmentPacket& token, std::uint32_t depth, std::uint32_t color, MemoryPort& memory,
                           CounterPacket& counters) {
  const std::array<bool, 2> clears{token.state.depth_write, token.state.color_write};
  directory_.fast_clear(token.key.tile_x, token.key.tile_y, clears, DataMover{*this, memory}, counters);
  if (clears[0]) clear_value_[0] = depth;
  if (clears[1]) clear_value_[1] = color;
}

void TileCache::flush(const FragmentPacket& token, MemoryPort& memory, CounterPacket& counters) {
  directory_.flush(token.key.tile_x, token.key.tile_y, DataMover{*this, memory}, counters);
}

}  // namespace halfplane
