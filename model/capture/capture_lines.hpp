// A capture whose first lines are not those of whoever gave the rest, such as the head that the C interface puts before lines
// of its caller's.
#pragma once

#include <cstddef>
#include <string_view>

#include "../scene.hpp"

namespace halfplane {

/// read_capture() of a text whose first `head` lines messages do not count.
[[nodiscard]] Scene read_capture_lines(std::string_view text, std::string_view file_name, std::size_t head);

}  // namespace halfplane
