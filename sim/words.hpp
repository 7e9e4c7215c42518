// Lists of words in a text: values of options, of TOML files, rows of figures.
#pragma once

#include <cstddef>
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

}  // namespace halfplane
