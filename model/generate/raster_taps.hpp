// The RTL's view of the pipeline graph, as SystemVerilog: printed from model/pipeline_graph.hpp, so that the order of
// bits is defined once.
#pragma once

#include <string>

namespace halfplane {

/// The text of rtl_ref/cosim/taps.svh: ports and assignments that show every arrow inside the RTL to the co-simulation.
[[nodiscard]] std::string raster_taps();

/// The lines of raster_pkg.sv that number the bits of raster_top's stall_i.
[[nodiscard]] std::string stall_constants();

}  // namespace halfplane
