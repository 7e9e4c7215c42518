// A configuration as a C header, for programs that feed the hardware.
#pragma once

#include <string>

#include "../config.hpp"

namespace halfplane {

/// The text of the header: settings, constants and widths as in raster_pkg.sv, each with HALFPLANE_ in front of its name, and the
/// places of the fields of the packets that a host packs. Throws InputError for an invalid configuration.
[[nodiscard]] std::string c_header(const Config& config);

}  // namespace halfplane
