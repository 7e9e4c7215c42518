// Lists of words in a text, numbers as digits, words for a shell.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace halfplane {

/// The parts of `text` between separators, including empty ones.
[[nodiscard]] inline std::vector<std::string> split(std::string_view text, char separator) {
  std::vector<std::string> parts;
  for (;;) {
    const std::size_t end = text.find(separator);
    parts.emplace_back(text.substr(0, end));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

/// The same without empty ones.
[[nodiscard]] inline std::vector<std::string> words_of(std::string_view text, char separator) {
  std::vector<std::string> words = split(text, separator);
  std::erase(words, "");
  return words;
}

/// The lowest `bits` bits of `value` in hexadecimal digits, as many as the bits need.
[[nodiscard]] inline std::string hex_digits(std::uint64_t value, int bits) {
  if (bits < 64) value &= (std::uint64_t{1} << bits) - 1;
  std::string digits;
  for (int digit = (bits + 3) / 4 - 1; digit >= 0; --digit) digits += "0123456789abcdef"[value >> 4 * digit & 15];
  return digits;
}

/// Between single quotes, for a POSIX shell.
[[nodiscard]] inline std::string in_single_quotes(std::string_view text) {
  std::string word = "'";
  for (const char c : text) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return word + "'";
}

}  // namespace halfplane
