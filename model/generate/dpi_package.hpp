// The C interface (capi/halfplane.h) as a SystemVerilog package, halfplane_dpi, for one configuration.
#pragma once

#include <string>

#include "../config.hpp"

namespace halfplane::vectors {

/// The text of the package: the C functions, and for each stage that can be run by itself one function that makes it, one for
/// each packet that goes in, and one for each that comes out. It imports raster_pkg of the same configuration.
[[nodiscard]] std::string dpi_package(const Config& config);

}  // namespace halfplane::vectors
