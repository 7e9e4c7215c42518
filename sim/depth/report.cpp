#include "sim/depth/report.hpp"

#include <stdexcept>

namespace halfplane {

extern const std::string_view kReportPage;    // sim/depth/report.html: report.html.cpp.in
extern const std::string_view kChartLibrary;  // Chart.js; empty when it was not found

namespace {

void replace(std::string& page, std::string_view placeholder, std::string_view text) {
  page.replace(page.find(placeholder), placeholder.size(), text);
}

}  // namespace

void require_chart_library() {
  if (kChartLibrary.empty())
    throw std::runtime_error(
        "this program was built without the chart library of reports; install the package libjs-chart.js, then build "
        "again");
}

std::string depth_report(std::string_view data) {
  require_chart_library();
  std::string escaped;  // a script element ends at the first "</", wherever it stands
  for (const char c : data) {
    if (c == '<')
      escaped += "\\u003c";
    else
      escaped += c;
  }
  std::string page(kReportPage);
  replace(page, "/*@DATA@*/", escaped);  // first: the library may hold anything
  replace(page, "/*@CHART_LIBRARY@*/", kChartLibrary);
  return page;
}

}  // namespace halfplane
