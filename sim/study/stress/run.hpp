// Runs cases over configurations, with any number of threads: a unit depends only on seed, case and number.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "sim/study/stress/cases.hpp"

namespace halfplane::stress {

struct RunOptions {
  std::uint64_t seed = 1;
  int threads = 1;
  double seconds = 0;                 ///< 0: the quick set, which is the same each time; otherwise this long
  std::vector<std::string> names;     ///< empty: all cases. Throws InputError for an unknown one
  std::optional<std::uint64_t> unit;  ///< only this unit of every chosen case: to repeat a failure
  std::optional<Config> config;       ///< instead of the grid
  Engine engine;                      ///< none: render_functional
  /// Called from this thread with the fraction done and the checks made; may be empty. Interrupted, thrown there, ends
  /// the run.
  std::function<void(double fraction, std::uint64_t checks)> progress;
};

struct CaseResult {
  const Case* about = nullptr;
  Tally tally;
};

/// Rounds of the quick set: two units of every case in each configuration of the grid.
[[nodiscard]] std::uint64_t quick_rounds();

/// Runs all cases, judges the mean errors, and measures each case's worst depth error with the independent checker. A
/// run ended early returns the results so far: some cases may have no unit.
[[nodiscard]] std::vector<CaseResult> run_cases(const RunOptions& options);

}  // namespace halfplane::stress
