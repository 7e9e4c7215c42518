#include "sim/depth/report.hpp"

#include <stdexcept>

namespace halfplane {

// sim/depth/report.html with the chart library inside, before and behind the data: report.html.cpp.in.
extern const bool kHasChartLibrary;
extern const std::string_view kReportHead, kReportTail;

void require_chart_library() {
  if (!kHasChartLibrary)
    throw std::runtime_error(
        "this program was built without the chart library of reports; install the package libjs-chart.js, then build "
        "again");
}

std::string depth_report(std::string_view data) {
  require_chart_library();
  std::string page(kReportHead);
  for (const char c : data) {  // a script element ends at the first "</", wherever it stands
    if (c == '<')
      page += "\\u003c";
    else
      page += c;
  }
  return page.append(kReportTail);
}

}  // namespace halfplane
