// Queue: an optional FIFO before a stage.
#pragma once

#include <optional>

#include "station.hpp"
#include "stream.hpp"

namespace halfplane {

/// When an item left its sender, and when its receiver took it: the same without a queue between them.
struct Passage {
  Cycle left, taken;
};

class Queue {
 public:
  /// `items` that it holds; 0: there is none. An item is on offer a cycle after it entered.
  explicit Queue(int items) {
    if (items > 0) place_.emplace(items, 1, 1);
  }

  /// The same where take(cycle), given when the item can be taken at the earliest, says when it is. `next`: behind the
  /// last one that was taken. Returns when the item leaves its sender.
  template <class Take>
  Cycle pass(Cycle offered, Cycle next, Take&& take) {
    if (!place_) return take(std::max(offered, next));
    const Cycle entered = std::max(offered, place_->room());
    place_->leave(take(std::max(place_->ready(entered), next)));
    return entered;
  }

  /// The next item, on offer from `offered` on, through the queue and over `stream` to somebody with room from `room` on.
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
  Cycle next_ = 0;  ///< behind the last item
};

}  // namespace halfplane
