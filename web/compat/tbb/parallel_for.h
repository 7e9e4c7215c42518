// Stands in for oneTBB: one thread.
#pragma once

#include <cstddef>

namespace tbb {

template <class T>
struct blocked_range {
  blocked_range(T first, T last, std::size_t) : first_(first), last_(last) {}
  [[nodiscard]] T begin() const { return first_; }
  [[nodiscard]] T end() const { return last_; }

 private:
  T first_, last_;
};

struct simple_partitioner {};

struct task_arena {
  explicit task_arena(int) {}
  template <class Work>
  void execute(Work&& work) {
    work();
  }
};

namespace info {
inline int default_concurrency() { return 1; }
}  // namespace info

template <class Range, class Body>
void parallel_for(const Range& range, const Body& body, simple_partitioner) {
  body(range);
}

}  // namespace tbb
