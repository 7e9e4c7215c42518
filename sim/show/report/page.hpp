// Self-contained HTML pages: a template that CMake split at the place of its data, and the data.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace halfplane {

/// The parts of a page before and after its data; page.html with page.css, page.js and the page's style and script.
struct ReportPage {
  std::string_view head, tail;
  bool has_library;  ///< the chart library, not needed by pages without charts
};
extern const ReportPage kBenchPage, kCoveragePage, kDepthPage, kExplainPage, kFramesPage, kSpacePage;

/// Throws std::runtime_error when this program was built without the chart library, which every page except
/// kExplainPage and kCoveragePage uses.
void require_chart_library();

/// Writes the page with `data`, in the form of its script. Throws InputError as write_whole_file().
void write_page(const std::string& path, const ReportPage& page, const nlohmann::ordered_json& data);

}  // namespace halfplane
