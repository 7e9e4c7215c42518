// The files of `explain -o`: the neighbourhood as a picture or as a page.
#pragma once

#include "sim/cli/explain_output.hpp"
#include "sim/study/explain/picture.hpp"

namespace halfplane::explain {

/// What the page's script reads (sim/study/explain/report.html). `around`: explained pixels of the window, row by row.
[[nodiscard]] Json page_json(const Explanation& around, const Window& window, const Rect& box, const Scene& scene,
                             const Config& config);

}  // namespace halfplane::explain
