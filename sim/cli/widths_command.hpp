// Shared by the two halves of `halfplane widths`: the table of widths, and the smallest configuration.
#pragma once

#include "sim/cli/options.hpp"

namespace halfplane {

/// The command line of `widths`, as typed.
struct WidthsCommand : CommonOptions {
  std::uint64_t samples = 20000;
  std::string captures;  ///< folder
  bool smallest = false;
  std::vector<std::string> scenes;
  std::string depth_error, coverage_error, color_error, texture_error, fight_rate;
};

/// `widths --smallest`. Returns the exit status.
int run_smallest(const WidthsCommand& options);

}  // namespace halfplane
