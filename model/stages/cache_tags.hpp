// Cache tags: which blocks of 4x4 pixels are on the chip, with which stamps, and which blocks a fast clear has flagged.
// They decide, in program order and before the depth test, the transfers between chip and memory: block_cache.hpp moves
// the data, the cycle model adds the time, rtl_ref/stages/cache_tags.sv is the hardware.
//
// Direct mapped: a line holds depth and colour of one block. Depth is fetched a stamp at a time, when a fragment first
// reads it. Colour is only written, until the operations of a fragment read stored colours: then the colours of its stamp are
// fetched like depth, after it, and stay known. A block that leaves the chip is an eviction. Its data wait until
// `cache.victims` later evictions have come, or until the block is needed again; then they go to memory, oldest first.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "clear_flags.hpp"

namespace halfplane {

/// A block that leaves a line.
struct Eviction {
  std::size_t line = 0;
  BlockAddress block;
  std::array<std::uint64_t, 2> stamps{};  ///< by buffer, a bit each: stamps that may have been written
  std::array<bool, 2> fills{};  ///< by buffer: memory is stale, so all of it is written, untouched samples as cleared
};

/// The result of a tag lookup for one fragment, or for one line on a walk.
struct TagResult {
  std::size_t line = 0;
  BlockAddress block;  ///< the fragment's
  int stamp = 0;       ///< likewise: its number in the block
  int writes = 0;      ///< number of evictions, oldest first, that go to memory now, ahead of this fragment's reads
  std::optional<Eviction> eviction;
  DepthSource source = DepthSource::none;
  bool starts_color = false;  ///< the first colours of this stamp: its other samples are not on the chip
  DepthSource color_source = DepthSource::none;  ///< of the stored colours, where operations read them

  /// Whether a flag falls with the eviction.
  [[nodiscard]] bool falls() const { return eviction && (eviction->fills[0] || eviction->fills[1]); }
};

class CacheTags {
 public:
  CacheTags(const Config& config, const Widths& widths)
      : widths_(widths),
        victims_(static_cast<std::size_t>(config.cache_victims)),
        has_stencil_(config.stencil_bits != 0),
        line_x_bits_(widths.line_x_bits),
        line_x_mask_((std::size_t{1} << widths.line_x_bits) - 1),
        line_y_mask_((std::size_t{1} << widths.line_y_bits) - 1),
        lines_(static_cast<std::size_t>(config.cache_lines)),
        flags_(widths) {
    unwritten_.reserve(4 * victims_);
  }

  [[nodiscard]] std::size_t lines() const { return lines_.size(); }

  /// A fragment with covered samples; `is_full`: it covers all of its stamp.
  TagResult access(const StampAddress& at, const PrimitiveState& state, bool is_full) {
    return access(block_stamp(at, widths_), state, is_full);
  }
  TagResult access(const BlockStamp& place, const PrimitiveState& state, bool is_full) {
    const std::uint64_t stamp = std::uint64_t{1} << place.stamp;
    TagResult result;
    result.line = line_of(place.block);
    result.block = place.block;
    result.stamp = place.stamp;
    Line& line = lines_[result.line];
    if (!line.is_valid || line.block != place.block) replace(line, result);
    if ((line.known & stamp) != 0)
      result.source = DepthSource::chip;
    else if (looks_at_depth(state, is_full))
      result.source = line.is_cleared[0] ? DepthSource::clear : DepthSource::memory;
    if (result.source != DepthSource::none || state.depth_write) line.known |= stamp;
    line.has_depth = line.has_depth || state.writes_word();
    result.starts_color = state.color_write && (line.colored & stamp) == 0;
    if (state.color_write) line.colored |= stamp;
    if (state.color_write && reads_color_) {
      if ((line.color_known & stamp) != 0)
        result.color_source = DepthSource::chip;
      else
        result.color_source = line.is_cleared[1] ? DepthSource::clear : DepthSource::memory;
      line.color_known |= stamp;
    }
    return result;
  }

  /// A token has set the colour operations: whether they read stored colours, and whether alpha is tested, so that some
  /// samples that pass the depth test may not be written; and, by side, whether a stencil test passes and replaces all
  /// of them.
  void set(bool reads_color, bool tests_alpha, const std::array<bool, 2>& replaces_stencil) {
    reads_color_ = reads_color;
    tests_alpha_ = tests_alpha;
    replaces_stencil_ = replaces_stencil;
  }

  /// Whether depth evicted from now on is lost: the flag of its block then stays.
  void drop_depth(bool drops) { drops_depth_ = drops; }
  [[nodiscard]] bool drops_depth() const { return drops_depth_; }

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

  /// All evictions go to memory; returns their number.
  int write_all() {
    const auto writes = static_cast<int>(unwritten_.size() - oldest_);
    unwritten_.clear();
    oldest_ = 0;
    return writes;
  }

  /// A fast clear of the buffers in `clears`, tiles (0, 0) to (last_x, last_y). Nothing is on the chip after it.
  void mark(int last_x, int last_y, const std::array<bool, 2>& clears) {
    for (Line& line : lines_) line = {};
    flags_.mark(last_x, last_y, clears);
  }

  /// A fast clear of the colours of the bin whose last tile this is. Precondition: nothing is on the chip. Returns the
  /// number of words of flags that it touches.
  int mark_bin(int last_x, int last_y) {
    const auto [first, last] = bin_blocks(last_x, last_y);
    flags_.mark_colors(first, last);
    return (word_of(last.x) - word_of(first.x) + 1) * (last.y - first.y + 1);
  }
  /// The first and the last block of the bin whose last tile this is.
  [[nodiscard]] std::pair<BlockAddress, BlockAddress> bin_blocks(int last_x, int last_y) const {
    const int per_tile = widths_.blocks.per_tile;
    const int right = (last_x + 1) * per_tile - 1, bottom = (last_y + 1) * per_tile - 1;
    const int left = right >> widths_.line_x_bits << widths_.line_x_bits,
              top = bottom >> widths_.line_y_bits << widths_.line_y_bits;
    return {{static_cast<std::uint16_t>(left), static_cast<std::uint16_t>(top)},
            {static_cast<std::uint16_t>(right), static_cast<std::uint16_t>(bottom)}};
  }

  /// The words of a buffer's flags: visit(x, y, word), word x of the row y of blocks.
  template <class Visit>
  void for_each_flag_word(TilePlane plane, int last_x, int last_y, Visit&& visit) const {
    flags_.for_each_word(plane, last_x, last_y, visit);
  }

  /// The clear colours of these tiles are in memory.
  void resolve(TilePlane plane, int last_x, int last_y) { flags_.resolve(plane, last_x, last_y); }

  [[nodiscard]] int words_of(int last_block) const { return word_of(last_block) + 1; }

 private:
  struct Line {
    bool is_valid = false;
    BlockAddress block;
    std::uint64_t known = 0;           ///< stamps whose depths are on the chip
    std::uint64_t colored = 0;         ///< stamps whose colours may have been written
    std::uint64_t color_known = 0;     ///< stamps of these whose colours are all on the chip
    bool has_depth = false;            ///< depths may have been written
    std::array<bool, 2> is_cleared{};  ///< the flags of the block, while it is on the chip
  };

  /// Whether a fragment reads its stored words. With a stencil a write keeps a part of them, unless both parts are
  /// replaced.
  [[nodiscard]] bool looks_at_depth(const PrimitiveState& state, bool is_full) const {
    if (state.depth_test != DepthFunc::always || !is_full || (tests_alpha_ && state.writes_word())) return true;
    const bool replaces = state.depth_write && state.tests_stencil && replaces_stencil_[state.is_back ? 1 : 0];
    return has_stencil_ && (state.tests_stencil || state.depth_write) && !replaces;
  }
  /// Index of a word in a row of blocks.
  [[nodiscard]] int word_of(int x) const { return x / widths_.blocks.flag_word; }
  [[nodiscard]] std::size_t line_of(const BlockAddress& block) const {
    return (block.y & line_y_mask_) << line_x_bits_ | (block.x & line_x_mask_);
  }

  /// Another block comes into the line. Not inlined: what follows has its registers.
  [[gnu::noinline]] void replace(Line& line, TagResult& result) {
    result.writes = write_up_to(result.block);
    evict(line, result);
    line = {};
    line.is_valid = true;
    line.block = result.block;
    line.is_cleared = {flags_.is_set(TilePlane::depth, line.block), flags_.is_set(TilePlane::color, line.block)};
  }

  /// A needed block may still be on its way to memory: the number of evictions that must go first, up to its newest
  /// one.
  int write_up_to(const BlockAddress& block) {
    for (std::size_t n = unwritten_.size(); n > oldest_; --n)
      if (unwritten_[n - 1] == block) return static_cast<int>(n - std::exchange(oldest_, n));
    return 0;
  }

  void evict(const Line& line, TagResult& result) {
    const bool stores_depth = line.has_depth && !drops_depth_;
    if (!line.is_valid || (!stores_depth && line.colored == 0)) return;
    Eviction& e = result.eviction.emplace();
    e.line = result.line;
    e.block = line.block;
    e.stamps = {stores_depth ? line.known : 0, line.colored};
    for (const TilePlane plane : kTilePlanes) {
      e.fills[number(plane)] = e.stamps[number(plane)] != 0 && line.is_cleared[number(plane)];
      if (e.fills[number(plane)]) flags_.fall(plane, line.block);
    }
    if (unwritten_.size() - oldest_ == victims_) {
      ++oldest_;
      ++result.writes;
    }
    if (unwritten_.size() == 4 * victims_) {
      unwritten_.erase(unwritten_.begin(), unwritten_.begin() + static_cast<std::ptrdiff_t>(oldest_));
      oldest_ = 0;
    }
    unwritten_.push_back(line.block);
  }

  Widths widths_;
  std::size_t victims_;
  bool has_stencil_;
  int line_x_bits_;
  std::size_t line_x_mask_, line_y_mask_;
  bool drops_depth_ = false;
  bool reads_color_ = false, tests_alpha_ = false;
  std::array<bool, 2> replaces_stencil_{};  ///< front, back
  std::vector<Line> lines_;
  std::vector<BlockAddress> unwritten_;  ///< from oldest_ on: evictions whose data wait, oldest first
  std::size_t oldest_ = 0;
  ClearFlags flags_;
};

}  // namespace halfplane
