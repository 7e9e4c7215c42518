// `reduce --command`: a program of somebody else's says whether a scene fails.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sim/cli/options.hpp"
#include "sim/cosim/reduce.hpp"

namespace halfplane {

struct ForeignOptions {
  std::string command;  ///< for sh, {} being a capture; empty: none
  std::string status;   ///< number, "timeout", or empty: any but 0
  double timeout_s = 10;
  std::vector<std::string> kept;  ///< ReduceOptions::kept
};

/// Adds --command, --status, --timeout and --keep.
void add_foreign_options(CLI::App& app, ForeignOptions& options);

/// The test of a scene: whether the program ends with the status that it has for the whole scene. A scene fails with any
/// status but 0, unless one is named; with the end of its time if that is named, or is how the whole scene ends.
struct ForeignTest {
  FailTest test;
  std::string status;                       ///< of the whole scene: "1", "timeout"
  std::shared_ptr<const std::size_t> runs;  ///< of the program, up to now; a scene that comes again is not run again
};

/// Runs the program on the whole scene, three times. Throws InputError when it does not fail, not each time with the same
/// status, or cannot be run, or for a name that cannot be kept.
[[nodiscard]] ForeignTest foreign_test(const ForeignOptions& options, const Scene& scene);

}  // namespace halfplane
