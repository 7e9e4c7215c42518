#include <ostream>

#include "sim/cli/commands.hpp"
#include "sim/cli/option_kinds.hpp"
#include "sim/cli/options.hpp"
#include "sim/cover/report.hpp"
#include "sim/show/image/whole_file.hpp"

namespace halfplane {
namespace {

struct CoverOptions : CommonOptions {
  std::vector<std::string> files, outputs;
  bool is_strict = false;
};

/// Writes the merged coverage in the form that the file's name says.
void write_as(const std::string& path, const cover::Report& report) {
  if (path.ends_with(".json")) return cover::write_coverage(path, report);
  if (path.ends_with(".html")) return cover::write_coverage_page(path, report, typed_command());
  if (path.ends_with(".dat")) return cover::write_verilator_coverage(path, report);
  throw InputError("-o: '" + path + "' is none of .json, .html, .dat; give a name with one of these endings");
}

int run(const CoverOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  if (std::ranges::find(options.outputs, "-") != options.outputs.end())
    throw InputError("-o: coverage goes to files; give a name that ends in .json, .html or .dat");
  cover::Report report;
  for (const std::string& path : options.files) report.merge(cover::read_coverage(path));
  for (const std::string& path : options.outputs) write_as(path, report);
  const cover::Totals totals = cover::totals_of(report);
  Json result{{"schema", "halfplane.cover/1"}, {"config", nullptr}, {"scene", nullptr}, {"seed", nullptr}};
  result["files"] = options.files;
  result.update(cover::coverage_json(report));
  finish_json(options, result, start);
  cover::print_coverage(human(options), report);
  const bool is_full = totals.holes == 0 && totals.pairs_hit == totals.pairs;
  return options.is_strict && !is_full ? exit_mismatch : exit_ok;
}

}  // namespace

void add_cover_command(CLI::App& app, Action& selected) {
  const auto [command, options] = add_command<CoverOptions>(
      app, selected, "cover", "what runs with --coverage have hit, merged, and what would hit the rest", run);
  add_text_option(*command, "FILE", options->files, "coverage of runs, as --coverage and -o write it")->required();
  add_text_option(*command, "-o", options->outputs,
                  "writes the merged coverage: .json, .html a page, .dat for verilator_coverage; repeatable", "FILE")
      ->allow_extra_args(false)
      ->each([](const std::string& path) { check_output(path); })
      ->each(claim_output("-o"));
  command->add_flag("--strict", options->is_strict, "status 1 while a bin or a pair that can be hit is not");
  add_result_options(*command, *options);
  command->footer(
      "\nBins that no run could hit, for want of a setting, are listed with it and are no holes.\n"
      "\nExample:\n  halfplane vectors --random 2000 --stage cull -o cull.jsonl --coverage random.json\n"
      "  halfplane cover random.json -o coverage.html");
}

}  // namespace halfplane
