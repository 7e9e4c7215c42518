#include "sim/cli/coverage_option.hpp"

namespace halfplane {

void add_coverage_option(CLI::App& app, std::string& path) {
  add_file_option(
      app, "--coverage", path,
      "what the stimulus did to the hardware, as bins, .json: for `halfplane cover` (docs/functional-coverage.md)",
      ".json");
}

std::string stimulus_text(const CommonOptions& common, const RandomOptions& options) {
  return options.random != 0 ? random_arguments(options).substr(1) : common.scene;
}

std::string save_coverage(const std::string& path, const cover::Hits& hits, const Config& config, cover::Run run,
                          cover::Source source, Json& result, std::span<const Arrow> arrows, std::string_view stage) {
  const cover::Report report = cover::report_of(hits, config, std::move(run), source, arrows, stage);
  cover::write_coverage(path, report);
  result["coverage"] = cover::coverage_json(report)["totals"];
  return "coverage    " + cover::summary_line(report) + "; halfplane cover " + quoted(path) + '\n';
}

}  // namespace halfplane
