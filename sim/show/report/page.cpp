#include "sim/show/report/page.hpp"

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "sim/show/image/whole_file.hpp"

namespace halfplane {

void require_chart_library() {
  if (!kDepthPage.has_library)
    throw std::runtime_error(
        "this program was built without the chart library of reports; install the package libjs-chart.js, then build "
        "again");
}

void write_page(const std::string& path, const ReportPage& page, const nlohmann::ordered_json& data) {
  std::string text(page.head);
  // A script element ends at the first "</". File names may be any bytes.
  for (const char c : data.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace))
    if (c == '<')
      text += "\\u003c";
    else
      text += c;
  write_text_file(path, text.append(page.tail));
}

}  // namespace halfplane
