#include "sim/study/space/report.hpp"

#include "sim/show/report/page.hpp"

namespace halfplane {

// sim/study/space/report.html with the chart library inside, before and behind the data: report.html.cpp.in.
extern const std::string_view kSpaceReportHead, kSpaceReportTail;

std::string space_report(std::string_view data) { return page_with_data(kSpaceReportHead, data, kSpaceReportTail); }

}  // namespace halfplane
