#include "sim/study/depth/report.hpp"

#include "sim/show/report/page.hpp"

namespace halfplane {

// sim/study/depth/report.html with the chart library inside, before and behind the data: report.html.cpp.in.
extern const std::string_view kReportHead, kReportTail;

std::string depth_report(std::string_view data) { return page_with_data(kReportHead, data, kReportTail); }

}  // namespace halfplane
