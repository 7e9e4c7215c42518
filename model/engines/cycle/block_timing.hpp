// The time of a framebuffer of blocks (cache.kind blocks): rtl_ref/stages/cache_tags.sv, block_cache.sv.
//
// T looks a fragment up, X tests it, W writes its colours; between T and X the fragments wait for memory, in order. Every
// wait is for an earlier fragment or eviction, so the time of one is a maximum over those before it:
//
//   t(m) = max(moved + 1, t(m-1) + 1, x(m-queue) + 1, room for an order), one or two more where a flag falls
//   requests: those of the order before, then evictions as X and W are through with them, then the read, a request a cycle
//   x(m) = max(t + 1, x(m-1) + 1, the read's answer + 1, w(m-2))
//   w(m) = max(x + 2, w(m-1) + 1); with a texture unit between X and W texture_timing.hpp says when W has it
//
// An eviction reads its stamps out of the RAMs one a cycle, from x and w on. Meanwhile X tests what needs no read of its own,
// W writes where nothing is left to be read, and the next eviction waits.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <deque>
#include <optional>

#include "../../stages/cache_tags.hpp"
#include "../../stages/texture_packets.hpp"
#include "../../timing/station.hpp"
#include "texture_timing.hpp"

namespace halfplane {

/// What a fragment is to a texture unit.
struct TextureWork {
  bool sets_state = false, invalidates = false;  ///< a token
  std::span<const TextureLookup> lookups;        ///< of the samples that are textured
};

/// What the test made of a fragment.
struct BlockItem {
  SampleMask mask;                                ///< covered samples; none: an empty stamp, or a line of a walk
  int stamp = 0;                                  ///< in its block
  bool depth_write = false, color_write = false;  ///< by its state
  bool wrote_depth = false, wrote_color = false;  ///< any sample passed
  TextureWork texture;                            ///< with a texture unit
};

class BlockTiming {
 public:
  BlockTiming(const Config& config, const Widths& widths)
      : widths_(widths),
        items_(config.cache_queue, 1, 1),
        orders_(config.cache_queue, 1, 1),
        slots_(static_cast<std::size_t>(config.cache_victims)),
        dirty_(static_cast<std::size_t>(config.cache_lines)) {
    if (has_texture_planes(config)) texture_.emplace(texture_settings(config, widths));
  }

  /// When T can take the next fragment.
  [[nodiscard]] Cycle room() const { return left_; }
  /// When T holds none.
  [[nodiscard]] Cycle is_empty() const { return left_ + 1; }
  /// When X was through with the last fragment.
  [[nodiscard]] Cycle tested() const { return tested_; }
  /// When W took its colours.
  [[nodiscard]] Cycle colored() const { return colored_; }
  /// A fragment was tested one cycle late because it needs what the one before wrote.
  [[nodiscard]] std::uint64_t hazards() const { return hazards_; }

  /// A fragment that T took in `moved`, or a line that it read then. ask(cycle, plane, stamp, run, is_write): a request, in
  /// `cycle` at the earliest; returns PortTimes.
  template <class Ask>
  void take(Cycle moved, const TagResult& tags, const BlockItem& item, Ask&& ask) {
    const bool reads = tags.source == DepthSource::memory, is_order = reads || tags.writes > 0;
    const Cycle t = std::max({moved + 1 + static_cast<Cycle>(tags.flag_cycles), items_.room(), orders_.room()});
    left_ = t;
    const Cycle answer = is_order ? order(t, tags.writes, reads ? &item : nullptr, tags, ask) : 0;
    Cycle x = std::max({items_.ready(t), tested_ + 1, texture_ ? texture_->room() : behind_.room()});
    if (reads) x = std::max(x, answer + 1);
    if (tags.source == DepthSource::chip || tags.eviction) x = std::max(x, depth_free_);
    if (tags.source == DepthSource::chip && last_line_ == tags.line && last_stamp_ == item.stamp &&
        (last_writes_ & item.mask).any() && x < tested_ + 2) {
      x = tested_ + 2;
      ++hazards_;
    }
    if (tags.eviction) {
      x = std::max(x, slots_[next_slot_]);
      if (last_line_ == tags.line && last_writes_.any()) x = std::max(x, tested_ + 2);
      depth_free_ = x + static_cast<Cycle>(std::popcount(tags.eviction->stamps[0]));
    }
    const Cycle depth_ready = depth_free_ + 1;
    items_.leave(x);
    tested_ = x;
    const Cycle color_ready = color(tags, item, shaded(item.texture, ask));
    texture_ ? texture_->leave(colored_) : behind_.leave(colored_);
    if (tags.eviction) victims_.push_back(victim(*tags.eviction, std::max(depth_ready, color_ready)));
    note_writes(tags, item);
  }

  /// A line on a token's walk, read in `cycle`. Returns when the next one can be.
  template <class Ask>
  Cycle walk(Cycle cycle, const TagResult& tags, Ask&& ask) {
    if (tags.eviction)
      take(cycle, tags, {}, ask);
    else
      left_ = std::max({cycle + 1, items_.room(), orders_.room()});
    return left_ + 1;
  }

  /// All that has left the chip goes to memory, from `cycle` on. Returns when nothing is under way any more.
  template <class Ask>
  Cycle drain(Cycle cycle, int writes, Ask&& ask) {
    if (writes > 0) {
      cycle = std::max(cycle, orders_.room());
      (void)order(cycle, writes, nullptr, {}, ask);
    }
    return std::max({cycle + 1, tested_ + 1, colored_ + 1, ordered_ + 1});
  }

 private:
  struct Victim {
    BlockAddress block;
    std::array<std::uint64_t, 2> stamps;  ///< to be written, by plane
    std::size_t slot;
    Cycle ready;  ///< all of it is in the slot
  };

  /// When the item that X is through with is on offer to W.
  template <class Ask>
  Cycle shaded(const TextureWork& work, Ask&& ask) {
    if (!texture_) return tested_ + 2;
    if (work.sets_state) return texture_->set(tested_, work.invalidates);
    if (work.lookups.empty()) return texture_->pass(tested_);
    return texture_->take(tested_, work.lookups, [&ask](Cycle cycle, std::uint32_t address, int beats) {
      return ask.texture(cycle, address, beats);
    });
  }

  /// W: the colours of that item, on offer from `offered` on. Returns when those of what it evicts are out of the RAM.
  Cycle color(const TagResult& tags, const BlockItem& item, Cycle offered) {
    const std::uint64_t own = item.wrote_color || tags.starts_color ? std::uint64_t{1} << item.stamp : 0;
    const auto read = [this](std::uint64_t wanted) {  // the stamp that is about to be written, or the lowest
      left_color_ &= ~(wanted != 0 ? wanted : left_color_ & (~left_color_ + 1));
      ++color_at_;
    };
    Cycle w = std::max(offered, colored_ + 1), ready = 0;
    if (tags.eviction) w = std::max(w, color_at_ + static_cast<Cycle>(std::popcount(left_color_)));
    while (left_color_ != 0 && color_at_ < w) read(0);
    if (tags.eviction) {
      left_color_ = tags.eviction->stamps[1];
      color_line_ = tags.line;
      color_at_ = w;
      ready = w + static_cast<Cycle>(std::popcount(left_color_)) + 1;
    }
    if (tags.line == color_line_ && (left_color_ & own) != 0) {
      read(own);
      ++w;
    }
    colored_ = w;
    return ready;
  }

  template <class Ask>
  Cycle order(Cycle pushed, int writes, const BlockItem* item, const TagResult& tags, Ask&& ask) {
    Cycle cycle = std::max(ordered_ + 1, orders_.ready(pushed)), answer = 0;
    for (; writes > 0; --writes) {
      const Victim& v = victims_.front();
      cycle = std::max(cycle, v.ready);
      Cycle behind = cycle + 1;  // nothing to write is found in a cycle too
      for (const TilePlane plane : kTilePlanes)
        for (std::uint64_t left = v.stamps[static_cast<std::size_t>(plane)]; left != 0; left &= left - 1) {
          const int stamp = std::countr_zero(left);
          const StampAddress at = stamp_address({v.block, stamp}, widths_);
          behind = ask(cycle, plane, at, std::countr_one(left >> stamp), true).asked + 1;
          cycle = behind;
        }
      cycle = behind;
      slots_[v.slot] = cycle;
      victims_.pop_front();
    }
    if (item != nullptr) {
      const auto [asked, answered] =
          ask(cycle, TilePlane::depth, stamp_address({tags.block, item->stamp}, widths_), 1, false);
      cycle = asked + 1;
      answer = answered;
    }
    ordered_ = cycle - 1;
    orders_.leave(ordered_);
    return answer;
  }

  [[nodiscard]] Victim victim(const Eviction& e, Cycle ready) {
    Victim v{e.block, {}, next_slot_, ready};
    next_slot_ = (next_slot_ + 1) % slots_.size();
    const std::uint64_t all = ~std::uint64_t{0} >> (64 - widths_.blocks.stamps());
    for (const std::size_t p : {0U, 1U}) v.stamps[p] = e.fills[p] ? all : e.stamps[p] & dirty_[e.line][p];
    return v;
  }

  void note_writes(const TagResult& tags, const BlockItem& item) {
    last_line_ = tags.line;
    last_stamp_ = item.stamp;
    last_writes_ = {};
    if (!item.mask.any()) return;
    const bool starts_depth = tags.source != DepthSource::chip;
    if (!starts_depth && item.depth_write) last_writes_ = item.mask;
    if (starts_depth && (tags.source != DepthSource::none || item.depth_write))
      last_writes_ = SampleMask::all(widths_.samples);
    const std::uint64_t bit = std::uint64_t{1} << item.stamp;
    const auto note = [&](std::uint64_t& dirty, bool starts, bool writes) {
      if (starts) dirty &= ~bit;
      if (writes) dirty |= bit;
    };
    note(dirty_[tags.line][0], starts_depth, item.wrote_depth);
    note(dirty_[tags.line][1], tags.starts_color, item.wrote_color);
  }

  Widths widths_;
  Station items_, orders_;
  Station behind_{2, 0, 0};  ///< between X and W; or there is a
  std::optional<TextureTiming> texture_;
  Cycle left_ = 0, tested_ = 0, colored_ = 0,
        ordered_ = 0;             ///< when the last one left T, X, W; the last request's cycle
  Cycle depth_free_ = 0;          ///< when the depth RAM has been read for the last eviction
  std::uint64_t left_color_ = 0;  ///< stamps of it that the colour RAM is still to be read for, one a cycle
  std::size_t color_line_ = 0;
  Cycle color_at_ = 0;  ///< when the next of them is
  std::size_t last_line_ = 0;
  int last_stamp_ = 0;
  SampleMask last_writes_;  ///< samples that the last fragment may have written
  std::uint64_t hazards_ = 0;
  std::vector<Cycle> slots_;  ///< of victims: the cycle from which on each is free
  std::size_t next_slot_ = 0;
  std::deque<Victim> victims_;
  std::vector<std::array<std::uint64_t, 2>> dirty_;  ///< by line and plane: stamps that differ from memory
};

}  // namespace halfplane
