#include "block_cache.hpp"

#include <algorithm>
#include <bit>

#include "resolve.hpp"

namespace halfplane {
BlockCache::BlockCache(const Config& config, const Widths& widths)
    : config_(config),
      widths_(widths),
      directory_(config, widths),
      stored_(static_cast<std::size_t>(widths.samples)),
      stored_color_(static_cast<std::size_t>(widths.samples)),
      code_mask_{static_cast<std::uint32_t>(widths.stored_depth.range.hi),
                 static_cast<std::uint32_t>(widths.stored_color.range.hi)},
      of_pixels_(widths) {
  const std::size_t stamps = stamp_index(directory_.lines(), 0);
  for (const TilePlane plane : kTilePlanes) {
    lanes_[number(plane)].resize(stamps * static_cast<std::size_t>(widths.samples));
    dirty_[number(plane)].resize(stamps);
  }
}

std::span<const std::uint32_t> BlockCache::access(const FragmentPacket& fragment, MemoryPort& memory,
                                                  CounterPacket& counters) {
  const StampAddress at{fragment.key.tile_x, fragment.key.tile_y, fragment.stamp};
  last_ = directory_.access(at, fragment.state, fragment.mask == SampleMask::all(widths_.samples));
  last_stamp_ = stamp_index(last_.line, block_stamp(at, widths_).stamp);
  write_victims(last_.writes, memory, counters);
  std::ranges::fill(stored_, last_.source == DepthSource::clear ? clear_value_[0] : 0);
  if (last_.source == DepthSource::clear) ++counters.tile_clears;
  if (last_.source == DepthSource::memory) {
    memory.request(request_of(TilePlane::depth, at));
    const MemoryResponse& response = memory.response();
    std::ranges::transform(std::span(response.data).first(stored_.size()), stored_.begin(),
                           [mask = code_mask_[0]](std::uint32_t lane) { return lane & mask; });
    ++counters.tile_fills;
  }
  color_plane_ = of_pixels_.is_set(last_.block) ? TilePlane::pixel_color : TilePlane::color;
  if (last_.color_source == DepthSource::memory) memory.request(request_of(color_plane_, at));
  if (last_.eviction) capture(*last_.eviction);
  read_colors(memory, counters);
  if (last_.source == DepthSource::chip) std::ranges::copy(lanes(TilePlane::depth, last_stamp_), stored_.begin());
  return stored_;
}

/// Reads stored colours; colours missing on the chip come from the clear value or from memory. Samples of the stamp
/// already written are newer.
void BlockCache::read_colors(MemoryPort& memory, CounterPacket& counters) {
  std::ranges::fill(stored_color_, last_.color_source == DepthSource::clear ? clear_value_[1] : 0);
  if (last_.color_source == DepthSource::none) return;
  if (last_.color_source == DepthSource::memory) {
    const MemoryResponse& response = memory.response();
    const auto samples = static_cast<std::size_t>(color_plane_ == TilePlane::color ? 1 : widths_.pixel_samples);
    for (std::size_t s = 0; s < stored_color_.size(); ++s)
      stored_color_[s] = response.data[s / samples] & code_mask_[1];
    ++counters.tile_fills;
  }
  const auto held = lanes(TilePlane::color, last_stamp_);
  if (last_.color_source == DepthSource::chip) {
    std::ranges::copy(held, stored_color_.begin());
  } else if (!last_.starts_color) {
    dirty_[number(TilePlane::color)][last_stamp_].for_each([&](std::size_t s) { stored_color_[s] = held[s]; });
  }
}

void BlockCache::write(const FragmentPacket& fragment, const WritePacket& packet) {
  const auto masked_copy = [&](TilePlane plane, SampleMask mask, const WritePacket::Codes& from) {
    const auto to = lanes(plane, last_stamp_);
    mask.for_each([&](std::size_t sample) { to[sample] = from[sample]; });
  };
  const auto add_dirty = [&](TilePlane plane, SampleMask written, bool starts) {
    SampleMask& dirty = dirty_[number(plane)][last_stamp_];
    dirty = starts ? written : dirty | written;
  };
  // From now on all of the stamp is on the chip.
  const bool starts_depth = last_.source != DepthSource::chip;
  if (starts_depth) std::ranges::copy(stored_, lanes(TilePlane::depth, last_stamp_).begin());
  masked_copy(TilePlane::depth, packet.write_depth, packet.depth);
  add_dirty(TilePlane::depth, packet.write_depth, starts_depth);
  if (last_.color_source != DepthSource::none && last_.color_source != DepthSource::chip)
    std::ranges::copy(stored_color_, lanes(TilePlane::color, last_stamp_).begin());
  masked_copy(TilePlane::color, packet.write_color, packet.color);
  if (fragment.state.color_write) add_dirty(TilePlane::color, packet.write_color, last_.starts_color);
}

/// Reduces the colours of a stamp on its way to memory to one per pixel. All samples of a pixel are present: its block
/// leaves the chip once in a frame that began with a clear.
void BlockCache::resolve_stamp(MemoryRequest& request) const {
  const int n = widths_.pixel_samples;
  SampleMask strobe;
  for (int pixel = 0; pixel < widths_.pixels; ++pixel) {
    const auto first = static_cast<std::size_t>(pixel * n);
    strobe.set(pixel, request.strobe.has(first));
    request.data[static_cast<std::size_t>(pixel)] =
        mean_color(config_.color_format, n, [&](int k) { return request.data[first + static_cast<std::size_t>(k)]; });
  }
  std::fill(request.data.begin() + widths_.pixels, request.data.begin() + widths_.samples, 0U);
  request.strobe = strobe;
}

/// A stamp whose pixels have one colour each, in the form for memory.
void BlockCache::choose_pixels(MemoryRequest& request) const {
  const auto n = static_cast<std::size_t>(widths_.pixel_samples);
  SampleMask strobe;
  for (int pixel = 0; pixel < widths_.pixels; ++pixel) {
    const auto p = static_cast<std::size_t>(pixel);
    strobe.set(pixel, request.strobe.has(p * n));
    request.data[p] = request.data[p * n];
  }
  std::fill(request.data.begin() + widths_.pixels, request.data.begin() + widths_.samples, 0U);
  request.strobe = strobe;
  request.plane = TilePlane::pixel_color;
}

/// Makes the requests of an eviction, before its line is overwritten.
void BlockCache::capture(const Eviction& eviction) {
  Victim& victim = victims_.emplace_back();
  victim.block = eviction.block;
  for (const TilePlane plane : kTilePlanes) {
    const std::size_t p = number(plane);
    for (int stamp = 0; stamp < widths_.blocks.stamps(); ++stamp) {
      const bool is_here = (eviction.stamps[p] >> stamp & 1) != 0;
      const std::size_t at = stamp_index(eviction.line, stamp);
      const SampleMask dirty = is_here ? dirty_[p][at] : SampleMask();
      // Depths of a stamp are on the chip all or none; of colours only the written ones.
      const SampleMask held = plane == TilePlane::depth && is_here ? SampleMask::all(widths_.samples) : dirty;
      MemoryRequest request = request_of(plane, stamp_address({eviction.block, stamp}, widths_));
      request.is_write = true;
      request.strobe = eviction.fills[p] ? SampleMask::all(widths_.samples) : dirty;
      if (!request.strobe.any()) continue;
      const auto codes = lanes(plane, at);
      request.strobe.for_each([&](std::size_t s) { request.data[s] = held.has(s) ? codes[s] : clear_value_[p]; });
      if (plane == TilePlane::color && config_.resolve_units != 0) resolve_stamp(request);
      victim.stamps[p].push_back(request);
    }
  }
  if (config_.compress_units == 0) return;
  const std::vector<MemoryRequest>& colors = victim.stamps[number(TilePlane::color)];
  victim.colors.fills = eviction.fills[number(TilePlane::color)];
  victim.colors.is_whole = colors.size() == static_cast<std::size_t>(widths_.blocks.stamps());
  for (const MemoryRequest& request : colors) {
    victim.colors.is_whole = victim.colors.is_whole && request.strobe == SampleMask::all(widths_.samples);
    victim.colors.is_uniform = victim.colors.is_uniform &&
                               has_one_color(request.strobe, widths_, [&](std::size_t s) { return request.data[s]; });
  }
}

/// Gives colours on their way to memory the form that the block will have there.
void BlockCache::compress(Victim& victim, MemoryPort& memory, CounterPacket& counters) {
  std::vector<MemoryRequest>& colors = victim.stamps[number(TilePlane::color)];
  if (colors.empty()) return;
  const ColorMove move = color_move(victim.colors, of_pixels_.is_set(victim.block));
  if (move == ColorMove::merge) merge(victim, memory, counters);
  if (move == ColorMove::pixels)
    for (MemoryRequest& request : colors) choose_pixels(request);
  of_pixels_.set(victim.block, move == ColorMove::pixels);
}

/// Writes all samples of the block: the evicted ones over the pixel colours read from memory.
void BlockCache::merge(Victim& victim, MemoryPort& memory, CounterPacket& counters) {
  std::vector<MemoryRequest> all;
  for (int stamp = 0; stamp < widths_.blocks.stamps(); ++stamp) {
    const StampAddress at = stamp_address({victim.block, stamp}, widths_);
    memory.request(request_of(TilePlane::pixel_color, at));
    ++counters.tile_fills;
    MemoryRequest& request = all.emplace_back(request_of(TilePlane::color, at));
    request.is_write = true;
    request.strobe = SampleMask::all(widths_.samples);
  }
  for (MemoryRequest& request : all) {
    const MemoryResponse& response = memory.response();
    request.strobe.for_each([&](std::size_t s) {
      request.data[s] = response.data[s / static_cast<std::size_t>(widths_.pixel_samples)] & code_mask_[1];
    });
    for (const MemoryRequest& leaving : victim.stamps[number(TilePlane::color)])
      if (leaving.stamp == request.stamp)
        leaving.strobe.for_each([&](std::size_t s) { request.data[s] = leaving.data[s]; });
  }
  victim.stamps[number(TilePlane::color)] = std::move(all);
}

void BlockCache::write_victims(int count, MemoryPort& memory, CounterPacket& counters) {
  for (; count > 0; --count) {
    Victim& victim = victims_.front();
    const auto number_in_block = [&](const MemoryRequest& request) {
      return block_stamp({request.tile_x, request.tile_y, request.stamp}, widths_).stamp;
    };
    for (const TilePlane plane : kTilePlanes) {
      if (plane == TilePlane::color && config_.compress_units != 0) compress(victim, memory, counters);
      std::vector<MemoryRequest>& stamps = victim.stamps[number(plane)];
      for (auto request = stamps.begin(); request != stamps.end(); ++request) {
        // Consecutive stamps are a run.
        auto last = request;
        while (std::next(last) != stamps.end() && number_in_block(*std::next(last)) == number_in_block(*last) + 1)
          ++last;
        request->run = static_cast<std::uint16_t>(last - request + 1);
        memory.request(*request);
        ++counters.tile_evictions;
      }
    }
    victims_.pop_front();
  }
}

/// Writes everything back: nothing stays on the chip, or in flight.
void BlockCache::evict_all(MemoryPort& memory, CounterPacket& counters) {
  directory_.evict_all([&](const TagResult& result) {
    write_victims(result.writes, memory, counters);
    if (result.eviction) capture(*result.eviction);
  });
}

void BlockCache::fast_clear(const FragmentPacket& token, std::uint32_t depth, std::uint32_t color, MemoryPort& memory,
                            CounterPacket& counters) {
  const std::array<bool, 2> clears{token.state.depth_write, token.state.color_write};
  const bool clears_bin = token.state.clears_bin();
  if (!(clears[0] && clears[1]) && !clears_bin) evict_all(memory, counters);
  write_victims(directory_.write_all(), memory, counters);
  if (clears_bin) {
    (void)directory_.mark_bin(token.key.tile_x, token.key.tile_y);
    const auto [first, last] = directory_.bin_blocks(token.key.tile_x, token.key.tile_y);
    of_pixels_.set_blocks(first, last, false);
  } else {
    directory_.mark(token.key.tile_x, token.key.tile_y, clears);
    if (clears[1]) of_pixels_.set_tiles(token.key.tile_x, token.key.tile_y, false);
  }
  directory_.drop_depth(token.state.drops_depth());
  if (clears[0]) clear_value_[0] = depth;
  if (clears[1]) clear_value_[1] = color;
}

void BlockCache::flush(const FragmentPacket& token, MemoryPort& memory, CounterPacket& counters) {
  directory_.drop_depth(token.state.drops_depth());
  evict_all(memory, counters);
  write_victims(directory_.write_all(), memory, counters);
  const int last_x = token.key.tile_x, last_y = token.key.tile_y;
  const int words = directory_.words_of((last_x + 1) * widths_.blocks.per_tile - 1);  // of a row
  const auto write_flags = [&](TilePlane plane) {
    directory_.for_each_flag_word(plane, last_x, last_y, [&](int word, int y, std::uint64_t bits) {
      memory.request(flag_word_request(plane, word, words, y, bits, widths_));
    });
  };
  if (!directory_.drops_depth()) write_flags(TilePlane::depth);
  directory_.drop_depth(false);
  if (config_.frame_clears == FrameClears::flags)
    write_flags(TilePlane::color);
  else
    write_cleared(last_x, last_y, memory, counters);
  if (config_.compress_units == 0) return;
  of_pixels_.for_each_word(last_x, last_y, [&](int word, int y, std::uint64_t bits) {
    memory.request(flag_word_request(TilePlane::pixel_color, word, words, y, bits, widths_));
  });
}

/// Writes the clear colour of blocks in which nothing was drawn since the clear.
void BlockCache::write_cleared(int last_x, int last_y, MemoryPort& memory, CounterPacket& counters) {
  directory_.for_each_flag_word(TilePlane::color, last_x, last_y, [&](int word, int y, std::uint64_t bits) {
    for (; bits != 0; bits &= bits - 1) {
      const int x = word * widths_.blocks.flag_word + std::countr_zero(bits);
      for (int stamp = 0; stamp < widths_.blocks.stamps(); ++stamp) {
        const BlockAddress block{static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y)};
        MemoryRequest request = request_of(TilePlane::color, stamp_address({block, stamp}, widths_));
        request.is_write = true;
        request.run = static_cast<std::uint16_t>(widths_.blocks.stamps() - stamp);
        request.strobe = SampleMask::all(widths_.memory_colors);
        request.strobe.for_each([&](std::size_t s) { request.data[s] = clear_value_[1]; });
        if (config_.compress_units != 0) choose_pixels(request);
        memory.request(request);
        ++counters.tile_evictions;
      }
      of_pixels_.set({static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y)}, config_.compress_units != 0);
    }
  });
  directory_.resolve(TilePlane::color, last_x, last_y);
}

}  // namespace halfplane
