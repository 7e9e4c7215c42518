// --memory, --memory-latency, --mhz: the memory of the hardware, for every command that has cycles.
#pragma once

#include <string>

#include "model/timing/memory.hpp"
#include "sim/cli/options.hpp"

namespace halfplane {

/// Adds all three.
void add_memory_options(CLI::App& app, MemorySettings& settings);

/// The options that select it; "" for the default.
[[nodiscard]] std::string memory_arguments(const MemorySettings& settings);

/// {kind, latency, mhz}; latency is null if the memory has its own.
[[nodiscard]] Json memory_json(const MemorySettings& settings);

/// "fixed, 8 cycles", "sdram, the chip at 50 MHz".
[[nodiscard]] std::string memory_text(const MemorySettings& settings);

}  // namespace halfplane
