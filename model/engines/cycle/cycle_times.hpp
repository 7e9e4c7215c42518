// The times of a frame's steps (steps.hpp): the half of the cycle model that knows no codes. Tags and tile directory are
// here, because they decide the transfers between chip and memory and no bit depends on them.
#pragma once

#include <memory>
#include <vector>

#include "../../timing/memory.hpp"
#include "../../timing/stream.hpp"
#include "cycle_model.hpp"
#include "step_queue.hpp"

namespace halfplane {

class CycleTimes : public StepRunner {
 public:
  virtual ~CycleTimes() = default;
  /// As CycleModel::begin().
  virtual void begin(int width, int height, Cycle cycle) = 0;
  /// Of tiles or blocks: those that the caches count.
  [[nodiscard]] virtual const CounterPacket& counters() const = 0;
  [[nodiscard]] virtual TimingTotals totals() const = 0;
  [[nodiscard]] virtual const Stream& stream(Arrow boundary) const = 0;
  [[nodiscard]] virtual std::vector<float>& cost() = 0;
};

/// `memory` must outlive it.
[[nodiscard]] std::unique_ptr<CycleTimes> make_cycle_times(const Config& config, MemoryTiming& memory,
                                                           const CycleOptions& options);

}  // namespace halfplane
