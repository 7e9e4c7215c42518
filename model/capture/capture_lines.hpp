// A capture with a prefix of generated lines, such as the head that the C interface puts before the lines of its caller.
#pragma once

#include <cstddef>
#include <string_view>

#include "../scene.hpp"

namespace halfplane {

/// read_capture() of a text whose first `head` lines messages do not count.
[[nodiscard]] Scene read_capture_lines(std::string_view text, std::string_view file_name, std::size_t head);

}  // namespace halfplane
