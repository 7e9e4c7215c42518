// The chart of `halfplane render --frames`: one HTML page that needs nothing beside it.
#pragma once

#include <string>
#include <string_view>

namespace halfplane {

/// report.html with the chart library and `data` (the JSON result) inside. Throws std::runtime_error when this program was
/// built without the library.
[[nodiscard]] std::string frames_report(std::string_view data);

}  // namespace halfplane
