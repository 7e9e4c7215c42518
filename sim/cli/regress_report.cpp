#include "sim/cli/regress_report.hpp"

#include <algorithm>
#include <map>
#include <ostream>

namespace halfplane {
namespace {

constexpr double kSlowTimes = 3, kSlowSeconds = 1;  // the median's multiple, and processor time that is worth a line
constexpr std::size_t kShownCases = 10;

bool is_bad(const std::string& outcome) { return outcome != "passed" && outcome != "skipped"; }

struct RegressCounts {
  std::map<std::string, std::size_t> outcomes;
  std::uint64_t ran = 0, primitives_planned = 0, primitives = 0, triangles = 0;
  std::vector<std::string> slow;
  double cpu_s = 0;

  [[nodiscard]] std::size_t of(const std::string& outcome) const {
    const auto found = outcomes.find(outcome);
    return found == outcomes.end() ? 0 : found->second;
  }
  [[nodiscard]] std::size_t bad() const { return of("failed") + of("crashed") + of("timeout") + of("flaky"); }
};

RegressCounts counts_of(const RegressReport& report) {
  RegressCounts counts;
  std::map<std::string, std::vector<double>> times;  // of a row and configuration
  const auto kind = [](const RegressCase& one) { return one.row + "\n" + one.config + "\n" + one.scene; };
  for (std::size_t i = 0; i < report.cases.size(); ++i) {
    counts.primitives_planned += report.cases[i].random;
    const Json& result = report.results[i];
    if (result.is_null()) continue;
    const std::string outcome = result["outcome"];
    ++counts.outcomes[outcome];
    ++counts.ran;
    if (outcome != "skipped") counts.primitives += report.cases[i].random;
    counts.triangles += result["triangles"].get<std::uint64_t>();
    counts.cpu_s += result["cpu_s"].get<double>();
    if (outcome == "passed") times[kind(report.cases[i])].push_back(result["cpu_s"]);
  }
  for (auto& [name, list] : times)
    std::ranges::nth_element(list, list.begin() + static_cast<std::ptrdiff_t>(list.size() / 2));
  for (std::size_t i = 0; i < report.cases.size(); ++i) {
    const Json& result = report.results[i];
    if (result.is_null() || result["outcome"] != "passed") continue;
    const auto& list = times[kind(report.cases[i])];
    const double seconds = result["cpu_s"], median = list[list.size() / 2];
    if (seconds > kSlowSeconds && seconds > kSlowTimes * median) counts.slow.push_back(report.cases[i].name);
  }
  return counts;
}

/// Short enough for a line of a report.
std::string first_line(const std::string& text) {
  constexpr std::size_t kLongest = 200;
  const std::string line = text.substr(0, text.find('\n'));
  return line.size() > kLongest ? line.substr(0, kLongest) + "..." : line;
}

/// In one line, why a case is no success.
std::string reason_of(const Json& result) {
  const Json& mismatch = result["mismatch"];
  if (mismatch.is_object())
    return "mismatch of kind " + mismatch["kind"].get<std::string>() + " in " + mismatch["stage"].get<std::string>() +
           ", arrow " + mismatch["arrow"].get<std::string>();
  const std::string outcome = result["outcome"];
  if (outcome == "timeout") return "ran out of its time";
  if (outcome == "skipped") return first_line(result["log"]);
  return "status " + result["status"].dump();
}

std::vector<std::string> names_with(const RegressReport& report, const std::string& outcome) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < report.cases.size(); ++i)
    if (!report.results[i].is_null() && report.results[i]["outcome"] == outcome) names.push_back(report.cases[i].name);
  return names;
}

}  // namespace

Json regress_json(const RegressReport& report) {
  const RegressCounts counts = counts_of(report);
  Json cases = Json::array();
  for (const Json& result : report.results)
    if (!result.is_null()) cases.push_back(result);
  return {{"schema", "halfplane.regress/1"},
          {"config", nullptr},
          {"scene", nullptr},
          {"seed", nullptr},
          {"plan", report.plan},
          {"folder", report.folder},
          {"commit", report.commit},
          {"planned", report.cases.size()},
          {"ran", counts.ran},
          {"passed", counts.of("passed")},
          {"failed", counts.of("failed")},
          {"crashed", counts.of("crashed")},
          {"timeout", counts.of("timeout")},
          {"flaky", counts.of("flaky")},
          {"skipped", counts.of("skipped")},
          {"primitives", {{"planned", counts.primitives_planned}, {"ran", counts.primitives}}},
          {"triangles", counts.triangles},
          {"cpu_s", counts.cpu_s},
          {"slow_cases", counts.slow},
          {"flaky_cases", names_with(report, "flaky")},
          {"cases", cases}};
}

std::string regress_junit(const RegressReport& report, double seconds, const std::string& command, bool is_partial) {
  std::vector<JunitCase> cases;
  for (std::size_t i = 0; i < report.cases.size(); ++i) {
    const RegressCase& planned = report.cases[i];
    const Json& result = report.results[i];
    JunitCase one;
    one.name = planned.name;
    one.properties = {{"seed", std::to_string(planned.seed)}, {"config", planned.config}, {"commit", report.commit}};
    if (result.is_null()) {
      one.skipped = "not run yet";
    } else {
      const std::string outcome = result["outcome"];
      one.seconds = result["wall_s"];
      one.properties.push_back({"command", result["repeat"]});
      if (outcome == "skipped") one.skipped = reason_of(result);
      if (is_bad(outcome)) one.failure = outcome + ": " + reason_of(result);
      one.details = result["log"];
    }
    cases.push_back(std::move(one));
  }
  std::vector<JunitProperty> properties{{"commit", report.commit}, {"command", command}};
  if (is_partial) properties.push_back({"partial", "true"});
  return junit_xml("regress." + report.plan, cases, seconds, properties);
}

void print_regression(std::ostream& out, const RegressReport& report, const std::string& program) {
  const RegressCounts counts = counts_of(report);
  out << report.plan << ", commit " << report.commit << ": " << with_commas(counts.ran) << " of "
      << with_commas(report.cases.size()) << " cases";
  for (const char* outcome : {"passed", "failed", "crashed", "timeout", "flaky", "skipped"})
    if (counts.of(outcome) != 0) out << ", " << with_commas(counts.of(outcome)) << " " << outcome;
  out << '\n';
  if (counts.primitives_planned != 0)
    out << "random      " << with_commas(counts.primitives) << " of " << with_commas(counts.primitives_planned)
        << " primitives; ";
  else
    out << "compared    ";
  out << with_commas(counts.triangles) << " triangles sent to the RTL, " << fixed(counts.cpu_s, 0)
      << " s of processor time\n";
  std::size_t shown = 0, kept = 0;
  for (std::size_t i = 0; i < report.cases.size(); ++i) {
    const Json& result = report.results[i];
    if (result.is_null() || result["outcome"] == "passed") continue;
    if (++kept > kShownCases) continue;
    ++shown;
    out << left_aligned(result["outcome"], 12) << report.cases[i].name << "\n            " << reason_of(result) << '\n';
    if (result["capture"].is_string()) out << "            reduced to " << result["capture"].get<std::string>() << '\n';
    out << "            " << result["repeat"].get<std::string>() << '\n';
  }
  if (kept > shown) out << "            and " << with_commas(kept - shown) << " more: --json has them all\n";
  for (std::size_t i = 0; i < counts.slow.size() && i < kShownCases; ++i)
    out << "slow        " << counts.slow[i] << ": more than " << fixed(kSlowTimes, 0)
        << " times the median of its like\n";
  if (counts.ran < report.cases.size())
    out << "left        " << with_commas(report.cases.size() - counts.ran) << " cases: " << program << " regress "
        << quoted(report.plan) << " -o " << quoted(report.folder) << " --resume\n";
  out << (counts.bad() != 0          ? "FAILED\n"
          : counts.of("passed") == 0 ? "nothing was compared\n"
                                     : "equal      every case that ran\n");
}

int regress_status(const RegressReport& report) {
  const RegressCounts counts = counts_of(report);
  if (counts.bad() != 0) return exit_mismatch;
  return counts.of("skipped") != 0 || counts.of("passed") == 0 ? kCannotTell : exit_ok;
}

}  // namespace halfplane
