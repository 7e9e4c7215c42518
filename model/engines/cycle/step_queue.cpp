#include "step_queue.hpp"

#include <system_error>

namespace halfplane {

void StepQueue::begin(int threads) {
  if (threads <= 1 || thread_.joinable()) return;
  ends_ = false;
  try {
    thread_ = std::thread([this] { work(); });
  } catch (const std::system_error&) {  // none is to be had, as in WebAssembly: batches run on this one
  }
}

void StepQueue::hand_over() {
  if (!thread_.joinable()) {
    runner_.run(filling());
    filling().clear();
    return;
  }
  std::unique_lock lock(mutex_);
  ++filled_;
  changed_.notify_all();
  changed_.wait(lock, [this] { return filled_ - run_ < ring_.size(); });  // the next place of the ring is free
  if (error_) std::rethrow_exception(error_);
  filling().clear();
}

void StepQueue::complete() {
  hand_over();
  stop(false);
  if (error_) std::rethrow_exception(error_);
}

void StepQueue::work() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return filled_ != run_ || ends_; });
    if (filled_ == run_ || drops_rest_) return;
    const Steps& steps = ring_[run_ % ring_.size()];
    const bool runs = !error_;
    lock.unlock();
    std::exception_ptr error;
    try {
      if (runs) runner_.run(steps);
    } catch (...) {
      error = std::current_exception();
    }
    lock.lock();
    if (error) error_ = error;
    ++run_;
    changed_.notify_all();
  }
}

void StepQueue::stop(bool drops_rest) {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
    drops_rest_ = drops_rest;
  }
  changed_.notify_all();
  thread_.join();
}

}  // namespace halfplane
