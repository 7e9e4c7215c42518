#include "sim/show/report/page.hpp"

#include <stdexcept>

namespace halfplane {

extern const bool kHasChartLibrary;  // report.html.cpp.in

void require_chart_library() {
  if (!kHasChartLibrary)
    throw std::runtime_error(
        "this program was built without the chart library of reports; install the package libjs-chart.js, then build "
        "again");
}

std::string page_with_data(std::string_view head, std::string_view data, std::string_view tail) {
  require_chart_library();
  return page_without_charts(head, data, tail);
}

std::string page_without_charts(std::string_view head, std::string_view data, std::string_view tail) {
  std::string page(head);
  for (const char c : data) {  // a script element ends at the first "</", wherever it stands
    if (c == '<')
      page += "\\u003c";
    else
      page += c;
  }
  return page.append(tail);
}

}  // namespace halfplane
