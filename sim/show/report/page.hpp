// Self-contained HTML pages: a template that CMake split at the place of its data, and the data.
#pragma once

#include <string>
#include <string_view>

namespace halfplane {

/// Throws std::runtime_error when this program was built without the chart library.
void require_chart_library();

/// `head`, `data` (JSON, in the form that the page's script reads), `tail`. Throws as require_chart_library().
[[nodiscard]] std::string page_with_data(std::string_view head, std::string_view data, std::string_view tail);

/// The same for a page that draws without the chart library, so that it needs none.
[[nodiscard]] std::string page_without_charts(std::string_view head, std::string_view data, std::string_view tail);

}  // namespace halfplane
