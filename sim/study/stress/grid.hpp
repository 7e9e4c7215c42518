// The configurations that every case runs in.
#pragma once

#include <cstdint>
#include <vector>

#include "model/config.hpp"

namespace halfplane::stress {

[[nodiscard]] bool is_legal(const Config& config);

/// The presets; then each setting through its range separately: S 0...8, depth 8...32, guard band, local guard bits,
/// bits of the reciprocal, stamp, tile, colour format; then legal combinations of all of them, the same on every
/// machine.
[[nodiscard]] const std::vector<Config>& grid();

/// The configuration with a number: the grid's, and beyond it an endless sequence of random legal ones.
[[nodiscard]] Config config_of(std::uint64_t number);

}  // namespace halfplane::stress
