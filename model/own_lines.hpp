// Memory in cache lines of its own. Small blocks of two threads that are neighbours on the heap share cache lines, which then
// move between the cores.
#pragma once

#include <cstddef>
#include <new>
#include <vector>

namespace halfplane {

inline constexpr std::size_t kOwnLineBytes = 128;  ///< two lines: processors prefetch lines in pairs

/// Allocates whole pairs of lines.
template <class T>
struct OwnLines {
  static_assert(alignof(T) <= kOwnLineBytes);
  using value_type = T;
  OwnLines() = default;
  template <class U>
  explicit(false) OwnLines(const OwnLines<U>& /*other*/) {}
  [[nodiscard]] T* allocate(std::size_t items) {
    const std::size_t bytes = (items * sizeof(T) + kOwnLineBytes - 1) / kOwnLineBytes * kOwnLineBytes;
    return static_cast<T*>(::operator new(bytes, std::align_val_t(kOwnLineBytes)));
  }
  void deallocate(T* items, std::size_t /*number*/) { ::operator delete(items, std::align_val_t(kOwnLineBytes)); }
  bool operator==(const OwnLines&) const = default;
};

template <class T>
using OwnLinesVector = std::vector<T, OwnLines<T>>;

}  // namespace halfplane
