// `halfplane convert FILE.trace`: frames of a recorded OpenGL program as captures.
#pragma once

#include <string>

#include "sim/cli/options.hpp"

namespace halfplane {

struct ConvertTraceOptions {
  std::string frames;  ///< "N" or "A..B"; empty: all
  std::string output;
};

/// The element of `captures` for a capture of `bytes` bytes.
[[nodiscard]] Json capture_json(const std::string& path, const Scene& scene, std::size_t bytes);

/// Whether `name` is a trace of apitrace's.
[[nodiscard]] bool is_trace(const std::string& name);

/// Draws the trace to the last frame asked for and writes the captures, which `result` then names. Returns the exit status.
/// Throws InputError.
[[nodiscard]] int convert_trace(const CommonOptions& options, const ConvertTraceOptions& trace, Json& result);

}  // namespace halfplane
