#include "sim/bench/report.hpp"

#include "sim/depth/report.hpp"

namespace halfplane {

// sim/bench/report.html with the chart library inside, before and behind the data: report.html.cpp.in.
extern const std::string_view kBenchReportHead, kBenchReportTail;

std::string bench_report(std::string_view data) {
  require_chart_library();
  std::string page(kBenchReportHead);
  for (const char c : data) {  // a script element ends at the first "</", wherever it stands
    if (c == '<')
      page += "\\u003c";
    else
      page += c;
  }
  return page.append(kBenchReportTail);
}

}  // namespace halfplane
