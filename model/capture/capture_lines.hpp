// A capture with a prefix of generated lines, such as the head that the C interface adds to its caller's lines.
#pragma once

#include <cstddef>
#include <string_view>

#include "../scene.hpp"

namespace halfplane {

/// read_capture() of a text; messages do not count its first `head` lines.
[[nodiscard]] Scene read_capture_lines(std::string_view text, std::string_view file_name, std::size_t head);

}  // namespace halfplane
