// Memory port: turns the framebuffer's requests, one per stamp, into bursts of beats of memory.port_bits, and the
// answers of memory into stamps. The begin and end of a burst follow from the requests alone, never from time.
//
// In: requests and answers, each in order. Out: beats and responses. A stamp wider than a beat takes several; narrower
// stamps of a run share a beat. Bytes are in order of the samples, lowest first. Time is in
// engines/cycle/port_timing.hpp, the hardware in rtl_ref/stages/memory_port.sv.
#pragma once

#include <algorithm>

#include "clear_flags.hpp"

namespace halfplane {

/// Memory, as a cache on the chip sees it.
struct MemoryPort {
  /// A write of one stamp or word, or a read of `run` of them.
  virtual void request(const MemoryRequest& request) = 0;
  /// The next stamp that was read; valid until the next call: 64 lanes are expensive to copy.
  [[nodiscard]] virtual const MemoryResponse& response() = 0;

 protected:
  ~MemoryPort() = default;
};

/// A word of flags, in the lanes of a request: bit n of the word is bit n of the data.
inline void set_flag_word(MemoryRequest& request, std::uint64_t bits, const Widths& widths) {
  for (int n = 0; n < widths.blocks.flag_word; ++n)
    request.data[static_cast<std::size_t>(n / widths.memory_lane.bits)] |= static_cast<std::uint32_t>(bits >> n & 1)
                                                                           << n % widths.memory_lane.bits;
}
[[nodiscard]] inline std::uint64_t flag_word(const MemoryRequest& request, const Widths& widths) {
  std::uint64_t bits = 0;
  for (int n = 0; n < widths.blocks.flag_word; ++n)
    bits |=
        std::uint64_t{
            request.data[static_cast<std::size_t>(n / widths.memory_lane.bits)] >> n % widths.memory_lane.bits & 1}
        << n;
  return bits;
}

/// A read request; a write adds its strobes and data.
[[nodiscard]] inline MemoryRequest request_of(TilePlane plane, const StampAddress& at) {
  MemoryRequest request;
  request.plane = plane;
  request.tile_x = at.tile_x;
  request.tile_y = at.tile_y;
  request.stamp = at.stamp;
  request.run = 1;
  return request;
}

/// `words` words of flags of a buffer, from word `word` of row y on.
[[nodiscard]] inline MemoryRequest flag_word_request(TilePlane plane, int word, int words, int y, std::uint64_t bits,
                                                     const Widths& widths) {
  MemoryRequest request = request_of(flags_of(plane), flag_word_address(word, y, widths));
  request.is_write = true;
  request.run = static_cast<std::uint16_t>(words - word);
  request.strobe = SampleMask::all(widths.samples);
  set_flag_word(request, bits, widths);
  return request;
}

[[nodiscard]] constexpr bool is_flags(TilePlane plane) { return (static_cast<unsigned>(plane) & 2U) != 0; }
[[nodiscard]] constexpr bool is_of_color(TilePlane plane) { return (static_cast<unsigned>(plane) & 1U) != 0; }
/// Colours one per pixel, or the flags of such blocks.
[[nodiscard]] constexpr bool is_of_pixels(TilePlane plane) { return (static_cast<unsigned>(plane) & 4U) != 0; }

[[nodiscard]] inline int codes_of_stamp(TilePlane plane, const Widths& widths) {
  return is_of_pixels(plane) ? widths.pixels : is_of_color(plane) ? widths.memory_colors : widths.samples;
}

/// Log2 of the bytes of a stamp of the buffer, or of a word of its flags.
[[nodiscard]] inline int item_shift(TilePlane plane, const MemoryGrid& memory) {
  if (is_flags(plane)) return memory.flag_word;
  return is_of_pixels(plane) ? memory.pixel_color : memory.stamp[is_of_color(plane) ? 1 : 0];
}

/// Offset of a stamp in its tile's buffer, in bytes: block by block, row by row in each. A block with one colour per
/// pixel has the same offset as with all its samples.
[[nodiscard]] inline std::uint32_t stamp_offset(TilePlane plane, int stamp, const Widths& widths) {
  const BlockStamp at = block_stamp({0, 0, static_cast<std::uint16_t>(stamp)}, widths);
  const auto block =
      static_cast<std::uint32_t>((at.block.y * widths.blocks.per_tile + at.block.x) * widths.blocks.stamps());
  return (block << widths.memory.stamp[is_of_color(plane) ? 1 : 0]) +
         (static_cast<std::uint32_t>(at.stamp) << item_shift(plane, widths.memory));
}

/// The address of the first byte of a stamp, or of word tile_x of a row of flags (MemoryRequest). The flag words of one
/// colour per pixel lie in the second half of a row of colour flags.
[[nodiscard]] inline std::uint32_t byte_address(TilePlane plane, int tile_x, int tile_y, int stamp,
                                                const MemoryLayout& layout, const Widths& widths) {
  const MemoryGrid& m = widths.memory;
  const auto multiple = [](std::uint32_t value, int shift) { return value >> shift << shift; };
  const auto x = static_cast<std::uint32_t>(tile_x), y = static_cast<std::uint32_t>(tile_y);
  if (is_flags(plane)) {
    const std::uint32_t row =
        y * static_cast<std::uint32_t>(widths.blocks.per_tile) + static_cast<std::uint32_t>(stamp);
    return multiple(is_of_color(plane) ? layout.color_flags_base : layout.depth_flags_base, m.flag_row) +
           (row << m.flag_row) + (x << m.flag_word) + (is_of_pixels(plane) ? std::uint32_t{1} << (m.flag_row - 1) : 0);
  }
  return multiple(is_of_color(plane) ? layout.color_base : layout.depth_base, m.plane) +
         y * multiple(layout.row_stride, m.tile()) + (x << m.tile()) + stamp_offset(plane, stamp, widths);
}

/// The tiles of the widest target row by row, depth and colour of a tile side by side, then the depth flags and the
/// colour flags.
[[nodiscard]] inline MemoryLayout default_layout(const Widths& widths) {
  const MemoryGrid& m = widths.memory;
  MemoryLayout layout;
  layout.color_base = std::uint32_t{1} << m.plane;
  layout.row_stride = static_cast<std::uint32_t>(widths.tiles_x) << m.tile();
  const auto rows = static_cast<std::uint32_t>(widths.tiles_y);
  layout.depth_flags_base = (((rows * layout.row_stride - 1) >> m.flag_row) + 1) << m.flag_row;
  layout.color_flags_base =
      layout.depth_flags_base + (rows * static_cast<std::uint32_t>(widths.blocks.per_tile) << m.flag_row);
  return layout;
}

/// One beyond the last byte of the target and its flags.
[[nodiscard]] inline std::uint64_t layout_end(const MemoryLayout& layout, const Widths& widths) {
  const MemoryGrid& m = widths.memory;
  const auto rows = static_cast<std::uint64_t>(widths.tiles_y);
  const std::uint64_t tiles = rows * layout.row_stride + (std::uint64_t{1} << m.tile());
  const std::uint64_t flags = rows * static_cast<std::uint64_t>(widths.blocks.per_tile) << m.flag_row;
  return std::max(std::max(layout.depth_base, layout.color_base) + tiles,
                  std::max(layout.depth_flags_base, layout.color_flags_base) + flags);
}

/// How the stamps or words of a run share beats. `shift`: log2 of the bytes of each; `place`: index of the first in its
/// row.
struct BeatShare {
  int per_stamp = 1;  ///< beats of each; 1 where several share a beat
  int per_beat = 1;   ///< stamps in a beat; 1 where each fills a beat
  int first = 0;      ///< index in its beat
  BeatShare(int shift, int port, std::uint32_t place)
      : per_stamp(1 << std::max(0, shift - port)),
        per_beat(1 << std::max(0, port - shift)),
        first(static_cast<int>(place & static_cast<std::uint32_t>(per_beat - 1))),
        per_beat_log2_(std::max(0, port - shift)) {}
  [[nodiscard]] int beats(int run) const { return ((first + run + per_beat - 1) >> per_beat_log2_) * per_stamp; }

 private:
  int per_beat_log2_ = 0;
};

class PortStage {
 public:
  PortStage(const Widths& widths, const MemoryLayout& layout) : widths_(widths), layout_(layout) {}

  /// send(MemoryBeat): the beats that the request completes, in order. After it the beats of a read may be answered.
  template <class Send>
  void take(const MemoryRequest& request, Send&& send) {
    const MemoryGrid& m = widths_.memory;
    const int shift = item_shift(request.plane, m);
    const std::uint32_t address =
        byte_address(request.plane, request.tile_x, request.tile_y, request.stamp, layout_, widths_);
    const BeatShare share(shift, m.port, address >> shift);
    if (!request.is_write) {
      MemoryBeat beat;
      beat.is_first = true;
      beat.address = address >> m.port << m.port;
      beat.length = static_cast<std::uint16_t>(share.beats(request.run));
      read_ = {request.plane, share, request.run, share.first, {}};
      send(beat);
      return;
    }
    if (share.first == 0 || !in_burst_) {
      gathered_ = {};
      gathered_.is_write = true;
      gathered_.is_first = !in_burst_;
      gathered_.length = static_cast<std::uint16_t>(share.beats(request.run));
    }
    in_burst_ = request.run != 1;
    for (int beat = 0; beat < share.per_stamp; ++beat) {
      gathered_.address = (address >> m.port << m.port) + (static_cast<std::uint32_t>(beat) << m.port);
      put(request, beat, share.first << shift);
      if (share.first == share.per_beat - 1 || !in_burst_) {
        send(gathered_);
        gathered_.is_first = false;
        --gathered_.length;
        gathered_.strobe = 0;
        gathered_.data = {};
      }
    }
  }

  /// A beat of the last read. give(MemoryResponse): the stamps that it completes, in order.
  template <class Give>
  void answer(const MemoryAnswer& answer, Give&& give) {
    const std::size_t bytes = static_cast<std::size_t>(widths_.port_bytes);
    read_.bytes.insert(read_.bytes.end(), answer.data.begin(),
                       answer.data.begin() + static_cast<std::ptrdiff_t>(bytes));
    const std::size_t size = std::size_t{1} << item_shift(read_.plane, widths_.memory);
    if (read_.bytes.size() < size) return;
    for (; read_.left > 0 && read_.next < read_.share.per_beat; ++read_.next, --read_.left)
      give(unpack(read_.bytes.data() + static_cast<std::size_t>(read_.next) * (size < bytes ? size : 0)));
    read_.next = 0;
    read_.bytes.clear();
  }

 private:
  struct Read {
    TilePlane plane = TilePlane::depth;
    BeatShare share{0, 0, 0};
    int left = 0;                     ///< stamps not yet answered
    int next = 0;                     ///< index of the next in its beat
    std::vector<std::uint8_t> bytes;  ///< of the next response, incomplete
  };

  /// Beat `beat` of the stamp or word of a request, from byte `first` of the beat on.
  void put(const MemoryRequest& request, int beat, int first) {
    const MemoryGrid& m = widths_.memory;
    const int size = std::min(1 << item_shift(request.plane, m), widths_.port_bytes);
    const bool has_flags = is_flags(request.plane);
    const std::uint64_t word = has_flags ? flag_word(request, widths_) : 0;
    const int sample = m.sample[is_of_color(request.plane) ? 1 : 0];
    for (int n = 0; n < size; ++n) {
      const int byte = beat * widths_.port_bytes + n;  // in the stamp
      const auto s = static_cast<std::size_t>(byte >> sample);
      if (!has_flags && !request.strobe.has(s)) continue;
      const auto at = static_cast<std::size_t>(first + n);
      gathered_.strobe |= std::uint64_t{1} << at;
      gathered_.data[at] =
          static_cast<std::uint8_t>(has_flags ? word >> 8 * byte : request.data[s] >> 8 * (byte & ((1 << sample) - 1)));
    }
  }

  [[nodiscard]] MemoryResponse unpack(const std::uint8_t* bytes) const {
    MemoryResponse response;
    const int size = 1 << widths_.memory.sample[is_of_color(read_.plane) ? 1 : 0];
    const auto codes = static_cast<std::size_t>(codes_of_stamp(read_.plane, widths_));
    for (std::size_t s = 0; s < codes; ++s) {
      std::uint32_t value = 0;
      for (int n = 0; n < size; ++n) value |= std::uint32_t{*bytes++} << 8 * n;
      response.data[s] = static_cast<std::uint32_t>(wrap_unsigned(value, widths_.memory_lane.bits));
    }
    return response;
  }

  Widths widths_;
  MemoryLayout layout_;
  MemoryBeat gathered_;  ///< a beat that is not complete
  bool in_burst_ = false;
  Read read_;
};

}  // namespace halfplane
