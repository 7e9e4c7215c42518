// Memory in cache lines of its own. Where two threads work, small blocks next to each other on the heap share lines, which
// then go back and forth.
#pragma once

#include <cstddef>
#include <new>
#include <vector>

namespace halfplane {

/// An allocator of whole pairs of lines, as they are prefetched.
template <class T>
struct OwnLines {
  using value_type = T;
  static constexpr std::size_t kBytes = 128;
  OwnLines() = default;
  template <class U>
  explicit(false) OwnLines(const OwnLines<U>& /*other*/) {}
  [[nodiscard]] T* allocate(std::size_t items) {
    return static_cast<T*>(::operator new((items * sizeof(T) + kBytes - 1) & -kBytes, std::align_val_t(kBytes)));
  }
  void deallocate(T* items, std::size_t /*number*/) { ::operator delete(items, std::align_val_t(kBytes)); }
  bool operator==(const OwnLines&) const = default;
};

template <class T>
using OwnLinesVector = std::vector<T, OwnLines<T>>;

}  // namespace halfplane
