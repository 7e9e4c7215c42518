// raster_pkg.sv: the SystemVerilog side of the one configuration. Widths, constants and packed packet structs are
// printed from the same tables that C++ uses, so both always agree.
#pragma once

#include <cstdint>
#include <string>

#include "../config.hpp"

namespace halfplane {

/// The text of raster_pkg.sv for `config`. Throws InputError for an invalid configuration.
[[nodiscard]] std::string raster_pkg(const Config& config);

/// FNV-1a 64 over every setting that affects hardware: model and RTL compare it first.
[[nodiscard]] std::uint64_t config_id(const Config& config);

}  // namespace halfplane
