// Cache tags: which blocks of 4x4 pixels are on the chip, what of them is known, and which a fast clear has flagged. It
// decides, in program order and before the depth test, what moves between chip and memory: block_cache.hpp moves the
// data, the cycle model the time, rtl_ref/stages/cache_tags.sv is the hardware.
//
// Direct mapped: a line holds depth and colour of one block. Depth is fetched a stamp at a time, when a fragment first
// asks for it; colour is only ever written. What leaves the chip is an eviction. Its data wait until `cache.victims` later
// ones have come, or until the block is wanted again; then they go to memory, oldest first.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "../packets.hpp"

namespace halfplane {

/// A block of the target, in blocks.
struct BlockAddress {
  std::uint16_t x = 0, y = 0;
  bool operator==(const BlockAddress&) const = default;
};

/// A stamp, by its tile or by its block.
struct StampAddress {
  std::uint16_t tile_x = 0, tile_y = 0, stamp = 0;
};
struct BlockStamp {
  BlockAddress block;
  int stamp = 0;  ///< row-major number in the block
};

[[nodiscard]] inline BlockStamp block_stamp(const StampAddress& at, const Widths& widths) {
  const BlockGrid& grid = widths.blocks;
  const int x = at.stamp % widths.stamps.stamps_per_row, y = at.stamp / widths.stamps.stamps_per_row;
  return {{static_cast<std::uint16_t>(at.tile_x * grid.per_tile + x / grid.side),
           static_cast<std::uint16_t>(at.tile_y * grid.per_tile + y / grid.side)},
          y % grid.side * grid.side + x % grid.side};
}

[[nodiscard]] inline StampAddress stamp_address(const BlockStamp& at, const Widths& widths) {
  const BlockGrid& grid = widths.blocks;
  const int x = at.block.x % grid.per_tile * grid.side + at.stamp % grid.side;
  const int y = at.block.y % grid.per_tile * grid.side + at.stamp / grid.side;
  return {static_cast<std::uint16_t>(at.block.x / grid.per_tile),
          static_cast<std::uint16_t>(at.block.y / grid.per_tile),
          static_cast<std::uint16_t>(y * widths.stamps.stamps_per_row + x)};
}

/// Where the depth test finds what is stored under a stamp.
enum class DepthSource : std::uint8_t {
  none,    ///< it does not look: `always`, with a full mask
  chip,    ///< on the chip
  clear,   ///< the last fast clear's value
  memory,  ///< a read
};

/// What leaves a line.
struct Eviction {
  std::size_t line = 0;
  BlockAddress block;
  std::array<std::uint64_t, 2> stamps{};  ///< by plane, a bit each: stamps that may have been written
  std::array<bool, 2>
      fills{};  ///< by plane: memory holds garbage, so all of it is written, untouched samples as cleared
};

/// What the tags make of one fragment, or of one line on a walk.
struct TagResult {
  std::size_t line = 0;
  BlockAddress block;  ///< the fragment's
  int writes = 0;      ///< so many evictions, oldest first, go to memory now, ahead of what is read for this fragment
  std::optional<Eviction> eviction;
  DepthSource source = DepthSource::none;
  bool starts_color = false;  ///< the first colours of this stamp: the others of it are not on the chip

  /// A flag falls: the hardware has to read and write a word of flags.
  [[nodiscard]] bool clears_flag() const { return eviction && (eviction->fills[0] || eviction->fills[1]); }
};

class CacheTags {
 public:
  CacheTags(const Config& config, const Widths& widths)
      : widths_(widths),
        victims_(static_cast<std::size_t>(config.cache_victims)),
        blocks_x_(static_cast<std::size_t>(widths.tiles_x * widths.blocks.per_tile)),
        lines_(static_cast<std::size_t>(config.cache_lines)) {
    for (auto& plane : is_cleared_)
      plane.resize(blocks_x_ * static_cast<std::size_t>(widths.tiles_y * widths.blocks.per_tile));
  }

  [[nodiscard]] std::size_t lines() const { return lines_.size(); }
  /// Flags of a row of the widest target, in words.
  [[nodiscard]] int flag_words() const { return words_of(static_cast<int>(blocks_x_) - 1); }

  /// A fragment with covered samples; `is_full`: all of its stamp.
  TagResult access(const StampAddress& at, const PrimitiveState& state, bool is_full) {
    const BlockStamp place = block_stamp(at, widths_);
    const std::uint64_t stamp = std::uint64_t{1} << place.stamp;
    TagResult result;
    result.line = line_of(place.block);
    result.block = place.block;
    Line& line = lines_[result.line];
    if (!line.is_valid || line.block != place.block) {
      result.writes = write_up_to(place.block);
      evict(line, result);
      line = {true, place.block, 0,
              0,    false,       {flag(TilePlane::depth, place.block) != 0, flag(TilePlane::color, place.block) != 0}};
    }
    if ((line.known & stamp) != 0)
      result.source = DepthSource::chip;
    else if (state.depth_test != DepthFunc::always || !is_full)
      result.source = line.is_cleared[0] ? DepthSource::clear : DepthSource::memory;
    if (result.source != DepthSource::none || state.depth_write) line.known |= stamp;
    line.has_depth = line.has_depth || state.depth_write;
    result.starts_color = state.color_write && (line.colored & stamp) == 0;
    if (state.color_write) line.colored |= stamp;
    return result;
  }

  /// Empties every line: visit(TagResult), in order.
  template <class Visit>
  void evict_all(Visit&& visit) {
    for (Line& line : lines_) {
      TagResult result;
      result.line = static_cast<std::size_t>(&line - lines_.data());
      evict(line, result);
      line = {};
      visit(result);
    }
  }

  /// Everything that has left the chip goes to memory: so many evictions.
  int write_all() {
    const auto writes = static_cast<int>(unwritten_.size());
    unwritten_.clear();
    return writes;
  }

  /// A fast clear of the planes in `clears`, tiles (0, 0) to (last_x, last_y). Nothing is on the chip behind it.
  void mark(int last_x, int last_y, const std::array<bool, 2>& clears) {
    for (Line& line : lines_) line = {};
    for (const TilePlane plane : kTilePlanes)
      if (clears[number(plane)])
        for_each_block(last_x, last_y, [&](const BlockAddress& block) { flag(plane, block) = 1; });
  }

  /// The words of the flags of a plane: visit(x, y, word), word x of the row y of blocks.
  template <class Visit>
  void for_each_flag_word(TilePlane plane, int last_x, int last_y, Visit&& visit) const {
    const int blocks = (last_x + 1) * widths_.blocks.per_tile, size = widths_.blocks.flag_word;
    for (int y = 0; y < (last_y + 1) * widths_.blocks.per_tile; ++y)
      for (int word = 0; word * size < blocks; ++word) {
        std::uint64_t bits = 0;
        for (int x = word * size; x < std::min(blocks, (word + 1) * size); ++x)
          bits |= std::uint64_t{is_cleared_[number(plane)][index(block_at(x, y))]} << (x - word * size);
        visit(word, y, bits);
      }
  }

  /// Their clear colours are in memory.
  void resolve(TilePlane plane, int last_x, int last_y) {
    for_each_block(last_x, last_y, [&](const BlockAddress& block) { flag(plane, block) = 0; });
  }

  [[nodiscard]] int words_of(int last_block) const { return last_block / widths_.blocks.flag_word + 1; }

 private:
  struct Line {
    bool is_valid = false;
    BlockAddress block;
    std::uint64_t known = 0;           ///< stamps whose depths are on the chip
    std::uint64_t colored = 0;         ///< stamps whose colours may have been written
    bool has_depth = false;            ///< depths may have been written
    std::array<bool, 2> is_cleared{};  ///< the flags of the block, as long as it is here
  };

  [[nodiscard]] static constexpr std::size_t number(TilePlane plane) { return static_cast<std::size_t>(plane); }
  [[nodiscard]] static BlockAddress block_at(int x, int y) {
    return {static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y)};
  }
  [[nodiscard]] std::size_t index(const BlockAddress& block) const { return block.y * blocks_x_ + block.x; }
  [[nodiscard]] std::uint8_t& flag(TilePlane plane, const BlockAddress& block) {
    return is_cleared_[number(plane)][index(block)];
  }
  [[nodiscard]] std::size_t line_of(const BlockAddress& block) const {
    const auto low = [](int value, int bits) { return static_cast<std::size_t>(value & ((1 << bits) - 1)); };
    return low(block.y, widths_.line_y_bits) << widths_.line_x_bits | low(block.x, widths_.line_x_bits);
  }

  template <class Visit>
  void for_each_block(int last_x, int last_y, Visit&& visit) const {
    for (int y = 0; y < (last_y + 1) * widths_.blocks.per_tile; ++y)
      for (int x = 0; x < (last_x + 1) * widths_.blocks.per_tile; ++x) visit(block_at(x, y));
  }

  /// A block that is wanted may be on its way to memory: how many evictions have to go first, the newest of it the last.
  int write_up_to(const BlockAddress& block) {
    for (std::size_t n = unwritten_.size(); n > 0; --n) {
      if (unwritten_[n - 1] != block) continue;
      unwritten_.erase(unwritten_.begin(), unwritten_.begin() + static_cast<std::ptrdiff_t>(n));
      return static_cast<int>(n);
    }
    return 0;
  }

  void evict(const Line& line, TagResult& result) {
    if (!line.is_valid || (!line.has_depth && line.colored == 0)) return;
    Eviction& e = result.eviction.emplace();
    e.line = result.line;
    e.block = line.block;
    e.stamps = {line.has_depth ? line.known : 0, line.colored};
    for (const TilePlane plane : kTilePlanes) {
      e.fills[number(plane)] = e.stamps[number(plane)] != 0 && line.is_cleared[number(plane)];
      if (e.fills[number(plane)]) flag(plane, line.block) = 0;
    }
    if (unwritten_.size() == victims_) {
      unwritten_.pop_front();
      ++result.writes;
    }
    unwritten_.push_back(line.block);
  }

  Widths widths_;
  std::size_t victims_, blocks_x_;
  std::vector<Line> lines_;
  std::deque<BlockAddress> unwritten_;                   ///< evictions whose data wait, oldest first
  std::array<std::vector<std::uint8_t>, 2> is_cleared_;  ///< by plane and block: memory holds garbage
};

}  // namespace halfplane
