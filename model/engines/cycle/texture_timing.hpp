// The time of the texture unit: rtl_ref/stages/texture_unit.sv, texture_coordinates.sv, texture_cache.sv.
//
// Every wait is for an earlier stamp or sample, so the time of one is a maximum over those before it. Of stamp m and sample n:
//
//   s(n) = max(x(m) + 2, s(n-1) + 1, a(n-16) + 1)                  split
//   a(n) = max(s(n) + 10, t(n-1), tags swept)                      its tag is read
//   t(n) = max(a(n) + 1, h(n-in_flight) + 1), a miss also: the request before is taken, the line's place is free
//   h(n) = max(t(n) + 1, d(n-1)), a miss also: its last beat + 1   its texel is read
//   d(n) = max(h(n) + 1, e(n-1))                                   decoded; of a linear filter three such stages
//   e(n) = max(d(n) + 1, g(m-1) + 1, w(m-1))                       combined
//   g(m) = that of its last sample; without texture max(x(m) + 2, g(m-1) + 1, w(m-1))
//
// With a linear filter a sample asks for its lines one by one, and leaves the tags with the last of them or later. It
// is offered to W in g(m) + 1. A state is set when no sample is left in front of h: max(x(m) + 2, s + 1, t + 1).
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

/// The unit's memory port, and the memory behind it: a request goes out from a register, and beats are taken as they come.
class TexturePort {
 public:
  /// All of them must outlive this.
  TexturePort(MemoryTiming& memory, Stream& requests, Stream& answers)
      : memory_(memory), requests_(requests), answers_(answers) {}

  /// Beats of before a reset come up to `over`.
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
  /// rst_ni is high from `start` on; all that was asked for before it is over in `recovered` (recovered()).
  explicit TextureTiming(const TextureSettings& settings, Cycle start = 0, Cycle recovered = 0)
      : has_linear_(settings.has_linear),
        inside_(settings.queue, 0, 1),
        ahead_(kAhead, kClocks, 1),
        waiting_(settings.in_flight, 1, 1),
        requests_(settings.has_linear ? kRequests : settings.in_flight, 1, 1),
        sweep_(static_cast<Cycle>(settings.has_linear ? settings.lines / 4 : settings.lines)),
        swept_(start + sweep_),
        request_room_(std::max(start, recovered)),
        lines_(static_cast<std::size_t>(settings.lines)),
        read_(static_cast<std::size_t>(settings.in_flight)) {}

  /// When the first request after a reset may leave the tags: rst_ni was low up to `reset`, the last request of before was
  /// taken and answered up to `over`.
  [[nodiscard]] static Cycle recovered(Cycle reset, Cycle over) { return std::max(reset, over) + 2; }

  /// The first cycle in which X may let the next stamp go, which is here in the cycle behind that.
  [[nodiscard]] Cycle room() const { return inside_.room(); }
  /// When nothing is under way any more.
  [[nodiscard]] Cycle is_empty() const { return std::max(left_ + 1, swept_); }

  /// X let a stamp go in `x` that has no texture. Returns when it is on offer to W.
  Cycle pass(Cycle x) {
    gone_ = std::max({x + kDoor, gone_ + 1, left_});
    return gone_ + 1;
  }

  /// A stamp that sets a state; `drops`: and invalidates the cache.
  Cycle set(Cycle x, bool drops) {
    split_ = std::max({x + kDoor, split_ + 1, looked_up_ + 1});
    if (drops) {
      swept_ = split_ + 1 + sweep_;
      for (std::uint64_t& group : lines_) group = last_group();
    }
    return pass(x);
  }

  /// A stamp with a texture; `lookups`: of its samples, in order. ask(cycle, address, beats): a request, on offer from `cycle`
  /// on; returns LineTimes.
  template <class Ask>
  Cycle take(Cycle x, std::span<const TextureLookup> lookups, Ask&& ask) {
    for (std::size_t first = 0; first < lookups.size();) {
      std::size_t end = first + 1;
      while (!lookups[end - 1].ends) ++end;
      sample(x, lookups.subspan(first, end - first), ask);
      first = end;
    }
    gone_ = combined_;
    return gone_ + 1;
  }

  /// W took the stamp.
  void leave(Cycle w) {
    left_ = w;
    inside_.leave(w);
  }

 private:
  static constexpr int kAhead = 16, kClocks = 10,
                       kRequests = 16;  ///< samples between split and tags, and the least cycles; lines asked for
  static constexpr Cycle kDoor = 2;     ///< from X to the head of the queues
  static constexpr int kGroup = 3, kNumber = 7;  ///< a group is 8 samples; of its number the tags know 7 bits
  static constexpr std::uint64_t kNumbers = 1U << kNumber;

  [[nodiscard]] std::uint64_t last_group() const { return (count_ - 1) >> kGroup; }

  template <class Ask>
  void sample(Cycle x, std::span<const TextureLookup> lookups, Ask&& ask) {
    split_ = std::max({x + kDoor, split_ + 1, ahead_.room()});
    const Cycle tag_read = std::max({ahead_.ready(split_), looked_up_, swept_});
    ahead_.leave(tag_read);
    Cycle t = tag_read + 1, next = t, answered = 0;
    for (const TextureLookup& lookup : lookups) {
      if (lookup.is_miss) {
        t = std::max({next, request_room_, requests_.room(), free_place(lines_[lookup.line])});
        if (!has_linear_) t = std::max(t, waiting_.room());  // asks as it leaves
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
    const std::size_t stages = has_linear_ ? stages_.size() : 1;
    for (std::size_t i = 0; i < stages; ++i) {
      at = std::max(at + 1, i + 1 < stages ? stages_[i + 1] : combined_);
      stages_[i] = at;
    }
    combined_ = std::max({at + 1, gone_ + 1, left_});
  }

  /// When no sample waits any more that may have been found in a line's place, the last of them in `group`: all up to the end
  /// of the youngest group that the tags cannot tell from it.
  [[nodiscard]] Cycle free_place(std::uint64_t group) const {
    const std::uint64_t now = count_ >> kGroup;
    const std::uint64_t last = now - ((now - group) & (kNumbers - 1));
    const std::uint64_t end = std::min((last + 1) << kGroup, count_);  // behind the last of them
    if (last > now || end == 0 || count_ - (end - 1) > read_.size()) return 0;
    return read_[(end - 1) % read_.size()] + 1;
  }

  bool has_linear_;
  Station inside_, ahead_, waiting_, requests_;
  Cycle sweep_, swept_;                             ///< how long it takes to sweep the tags; when they have been
  Cycle request_room_;                              ///< when the next request may leave the tags
  Cycle split_ = 0, looked_up_ = 0, combined_ = 0;  ///< of the last sample
  std::array<Cycle, 3>
      stages_{};  ///< of the last sample, when it left the data RAM, and what a linear filter has behind it
  Cycle gone_ = 0, left_ = 0;         ///< of the last stamp
  std::uint64_t count_ = 0;           ///< samples
  std::vector<std::uint64_t> lines_;  ///< of each line's place, the group of the last sample that was found there
  std::vector<Cycle> read_;           ///< h of the last samples
};

}  // namespace halfplane
