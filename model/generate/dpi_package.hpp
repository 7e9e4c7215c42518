// The C interface (capi/halfplane.h) as a SystemVerilog package, halfplane_dpi, for one configuration.
#pragma once

#include <string>

#include "../config.hpp"

namespace halfplane::vectors {

/// The text of the package: the C functions; the whole pipeline, and the host of a scene, with typed packets; and for
/// each stage that can run alone one function that creates it, one for each input packet, and one for each output packet.
/// It imports raster_pkg of the same configuration.
[[nodiscard]] std::string dpi_package(const Config& config);

}  // namespace halfplane::vectors
