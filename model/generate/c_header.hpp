// A configuration as a C header: what a program that feeds the hardware needs to know of it.
#pragma once

#include <string>

#include "../config.hpp"

namespace halfplane {

/// The text of the header: settings, constants and widths as in raster_pkg.sv, each with HALFPLANE_ in front of its name, and the
/// places of the fields of the packets that a host packs. Throws InputError for an invalid configuration.
[[nodiscard]] std::string c_header(const Config& config);

}  // namespace halfplane
