// Station: a place in a pipeline that holds a few items in order. A register, a unit that works on one item at a time, a
// row of registers with back-pressure, a skid buffer, a pool of slots: one rule for all.
//
//   item n may enter when item n - capacity has left: in the same cycle (turnaround 0, ready passes through) or that
//   many
//   cycles later (turnaround 1: ready is a register)
//   it may leave `latency` cycles after it entered
//
// So time is a max-plus recurrence over the items; there is no clock loop.
#pragma once

#include <array>

#include "../own_lines.hpp"
#include "stalls.hpp"

namespace halfplane {

class Station {
 public:
  /// In cycles, except `capacity`: items, at least 1.
  Station(int capacity, int latency, int turnaround)
      : latency_(static_cast<Cycle>(latency)),
        turnaround_(static_cast<Cycle>(turnaround)),
        free_at_(static_cast<std::size_t>(capacity)),
        next_(free_at_.data()),
        end_(next_ + capacity) {}
  Station(Station&&) = default;  // the places stay where they are
  Station& operator=(Station&&) = default;

  /// The first cycle in which the next item can enter, as far as earlier items decide.
  [[nodiscard]] Cycle room() const { return *next_; }
  /// The first cycle in which an item that entered in `entered` can leave.
  [[nodiscard]] Cycle ready(Cycle entered) const { return entered + latency_; }
  /// The next item leaves. Call once for every item, in order, before room() for the item `capacity` after it.
  void leave(Cycle cycle) {
    *next_ = cycle + turnaround_;
    if (++next_ == end_) next_ = free_at_.data();
  }
  /// The cycle from which on all items have left, turnaround included.
  [[nodiscard]] Cycle empty() const { return (next_ == free_at_.data() ? end_ : next_)[-1]; }

 private:
  Cycle latency_, turnaround_;
  OwnLinesVector<Cycle> free_at_;  ///< ring: when the place of item n - capacity is free
  Cycle *next_, *end_;             ///< in it
};

/// A Station whose capacity, latency and turnaround are constants of the compiler.
template <std::size_t kCapacity, Cycle kLatency, Cycle kTurnaround>
class FixedStation {
 public:
  [[nodiscard]] Cycle room() const { return free_at_[next()]; }
  [[nodiscard]] static constexpr Cycle ready(Cycle entered) { return entered + kLatency; }
  void leave(Cycle cycle) {
    free_at_[next()] = cycle + kTurnaround;
    if (kCapacity != 1) next_ = next_ + 1 == kCapacity ? 0 : next_ + 1;
  }

 private:
  [[nodiscard]] std::size_t next() const { return kCapacity == 1 ? 0 : next_; }

  std::array<Cycle, kCapacity> free_at_{};
  std::size_t next_ = 0;
};

}  // namespace halfplane
