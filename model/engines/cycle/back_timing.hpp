// Timing of the stages downstream of interpolate: primitive_join, line_raster, depth_test, framebuffer, memory. Base class of
// pipelined_timing.hpp and serial_timing.hpp.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "../../stages/cache_tags.hpp"
#include "../../stages/tile_directory.hpp"
#include "../../timing/memory.hpp"
#include "../../timing/station.hpp"
#include "../../timing/stream.hpp"
#include "block_timing.hpp"
#include "port_timing.hpp"
#include "streams.hpp"
#include "timing_totals.hpp"

namespace halfplane {

/// The samples that a fragment reads and writes, to find hazards with the next fragment.
struct FragmentPlace {
  int tile_x = 0, tile_y = 0, stamp = 0;
  SampleMask mask;  ///< covered samples; none: no lookup
  bool depth_write = false;
};

template <class Run>
class BackTiming {
 public:
  static constexpr bool is_plain = Run::is_plain;

  /// `memory` and `sink`, which may be null, must outlive this.
  BackTiming(const Config& config, const Widths& widths, const Stalls& stalls, MemoryTiming& memory, TransferSink* sink,
             const MemorySettings& textures)
      : stalls_(stalls),
        streams_(streams_of(stalls)),
        port_(widths, stalls, memory, streams_, sink),
        sink_(sink),
        widths_(widths),
        line_raster_(1, 1, 1),
        resolves_(config.frame_clears == FrameClears::resolve),
        compresses_(config.compress_units != 0) {
    if (config.cache_kind == CacheKind::blocks) blocks_.emplace(config, widths);
    if (!has_texture_planes(config)) return;
    textures_ = make_memory(without_traffic(textures), config);
    texture_port_.emplace(*textures_, stream(Arrow::texture), stream(Arrow::texel));
  }

  /// Addresses of the buffers in memory; the default is default_layout().
  void set_layout(const MemoryLayout& layout) { port_.set_layout(layout); }
  /// With compress.unit: has_one_color() of a stamp's stored samples.
  using OneColor = std::function<bool(const StampAddress&, SampleMask)>;
  void look_at_colors(OneColor has_one_color) { has_one_color_ = std::move(has_one_color); }
  [[nodiscard]] TimingTotals totals() const {
    TimingTotals totals = totals_;
    totals.last = std::max(totals.last, port_.last());
    for (const auto& of_cause : totals.beats) totals.works[index(Stage::memory_port)] += of_cause[0] + of_cause[1];
    return totals;
  }
  /// The cycle in which the last fragment moved.
  [[nodiscard]] Cycle last_fragment() const { return last_fragment_; }
  /// The stream of an elastic arrow.
  [[nodiscard]] const Stream& stream(Arrow arrow) const { return streams_[index(arrow)]; }

  /// Another scene: primitives, writes and tile moves are counted from here on.
  void begin_scene() {
    totals_.has_primitive = false;
    totals_.last_write = 0;
    totals_.tile_cycles = moving_ = 0;
    moved_before_.clear();
  }

  /// A triangle, point or line has been taken by cull.
  void count_primitive(Cycle cycle) {
    if (totals_.has_primitive) return;
    totals_.has_primitive = true;
    totals_.first_primitive = cycle;
    // Moves and writes of a clear come earlier in program order, and may come later in time.
    const auto since = [cycle](Cycle from, Cycle to) {
      return to > cycle ? to - std::min(std::max(from, cycle), to) : 0;
    };
    for (const auto& [from, to] : moved_before_) {
      moving_ += since(from, to);
      totals_.tile_cycles += since(std::min(from, totals_.last_write + 1), std::min(to, totals_.last_write + 1));
    }
    moved_before_.clear();
  }

  /// The setup of a line whose place is offered from `offered` on goes into line_raster.
  void take_line(Cycle offered) {
    const Cycle taken = stream(Arrow::line).transfer(std::max(offered, next_line_), line_raster_.room());
    next_line_ = taken + 1;
    first_pixel_ = line_raster_.ready(taken);
    note(Arrow::line, taken);
  }

  /// A stamp without a covered sample, on offer to depth_test from `offered` on. Returns when it moves.
  Cycle pass(Cycle offered, unsigned others = 0) {
    if (has_blocks()) return access(offered, {}, {}, {}, others);
    const Cycle moved = move(Arrow::fragment, offered, 0, others);
    note(Arrow::fragment, moved);
    last_fragment_ = moved;
    last_place_ = {};
    return moved;
  }

  /// A stamp with covered samples. look_up(mover) makes its tile resident and returns whether it already was.
  template <class LookUp>
  Cycle access(Cycle offered, const FragmentPlace& place, LookUp&& look_up, unsigned others) {
    Cycle ready = offered;
    if (last_place_.depth_write && last_place_.stamp == place.stamp && last_place_.tile_x == place.tile_x &&
        last_place_.tile_y == place.tile_y && (last_place_.mask & place.mask).any() && offered < last_fragment_ + 2) {
      ready = last_fragment_ + 2;
      totals_.hazard_cycles += ready - offered;
    }
    const Cycle begins = stalls_.next_free(stream(Arrow::fragment).streams() | others, ready);
    Mover mover{*this, begins + 1};
    if (!look_up(mover)) {
      ready = mover.cycle;
      count_moves(begins, ready);
    }
    const Cycle moved = stream(Arrow::fragment).transfer(offered, ready, others);
    note(Arrow::fragment, moved);
    note(Arrow::write, moved + 1);
    totals_.last_write = moved + 1;
    if (totals_.has_primitive) totals_.tile_cycles = moving_;
    last_fragment_ = moved;
    last_place_ = place;
    return moved;
  }

  /// The same in a framebuffer of blocks, with the results of the tag lookup and the test.
  Cycle access(Cycle offered, const TagResult& tags, const BlockItem& item, const TextureWork& texture,
               unsigned others = 0) {
    const unsigned streams = stream(Arrow::fragment).streams() | others;
    Cycle moved = next_free(streams, std::max(offered, blocks_->room()));
    while (blocks_->is_busy(moved, tags, item)) moved = next_free(streams, moved + 1);
    stream(Arrow::fragment).count(offered, moved);
    if (!Run::is_plain || !item.mask.any()) note(Arrow::fragment, moved);  // its write below is later
    last_fragment_ = moved;
    blocks_->take(moved, tags, item, texture, BlockPort{*this});
    if (!Run::is_plain) work(Stage::texture_unit, texture.lookups.size());
    if (!Run::is_plain && textures_ && item.is_shaded) note(Arrow::color, blocks_->colored());
    return moved;
  }
  /// The last stamp had covered samples. Several in a row may be noted at once, by the last of them, if nothing watches.
  void note_write() {
    totals_.last_write = blocks_->tested() + 1;
    note(Arrow::write, totals_.last_write);
    if (totals_.has_primitive) totals_.tile_cycles = moving_;
  }

  /// The pixels of a line, whose place is on offer from `offered` on. take(offered, others): the next one in
  /// depth_test. Returns the cycle in which the last pixel moves.
  template <class Take>
  Cycle take_pixels(Cycle offered, std::uint32_t pixels, Take&& take) {
    Cycle pixel = first_pixel_, moved = 0;
    for (; pixels > 0; --pixels, pixel = moved + 1, offered = std::max(offered, pixel)) {
      moved = take(std::max(offered, pixel), stream(Arrow::line_pixel).streams());
      stream(Arrow::line_pixel).count(pixel, moved);
      work(Stage::line_raster, 1);
      note(Arrow::line_pixel, moved);
    }
    line_raster_.leave(moved);
    return moved;
  }

  /// A fast clear or a flush on its way through the framebuffer. walk(mover) visits lines and tiles.
  template <class Walk>
  Cycle pass_token(Cycle offered, Walk&& walk) {
    const Cycle begins = stalls_.next_free(stream(Arrow::fragment).streams(), offered);
    Mover mover{*this, begins + 1};
    walk(mover);
    const Cycle moved = stream(Arrow::fragment).transfer(offered, mover.cycle);
    count_moves(begins, moved + 1);
    note(Arrow::fragment, moved);
    last_fragment_ = moved;
    last_place_ = {};
    return moved;
  }

  /// The same in a framebuffer of blocks: a flush, or a fast clear of the buffers that `state` writes, of tiles (0, 0),
  /// or the first tile of its bin, to (last_x, last_y).
  Cycle pass_token(Cycle offered, CacheTags& directory, bool is_clear, const PrimitiveState& state, int last_x,
                   int last_y) {
    const std::array<bool, 2> clears{state.depth_write, state.color_write};
    const BlockPort ask{*this};
    const Cycle begins = stalls_.next_free(stream(Arrow::fragment).streams(), std::max(offered, blocks_->is_empty()));
    Cycle cycle = begins + 1;
    if (!is_clear) directory.drop_depth(state.drops_depth());
    const bool clears_bin = is_clear && state.clears_bin();
    if (!(is_clear && clears[0] && clears[1]) && !clears_bin) {
      directory.evict_all([&](const TagResult& tags) { cycle = blocks_->walk(cycle, tags, ask); });
      cycle = blocks_->is_empty();
    }
    const Cycle drained = blocks_->drain(cycle, directory.write_all(), ask) + 1;
    cycle = drained;
    const int words = directory.words_of((last_x + 1) * widths_.blocks.per_tile - 1);  // of a row
    // In a clear of one bin each word is read, then written.
    if (clears_bin) {
      cycle += 2 * static_cast<Cycle>(directory.mark_bin(last_x, last_y));
      const auto [first, last] = directory.bin_blocks(last_x, last_y);
      blocks_->of_pixels().set_blocks(first, last, false);
    } else if (is_clear) {
      directory.mark(last_x, last_y, clears);
      if (clears[1]) blocks_->of_pixels().set_tiles(last_x, last_y, false);
      cycle += std::max<Cycle>(directory.lines(),
                               static_cast<Cycle>(words) * static_cast<Cycle>((last_y + 1) * widths_.blocks.per_tile));
    } else {
      for (const TilePlane plane : kTilePlanes) {
        if (plane == TilePlane::depth && directory.drops_depth()) continue;
        if (plane == TilePlane::color && resolves_)
          directory.for_each_flag_word(plane, last_x, last_y, [&](int word, int y, std::uint64_t bits) {
            cycle = resolve_word(cycle + 2, word, y, bits);
          });
        else
          cycle = write_flags(cycle, plane, words, last_y);
      }
      if (resolves_) directory.resolve(TilePlane::color, last_x, last_y);
      if (compresses_) cycle = write_flags(cycle, TilePlane::pixel_color, words, last_y);
    }
    directory.drop_depth(is_clear && state.drops_depth());
    const Cycle moved = stream(Arrow::fragment).transfer(offered, cycle);
    count_moves(drained, moved + 1);
    note(Arrow::fragment, moved);
    last_fragment_ = moved;
    return moved;
  }

 protected:
  ~BackTiming() = default;

  void note(Arrow boundary, Cycle cycle) {
    totals_.last = std::max(totals_.last, cycle);
    if (!Run::is_plain && sink_ != nullptr) sink_->transfer(boundary, cycle);
  }

  /// The first cycle from `cycle` on in which none of these streams is stalled.
  [[nodiscard]] Cycle next_free(unsigned streams, Cycle cycle) const {
    return Run::is_plain ? cycle : stalls_.next_free(streams, cycle);
  }
  /// The next item of an elastic arrow moves (Stream::transfer).
  Cycle move(Arrow arrow, Cycle offered, Cycle room, unsigned others = 0) {
    return Run::is_plain ? stream(arrow).move(offered, room) : stream(arrow).transfer(offered, room, others);
  }

  [[nodiscard]] bool has_blocks() const { return Run::is_plain || blocks_.has_value(); }
  void work(Stage stage, std::uint64_t cycles) { totals_.works[index(stage)] += cycles; }

  /// The visit of the last fragment has ended.
  void retire() {
    last_retire_ = (has_blocks() ? blocks_->tested() : last_fragment_) + 2;
    note(Arrow::retire, last_retire_);
  }

  [[nodiscard]] Stream& stream(Arrow arrow) { return streams_[index(arrow)]; }

  const Stalls stalls_;
  Cycle last_fragment_ = 0;  ///< when the last fragment moved
  Cycle last_retire_ = 0;

  TimingTotals totals_;

 private:
  /// Sends a request, in `cycle` at the earliest.
  template <class At>
  PortTimes ask(Cycle cycle, TilePlane plane, const At& at, int run, MoveCause cause) {
    const bool is_read = cause == MoveCause::fill;
    const PortTimes times = port_.take(PortRequest<At>{!is_read, plane, at, run}, cycle, beats(plane, cause));
    totals_.memory_cycles += times.asked - cycle;
    return times;
  }

  /// Writes `run` stamps of a block, from `at` on: a request a cycle, from `cycle` on. Returns when the last is taken.
  Cycle write_run(Cycle cycle, TilePlane plane, const BlockStamp& at, int run, MoveCause cause) {
    const PortRequest<BlockStamp> request{true, plane, at, run};
    const RunTimes times = port_.take_run(request, cycle, beats(plane, cause),
                                          [&](Cycle asked) { note_move(cause, plane, at, asked, asked + 1); });
    totals_.memory_cycles += times.waited;
    return times.last;
  }

  [[nodiscard]] std::uint64_t& beats(TilePlane plane, MoveCause cause) {
    return totals_.beats[static_cast<std::size_t>(cause)][is_of_color(plane) ? 1 : 0];
  }
  /// A request of a framebuffer of blocks.
  template <class At>
  void note_move(MoveCause cause, TilePlane plane, const At& at, Cycle from, Cycle to) {
    if (Run::is_plain || sink_ == nullptr) return;
    const StampAddress stamp = port_.address_of(at);
    sink_->move(cause, is_of_color(plane), stamp.tile_x, stamp.tile_y, from, to);
  }

  /// Requests a line for the texture unit, which takes its beats as they come.
  LineTimes ask_for_texels(Cycle cycle, std::uint32_t address, int beats) {
    const LineTimes times =
        texture_port_->ask(cycle, address, beats, [this](int, Cycle at) { note(Arrow::texel, at); });
    note(Arrow::texture, times.asked);
    totals_.texel_beats += static_cast<std::uint64_t>(beats);
    return times;
  }

  /// BlockTiming's access to memory.
  struct BlockPort {
    BackTiming& timing;

    LineTimes texture(Cycle cycle, std::uint32_t address, int beats) const {
      return timing.ask_for_texels(cycle, address, beats);
    }
    PortTimes read(Cycle cycle, TilePlane plane, const BlockStamp& at) const {
      return timing.ask_of_block(cycle, plane, at, 1, MoveCause::fill);
    }
    Cycle write(Cycle cycle, TilePlane plane, const BlockStamp& at, int run) const {
      return timing.write_run(cycle, plane, at, run, MoveCause::evict);
    }
    [[nodiscard]] bool has_one_color(const BlockStamp& at, SampleMask mask) const {
      return timing.has_one_color_(timing.port_.address_of(at), mask);
    }
  };

  /// The same for a framebuffer of blocks.
  template <class At>
  PortTimes ask_of_block(Cycle cycle, TilePlane plane, const At& at, int run, MoveCause cause) {
    const PortTimes times = ask(cycle, plane, at, run, cause);
    note_move(cause, plane, at, times.asked, std::max(times.asked, times.answered) + 1);
    return times;
  }

  /// A flush's requests for one word of flags, of `words` in its row, in `cycle` at the earliest. Both return when the next
  /// word can be read.
  Cycle write_flag_word(Cycle cycle, TilePlane plane, int word, int words, int y) {
    const StampAddress at = flag_word_address(word, y, widths_);
    return ask_of_block(cycle, flags_of(plane), at, words - word, MoveCause::clear).asked + 1;
  }
  /// All words, up to the tiles of row last_y.
  Cycle write_flags(Cycle cycle, TilePlane plane, int words, int last_y) {
    for (int y = 0; y < (last_y + 1) * widths_.blocks.per_tile; ++y)
      for (int word = 0; word < words; ++word) cycle = write_flag_word(cycle + 1, plane, word, words, y);
    return cycle;
  }
  Cycle resolve_word(Cycle cycle, int word, int y, std::uint64_t bits) {
    if (bits == 0) ++cycle;
    for (int x = word * widths_.blocks.flag_word; bits != 0; bits >>= 1, ++x) {
      if ((bits & 1) == 0) {
        ++cycle;
        continue;
      }
      const BlockAddress block{static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y)};
      const TilePlane plane = compresses_ ? TilePlane::pixel_color : TilePlane::color;
      cycle = write_run(cycle, plane, {block, 0}, widths_.blocks.stamps(), MoveCause::clear) + 1;
      if (compresses_) blocks_->of_pixels().set(block, true);
    }
    return cycle;
  }

  /// The framebuffer's state machine while it moves tiles: `cycle` is the next unused one.
  struct Mover {
    BackTiming& timing;
    Cycle cycle;

    void look_at_line() { ++cycle; }
    void write_back(std::size_t, const TileAddress& address, const StampRows& rows, bool fills) {
      cycle += 2;  // the lookup that found it dirty, and one for its first row of stamps
      timing.write_stamps(cycle, address, rows, fills, MoveCause::evict);
    }
    void fill(std::size_t, int x, int y, const std::array<bool, 2>& is_cleared) {
      ++cycle;  // the lookup that found nothing dirty
      timing.fill(cycle, x, y, is_cleared[0]);
    }
    void mark_words(int words) { cycle += static_cast<Cycle>(words); }
    void write_flags(TilePlane plane, int word, int words, int y, std::uint64_t) {
      cycle = timing.write_flag_word(cycle + 1, plane, word, words, y);
    }
    void look_at_tile() { cycle += 2; }
    void write_clear_value(const TileAddress& address, const StampRows& rows) {
      timing.write_stamps(cycle, address, rows, true, MoveCause::clear);
    }
  };

  /// Writes of these stamps of a tile: a stamp is read out of the RAMs, from `cycle` on, and offered in the next cycle;
  /// the next stamp is read when it is taken. A row without stamps takes a cycle, the last row none. `cycle` becomes
  /// the cycle after the last request and row.
  void write_stamps(Cycle& cycle, const TileAddress& address, const StampRows& rows, bool is_whole, MoveCause cause) {
    const int per_row = widths_.stamps.stamps_per_row;
    Cycle first = 0, taken = 0;
    for (int row = 0; row < per_row; ++row) {
      std::uint32_t left = rows[static_cast<std::size_t>(row)];
      if (left == 0 && row + 1 < per_row) ++cycle;
      for (; left != 0; left &= left - 1) {
        const int stamp = row * per_row + std::countr_zero(left);
        const StampAddress at{address.tile_x, address.tile_y, static_cast<std::uint16_t>(stamp)};
        cycle = std::max(cycle, taken) + 1;
        taken = ask(cycle, address.plane, at, run_of(rows, is_whole, stamp, widths_), cause).asked;
        if (first == 0) first = taken;
      }
    }
    cycle = std::max(cycle, taken) + 1;
    if (sink_ != nullptr)
      sink_->move(cause, address.plane == TilePlane::color, address.tile_x, address.tile_y, first, cycle);
  }

  /// The depth of a tile, from memory in one burst or from the clear value.
  void fill(Cycle& cycle, int x, int y, bool is_cleared) {
    const int stamps = widths_.stamps.stamps();
    if (is_cleared) {
      cycle += static_cast<Cycle>(stamps);
      return;
    }
    const StampAddress at{static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y), 0};
    const PortTimes times = ask(cycle + 1, TilePlane::depth, at, stamps, MoveCause::fill);
    if (sink_ != nullptr) sink_->move(MoveCause::fill, false, x, y, times.asked, times.answered + 1);
    totals_.memory_cycles += times.answered - times.asked;
    cycle = times.answered + 1;
  }

  void count_moves(Cycle from, Cycle to) {
    totals_.move_cycles += to - from;
    if (sink_ != nullptr) sink_->wait(from, to);
    if (!totals_.has_primitive)
      moved_before_.emplace_back(from, to);
    else
      moving_ += to - from;
    // The next access waits while the last write goes in.
    if (totals_.has_primitive && from == totals_.last_write && from >= totals_.first_primitive) ++totals_.tile_cycles;
  }

  using Streams = std::array<Stream, kArrows>;
  /// One stream for each arrow, though only elastic arrows need one.
  static Streams streams_of(const Stalls& stalls) {
    const auto stalled_by = [](Arrow arrow) {
      return stall_bit(arrow) | (info(arrow).to == Stage::memory ? 1U << kMemoryStall : 0);
    };
    return [&]<std::size_t... I>(std::index_sequence<I...>) {
      return Streams{Stream(stalls, stalled_by(static_cast<Arrow>(I)))...};
    }
    (std::make_index_sequence<kArrows>{});
  }

  Streams streams_;
  PortTiming<Run> port_;
  TransferSink* sink_;
  Widths widths_;
  Station line_raster_;
  bool resolves_;    ///< frame.clears
  bool compresses_;  ///< compress.unit
  OneColor has_one_color_;
  std::optional<BlockTiming<Run>> blocks_;  ///< with cache.kind blocks
  std::unique_ptr<MemoryTiming> textures_;  ///< with a texture unit: its memory
  std::optional<TexturePort> texture_port_;
  Cycle next_line_ = 0, first_pixel_ = 0;
  FragmentPlace last_place_;
  std::uint64_t moving_ = 0;                           ///< cycles since the first primitive in which tiles moved
  std::vector<std::pair<Cycle, Cycle>> moved_before_;  ///< tile moves before the first primitive
};

}  // namespace halfplane
