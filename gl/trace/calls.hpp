// Recorded calls as calls of the driver's entry points.
#pragma once

#include <cstddef>
#include <list>
#include <vector>

#include "../core/entry_points.hpp"
#include "trace_file.hpp"

namespace halfplane::gl {

/// Arguments for a pointer whose memory the trace lacks.
enum class Addresses { none, null, offsets };

/// Everything that a call's arguments point at. To outlive them.
using HeldMemory = std::list<std::vector<std::byte>>;

/// Calls `entry` with recorded arguments, whose memory is put into `held`, followed by zeros up to `reach` bytes: those that
/// the command may read however short the recorded memory is. False: it takes other arguments, or a pointer that it must not
/// get. Not for commands that write to the program's memory.
bool call_entry(const EntryPoint& entry, const std::vector<TraceValue>& values, std::size_t reach, Addresses addresses,
                HeldMemory& held);

}  // namespace halfplane::gl
