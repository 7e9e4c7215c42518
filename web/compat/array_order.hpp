// operator<=> of std::array, which libc++ 14 lacks: in front of the one file that sorts by structs with arrays.
#pragma once

#include <algorithm>
#include <array>
#include <compare>

namespace std {

template <class T, size_t n>
constexpr auto operator<=>(const array<T, n>& a, const array<T, n>& b) {
  for (size_t i = 0; i < n; ++i)
    if (const auto order = a[i] <=> b[i]; order != 0) return order;
  return decltype(a[0] <=> b[0])::equivalent;
}

}  // namespace std
