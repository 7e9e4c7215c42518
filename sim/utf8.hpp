// UTF-8, code point by code point: names of files and scenes are bytes of others.
#pragma once

#include <cstddef>
#include <string_view>

namespace halfplane {

/// What stands for bytes that are no UTF-8.
inline constexpr char32_t kNoCodePoint = 0xfffd;

/// The code point that begins at text[at], and moves `at` behind it. A byte that begins none is one kNoCodePoint, and so
/// is a sequence that is cut, overlong or a surrogate.
[[nodiscard]] char32_t next_code_point(std::string_view text, std::size_t& at);

/// The length of `text` without its last code point.
[[nodiscard]] std::size_t without_last_code_point(std::string_view text);

}  // namespace halfplane
