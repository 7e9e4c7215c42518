#include "step_queue.hpp"

#include <system_error>

namespace halfplane {

void StepQueue::begin(int threads) {
  if (threads <= 1) return stop(false);
  if (thread_.joinable()) return;
  ends_ = false;
  try {
    thread_ = launch_([this] { work(); });
  } catch (const std::system_error&) {  // none is to be had, as in WebAssembly: batches run on this one
  }
}

void StepQueue::hand_over() {
  if (!thread_.joinable()) {
    runner_.run(filling());
    filling().clear();
    return;
  }
  filling_ = &ring_[(filled_ + 1) % ring_.size()];
  ++filled_;
  notify();
  wait_until([this] { return filled_ - run_ < ring_.size(); });  // the next place of the ring is free
  rethrow();
  filling().clear();
}

void StepQueue::complete() {
  hand_over();
  wait_until([this] { return run_ == filled_; });
  rethrow();
}

void StepQueue::work() {
  for (;;) {
    wait_until([this] { return filled_ != run_ || ends_; });
    if (filled_ == run_ || drops_rest_) return;
    try {
      if (!has_failed_) runner_.run(ring_[run_ % ring_.size()]);
    } catch (...) {
      error_ = std::current_exception();
      has_failed_ = true;
    }
    ++run_;
    notify();
  }
}

void StepQueue::stop(bool drops_rest) {
  if (!thread_.joinable()) return;
  drops_rest_ = drops_rest;
  ends_ = true;
  notify();
  thread_.join();
}

void StepQueue::rethrow() const {
  if (has_failed_) std::rethrow_exception(error_);
}

void StepQueue::notify() {
  { const std::lock_guard lock(mutex_); }  // the other thread is not between its last look and its sleep
  changed_.notify_one();
}

template <class Ready>
void StepQueue::wait_until(Ready&& ready) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, ready);
}

}  // namespace halfplane
