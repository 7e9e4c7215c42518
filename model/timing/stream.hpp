// Stream: a valid/ready hand-over between two stages. An item moves in the first cycle in which it is offered, the
// other side is ready, and no stall holds the stream.
#pragma once

#include <algorithm>

#include "stalls.hpp"

namespace halfplane {

/// Use of one stream, in cycles.
struct StreamUse {
  std::uint64_t busy = 0;     ///< moved an item
  std::uint64_t stalled = 0;  ///< had an item that was not taken
  std::uint64_t starved = 0;  ///< had no item
};

class Stream {
 public:
  /// `streams`: the stalls that hold it back, a bit each.
  Stream(const Stalls& stalls, unsigned streams) : stalls_(stalls), streams_(streams) {}

  /// Moves the next item, on offer from `offered` on, to a receiver that can take it from `room` on; the stalls of
  /// `others`, a bit each, hold it back as well. Returns the cycle.
  Cycle transfer(Cycle offered, Cycle room, unsigned others = 0) {
    const Cycle moved = stalls_.next_free(streams_ | others, std::max(offered, room));
    count(offered, moved);
    return moved;
  }
  /// The same where nothing stalls.
  Cycle move(Cycle offered, Cycle room) {
    const Cycle moved = std::max(offered, room);
    count(offered, moved);
    return moved;
  }
  /// Counts an item that moved together with an item of another stream.
  void count(Cycle offered, Cycle moved) {
    ++items_;
    waited_ += moved - offered;
  }

  /// Counts `items` that have waited that many cycles in all.
  void count_run(std::uint64_t items, std::uint64_t waited) {
    items_ += items;
    waited_ += waited;
  }

  [[nodiscard]] unsigned streams() const { return streams_; }
  [[nodiscard]] StreamUse use(Cycle cycles) const { return {items_, waited_, cycles - items_ - waited_}; }

 private:
  Stalls stalls_;
  unsigned streams_;
  std::uint64_t items_ = 0, waited_ = 0;
};

}  // namespace halfplane
