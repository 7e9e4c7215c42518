// The page of `halfplane bench --area`: one HTML page that needs nothing beside it.
#pragma once

#include <string>
#include <string_view>

namespace halfplane {

/// report.html with the chart library and `data` (JSON, in the form that the page's script reads) inside. Throws
/// std::runtime_error when this program was built without the library.
[[nodiscard]] std::string space_report(std::string_view data);

}  // namespace halfplane
