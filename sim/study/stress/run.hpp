// Runs cases over configurations, by as many threads as wanted: a unit depends on seed, case and number alone.
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
  double seconds = 0;                 ///< 0: the quick set, which is the same each time; otherwise for so long
  std::vector<std::string> names;     ///< empty: all cases. Throws InputError for one that there is not
  std::optional<std::uint64_t> unit;  ///< this unit of every chosen case alone: how a failure is repeated
  std::optional<Config> config;       ///< instead of the grid
  Engine engine;                      ///< none: render_functional
  /// Called from this thread with the part done and the checks made; may be empty. Interrupted, thrown there, ends the run.
  std::function<void(double fraction, std::uint64_t checks)> progress;
};

struct CaseResult {
  const Case* about = nullptr;
  Tally tally;
};

/// Rounds of the quick set: two units of every case in each configuration of the grid.
[[nodiscard]] std::uint64_t quick_rounds();

/// Runs them all, judges the mean errors, and has the independent checker measure each case's worst depth error. Of a run
/// that was ended early, what was done: some cases may have no unit.
[[nodiscard]] std::vector<CaseResult> run_cases(const RunOptions& options);

}  // namespace halfplane::stress
