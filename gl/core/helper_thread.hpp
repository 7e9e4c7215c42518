// A thread that works beside the program's own, one piece of work at a time.
#pragma once

#include <functional>
#include <semaphore>
#include <thread>

namespace halfplane::gl {

/// Used by one thread at a time. A process that ends by exit() waits for work that has been started.
class HelperThread {
 public:
  HelperThread() = default;
  ~HelperThread();
  HelperThread(const HelperThread&) = delete;
  HelperThread& operator=(const HelperThread&) = delete;

  /// Waits for the work before. `work` must not throw.
  void start(std::function<void()> work);
  void wait();

 private:
  void run();

  std::thread thread_;          ///< since the first start()
  std::function<void()> work_;  ///< empty: the thread ends
  std::binary_semaphore begun_{0}, done_{0};
  bool is_busy_ = false;
};

}  // namespace halfplane::gl
