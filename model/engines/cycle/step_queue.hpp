// Batches of steps on their way from the bits to the times: run at once, or by another thread while the next ones are
// filled. Either way the times see the same steps in the same order.
#pragma once

#include <array>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <functional>
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
  /// Starts a thread with that function. Throws std::system_error when none is to be had.
  using Launch = std::function<std::thread(std::function<void()>)>;
  /// `runner` must outlive this.
  explicit StepQueue(
      StepRunner& runner, Launch launch = [](std::function<void()> work) { return std::thread(std::move(work)); })
      : runner_(runner), launch_(std::move(launch)) {}
  StepQueue(const StepQueue&) = delete;
  StepQueue& operator=(const StepQueue&) = delete;
  ~StepQueue() { stop(true); }

  /// With more than one thread batches run on a thread of their own; where none is to be had, on this. The thread stays
  /// from frame to frame.
  void begin(int threads);
  /// The batch that is being filled.
  [[nodiscard]] Steps& filling() { return *filling_; }
  /// Hands it over. Throws what the runner threw.
  void hand_over();
  /// Likewise, and waits until all have run.
  void complete();

 private:
  void work();
  void stop(bool drops_rest);
  void rethrow() const;
  void notify();
  template <class Ready>
  void wait_until(Ready&& ready);

  StepRunner& runner_;
  Launch launch_;
  std::array<Steps, 16> ring_;     ///< one is filled, one runs, the rest wait: with fewer the faster thread sleeps more
  Steps* filling_ = ring_.data();  ///< the one that is filled: of batch filled_
  std::thread thread_;
  std::atomic<std::size_t> filled_ = 0, run_ = 0;  ///< batches; each is written by one of the threads
  std::atomic<bool> ends_ = false, drops_rest_ = false;
  std::atomic<bool> has_failed_ = false;
  std::exception_ptr error_;  ///< then
  std::mutex mutex_;          ///< of a thread that waits for one of these to change
  std::condition_variable changed_;
};

}  // namespace halfplane
