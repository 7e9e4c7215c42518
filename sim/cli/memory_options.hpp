// --memory, --memory-latency, --mhz: the memory of the hardware, for every command that has cycles; and who else reads it.
#pragma once

#include <string>

#include "model/timing/memory.hpp"
#include "sim/cli/options.hpp"

namespace halfplane {

/// Adds all three.
void add_memory_options(CLI::App& app, MemorySettings& settings);

/// Adds --scan-out and --other-traffic.
void add_traffic_options(CLI::App& app, MemorySettings& settings);

/// The options that select it; "" for the default.
[[nodiscard]] std::string memory_arguments(const MemorySettings& settings);

/// {kind, latency, mhz}; latency is null if the memory has its own. Of sdram width and memory_mhz too; scan_out_hz and
/// other_bytes_per_s if there are such masters.
[[nodiscard]] Json memory_json(const MemorySettings& settings);

/// "fixed, 8 cycles", "sdram, the chip at 50 MHz".
[[nodiscard]] std::string memory_text(const MemorySettings& settings);

}  // namespace halfplane
