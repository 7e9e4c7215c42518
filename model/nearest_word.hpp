// Nearest known word to a misspelt one, for error messages.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace halfplane {

/// The word of `words` with the fewest edits from `word`, the first of equals; empty when none is near: one edit for
/// three letters, two for up to six, then a third of the letters.
[[nodiscard]] std::string_view nearest_word(std::string_view word, std::span<const std::string_view> words);

/// " did you mean teapot?", or nothing: follows the ';' of an error's one line.
[[nodiscard]] std::string did_you_mean(std::string_view word, std::span<const std::string_view> words);

}  // namespace halfplane
