// The time of the memory port: rtl_ref/stages/memory_port.sv, and of the memory.
//
// One register holds a stamp to be sent, or the gathered part of a beat; it loads the next one in the cycle in which
// its last beat moves. Reads wait for nothing else; a write burst waits until at most 255 are unanswered. An answer
// passes without a register: a stamp is handed on in the cycle in which its last beat comes.
//
//   request(n) = max(offered, last beat of n-1, for a new write burst: answer of the 255th before + 1)
//   beat       = max(request + 1, beat before + 1, for a new burst: memory has room)
//   answer     = max(memory has it, answer before + 1)
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "../../pipeline_graph.hpp"
#include "../../stages/memory_port.hpp"
#include "../../timing/memory.hpp"
#include "../../timing/station.hpp"
#include "../../timing/stream.hpp"
#include "run_kind.hpp"
#include "streams.hpp"

namespace halfplane {

/// The subject of a request (MemoryRequest). At: StampAddress or BlockStamp.
template <class At>
struct PortRequest {
  bool is_write = false;
  TilePlane plane = TilePlane::depth;
  At at;
  int run = 1;
};

/// The cycle in which a request was taken, and the cycle of the last response to it.
struct PortTimes {
  Cycle asked = 0, answered = 0;
};

/// The cycle in which the last request of a run was taken, and the sum of what each has waited.
struct RunTimes {
  Cycle last = 0, waited = 0;
};

template <class Run = AnyRun>
class PortTiming {
 public:
  static constexpr int kUnanswered = 255;  ///< write bursts

  /// `memory`, `streams` by Arrow and `sink`, which may be null, must outlive this.
  PortTiming(const Widths& widths, const Stalls& stalls, MemoryTiming& memory, std::array<Stream, kArrows>& streams,
             TransferSink* sink)
      : widths_(widths),
        layout_(default_layout(widths)),
        stalls_(stalls),
        memory_(memory),
        ideal_(memory.ideal_latency()),
        streams_(streams),
        sink_(sink) {
    for (std::size_t plane = 0; plane < offsets_.size(); ++plane) {
      const int shift = item_shift(static_cast<TilePlane>(plane), widths.memory);
      places_.push_back({shift, BeatShare(shift, widths.memory.port, 0)});
      for (int stamp = 0; stamp < widths.stamps.stamps(); ++stamp)
        offsets_[plane].push_back(stamp_offset(static_cast<TilePlane>(plane), stamp, widths));
    }
    set_layout(layout_);
  }

  void set_layout(const MemoryLayout& layout) {
    layout_ = layout;
    for (std::size_t plane = 0; plane < places_.size(); ++plane) {
      const auto first_of_row = [&](int y) {
        return byte_address(static_cast<TilePlane>(plane), 0, y, 0, layout, widths_);
      };
      places_[plane].base = first_of_row(0);
      places_[plane].row = first_of_row(1) - first_of_row(0);
    }
  }
  /// A stamp, by its tile.
  [[nodiscard]] const StampAddress& address_of(const StampAddress& at) const { return at; }
  [[nodiscard]] StampAddress address_of(const BlockStamp& at) const { return stamp_address(at, widths_); }
  /// The last cycle in which an item crossed: where nothing holds the streams back, the last answer.
  [[nodiscard]] Cycle last() const { return std::max(last_, answered_); }

  /// A request on offer from `cycle` on. Its beats are added to `beats`.
  template <class At>
  PortTimes take(const PortRequest<At>& request, Cycle cycle, std::uint64_t& beats) {
    if (!request.is_write && request.run == 1 && moves_freely()) return read_at_once(request, cycle, beats);
    const auto [share, address] = place_of(request);
    if (!request.is_write) return read(request, share, address, cycle, beats);
    return {write(request, share, address, share.first, cycle, beats), 0};
  }

  /// The `run` requests of a burst of writes: the first on offer from `cycle` on, each other from the cycle after the one
  /// before was taken. watch(asked): of each, if there is a sink.
  template <class At, class Watch>
  RunTimes take_run(const PortRequest<At>& request, Cycle cycle, std::uint64_t& beats, Watch&& watch) {
    if (left_ == 0 && moves_freely() && places_[number(request.plane)].share.per_beat == 1)
      return write_at_once(request, cycle, beats);
    const auto [share, address] = place_of(request);
    RunTimes times;
    for (int n = 0; n < request.run; ++n) {
      times.last = write(request, share, address, (share.first + n) & (share.per_beat - 1), cycle, beats);
      times.waited += times.last - cycle;
      cycle = times.last + 1;
      watch(times.last);
    }
    return times;
  }

 private:
  struct Place {
    BeatShare share;
    std::uint32_t address;  ///< of the first byte
  };
  template <class At>
  [[nodiscard]] Place place_of(const PortRequest<At>& request) const {
    const StampAddress at = address_of(request.at);
    if (is_flags(request.plane)) {
      const int shift = item_shift(request.plane, widths_.memory);
      const std::uint32_t address = byte_address(request.plane, at.tile_x, at.tile_y, at.stamp, layout_, widths_);
      return {BeatShare(shift, widths_.memory.port, address >> shift), address};
    }
    const PlanePlace& plane = places_[number(request.plane)];
    Place place{plane.share, plane.base + std::uint32_t{at.tile_y} * plane.row +
                                 (std::uint32_t{at.tile_x} << widths_.memory.tile()) +
                                 offsets_[number(request.plane)][at.stamp]};
    place.share.first =
        static_cast<int>((place.address >> plane.shift) & static_cast<std::uint32_t>(place.share.per_beat - 1));
    return place;
  }

  /// The address of the first beat.
  template <class At>
  [[nodiscard]] std::uint64_t beat_address(const PortRequest<At>& request) const {
    return place_of(request).address >> widths_.memory.port << widths_.memory.port;
  }

  /// Whether nothing holds the streams back or watches them.
  [[nodiscard]] bool moves_freely() const { return Run::is_plain || (stalls_.threshold == 0 && sink_ == nullptr); }

  [[nodiscard]] Cycle memory_room() const { return ideal_ ? 0 : memory_.room(); }

  /// A stamp, the number `in_beat` of its beat; if it begins a burst, `request.run` counts the stamps of the burst.
  /// Returns when it is taken.
  template <class At>
  Cycle write(const PortRequest<At>& request, const BeatShare& share, std::uint32_t address, int in_beat, Cycle cycle,
              std::uint64_t& beats) {
    const bool begins = left_ == 0;
    if (begins) {
      left_ = request.run;
      burst_ = {true, address >> widths_.memory.port << widths_.memory.port, share.beats(request.run)};
      has_sent_ = false;
    }
    const Cycle asked = moves(Arrow::request, cycle, begins ? std::max(room_, unanswered_.room()) : room_);
    room_ = asked + 1;
    --left_;
    if (left_ != 0 && in_beat != share.per_beat - 1) return asked;  // the beat is not complete
    Cycle beat = asked;
    for (int n = 0; n < share.per_stamp; ++n) {
      beat = moves(Arrow::beat, beat + 1, has_sent_ ? 0 : memory_.room());
      has_sent_ = true;
    }
    room_ = beat;
    beats += static_cast<std::uint64_t>(share.per_stamp);
    if (left_ == 0) end_burst(beat, [&] { return burst_; });
    return asked;
  }

  /// A burst of writes in closed form, where nothing holds the streams back and no stamps share a beat: its first beat may
  /// wait for memory; then each stamp is taken with the last beat of the one before.
  template <class At>
  RunTimes write_at_once(const PortRequest<At>& request, Cycle cycle, std::uint64_t& counted) {
    const BeatShare& share = places_[number(request.plane)].share;
    const auto beats = static_cast<Cycle>(share.per_stamp), others = static_cast<Cycle>(request.run - 1);
    const Cycle first = std::max({cycle, room_, unanswered_.room()}), sent = std::max(first + 1, memory_room());
    const Cycle second = sent + beats - 1;  // with the last beat of the first stamp
    RunTimes times{first, first - cycle};
    if (others != 0) {
      times.last = second + (others - 1) * beats;
      times.waited += second - first - 1 + (others - 1) * (beats - 1);
    }
    room_ = second + others * beats;
    counted += (others + 1) * beats;
    streams_[index(Arrow::request)].count_run(others + 1, times.waited);
    streams_[index(Arrow::beat)].count_run((others + 1) * beats, sent - first - 1);
    end_burst(room_, [&] { return MemoryBurst{true, beat_address(request), share.beats(request.run)}; });
    return times;
  }

  /// The last beat of the burst of writes `burst()` has been sent in `beat`.
  template <class Burst>
  void end_burst(Cycle beat, Burst&& burst) {
    const Cycle answer = ideal_ ? beat + *ideal_ : memory_.accept(burst(), beat).at(0);
    answered_ = moves(Arrow::answer, std::max(answer, answered_ + 1), 0);
    unanswered_.leave(answered_);
  }

  /// A read of a stamp where nothing holds the streams back.
  template <class At>
  PortTimes read_at_once(const PortRequest<At>& request, Cycle cycle, std::uint64_t& counted) {
    const Cycle asked = std::max(cycle, room_);
    room_ = std::max(asked + 1, memory_room());
    const int per_stamp = places_[number(request.plane)].share.per_stamp;
    const auto beats = static_cast<std::uint64_t>(per_stamp);
    if (ideal_) {
      answered_ = std::max(room_ + *ideal_ + beats - 1, answered_ + beats);
    } else {
      const MemoryBurst burst{false, beat_address(request), per_stamp};
      const BurstAnswer answer = memory_.accept(burst, room_);
      for (int n = 0; n < burst.beats; ++n) answered_ = std::max(answer.at(n), answered_ + 1);
    }
    counted += beats;
    streams_[index(Arrow::request)].count_run(1, asked - cycle);
    streams_[index(Arrow::beat)].count_run(1, room_ - asked - 1);
    streams_[index(Arrow::answer)].count_run(beats, 0);
    streams_[index(Arrow::response)].count_run(1, 0);
    return {asked, answered_};
  }

  template <class At>
  PortTimes read(const PortRequest<At>& request, const BeatShare& share, std::uint32_t address, Cycle cycle,
                 std::uint64_t& beats) {
    const Cycle asked = moves(Arrow::request, cycle, room_);
    room_ = moves(Arrow::beat, asked + 1, memory_.room());
    const MemoryBurst burst{false, address >> widths_.memory.port << widths_.memory.port, share.beats(request.run)};
    const BurstAnswer answer = memory_.accept(burst, room_);
    beats += static_cast<std::uint64_t>(burst.beats);
    const unsigned both = streams_[index(Arrow::answer)].streams() | streams_[index(Arrow::response)].streams();
    int stamps = request.run, next = share.first;
    for (int n = 0; n < burst.beats; ++n) {
      const Cycle due = std::max(answer.at(n), answered_ + 1);
      if ((n + 1) % share.per_stamp != 0) {  // the stamp is not complete
        answered_ = moves(Arrow::answer, due, 0);
        continue;
      }
      for (Cycle from = due; stamps > 0 && next < share.per_beat; ++next, --stamps, from = answered_ + 1) {
        answered_ = stalls_.next_free(both, from);
        count(Arrow::response, from, answered_);
      }
      next = 0;
      count(Arrow::answer, due, answered_);
    }
    return {asked, answered_};
  }

  Cycle moves(Arrow arrow, Cycle offered, Cycle room) {
    Stream& stream = streams_[index(arrow)];
    const Cycle moved = Run::is_plain ? stream.move(offered, room) : stream.transfer(offered, room);
    if (!Run::is_plain) note(arrow, moved);  // plain runs ask for last() alone, and the answer is later
    return moved;
  }
  void count(Arrow arrow, Cycle offered, Cycle moved) {
    streams_[index(arrow)].count(offered, moved);
    note(arrow, moved);
  }
  void note(Arrow arrow, Cycle cycle) {
    last_ = std::max(last_, cycle);
    if (!Run::is_plain && sink_ != nullptr) sink_->transfer(arrow, cycle);
  }

  Widths widths_;
  MemoryLayout layout_;
  Stalls stalls_;
  MemoryTiming& memory_;
  std::optional<Cycle> ideal_;  ///< MemoryTiming::ideal_latency(): then nothing is asked of it
  std::array<Stream, kArrows>& streams_;
  TransferSink* sink_;
  FixedStation<kUnanswered, 0, 1> unanswered_;  ///< write bursts
  MemoryBurst burst_;                           ///< the burst being written
  int left_ = 0;                                ///< stamps of it that have not come
  /// A buffer in memory, and how its stamps share beats.
  struct PlanePlace {
    int shift;  ///< log2 of the bytes of a stamp
    BeatShare share;
    std::uint32_t base = 0, row = 0;  ///< of tile (0, 0); from a row of tiles to the next
  };
  OwnLinesVector<PlanePlace> places_;                  ///< by plane, not those of flags
  std::array<std::vector<std::uint32_t>, 6> offsets_;  ///< stamp_offset() by plane, but for flags
  bool has_sent_ = false;                              ///< a beat of it has been sent
  Cycle room_ = 0, answered_ = 0;
  Cycle last_ = 0;
};

}  // namespace halfplane
