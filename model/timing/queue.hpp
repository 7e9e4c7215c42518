// Queue: an optional FIFO before a stage.
#pragma once

#include <optional>

#include "station.hpp"
#include "stream.hpp"

namespace halfplane {

/// The cycle in which an item left its sender, and in which its receiver took it: equal without a queue.
struct Passage {
  Cycle left, taken;
};

class Queue {
 public:
  /// `items`: its capacity; 0: no queue.
  explicit Queue(int items) {
    if (items > 0) place_.emplace(items, 1, 1);
  }

  /// The same with take(cycle), which gets the earliest cycle and returns the cycle in which the item is taken. `next`:
  /// after the last take. Returns when the item leaves its sender.
  template <class Take>
  Cycle pass(Cycle offered, Cycle next, Take&& take) {
    if (!place_) return take(std::max(offered, next));
    const Cycle entered = std::max(offered, place_->room());
    place_->leave(take(std::max(place_->ready(entered), next)));
    return entered;
  }

  /// Passes the next item, on offer from `offered` on, through the queue and over `stream` to a receiver with room from
  /// `room` on.
  Passage pass(Stream& stream, Cycle offered, Cycle room) {
    if (!place_) {
      const Cycle moved = stream.transfer(offered, room);
      return {moved, moved};
    }
    const Cycle entered = std::max(offered, place_->room());
    const Cycle taken = stream.transfer(std::max(place_->ready(entered), next_), room);
    place_->leave(taken);
    next_ = taken + 1;
    return {entered, taken};
  }

 private:
  std::optional<Station> place_;
  Cycle next_ = 0;  ///< after the last item
};

}  // namespace halfplane
