#include "sim/study/frames/report.hpp"

#include "sim/show/report/page.hpp"

namespace halfplane {

// sim/study/frames/report.html with the chart library inside, before and behind the data: report.html.cpp.in.
extern const std::string_view kFramesReportHead, kFramesReportTail;

std::string frames_report(std::string_view data) { return page_with_data(kFramesReportHead, data, kFramesReportTail); }

}  // namespace halfplane
