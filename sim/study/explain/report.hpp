// The page of `explain -o FILE.html`: a neighbourhood to be looked at pixel by pixel and primitive by primitive, offline.
#pragma once

#include <string>
#include <string_view>

namespace halfplane::explain {

/// `data`: JSON as the page's script reads it (sim/cli/explain_page.cpp).
[[nodiscard]] std::string explain_report(std::string_view data);

}  // namespace halfplane::explain
