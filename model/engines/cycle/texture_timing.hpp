// The time of the texture unit: rtl_ref/stages/texture_unit.sv and the texture_*.sv in it.
//
// Every wait is for an earlier stamp or sample, so each time is a maximum over earlier ones. For stamp m and sample n:
//
//   s(n) = max(x(m) + 2, s(n-1) + 1, a(n-16) + 1)                  split
//   a(n) = max(s(n) + 10, t(n-1), tags swept)                      its tag is read
//   t(n) = max(a(n) + 1, h(n-in_flight) + 1), a miss also: the request before is taken, the line's place is free
//   h(n) = max(t(n) + 1, d(n-1)), a miss also: its last beat + 1   its texel is read
//   d(n) = max(h(n) + 1, e(n-1))                                   decoded; three such stages for a linear filter
//   e(n) = max(d(n) + 1, g(m-1) + 1, w(m-1))                       combined
//   g(m) = e of its last sample; without texture max(x(m) + 2, g(m-1) + 1, w(m-1))
//
// A sample without texture whose colour is divided bypasses the tags: its e(n) is c(n) = max(s(n) + 10, c(n-1) + 1,
// g(m-1) + 1, w(m-1)). A state precedes it, so no sample waits upstream of the tags and its split needs no room there.
// With a texture as well, the colour is ready before the texel.
//
// With a linear filter a sample requests its lines one by one, and leaves the tags with the last request or later. A
// stamp is offered to the colour stage in g(m) + 1. A state is set when no sample is left upstream of h: max(x(m) + 2,
// s + 1, t + 1); lines of a triangle as soon as they come: max(x(m) + 2, s + 1). The border's colour is set when no
// sample is left upstream of e: max(x(m) + 2, s + 1, the cycle after the last sample left the stage before e).
//
// With levels a sample's level is known two clocks later, and the sample goes through two more stages upstream of the
// tags and one more after the filter, once or twice. For its pass i, counted over all samples:
//
//   f(i) = max(s(n) + 12, b(i-1))   it leaves the queue; with its last pass the sample
//   b(i) = max(f(i) + 1, a(i-1))    its coordinates are on their level
//   a(i) = max(b(i) + 1, t(i-1), tags swept)
//
// and the first of two passes does not reach e: it ends in the filter's last stage, a clock after the previous pass.
//
// With four lanes n counts groups, and a group goes through cache and filter in one pass or more, of samples that
// agree. Their lines are requested one by one, also without a linear filter, and a register holds a pass upstream of
// the tags:
//
//   f(i) = max(s(n) + 10, a(i-1))   it leaves the queue; with its last pass the group
//   a(i) = max(f(i) + 1, t(i-1), tags swept)
//
// e is that of a pass, and c that of a group.
//
// With four lanes and levels a group leaves its queue once or twice, with all samples' lower levels and with the upper
// ones. For such a round r, and its pass i:
//
//   f(r) = max(s(n) + 12, b(r-1))       with its last round the group leaves the queue
//   b(r) = max(f(r) + 1, c(r-1))        its coordinates are on their levels
//   c(r) = max(b(r) + 1, p(r-1, last))  the agreeing samples are known
//   p(i) = max(c(r) + 1, a(i-1))        a pass upstream of the tags
//   a(i) = max(p(i) + 1, t(i-1), tags swept)
//
// A pass whose samples all wait for their upper level does not reach e.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "../../stages/texture_unit.hpp"
#include "../../timing/memory.hpp"
#include "../../timing/station.hpp"
#include "../../timing/stream.hpp"

namespace halfplane {

/// When a request for a line was taken, and when the last beat of the line came.
struct LineTimes {
  Cycle asked = 0, answered = 0;
};

/// The unit's memory port, and its memory: a request goes out from a register, and beats are taken as they come.
class TexturePort {
 public:
  /// All arguments must outlive this.
  TexturePort(MemoryTiming& memory, Stream& requests, Stream& answers)
      : memory_(memory), requests_(requests), answers_(answers) {}

  /// Beats requested before a reset come up to `over`.
  void answers_until(Cycle over) { answered_ = over; }
  /// A line, on offer from `cycle` on. visit(beat, cycle) for each beat.
  template <class Visit>
  LineTimes ask(Cycle cycle, std::uint32_t address, int beats, Visit&& visit) {
    const Cycle asked = requests_.transfer(cycle, memory_.room());
    const BurstAnswer answer = memory_.accept({false, address, beats}, asked);
    for (int beat = 0; beat < beats; ++beat) {
      answered_ = answers_.transfer(std::max(answer.at(beat), answered_ + 1), 0);
      visit(beat, answered_);
    }
    return {asked, answered_};
  }

 private:
  MemoryTiming& memory_;
  Stream &requests_, &answers_;
  Cycle answered_ = 0;
};

class TextureTiming {
 public:
  /// rst_ni is high from `start` on; all earlier requests are complete in `recovered` (recovered()).
  explicit TextureTiming(const TextureSettings& settings, Cycle start = 0, Cycle recovered = 0)
      : has_banks_(settings.has_banks()),
        has_levels_(settings.has_levels),
        has_lanes_(settings.lanes != 1),
        filter_stages_(settings.has_levels   ? 4
                       : settings.has_linear ? 3
                                             : 1),
        inside_(settings.queue, 0, 1),
        ahead_(kAhead, settings.has_levels ? kLevelClocks : kClocks, 1),
        waiting_(settings.in_flight, 1, 1),
        requests_(settings.has_banks() ? kRequests : settings.in_flight, 1, 1),
        sweep_(static_cast<Cycle>(settings.has_banks() ? settings.lines / 4 / settings.ways : settings.lines)),
        swept_(start + sweep_),
        request_room_(std::max(start, recovered)),
        lines_(static_cast<std::size_t>(settings.lines)),
        read_(static_cast<std::size_t>(settings.in_flight)) {}

  /// When the first request after a reset may leave the tags: rst_ni was low up to `reset`, the last earlier request
  /// was taken and answered up to `over`.
  [[nodiscard]] static Cycle recovered(Cycle reset, Cycle over) { return std::max(reset, over) + 2; }

  /// The first cycle in which the depth stage may let the next stamp go; the stamp arrives in the next cycle.
  [[nodiscard]] Cycle room() const { return inside_.room(); }
  /// When nothing is under way any more.
  [[nodiscard]] Cycle is_empty() const { return std::max(left_ + 1, swept_); }

  /// A stamp without texture that left the depth stage in `x`. Returns when it is on offer to the colour stage.
  Cycle pass(Cycle x) {
    gone_ = std::max({x + kDoor, gone_ + 1, left_});
    return gone_ + 1;
  }

  /// A stamp that sets a state; `drops`: it also invalidates the cache.
  Cycle set(Cycle x, bool drops) {
    split_ = std::max({x + kDoor, split_ + 1, looked_up_ + 1});
    if (drops) {
      swept_ = split_ + 1 + sweep_;
      for (std::uint64_t& group : lines_) group = last_group();
    }
    return pass(x);
  }

  /// A stamp that sets the border's colour.
  Cycle set_border(Cycle x) {
    split_ = std::max({x + kDoor, split_ + 1, stages_[filter_stages_ - 1] + 1});
    return pass(x);
  }

  /// A stamp with a part of a triangle's lines.
  Cycle set_lines(Cycle x) {
    split_ = std::max(x + kDoor, split_ + 1);
    return pass(x);
  }

  /// A stamp with a texture; `lookups`: of its samples, in their order. ask(cycle, address, beats): a request, on offer
  /// from `cycle` on; returns LineTimes.
  template <class Ask>
  Cycle take(Cycle x, std::span<const TextureLookup> lookups, Ask&& ask) {
    bool is_next = true;  // the next pass is the first of a sample, or of a group
    for (std::size_t first = 0; first < lookups.size();) {
      std::size_t end = first + 1;
      while (!lookups[end - 1].ends) ++end;
      if (is_next) split_ = std::max({x + kDoor, split_ + 1, ahead_.room()});
      is_next = !lookups[end - 1].continues;
      pass(lookups.subspan(first, end - first), ask);
      first = end;
    }
    gone_ = combined_;
    return gone_ + 1;
  }

  /// A stamp without a texture whose colours are divided by w, in this many groups of samples: they bypass the tags.
  Cycle divide(Cycle x, int groups) {
    for (int n = 0; n < groups; ++n) {
      split_ = std::max(x + kDoor, split_ + 1);
      divided_ = std::max({split_ + kClocks, divided_ + 1, gone_ + 1, left_});
    }
    gone_ = divided_;
    return gone_ + 1;
  }

  /// The stage after the unit took the stamp, and the colour stage took it in `w`.
  void leave(Cycle taken, Cycle w) {
    left_ = taken;
    inside_.leave(w);
  }
  void leave(Cycle w) { leave(w, w); }

 private:
  static constexpr int kAhead = 16, kClocks = 10, kLevelClocks = 12,
                       kRequests = 16;  ///< samples between split and tags, and the least cycles; lines in flight
  static constexpr Cycle kDoor = 2;     ///< from the depth stage to the head of the queues
  static constexpr int kGroup = 3, kNumber = 7;  ///< a group is 8 samples; the tags hold 7 bits of its number
  static constexpr std::uint64_t kNumbers = 1U << kNumber;

  [[nodiscard]] std::uint64_t last_group() const { return (count_ - 1) >> kGroup; }

  /// When the tags of the next pass are read. `is_last`: of its sample or group; `turns`: last of its group's lower
  /// levels.
  Cycle tags_read(bool is_last, bool turns) {
    Cycle at = ahead_.ready(split_);
    if (has_lanes_ && has_levels_) return tags_read_of_round(is_last, turns, at);
    if (has_lanes_) {
      at = std::max(at, tag_read_);
      if (is_last) ahead_.leave(at);
      tag_read_ = std::max({at + 1, looked_up_, swept_});
      return tag_read_;
    }
    if (!has_levels_) {
      at = std::max({at, looked_up_, swept_});
      ahead_.leave(at);
      return at;
    }
    at = std::max(at, on_level_);
    if (is_last) ahead_.leave(at);
    on_level_ = std::max(at + 1, tag_read_);
    tag_read_ = std::max({on_level_ + 1, looked_up_, swept_});
    return tag_read_;
  }

  Cycle tags_read_of_round(bool is_last, bool turns, Cycle at) {
    if (is_next_round_) {
      at = std::max(at, on_level_);
      on_level_ = std::max(at + 1, agreed_);
      agreed_ = std::max(on_level_ + 1, passed_);
      round_left_ = at;
    }
    is_next_round_ = is_last || turns;
    if (is_last) ahead_.leave(round_left_);
    passed_ = std::max({agreed_ + 1, tag_read_});
    tag_read_ = std::max({passed_ + 1, looked_up_, swept_});
    return tag_read_;
  }

  /// A sample on one level, or agreeing samples, through cache and filter.
  template <class Ask>
  void pass(std::span<const TextureLookup> lookups, Ask&& ask) {
    const bool is_combined = lookups.back().samples != 0;
    const Cycle tag_read = tags_read(!lookups.back().continues, lookups.back().turns);
    Cycle t = tag_read + 1, next = t, answered = 0;
    for (const TextureLookup& lookup : lookups) {
      if (lookup.is_miss) {
        t = std::max({next, request_room_, requests_.room(), free_place(lines_[lookup.line])});
        if (!has_banks_) t = std::max(t, waiting_.room());  // requests as it leaves
        const LineTimes times = ask(t + 1, lookup.address, lookup.beats);
        request_room_ = times.asked;
        requests_.leave(times.answered);
        answered = times.answered + 1;
        next = t + 1;
      }
    }
    for (const TextureLookup& lookup : lookups) lines_[lookup.line] = count_ >> kGroup;
    looked_up_ = std::max(t, waiting_.room());
    const Cycle h = std::max({waiting_.ready(looked_up_), stages_[0], answered});
    waiting_.leave(h);
    read_[count_ % read_.size()] = h;
    ++count_;
    Cycle at = h;
    for (std::size_t i = 0; i < filter_stages_; ++i) {
      at = std::max(at + 1, i + 1 < filter_stages_ ? stages_[i + 1] : is_combined ? combined_ : 0);
      stages_[i] = at;
    }
    if (is_combined) combined_ = std::max({at + 1, gone_ + 1, left_});
  }

  /// When no sample that may have been found in a line's place is still in the queue, the last of them in `group`: all
  /// up to the end of the youngest group that the tags cannot tell from it.
  [[nodiscard]] Cycle free_place(std::uint64_t group) const {
    const std::uint64_t now = count_ >> kGroup;
    const std::uint64_t last = now - ((now - group) & (kNumbers - 1));
    const std::uint64_t end = std::min((last + 1) << kGroup, count_);  // after the last sample of the group
    if (last > now || end == 0 || count_ - (end - 1) > read_.size()) return 0;
    return read_[(end - 1) % read_.size()] + 1;
  }

  bool has_banks_, has_levels_, has_lanes_;
  std::size_t filter_stages_;  ///< between data RAM and e
  Station inside_, ahead_, waiting_, requests_;
  Cycle sweep_, swept_;                             ///< duration of a sweep of the tags; its end
  Cycle request_room_;                              ///< when the next request may leave the tags
  Cycle split_ = 0, looked_up_ = 0, combined_ = 0;  ///< times of the last sample
  Cycle divided_ = 0;                               ///< time of the last sample with a colour and no texture
  Cycle on_level_ = 0, tag_read_ = 0;               ///< times of the last pass, with levels
  Cycle round_left_ = 0, agreed_ = 0, passed_ = 0;  ///< f and c of the last round, p of the last pass
  bool is_next_round_ = true;                       ///< the next pass is the first of a round
  std::array<Cycle, 4> stages_{};     ///< when the last sample left the data RAM, and each stage of a linear filter
  Cycle gone_ = 0, left_ = 0;         ///< times of the last stamp
  std::uint64_t count_ = 0;           ///< samples
  std::vector<std::uint64_t> lines_;  ///< by a line's place: group of the last sample that was found there
  std::vector<Cycle> read_;           ///< h of the last samples
};

}  // namespace halfplane
