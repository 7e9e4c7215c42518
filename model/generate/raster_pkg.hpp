// raster_pkg.sv: the SystemVerilog side of the one configuration. Widths, constants and packed packet structs are printed
// from the same tables that C++ uses, so the two cannot drift apart.
#pragma once

#include <cstdint>
#include <string>

#include "../config.hpp"

namespace halfplane {

/// The text of raster_pkg.sv for `config`. Throws InputError when the configuration is not valid.
[[nodiscard]] std::string raster_pkg(const Config& config);

/// FNV-1a 64 over every setting that shapes hardware: model and RTL compare it before they compare anything else.
[[nodiscard]] std::uint64_t config_id(const Config& config);

}  // namespace halfplane
