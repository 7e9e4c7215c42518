// What the RTL needs of the pipeline's graph, as SystemVerilog: printed from model/pipeline_graph.hpp, so that no order of
// bits is written down twice.
#pragma once

#include <string>

namespace halfplane {

/// The text of rtl_ref/cosim/taps.svh: ports and assignments that show every arrow inside the RTL to the co-simulation.
[[nodiscard]] std::string raster_taps();

/// The lines of raster_pkg.sv that number the bits of raster_top's stall_i.
[[nodiscard]] std::string stall_constants();

}  // namespace halfplane
