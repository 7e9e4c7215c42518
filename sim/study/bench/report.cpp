#include "sim/study/bench/report.hpp"

#include "sim/show/report/page.hpp"

namespace halfplane {

// sim/study/bench/report.html with the chart library inside, before and behind the data: report.html.cpp.in.
extern const std::string_view kBenchReportHead, kBenchReportTail;

std::string bench_report(std::string_view data) { return page_with_data(kBenchReportHead, data, kBenchReportTail); }

}  // namespace halfplane
