// What the code uses of C++20 and libc++ 14, Emscripten's in Debian 12, lacks: algorithms of std::ranges, std::bit_cast,
// floating-point std::from_chars and std::to_chars, std::jthread. In front of every file; only what is used.
#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <iterator>
#include <limits>
#include <memory>
#include <string>
#include <thread>
#include <type_traits>
#include <utility>

namespace std {
namespace ranges {
namespace web {

// A range, then what std:: takes after its two iterators.
#define HALFPLANE_WEB_OF_RANGE(NAME)                                                                           \
  inline constexpr auto NAME = []<class Range, class... Rest>(                                                 \
      Range && range, Rest && ... rest) requires(!std::input_or_output_iterator<std::remove_cvref_t<Range>>) { \
    return std::NAME(std::begin(range), std::end(range), std::forward<Rest>(rest)...);                         \
  };
HALFPLANE_WEB_OF_RANGE(copy)
HALFPLANE_WEB_OF_RANGE(count)
HALFPLANE_WEB_OF_RANGE(fill)
HALFPLANE_WEB_OF_RANGE(lower_bound)
HALFPLANE_WEB_OF_RANGE(move)
HALFPLANE_WEB_OF_RANGE(replace)
#undef HALFPLANE_WEB_OF_RANGE

// A range, a predicate, a projection.
#define HALFPLANE_WEB_IF(NAME)                                                                                    \
  inline constexpr auto NAME = []<class Range, class Predicate, class Projection = std::identity, class... Rest>( \
      Range && range, Predicate is, Projection of = {}) {                                                         \
    return std::NAME(std::begin(range), std::end(range), [&](auto&& value) -> bool {                              \
      return std::invoke(is, std::invoke(of, std::forward<decltype(value)>(value)));                              \
    });                                                                                                           \
  };
HALFPLANE_WEB_IF(all_of)
HALFPLANE_WEB_IF(any_of)
HALFPLANE_WEB_IF(count_if)
HALFPLANE_WEB_IF(find_if)
HALFPLANE_WEB_IF(none_of)
#undef HALFPLANE_WEB_IF

// A range, an order, a projection.
#define HALFPLANE_WEB_ORDERED(NAME)                                                                          \
  inline constexpr auto NAME = []<class Range, class Order = std::less<>, class Projection = std::identity>( \
      Range && range, Order order = {}, Projection of = {}) {                                                \
    return std::NAME(std::begin(range), std::end(range), [&](auto&& a, auto&& b) -> bool {                   \
      return std::invoke(order, std::invoke(of, a), std::invoke(of, b));                                     \
    });                                                                                                      \
  };
HALFPLANE_WEB_ORDERED(max_element)
HALFPLANE_WEB_ORDERED(min_element)
HALFPLANE_WEB_ORDERED(sort)
HALFPLANE_WEB_ORDERED(stable_sort)
#undef HALFPLANE_WEB_ORDERED

inline constexpr auto equal = [](auto&& a, auto&& b) {
  return std::equal(std::begin(a), std::end(a), std::begin(b), std::end(b));
};

inline constexpr auto find = []<class Range, class Value, class Projection = std::identity>(
    Range && range, const Value& wanted, Projection of = {}) {
  return std::find_if(std::begin(range), std::end(range),
                      [&](auto&& value) -> bool { return std::invoke(of, value) == wanted; });
};

inline constexpr auto max = [](const auto& range) { return *max_element(range); };

template <class T>
struct Extremes {
  T min, max;
};
inline constexpr auto minmax = []<class Range, class Order = std::less<>, class Projection = std::identity>(
    const Range& range, Order order = {}, Projection of = {}) {
  using Value = std::remove_cvref_t<decltype(*std::begin(range))>;
  return Extremes<Value>{*min_element(range, order, of), *max_element(range, order, of)};
};

inline constexpr auto nth_element = [](auto&& range, auto nth) {
  std::nth_element(std::begin(range), nth, std::end(range));
};

inline constexpr auto replace_if = [](auto&& range, auto is, const auto& with) {
  std::replace_if(std::begin(range), std::end(range), is, with);
};

inline constexpr auto transform = []<class Range, class Second, class... Rest>(Range&& range, Second&& second,
                                                                               Rest&&... rest) {
  if constexpr (sizeof...(rest) == 2)
    return std::transform(std::begin(range), std::end(range), std::begin(second), std::forward<Rest>(rest)...);
  else
    return std::transform(std::begin(range), std::end(range), second, std::forward<Rest>(rest)...);
};

/// The elements that are left over.
template <class Iterator>
struct Rest {
  Iterator first, last;
  [[nodiscard]] Iterator begin() const { return first; }
  [[nodiscard]] Iterator end() const { return last; }
  [[nodiscard]] bool empty() const { return first == last; }
};
inline constexpr auto unique = [](auto&& range) {
  return Rest<decltype(std::begin(range))>{std::unique(std::begin(range), std::end(range)), std::end(range)};
};

}  // namespace web
using namespace web;
}  // namespace ranges

template <class To, class From>
requires(sizeof(To) == sizeof(From)) [[nodiscard]] constexpr To bit_cast(const From& from) noexcept {
  return __builtin_bit_cast(To, from);
}

template <class T>
[[nodiscard]] auto make_unique_for_overwrite(size_t count) {
  return unique_ptr<T>(new remove_extent_t<T>[count]);
}

/// Decimal and hexadecimal as in the standard: no leading '+' or blank, no 0x. musl's strtod rounds correctly.
inline from_chars_result from_chars(const char* first, const char* last, double& value,
                                    chars_format format = chars_format::general) {
  const char* const digits = first != last && *first == '-' ? first + 1 : first;
  const bool is_hex = format == chars_format::hex;
  const auto begins_number = [&](char c) {
    return (c >= '0' && c <= '9') || c == '.' || c == 'i' || c == 'I' || c == 'n' || c == 'N' ||
           (is_hex && ((c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F')));
  };
  if (digits == last || !begins_number(*digits)) return {first, errc::invalid_argument};
  const auto is_x = [&](const char* at) { return last - at > 1 && at[0] == '0' && (at[1] == 'x' || at[1] == 'X'); };
  string text(first, digits);
  if (is_hex) text += "0x";
  // "0x1" is the number 0, then an x: without 0x in front strtod must not see the rest.
  text.append(digits, is_x(digits) ? digits + 1 : last);
  char* end = nullptr;
  const double read = strtod(text.c_str(), &end);
  const ptrdiff_t length = end - text.c_str() - (is_hex ? 2 : 0);
  if (length <= digits - first) return {first, errc::invalid_argument};
  const char* const stop = first + length;
  if (isinf(read) && begins_number(*digits) && *digits != 'i' && *digits != 'I')
    return {stop, errc::result_out_of_range};
  if (read == 0)  // of digits that are not all zero: below the smallest number
    for (const char* c = digits; c != stop && *c != (is_hex ? 'p' : 'e') && *c != (is_hex ? 'P' : 'E'); ++c)
      if (*c != '0' && *c != '.') return {stop, errc::result_out_of_range};
  value = read;
  return {stop, errc{}};
}

/// The shortest decimal that is read back as the same number, of these the nearest; fixed unless scientific is shorter.
to_chars_result to_chars(char* first, char* last, double value);

class jthread {
 public:
  jthread() = default;
  template <class Work>
  explicit jthread(Work&& work) : thread_(std::forward<Work>(work)) {}
  jthread(jthread&&) = default;
  ~jthread() {
    if (thread_.joinable()) thread_.join();
  }

 private:
  thread thread_;
};

}  // namespace std
