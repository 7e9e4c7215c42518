// Shared by `cosim`, `vectors` and `check`: --coverage.
#pragma once

#include <string>

#include "sim/cli/random_options.hpp"
#include "sim/cover/report.hpp"

namespace halfplane {

void add_coverage_option(CLI::App& app, std::string& path);

/// "teapot", or the options of --random.
[[nodiscard]] std::string stimulus_text(const CommonOptions& common, const RandomOptions& options);

/// Writes the coverage of a run, adds its totals to `result`, and returns the line for a person.
[[nodiscard]] std::string save_coverage(const std::string& path, const cover::Hits& hits, const Config& config,
                                        cover::Run run, cover::Source source, Json& result,
                                        std::span<const Arrow> arrows = {}, std::string_view stage = {});

}  // namespace halfplane
