// The plan of `regress`: rows of scenes, configurations, stalls and seeds, and the cases that they make.
#pragma once

#include <string>
#include <vector>

namespace halfplane {

/// One run of `cosim`.
struct RegressCase {
  std::string row;     ///< its table in the plan
  std::string name;    ///< "row: embedded stamp.size=4, city, stalls 0.3, seed 7"
  std::string config;  ///< "embedded stamp.size=4"
  std::string scene;   ///< empty: random
  std::uint64_t random = 0, seed = 1;
  std::vector<std::string> arguments;  ///< of the program: "cosim", ...
  double timeout_s = 0;
};

/// Reads PLAN.toml. Files in it are relative to its folder. Cases with the first seed of each row come first, so that a run
/// that ends early has seen every configuration. Throws InputError, "file:line: ...".
[[nodiscard]] std::vector<RegressCase> read_regress_plan(const std::string& path);

/// "90s", "30m", "8h" as seconds. Throws InputError, which begins with `option`.
[[nodiscard]] double parse_duration(const std::string& text, const std::string& option);

}  // namespace halfplane
