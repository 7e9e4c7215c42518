#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>

#include "sim/cli/commands.hpp"
#include "sim/cli/option_kinds.hpp"
#include "sim/cli/progress.hpp"
#include "sim/config_file.hpp"
#include "sim/cosim/junit.hpp"
#include "sim/show/image/whole_file.hpp"
#include "sim/study/stress/run.hpp"

namespace halfplane {

namespace stress {
HALFPLANE_JSON_OF_MEMBERS(Case, name, item, property)
}

namespace {

struct StressCommand : CommonOptions {
  std::vector<std::string> names;
  std::string junit_path, captures;
  double seconds = 0;
  std::int64_t unit = -1;
  bool quick = false, list = false, has_config = false;
};

/// One figure of a case, for a row of the table and the result.
using WorstEntry = std::pair<const std::string, stress::Worst>;

/// The property that is nearest to its bound.
const WorstEntry* nearest_bound(const stress::Tally& tally) {
  const WorstEntry* found = nullptr;
  for (const WorstEntry& entry : tally.worst)
    if (found == nullptr || entry.second.ratio() > found->second.ratio()) found = &entry;
  return found;
}

std::string figure(double value) {
  const bool is_whole = value == static_cast<double>(static_cast<std::int64_t>(value));
  return is_whole ? with_commas(static_cast<std::uint64_t>(value)) : fixed(value, 4);
}

/// A configuration in a table: its preset and the number of different settings, if it is no preset alone.
std::string short_label(const Config& config) {
  const std::string text = label(config);
  const auto settings = std::count(text.begin(), text.end(), ',');
  return settings < 2 ? text : config.preset + " and " + std::to_string(settings) + " settings";
}

std::string worst_text(const stress::CaseResult& result) {
  const WorstEntry* entry = nearest_bound(result.tally);
  if (entry == nullptr) return "";
  const stress::Worst& w = entry->second;
  std::string text = entry->first + " " + figure(w.value) + (w.unit.empty() ? "" : " " + w.unit);
  if (w.bound > 0) text += ", bound " + figure(w.bound);
  if (w.value > 0 && !result.about->own_configs) text += " (" + short_label(w.place.config) + ")";
  return text;
}

void print_list(std::ostream& out) {
  for (const stress::Case& c : stress::cases())
    out << left_aligned(std::string(c.name), 26) << right_aligned(std::string(c.item), 3) << "  " << c.property << '\n';
}

int list_cases(const StressCommand& options) {
  const Json result{{"schema", "halfplane.stress.list/1"}, {"cases", stress::cases()}};
  write_json(options, result);
  print_list(human(options));
  return exit_ok;
}

/// The command that runs one unit again; a property of all units together needs all units.
std::string repeat_command(const StressCommand& options, const stress::CaseResult& result, const std::string& property,
                           std::uint64_t unit) {
  std::string command =
      program_word() + " stress --case " + std::string(result.about->name) + " --seed " + std::to_string(options.seed);
  if (property != "bias" && property != "empty")
    command += " --unit " + std::to_string(unit);
  else if (options.unit >= 0)
    command += " --unit " + std::to_string(options.unit);
  else if (options.seconds > 0)
    command += " --seconds " + Json(options.seconds).dump();
  if (options.has_config) {
    command += " --config " + quoted(options.config);
    for (const std::string& setting : options.settings) command += " --set " + quoted(setting);
  }
  return command;
}

/// Writes a scene as DIR/NAME.hpt; returns the file's name, or "" without a scene.
std::string save_capture(const std::string& folder, const std::string& name, const Scene& scene) {
  if (scene.states.empty()) return "";
  std::filesystem::create_directories(folder);
  std::string file = name;
  for (char& c : file)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '-';
  const std::string path = folder + "/" + file + ".hpt";
  write_text_file(path, capture_text(scene));
  return path;
}

Json worst_json(const StressCommand& options, const stress::CaseResult& result, const WorstEntry& entry) {
  const auto& [property, w] = entry;
  Json row{{"value", w.value}, {"bound", w.bound}, {"unit", w.unit}, {"config", label(w.place.config)}};
  row["measured"] = w.measured;
  row["capture"] = nullptr;
  if (!options.captures.empty() && w.value > 0) {
    const std::string path =
        save_capture(options.captures, std::string(result.about->name) + "-" + property, w.place.scene);
    if (!path.empty()) row["capture"] = path;
  }
  row["repeat"] = repeat_command(options, result, property, w.place.unit);
  return row;
}

Json case_json(const StressCommand& options, const stress::CaseResult& result) {
  const stress::Tally& t = result.tally;
  Json row{{"name", result.about->name},  {"item", result.about->item}, {"property", result.about->property},
           {"configs", t.configs.size()}, {"units", t.units},           {"triangles", t.triangles},
           {"samples", t.samples},        {"checks", t.checks},         {"failures", t.failures}};
  row["worst"] = Json::object();
  for (const WorstEntry& entry : t.worst) row["worst"][entry.first] = worst_json(options, result, entry);
  if (!t.bias.empty()) row["bias"] = {{"configs", t.bias.size()}, {"judged", t.bias_judged}};
  row["first_failure"] = nullptr;
  if (t.first) {
    const std::string folder = options.captures.empty() ? "out/stress" : options.captures;
    const std::string path = save_capture(folder, std::string(result.about->name) + "-failure", t.first->place.scene);
    row["first_failure"] = {{"property", t.first->property},
                            {"what", t.first->what},
                            {"config", label(t.first->place.config)},
                            {"capture", or_null(path)},
                            {"repeat", repeat_command(options, result, t.first->property, t.first->place.unit)}};
  }
  return row;
}

void print_failure(std::ostream& out, const Json& row, const stress::Failure& failure) {
  const Json& f = row["first_failure"];
  out << "\nFAILED    " << row["name"].get<std::string>() << ": " << failure.property << ": " << failure.what
      << "\n  config  " << label(failure.place.config) << "\n  repeat  " << f["repeat"].get<std::string>() << '\n';
  if (!f["capture"].is_null())
    out << "  look    " << program_word() << " compare " << quoted(f["capture"].get<std::string>())
        << config_arguments(failure.place.config) << '\n';
}

std::vector<JunitCase> junit_cases_of(const std::vector<stress::CaseResult>& results, bool is_partial) {
  std::vector<JunitCase> rows;
  for (const stress::CaseResult& r : results) {
    JunitCase row{std::string(r.about->name), "", "", ""};
    if (is_partial && r.tally.units == 0)
      row.skipped = "interrupted before its first unit";
    else if (r.tally.first)
      row.failure = r.tally.first->property + ": " + r.tally.first->what;
    else
      row.output = with_commas(r.tally.checks) + " checks; " + worst_text(r);
    rows.push_back(std::move(row));
  }
  return rows;
}

struct Totals {
  std::uint64_t triangles = 0, samples = 0, checks = 0, failures = 0;
  std::map<std::string, double> preset_depth;
};

Totals totals_of(const std::vector<stress::CaseResult>& results) {
  Totals sum;
  for (const stress::CaseResult& r : results) {
    sum.triangles += r.tally.triangles;
    sum.samples += r.tally.samples;
    sum.checks += r.tally.checks;
    sum.failures += r.tally.failures;
    for (const auto& [name, value] : r.tally.preset_depth)
      sum.preset_depth[name] = std::max(sum.preset_depth[name], value);
  }
  return sum;
}

void print_table(std::ostream& out, const StressCommand& options, const std::vector<stress::CaseResult>& results,
                 const Totals& sum, double wall_s) {
  out << left_aligned("case", 26) << "item configs " << right_aligned("triangles", 11) << right_aligned("checks", 15)
      << " failures  nearest to its bound\n";
  for (const stress::CaseResult& r : results)
    out << left_aligned(std::string(r.about->name), 26) << right_aligned(std::string(r.about->item), 4)
        << right_aligned(std::to_string(r.tally.configs.size()), 8) << ' '
        << right_aligned(with_commas(r.tally.triangles), 11) << right_aligned(with_commas(r.tally.checks), 15)
        << right_aligned(with_commas(r.tally.failures), 9) << "  " << worst_text(r) << '\n';
  out << "\ndepth       worst, LSB:";
  for (const auto& [name, value] : sum.preset_depth) out << ' ' << name << ' ' << fixed(value, 4);
  out << "\nchecks      " << with_commas(sum.samples) << " samples and fragments against the exact oracle, "
      << with_commas(sum.checks - sum.samples) << " others, " << with_commas(sum.triangles) << " triangles; seed "
      << options.seed << ", " << fixed(wall_s, 1) << " s, "
      << with_commas(static_cast<std::uint64_t>(static_cast<double>(sum.samples) / wall_s)) << " of them a second\n";
}

int run(const StressCommand& options) {
  const auto start = std::chrono::steady_clock::now();
  if (options.list) return list_cases(options);
  if (options.quick && options.seconds > 0)
    throw InputError("--quick and --seconds exclude each other; leave one of them out");
  if (options.unit >= 0 && options.names.empty())
    throw InputError("--unit: units are numbered within a case; add the --case of the unit");
  if (options.unit >= 0 && (options.quick || options.seconds > 0))
    throw InputError("--unit: runs a single unit; leave out --quick and --seconds");
  make_folder("--captures", options.captures);
  const Config config = effective_config(options);
  if (config.depth_format != DepthFormat{} || config.depth_mapping != DepthMapping::projection)
    throw InputError("stress: its cases test interpolated planes; leave depth.format and depth.mapping as they are");
  if (config.msaa_samples != 1)
    throw InputError("stress: the case `samples` chooses msaa.samples itself, the others have one; leave it as it is");
  stress::RunOptions run;
  run.seed = options.seed;
  run.threads = options.threads;
  run.seconds = options.seconds;
  run.names = options.names;
  if (options.unit >= 0) run.unit = static_cast<std::uint64_t>(options.unit);
  if (options.has_config) run.config = config;
  std::vector<stress::CaseResult> results;
  {
    Progress progress(options, "stress", "checks");
    run.progress = [&progress](double fraction, std::uint64_t checks) { progress(fraction, checks); };
    results = stress::run_cases(run);
  }
  const bool is_partial = is_interrupted();
  const Totals sum = totals_of(results);

  Json result{{"schema", "halfplane.stress/1"},
              {"config", options.has_config ? config_json(config) : Json(nullptr)},
              {"scene", nullptr},
              {"seed", options.seed},
              {"cases", Json::array()},
              {"triangles", sum.triangles},
              {"samples", sum.samples},
              {"checks", sum.checks},
              {"failures", sum.failures},
              {"preset_depth", sum.preset_depth}};
  for (const stress::CaseResult& r : results) result["cases"].push_back(case_json(options, r));
  const double wall_s = seconds_since(start);
  result["wall_s"] = wall_s;
  if (is_partial) mark_partial(result);
  write_junit(options.junit_path, "stress", junit_cases_of(results, is_partial), wall_s, result,
              options.has_config ? &config : nullptr, is_partial);
  write_json(options, result);
  std::ostream& out = human(options);
  print_table(out, options, results, sum, wall_s);
  for (std::size_t i = 0; i < results.size(); ++i)
    if (results[i].tally.first) print_failure(out, result["cases"][i], *results[i].tally.first);
  out << (sum.failures == 0 ? "every bound holds\n" : "");
  return ended(out, is_partial, sum.failures == 0 ? exit_ok : exit_mismatch);
}

}  // namespace

void add_stress_command(CLI::App& app, Action& selected) {
  CLI::App* command = app.add_subcommand("stress", "the stress list, over configurations, against the exact oracle");
  auto options = std::make_shared<StressCommand>();
  add_output_options(*command, *options);
  add_seed_option(*command, *options, "seed of everything random");
  add_text_option(*command, "--case", options->names, "only these, with commas (--list names them)", "NAME")
      ->delimiter(',');
  command->add_flag("--list", options->list, "lists the cases: name, item of the stress list, property");
  command->add_flag("--quick", options->quick, "the quick set, under a minute (default)");
  add_real_option(*command, "--seconds", options->seconds, 0.001, 1e7,
                  "runs for this long instead, always with new inputs")
      ->type_name("N");
  command->add_option("--unit", options->unit, "only the unit with this number: repeats a failure")
      ->check(whole_number(std::int64_t{0}, std::int64_t{1} << 62))
      ->type_name("N");
  command->add_option("--threads", options->threads, "threads")->check(whole_number(1, 1024))->type_name("N");
  add_text_option(*command, "--captures", options->captures, "folder for the worst input of each property, .hpt",
                  "DIR");
  add_file_option(*command, "--junit", options->junit_path, "result as JUnit XML");
  command->footer(
      "\nWithout --config and --set: over presets, each setting through its range, and combinations.\n"
      "Exit status 1 when a bound is broken; the input is saved as a capture, with the command that repeats it.\n"
      "\nExample:\n  halfplane stress --case fans,adversarial_depth --config tiny --seconds 2");
  command->callback([&selected, options, command] {
    options->has_config = command->count("--config") + command->count("--set") > 0;
    selected = [options] { return run(*options); };
  });
}

}  // namespace halfplane
