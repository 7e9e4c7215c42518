// Batches of steps on their way from the bits to the times: run at once, or by another thread while the next ones are
// filled. Either way the times see the same steps in the same order.
#pragma once

#include <array>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>

#include "steps.hpp"

namespace halfplane {

/// Takes the steps of a frame.
class StepRunner {
 public:
  virtual void run(const Steps& steps) = 0;

 protected:
  ~StepRunner() = default;
};

class StepQueue {
 public:
  /// `runner` must outlive this.
  explicit StepQueue(StepRunner& runner) : runner_(runner) {}
  StepQueue(const StepQueue&) = delete;
  StepQueue& operator=(const StepQueue&) = delete;
  ~StepQueue() { stop(true); }

  /// With more than one thread batches run on a thread of their own, until complete().
  void begin(int threads);
  /// The batch that is being filled.
  [[nodiscard]] Steps& filling() { return ring_[filled_ % ring_.size()]; }
  /// Hands it over. Throws what the runner threw.
  void hand_over();
  /// Likewise, and waits until all have run. Nothing runs after it.
  void complete();

 private:
  void work();
  void stop(bool drops_rest);

  StepRunner& runner_;
  std::array<Steps, 4> ring_;  ///< one is filled, one runs
  std::thread thread_;
  std::mutex mutex_;  ///< of all that follows; filled_ is written by the filling thread alone
  std::condition_variable changed_;
  std::size_t filled_ = 0, run_ = 0;  ///< batches
  bool ends_ = false, drops_rest_ = false;
  std::exception_ptr error_;
};

}  // namespace halfplane
