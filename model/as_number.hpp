// Numbers written as text: the whole text is one, or it is none.
#pragma once

#include <charconv>
#include <concepts>
#include <optional>
#include <string_view>
#include <system_error>

namespace halfplane {

/// The number that `text` is, whole numbers in `base`. None for anything else, also where blanks or letters follow, and
/// for a number that the type does not hold.
template <class Number>
[[nodiscard]] std::optional<Number> as_number(std::string_view text, int base = 10) {
  Number value{};
  const char* const last = text.data() + text.size();
  std::from_chars_result read{};
  if constexpr (std::integral<Number>)
    read = std::from_chars(text.data(), last, value, base);
  else
    read = std::from_chars(text.data(), last, value);
  return read.ec == std::errc() && read.ptr == last ? std::optional(value) : std::nullopt;
}

}  // namespace halfplane
