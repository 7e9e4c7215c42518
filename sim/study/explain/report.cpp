#include "report.hpp"

#include "sim/show/report/page.hpp"

namespace halfplane {

// sim/study/explain/report.html, before and behind the data: report.html.cpp.in.
extern const std::string_view kExplainReportHead, kExplainReportTail;

namespace explain {

std::string explain_report(std::string_view data) {
  return page_without_charts(kExplainReportHead, data, kExplainReportTail);
}

}  // namespace explain
}  // namespace halfplane
