// UTF-8, code point by code point: names of files and scenes are bytes of others.
#pragma once

#include <cstddef>
#include <string_view>

namespace halfplane {

/// Replacement for bytes that are not UTF-8.
inline constexpr char32_t kNoCodePoint = 0xfffd;

/// The code point that begins at text[at], and moves `at` past it. A byte that begins no code point is one
/// kNoCodePoint, and so is a truncated or overlong sequence or a surrogate.
[[nodiscard]] char32_t next_code_point(std::string_view text, std::size_t& at);

/// The length of `text` without its last code point.
[[nodiscard]] std::size_t without_last_code_point(std::string_view text);

}  // namespace halfplane
