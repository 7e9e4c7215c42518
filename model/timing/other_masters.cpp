#include "other_masters.hpp"

#include <algorithm>

#include "../stages/memory_port.hpp"

namespace halfplane {

OtherMasters::OtherMasters(const MemoryTraffic& traffic, const Config& config, Picoseconds cycle)
    : traffic_(traffic), cycle_(cycle) {
  const Widths widths = derive_widths(config);
  const MemoryGrid& m = widths.memory;
  const MemoryLayout layout = default_layout(widths);
  const int block = widths.blocks.side * config.stamp_size;  // pixels along it
  beat_ = std::uint64_t{1} << m.port;
  lines_ = block;
  tile_size_ = config.tile_size;
  bands_per_tile_ = widths.blocks.per_tile;
  units_per_tile_ = config.compress_units != 0 ? widths.blocks.per_tile : 1;
  const std::uint64_t colors = static_cast<std::uint64_t>(widths.memory_colors / widths.pixels) << m.sample[1];
  unit_ = std::max(beat_, static_cast<std::uint64_t>(config.tile_size / units_per_tile_ * block) * colors);
  tile_pitch_ = std::uint64_t{1} << m.tile();
  row_stride_ = layout.row_stride;
  flag_row_ = std::uint64_t{1} << m.flag_row;
  flag_tiles_ = static_cast<int>(8 * beat_) / widths.blocks.per_tile;
  flag_reads_ = (config.frame_clears == FrameClears::flags ? 1 : 0) + (config.compress_units != 0 ? 1 : 0);
  const std::uint64_t end = layout_end(layout, widths);
  picture_ = (end + tile_pitch_ - 1) / tile_pitch_ * tile_pitch_ + layout.color_base;
  flags_ = (picture_ + end + flag_row_ - 1) / flag_row_ * flag_row_;
  others_base_ = flags_ + end;
  if (traffic.other_bytes_per_s != 0) other_arrives_ = arrives_of_other(0);
}

void OtherMasters::show(int width, int height) {
  if (traffic_.scan_out_hz == 0) return;
  const auto tiles = static_cast<std::uint64_t>((width - 1) / tile_size_ + 1);
  const auto bands = static_cast<std::uint64_t>((height - 1) / lines_ + 1);
  if (tiles == tiles_ && bands == bands_) return;
  scan_.begins = band_begins(scan_.band);
  scan_.first_band = scan_.band;
  tiles_ = tiles;
  bands_ = bands;
  scan_.unit = scan_.sent = 0;
  scan_.flags = flag_reads_;
  scan_.arrives = std::max(scan_.begins, scan_.asked);
}

/// When the band may be read; without a picture the beginning of the first.
OtherMasters::Picoseconds OtherMasters::band_begins(std::uint64_t band) const {
  if (bands_ == 0) return 0;
  const std::uint64_t n = band - scan_.first_band, a_second = bands_ * static_cast<std::uint64_t>(traffic_.scan_out_hz);
  return scan_.begins + n / a_second * kPicosecondsPerSecond + n % a_second * kPicosecondsPerSecond / a_second;
}

OtherMasters::Picoseconds OtherMasters::arrives_of_other(std::uint64_t n) const {
  const std::uint64_t bytes = n * kOtherBurst, rate = traffic_.other_bytes_per_s;
  // In two steps: a product of bytes and picoseconds would not fit.
  const std::uint64_t rest = bytes % rate;
  return bytes / rate * kPicosecondsPerSecond +
         static_cast<Picoseconds>(static_cast<double>(rest) / static_cast<double>(rate) * 1e12);
}

std::uint64_t OtherMasters::scan_address() const {
  const std::uint64_t band = (scan_.band - scan_.first_band) % bands_;
  const auto per_tile = static_cast<std::uint64_t>(bands_per_tile_),
             units = static_cast<std::uint64_t>(units_per_tile_);
  const std::uint64_t tile = scan_.unit / units;
  if (scan_.flags != 0)
    return flags_ + band * flag_row_ + tile / static_cast<std::uint64_t>(flag_tiles_) * beat_ +
           (scan_.flags == 1 && flag_reads_ == 2 ? flag_row_ / 2 : 0);
  return picture_ + band / per_tile * row_stride_ + tile * tile_pitch_ + band % per_tile * unit_ * units +
         scan_.unit % units * unit_ + scan_.sent;
}

std::uint64_t OtherMasters::scan_bytes() const {
  return scan_.flags != 0 ? beat_ : std::min(unit_ - scan_.sent, static_cast<std::uint64_t>(kBurst) * beat_);
}

void OtherMasters::scanned(std::uint64_t bytes, Picoseconds done) {
  use_.scan_out_bytes += bytes;
  scan_.asked = scan_.arrives;
  Picoseconds earliest = scan_.asked + cycle_;  // a request a cycle
  const auto units = static_cast<std::uint64_t>(units_per_tile_);
  if (scan_.flags != 0) {
    if (--scan_.flags == 0) earliest = std::max(earliest, done);  // the units wait for their flags
  } else {
    scan_.sent += bytes;
    if (scan_.sent == unit_) {
      scan_.done[scan_.unit % kAhead] = done;
      scan_.sent = 0;
      ++scan_.unit;
      if (scan_.unit % (units * static_cast<std::uint64_t>(flag_tiles_)) == 0) scan_.flags = flag_reads_;
    }
  }
  if (scan_.unit == tiles_ * units) {
    ++use_.bands;
    ++scan_.band;
    // The next band has its buffer a band before the display wants it: from the time at which this band is wanted.
    use_.late_bands += done > band_begins(scan_.band) ? 1U : 0U;
    earliest = std::max(earliest, band_begins(scan_.band));
    scan_.unit = 0;
    scan_.flags = flag_reads_;
  }
  if (scan_.sent == 0 && scan_.flags == 0) earliest = std::max(earliest, scan_.done[scan_.unit % kAhead]);
  scan_.arrives = earliest;
}

}  // namespace halfplane
