// The time of a framebuffer of blocks (cache.kind blocks): rtl_ref/stages/cache_tags.sv, depth_cache.sv, late_test.sv,
// color_write.sv, write_back.sv, memory_answers.sv, pixel_colors.sv. For fragment m: t, x, w are the cycles in which it
// leaves the tags, the depth stage, the colour stage.
//
// The tags look a fragment up, the depth stage tests it, the colour stage writes its colours; between the tags and the
// depth stage the fragments wait for memory, in order. Every wait is for an earlier fragment or eviction, so each time
// is a maximum over earlier ones:
//
//   s(m) = max(moved + 1, t(m-1))
//   t(m) = max(s(m) + 1, x(m-queue) + 1, room for an order, if a flag falls: two cycles after the last fall)
//   moved(m) >= s(m-1), and not the cycle after a t in which a flag fell, unless it is in the block of the fragment
//   before
//   requests: of the previous order, then evictions that both stages have finished, then the read, a request a
//   cycle
//   x(m) = max(t + 2, x(m-1) + 1, the read's answer + 1, w(m-2)), whatever the stamp before
//   w(m) = max(x + 2, w(m-1) + 1); with a texture unit between x and w given by texture_timing.hpp
//
// With blending an order may end with a read of colours, and the colour stage takes a fragment for as many clocks as
// blend.lanes requires, one at least: w is the first, and w(m-1) + 1 counts from the last. Its colours are in the RAM
// kBlendClocks later, in order. An item that reads colours waits at the colour stage for its answer, w >= answer + 1,
// and if it reads the RAM, until all reads of evictions are complete; writes in flight to the RAM are forwarded. With
// the alpha test downstream of a texture unit a fragment that writes depth is late: the colour stage writes its depth,
// and at the depth stage an item waits for late ones in its place (kLateLines), or for all if it is not late itself.
//
// With compress.unit a request for colours waits a cycle for the bit that gives the block's form in memory; a merge
// waits for all answers in flight, and for its own.
//
// An eviction reads its stamps out of the RAMs one a cycle, from x and w on. Meanwhile the depth stage tests items that
// need no eviction of their own, and the next eviction waits. In the colour stage, where a stamp is in the RAM a cycle
// after w, the stamp at w is read first; so no stamp waits, and an eviction waits only for the second one before it.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <optional>
#include <utility>

#include "../../stages/cache_tags.hpp"
#include "../../stages/pixel_colors.hpp"
#include "../../stages/texture_packets.hpp"
#include "../../timing/station.hpp"
#include "run_kind.hpp"
#include "shade_timing.hpp"
#include "texture_timing.hpp"

namespace halfplane {

/// The work of a fragment in a texture unit and its neighbours.
struct TextureWork {
  std::optional<StateRegister> sets;       ///< the fragment is a token for this register
  bool invalidates = false;                ///< and it invalidates the cache
  std::span<const TextureLookup> lookups;  ///< of the textured samples
  int divided = 0;                         ///< groups of samples whose colours lie over w
  int lit = 0;                             ///< lit samples
  bool sets_light = false;                 ///< a token for the light
  bool sets_border = false;                ///< a token with the border's colour
};

/// A fragment after the depth test.
struct BlockItem {
  SampleMask mask;                                ///< covered samples; none: an empty stamp, or a line of a walk
  bool depth_write = false, color_write = false;  ///< by its state
  bool wrote_depth = false;                       ///< for some sample
  SampleMask colors;                              ///< samples whose colour is written
  bool blends = false;                            ///< by the state
  bool is_late = false;                           ///< depth is written after the texture unit: is_late()
  bool is_shaded = false;                         ///< with a texture unit: a sample is live there
};

template <class Run = AnyRun>
class BlockTiming {
 public:
  BlockTiming(const Config& config, const Widths& widths)
      : all_samples_(SampleMask::all(widths.samples)),
        stamps_(widths.blocks.stamps()),
        all_stamps_(~std::uint64_t{0} >> (64 - stamps_)),
        samples_(widths.samples),
        lanes_(std::min(config.blend_lanes, widths.samples)),
        write_clocks_(lanes_ == 0 ? 1 : kBlendClocks),
        items_(config.cache_queue, 2, 1),
        orders_(config.cache_queue, 1, 1),
        slots_(static_cast<std::size_t>(config.cache_victims)),
        victims_(slots_.size()),
        dirty_(static_cast<std::size_t>(config.cache_lines)),
        compresses_(config.compress_units != 0),
        dirty_colors_(compresses_ ? dirty_.size() * static_cast<std::size_t>(widths.blocks.stamps()) : 0),
        of_pixels_(widths),
        late_(kLateLines * static_cast<std::size_t>(widths.blocks.stamps())) {
    if (has_texture_planes(config)) texture_.emplace(texture_settings(config, widths));
    if (config.fog_units != 0) fog_.emplace();
    if (has_normals(config)) light_.emplace();
  }

  /// When the tags can take the next fragment, except for cycles in which it is_busy().
  [[nodiscard]] Cycle room() const { return looked_; }
  /// In `cycle` the word of a falling flag is read, and the fragment needs its own.
  [[nodiscard]] bool is_busy(Cycle cycle, const TagResult& tags, const BlockItem& item) const {
    return cycle <= fall_reads_[0] && (cycle == fall_reads_[0] || cycle == fall_reads_[1]) && item.mask.any() &&
           last_block_ != tags.block;
  }
  /// When the tags are empty.
  [[nodiscard]] Cycle is_empty() const { return left_ + 1; }
  /// When the last fragment left the depth stage.
  [[nodiscard]] Cycle tested() const { return tested_; }
  /// When the colour stage took the last fragment.
  [[nodiscard]] Cycle colored() const { return colored_; }

  /// A fragment that the tags took in `moved`, or a line that was read then; `texture` counts with a texture unit.
  /// ask.read(cycle, plane, BlockStamp): a request, in `cycle` at the earliest; returns PortTimes. ask.write(cycle, plane,
  /// first BlockStamp, run): a burst, a request a cycle; returns when the last is taken.
  template <class Ask>
  void take(Cycle moved, const TagResult& tags, const BlockItem& item, const TextureWork& texture, Ask&& ask) {
    const bool reads = tags.source == DepthSource::memory,
               reads_color = !Run::is_plain && tags.color_source == DepthSource::memory;
    const bool is_order = reads || reads_color || tags.writes > 0;
    const Cycle t = leave(moved, tags.falls());
    if (item.mask.any())
      last_block_ = tags.block;
    else
      last_block_.reset();
    const Answers answers = is_order ? order(t, tags.writes, tags, ask) : Answers{};
    Cycle x = std::max({items_.ready(t), tested_ + 1, has_texture() ? texture_->room() : behind_.room()});
    if (reads) x = std::max(x, answers.depth + 1);
    if (tags.source == DepthSource::chip || tags.eviction) x = std::max(x, depth_free_);
    x = std::max(x, late_room(tags, item));
    if (tags.eviction) {
      x = std::max(x, slots_[next_slot_]);
      if (last_line_ == tags.line && last_writes_) x = std::max(x, tested_ + 2);
      depth_free_ = x + static_cast<Cycle>(count_of(tags.eviction->stamps[0]));
    }
    const Cycle depth_ready = depth_free_ + 1;
    items_.leave(x);
    tested_ = x;
    const Cycle shaded_at = shaded(texture, ask);
    const Cycle fogged_at = has_fog() ? fog_->take(shaded_at) : shaded_at;
    const Cycle color_ready = color(tags, item, fogged_at, answers.color);
    if (has_texture() && item.is_late && item.mask.any()) {
      late_[late_place(tags.line, tags.stamp)] = colored_;
      last_late_ = colored_;
    }
    if (has_texture())
      texture_->leave(fog_ ? fog_->taken() : colored_, colored_);
    else
      behind_.leave(colored_);
    if (has_fog()) fog_->leave(colored_);
    if (tags.eviction) note_victim(*tags.eviction, std::max(depth_ready, color_ready), ask);
    note_writes(tags, item);
  }

  /// A line on a token's walk, read in `cycle`. Returns when the next one can be read.
  template <class Ask>
  Cycle walk(Cycle cycle, const TagResult& tags, Ask&& ask) {
    if (tags.eviction)
      take(cycle, tags, {}, {}, ask);
    else
      leave(cycle, false);
    return looked_;
  }

  /// With compress.unit: the blocks that lie in memory with one colour per pixel.
  [[nodiscard]] BlockBits& of_pixels() { return of_pixels_; }

  /// All evicted blocks go to memory, from `cycle` on. Returns when nothing is under way any more.
  template <class Ask>
  Cycle drain(Cycle cycle, int writes, Ask&& ask) {
    last_block_.reset();
    if (writes > 0) {
      cycle = std::max(cycle, orders_.room());
      (void)order(cycle, writes, TagResult{}, ask);
    }
    return std::max({cycle + 1, tested_ + 1, colored_ + 1, ordered_ + 1});
  }

 private:
  [[nodiscard]] bool has_texture() const { return !Run::is_plain && texture_.has_value(); }
  [[nodiscard]] bool has_fog() const { return !Run::is_plain && fog_.has_value(); }
  [[nodiscard]] bool compresses() const { return !Run::is_plain && compresses_; }
  [[nodiscard]] Cycle write_clocks() const { return Run::is_plain ? 1 : write_clocks_; }

  /// The tags: the line read in `moved` is compared, then leaves. Returns the cycle in which it leaves.
  Cycle leave(Cycle moved, bool falls) {
    looked_ = std::max(moved + 1, left_);
    left_ = std::max({looked_ + 1, items_.room(), orders_.room()});
    if (falls) {
      left_ = std::max(left_, fall_reads_[0] + 1);
      fall_reads_ = {left_ + 1, fall_reads_[0]};
    }
    return left_;
  }

  /// The number of stamps of a block, a bit each: mostly four of them, and std::popcount is a call.
  [[nodiscard]] static int count_of(std::uint64_t stamps) {
    int count = 0;
    for (; stamps != 0; stamps >>= 4) count += kCountOf4[stamps & 15];
    return count;
  }
  static constexpr std::array<std::uint8_t, 16> kCountOf4{0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4};

  struct Victim {
    BlockAddress block;
    std::array<std::uint64_t, 2> stamps;  ///< to be written, by buffer
    Cycle ready;                          ///< when all of it is in the slot
    LeavingColors colors;
  };

  /// When the answers to an item's reads have come.
  struct Answers {
    Cycle depth = 0, color = 0;
  };
  /// A write of colours that may not be in the RAM yet: the cycle in which the colour stage took it.
  struct ColorWrite {
    Cycle taken = 0;
    std::size_t line = 0;
    SampleMask samples;
  };
  static constexpr Cycle kBlendClocks = 3;  ///< from the colour stage to the RAM, with blending
  /// Without blending only the last write can hold back the next: w(m-1) + 1 is the bound of all others.
  static constexpr std::size_t kWritesInFlight = Run::is_plain ? 1 : kBlendClocks;
  static constexpr std::size_t kLateLines = 16;  ///< lines whose late fragments the depth stage distinguishes, modulo

  [[nodiscard]] std::size_t late_place(std::size_t line, int stamp) const {
    return line % kLateLines * static_cast<std::size_t>(stamps_) + static_cast<std::size_t>(stamp);
  }

  /// The first cycle in which the depth stage can let an item go, as far as late items decide it.
  [[nodiscard]] Cycle late_room(const TagResult& tags, const BlockItem& item) const {
    if (!has_texture()) return 0;  // no item is late
    Cycle room = 0;
    if (item.mask.any()) room = item.is_late ? late_[late_place(tags.line, tags.stamp)] + 1 : last_late_ + 1;
    for (int stamp = 0; tags.eviction && stamp < stamps_; ++stamp)
      room = std::max(room, late_[late_place(tags.line, stamp)] + 1);
    return room;
  }

  /// The cycle in which an item that the depth stage has finished is offered to the colour stage.
  template <class Ask>
  Cycle shaded(const TextureWork& work, Ask&& ask) {
    if (!has_texture()) return tested_ + 2;
    const Cycle x = light_ ? light_->take(tested_, work.lit, work.sets_light) : tested_;
    if (work.sets == StateRegister::texture_lines) return texture_->set_lines(x);
    if (work.sets) return texture_->set(x, work.invalidates);
    if (work.sets_border) return texture_->set_border(x);
    if (work.lookups.empty()) return work.divided != 0 ? texture_->divide(x, work.divided) : texture_->pass(x);
    return texture_->take(x, work.lookups, [&ask](Cycle cycle, std::uint32_t address, int beats) {
      return ask.texture(cycle, address, beats);
    });
  }

  /// The evictions whose colours are being read out of the RAM, a stamp a cycle: the older eviction first, but a stamp
  /// that the colour stage is about to overwrite before all others. Two at most.
  class ColorReads {
   public:
    [[nodiscard]] bool has_two() const { return has_two_; }
    /// When the older eviction has been read, if no stamp of it is read earlier; then the next can begin.
    [[nodiscard]] Cycle first_done() const { return at_ + static_cast<Cycle>(count_of(left_[0])); }
    /// When both have been read.
    [[nodiscard]] Cycle all_done() const { return first_done() + static_cast<Cycle>(count_of(left_[1])); }

    /// Reads before `cycle`. Calls do not go back in time.
    void pass(Cycle cycle) {
      if (left_[0] == 0) return;
      while (left_[0] != 0 && at_ < cycle) remove(0, left_[0] & (~left_[0] + 1));
      at_ = std::max(at_, cycle);
    }
    /// An eviction begins in `cycle`.
    void begin(Cycle cycle, std::size_t line, std::uint64_t stamps) {
      at_ = std::max(at_, cycle);
      const std::size_t place = left_[0] != 0 ? 1 : 0;
      left_[place] = stamps;
      line_[place] = line;
      has_two_ = place == 1;
    }
    /// A stamp that is overwritten in this cycle, if still to be read.
    void read(std::size_t line, std::uint64_t stamp) {
      if (left_[0] == 0) return;
      for (const std::size_t place : {0U, 1U})
        if (line_[place] == line && (left_[place] & stamp) != 0) return remove(place, stamp);
    }

   private:
    void remove(std::size_t place, std::uint64_t stamp) {
      left_[place] &= ~stamp;
      ++at_;
      if (left_[0] != 0) return;
      left_[0] = std::exchange(left_[1], 0);
      line_[0] = line_[1];
      has_two_ = false;
    }

    std::array<std::uint64_t, 2> left_{};  ///< stamps to be read
    std::array<std::size_t, 2> line_{};
    bool has_two_ = false;  ///< the second has begun, and the first is not complete
    Cycle at_ = 0;          ///< the next read
  };

  /// The colour stage: the colours of that item, on offer from `offered` on, the stored ones from `answer` on. Returns
  /// when the colours of its eviction are reported in their slot, which does not depend on later items.
  Cycle color(const TagResult& tags, const BlockItem& item, Cycle offered, Cycle answer) {
    const DepthSource source = Run::is_plain ? DepthSource::none : tags.color_source;
    const bool fetches = source == DepthSource::clear || source == DepthSource::memory;
    const bool writes_all = tags.starts_color || fetches;
    Cycle w = std::max(offered, colored_ + 1), ready = 0;
    if (tags.eviction) {
      for (const ColorWrite& write : color_writes_)
        if (write.samples.any() && write.line == tags.line) w = std::max(w, write.taken + write_clocks() + 1);
      if (reads_.has_two()) w = std::max(w, reads_.first_done());
      reads_.pass(w);
      reads_.begin(w, tags.line, tags.eviction->stamps[1]);
      ready = w + 3 * static_cast<Cycle>(stamps_) + 1;
    }
    if (source == DepthSource::memory) w = std::max(w, answer + 1);
    if (source != DepthSource::none && !tags.starts_color) w = std::max(w, reads_.all_done());  // reads the RAM
    reads_.pass(w);
    if (item.colors.any() || writes_all) reads_.read(tags.line, std::uint64_t{1} << tags.stamp);
    colored_ = write_colors(w, tags.line, item, writes_all);
    return ready;
  }

  /// The clocks in which an item passes the colour stage from `w` on: one for each group of lanes with a sample to blend.
  /// Returns the last.
  Cycle write_colors(Cycle w, std::size_t line, const BlockItem& item, bool writes_all) {
    if (Run::is_plain || !item.blends) {
      note_color_write({w, line, writes_all ? all_samples_ : item.colors});
      return w;
    }
    SampleMask writes;  // samples written with the first group: no group reads the writes of another
    if (writes_all) writes = SampleMask(all_samples_.bits() & ~item.colors.bits());
    const int groups = samples_ / lanes_, size = lanes_;
    bool has_gone = false;
    for (int group = 0; group < groups; ++group) {
      const SampleMask own = item.colors & SampleMask((SampleMask::all(size).bits()) << group * size);
      if (!own.any() && !(group + 1 == groups && !has_gone)) continue;
      if (has_gone) ++w;
      note_color_write({w, line, writes | own});
      writes = {};
      has_gone = true;
    }
    return w;
  }

  void note_color_write(const ColorWrite& write) {
    color_writes_[Run::is_plain ? 0 : next_write_] = write;
    if (!Run::is_plain && ++next_write_ == color_writes_.size()) next_write_ = 0;
  }

  template <class Ask>
  Answers order(Cycle pushed, int writes, const TagResult& tags, Ask&& ask) {
    Cycle cycle = std::max(ordered_ + 1, orders_.ready(pushed));
    Answers answers;
    for (; writes > 0; --writes) {
      const Victim& v = victims_[oldest_];
      cycle = std::max(cycle, v.ready);
      Cycle behind = cycle + 1;  // finding nothing to write takes a cycle too
      for (const TilePlane plane : kTilePlanes) {
        std::uint64_t left = v.stamps[static_cast<std::size_t>(plane)];
        ColorMove move = ColorMove::samples;
        if (compresses() && plane == TilePlane::color && left != 0) {
          ++cycle;  // the bit is read
          move = color_move(v.colors, of_pixels_.is_set(v.block));
          of_pixels_.set(v.block, move == ColorMove::pixels);
        }
        if (move == ColorMove::merge) {
          cycle = merge(cycle, v.block, ask);
          left = all_stamps_;
        }
        while (left != 0) {
          const int stamp = std::countr_zero(left), run = std::countr_one(left >> stamp);
          const TilePlane stored = move == ColorMove::pixels ? TilePlane::pixel_color : plane;
          behind = ask.write(cycle, stored, {v.block, stamp}, run) + 1;
          cycle = behind;
          left &= left + (std::uint64_t{1} << stamp);  // clears the lowest run of ones
        }
      }
      cycle = behind;
      slots_[oldest_] = cycle;
      oldest_ = slot_after(oldest_);
    }
    const auto read = [&](TilePlane plane) {
      const auto [asked, answered] = ask.read(cycle, plane, {tags.block, tags.stamp});
      cycle = asked + 1;
      answered_ = answered;
      return answered;
    };
    if (tags.source == DepthSource::memory) answers.depth = read(TilePlane::depth);
    if (!Run::is_plain && tags.color_source == DepthSource::memory) {
      if (compresses()) ++cycle;  // the bit is read
      answers.color = read(compresses() && of_pixels_.is_set(tags.block) ? TilePlane::pixel_color : TilePlane::color);
    }
    ordered_ = cycle - 1;
    orders_.leave(ordered_);
    return answers;
  }

  /// Reads a block's pixels from memory, from `cycle` on. Returns when its samples can be written.
  template <class Ask>
  Cycle merge(Cycle cycle, const BlockAddress& block, Ask&& ask) {
    cycle = std::max(cycle, answered_ + 1);
    for (int stamp = 0; stamp < stamps_; ++stamp) {
      const auto [asked, answered] = ask.read(cycle, TilePlane::pixel_color, {block, stamp});
      cycle = asked + 1;
      answered_ = answered;
    }
    return answered_ + 1;
  }

  [[nodiscard]] std::size_t slot_after(std::size_t slot) const { return slot + 1 == slots_.size() ? 0 : slot + 1; }

  /// Into the next slot.
  template <class Ask>
  void note_victim(const Eviction& e, Cycle ready, Ask&& ask) {
    Victim& v = victims_[next_slot_];
    v = {e.block, {}, ready, {}};
    next_slot_ = slot_after(next_slot_);
    for (const std::size_t p : {0U, 1U}) v.stamps[p] = e.fills[p] ? all_stamps_ : e.stamps[p] & dirty_[e.line][p];
    if (!compresses()) return;
    v.colors = {e.fills[1], true, v.stamps[1] == all_stamps_};
    for (std::uint64_t left = v.stamps[1]; left != 0; left &= left - 1) {
      const int stamp = std::countr_zero(left);
      const SampleMask all = all_samples_, mask = e.fills[1] ? all : dirty_colors_[color_place(e.line, stamp)];
      v.colors.is_whole = v.colors.is_whole && mask == all;
      v.colors.is_uniform = v.colors.is_uniform && ask.has_one_color({e.block, stamp}, mask);
    }
  }

  [[nodiscard]] std::size_t color_place(std::size_t line, int stamp) const {
    return line * static_cast<std::size_t>(stamps_) + static_cast<std::size_t>(stamp);
  }

  void note_writes(const TagResult& tags, const BlockItem& item) {
    const bool starts_depth = tags.source != DepthSource::chip;
    last_line_ = tags.line;
    last_writes_ =
        item.mask.any() && !item.is_late && (item.depth_write || (starts_depth && tags.source != DepthSource::none));
    if (!item.mask.any()) return;
    const std::uint64_t bit = std::uint64_t{1} << tags.stamp;
    const auto note = [&](std::uint64_t& dirty, bool starts, bool writes) {
      if (writes)
        dirty |= bit;
      else if (starts)
        dirty &= ~bit;
    };
    note(dirty_[tags.line][0], starts_depth, item.wrote_depth);
    note(dirty_[tags.line][1], tags.starts_color, item.colors.any());
    if (!compresses()) return;
    SampleMask& dirty = dirty_colors_[color_place(tags.line, tags.stamp)];
    dirty = tags.starts_color ? item.colors : dirty | item.colors;
  }

  SampleMask all_samples_;
  int stamps_;                ///< of a block
  std::uint64_t all_stamps_;  ///< a bit for each
  int samples_;               ///< of a stamp
  int lanes_;                 ///< samples blended per clock; 0: no blending
  Cycle write_clocks_;        ///< from the colour stage to the RAM
  Station items_, orders_;
  FixedStation<2, 0, 0> behind_;  ///< between the depth stage and the colour stage; or the shading units
  std::optional<TextureTiming> texture_;
  std::optional<FogTiming> fog_;
  std::optional<LightTiming> light_;
  Cycle looked_ = 0;                        ///< the last fragment was looked up in the tags
  Cycle left_ = 0;                          ///< it left the tags
  Cycle tested_ = 0;                        ///< it left the depth stage
  Cycle colored_ = 0;                       ///< the colour stage took it
  Cycle ordered_ = 0;                       ///< the last request
  std::array<Cycle, 2> fall_reads_{};       ///< when words of falling flags were read, the last one first
  std::optional<BlockAddress> last_block_;  ///< block of the last fragment, if it has samples and no token came since
  Cycle depth_free_ = 0;                    ///< when the depth RAM has been read for the last eviction
  ColorReads reads_;
  std::array<ColorWrite, kWritesInFlight> color_writes_{};  ///< the last writes
  std::size_t next_write_ = 0;
  std::size_t last_line_ = 0;
  bool last_writes_ = false;        ///< the last fragment may have written depths
  OwnLinesVector<Cycle> slots_;     ///< of victims: the cycle from which on each is free
  OwnLinesVector<Victim> victims_;  ///< by slot
  std::size_t next_slot_ = 0, oldest_ = 0;
  OwnLinesVector<std::array<std::uint64_t, 2>> dirty_;  ///< by line and plane: stamps that differ from memory
  bool compresses_;                                     ///< compress.unit
  std::vector<SampleMask>
      dirty_colors_;         ///< with compress.unit, by line and stamp: samples whose colours differ from memory
  BlockBits of_pixels_;      ///< likewise: blocks that lie in memory with one colour per pixel
  Cycle answered_ = 0;       ///< answer of the last read
  std::vector<Cycle> late_;  ///< by place: when the colour stage took the last late item
  Cycle last_late_ = 0;      ///< the latest of all
};

}  // namespace halfplane
