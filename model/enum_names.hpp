// The names of an enumeration's values, as the source has them: words that users type and read are said once.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>
#include <utility>

namespace halfplane {

/// Empty where the enumeration has no such value: compilers print a value without a name as a cast, "(E)7".
template <auto value>
consteval std::string_view enumerator_name() {
  const std::string_view function = __PRETTY_FUNCTION__;
  const std::size_t begin = function.find("value = ") + 8;
  const std::string_view printed = function.substr(begin, function.find_first_of(";]", begin) - begin);
  return printed.starts_with('(') ? std::string_view() : printed.substr(printed.rfind(':') + 1);
}

/// A value and its name.
template <class Enum>
struct Enumerator {
  Enum value;
  std::string_view name;
};

/// The values of an enumeration from 0 to 15, in that order.
template <class Enum>
inline constexpr auto kEnumerators = []<std::size_t... n>(std::index_sequence<n...>) {
  std::array<Enumerator<Enum>, (... + (enumerator_name<static_cast<Enum>(n)>().empty() ? 0 : 1))> all{};
  std::size_t next = 0;
  for (const Enumerator<Enum>& one :
       {Enumerator<Enum>{static_cast<Enum>(n), enumerator_name<static_cast<Enum>(n)>()}...})
    if (!one.name.empty()) all[next++] = one;
  return all;
}
(std::make_index_sequence<16>{});

/// The number of values of an enumeration without gaps.
template <class Enum, int n = 0>
consteval std::size_t enumerators() {
  if constexpr (enumerator_name<static_cast<Enum>(n)>().empty())
    return n;
  else
    return enumerators<Enum, n + 1>();
}

/// The names of an enumeration without gaps, by value.
template <class Enum>
inline constexpr auto kNamesOf = []<std::size_t... n>(std::index_sequence<n...>) {
  return std::array{enumerator_name<static_cast<Enum>(n)>()...};
}
(std::make_index_sequence<enumerators<Enum>()>{});

}  // namespace halfplane
