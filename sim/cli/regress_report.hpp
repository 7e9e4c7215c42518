// The report of `regress`: JSON, JUnit, text, and its exit status.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "sim/cli/options.hpp"
#include "sim/cli/regress_plan.hpp"

namespace halfplane {

/// For `git bisect run`: this commit can be called neither good nor bad.
inline constexpr int kCannotTell = 125;

struct RegressReport {
  std::string plan, folder, commit;
  std::vector<RegressCase> cases;
  std::vector<Json> results;  ///< by case; null: not run
};

[[nodiscard]] Json regress_json(const RegressReport& report);
[[nodiscard]] std::string regress_junit(const RegressReport& report, double seconds, const std::string& command,
                                        bool is_partial);
void print_regression(std::ostream& out, const RegressReport& report, const std::string& program);

/// 1: a case failed. kCannotTell: none failed, and one could not be run, or none was. 0 otherwise.
[[nodiscard]] int regress_status(const RegressReport& report);

}  // namespace halfplane
