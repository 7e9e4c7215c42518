#include <algorithm>
#include <iostream>
#include <memory>
#include <sstream>

#include "model/as_number.hpp"
#include "model/host/primitive_assembly.hpp"
#include "sim/cli/commands.hpp"
#include "sim/cli/cosim_options.hpp"
#include "sim/cli/coverage_option.hpp"
#include "sim/cli/option_kinds.hpp"
#include "sim/cli/progress.hpp"
#include "sim/cosim/report.hpp"
#include "sim/cosim/specification.hpp"
#include "sim/cover/collector.hpp"
#include "sim/show/image/whole_file.hpp"

namespace halfplane {
namespace {

constexpr double kReduceSeconds = 20;
constexpr std::uint64_t kTracedCycles = 10'000;  // without --trace-cycles: some megabytes at most

/// The cycles of a run whose waveform --trace takes, counted from reset.
struct TraceWindow {
  std::uint64_t first = 0, last = kTracedCycles - 1;
};

TraceWindow trace_window(const CosimOptions& options) {
  const std::string& text = options.trace_cycles;
  if (text.empty()) return {};
  if (options.trace_path.empty())
    throw InputError("--trace-cycles: there is no waveform to choose them for; add --trace FILE.fst");
  const std::size_t colon = text.find(':');
  const auto first = as_number<std::uint64_t>(text.substr(0, colon));
  const auto last = colon == std::string::npos ? std::nullopt : as_number<std::uint64_t>(text.substr(colon + 1));
  if (!first || !last || *first > *last)
    throw InputError("--trace-cycles: '" + text + "' is no window; give FIRST:LAST, both included, as in 0:999");
  return {*first, *last};
}

/// Runs the whole stimulus, with progress over all of it.
Session run_stimulus(const CosimOptions& options, const Config& config, Dut& dut, SceneSource source,
                     cover::Collector* coverage) {
  Progress progress(options, "co-simulating", "primitives");
  LockstepOptions lockstep = lockstep_options(options);
  if (coverage != nullptr) {
    lockstep.counts_use = true;
    lockstep.watch = [coverage](const Scene& scene, const Config& host) { coverage->run(scene, host); };
  }
  const TraceWindow window = trace_window(options);
  lockstep.trace = options.trace_path;
  lockstep.trace_first = window.first;
  lockstep.trace_last = window.last;
  std::uint64_t primitives = 0, before = 0;  // primitives given out, and primitives before the current scene
  const auto counted = [&]() -> std::optional<Scene> {
    auto scene = source();
    before = primitives;
    if (!scene) return scene;
    for (const Command& command : scene->commands)
      if (const auto* draw = std::get_if<Draw>(&command)) primitives += primitive_count(*scene, *draw);
    return scene;
  };
  lockstep.progress = [&](double fraction) {
    const double total = static_cast<double>(options.random != 0 ? options.random : primitives);
    const double done = static_cast<double>(before) + fraction * static_cast<double>(primitives - before);
    return progress.goes_on(done / total, static_cast<std::uint64_t>(done));
  };
  const bool is_random = options.random != 0;
  return run_session(dut, config, lockstep, counted, is_random ? HostOrders::drawn : HostOrders::configured, is_random,
                     options.first_scene);
}

Json session_json(const CosimOptions& options, const Config& config, const DutFactory& factory,
                  const Session& session) {
  const LockstepResult& r = session.result;
  Json result = result_head("cosim", options, config);
  result["seed"] = options.seed;
  add_random_json(result, options);
  result["rtl"] = factory.name;
  result["stalls"] = options.stalls;
  result["memory"] = memory_json(options.memory);
  result["mutant"] = options.mutant;
  Json stages = Json::object(), arrows = Json::object();
  for (const Arrow arrow : kCompared) {
    const std::string stage(info(suspect(arrow)).name);
    stages[stage] = stages.value(stage, std::uint64_t{0}) + r.compared[index(arrow)];
    arrows[std::string(info(arrow).name)] = r.compared[index(arrow)];
  }
  result["packets"] = stages;
  result["arrows"] = arrows;
  result["memory_stamps"] = r.memory_compared;
  result["counters"] = r.counters_compared;
  result["frame"] = nullptr;  // each random scene has an order of its own
  if (options.random == 0)
    result["frame"] = {
        {"order", result["config"]["frame.order"]}, {"bins", session.counters.bins}, {"pairs", session.counters.pairs}};
  result["triangles"] = r.triangles;
  result["lines"] = r.lines;
  result["points"] = r.points;
  result["scenes"] = session.scenes;
  result["mismatches"] = r.mismatch ? 1 : 0;  // the run stops at the first
  result["first_mismatch"] = nullptr;
  result["specification"] = options.random == 0            ? Json(nullptr)
                            : session.disagreement.empty() ? Json("equal")
                                                           : Json(session.disagreement);
  Json crossings = Json::object();
  for (const Arrow boundary : kBoundaries)
    crossings[std::string(info(boundary).name)] = r.cycles_compared[index(boundary)];
  result["crossings"] = crossings;
  const bool is_whole = !r.mismatch && !r.is_stopped;
  const bool is_late = r.mismatch && r.mismatch->kind == Mismatch::Kind::cycle && !r.mismatch->fields.empty();
  const auto error = [&r] {
    const FieldPair& cycle = r.mismatch->fields.front();
    return cycle.model > cycle.rtl ? cycle.model - cycle.rtl : cycle.rtl - cycle.model;
  };
  const bool has_cycles = is_whole && r.total_cycles_compared() > 0;
  result["cycles"] = {{"model", has_cycles ? Json(r.model_cycles) : Json(nullptr)},
                      {"rtl", r.cycles},
                      {"raster", is_whole ? Json(r.raster_cycles) : Json(nullptr)},
                      {"tiles", is_whole ? Json(r.tile_cycles) : Json(nullptr)},
                      // The run stops at the first difference; with other bits, or none, cycles are meaningless.
                      {"max_primitive_error", is_late      ? Json(error())
                                              : has_cycles ? Json(0)
                                                           : Json(nullptr)}};
  const bool has_speed = session.seconds > 0 && r.clocks > 0;
  result["rtl_cycles_per_s"] = has_speed ? Json(static_cast<double>(r.clocks) / session.seconds) : Json(nullptr);
  return result;
}

void print_equal(std::ostream& out, const CosimOptions& options, const Config& config, const Session& session) {
  const LockstepResult& r = session.result;
  out << (options.random != 0 ? "random scenes" : options.scene) << ", " << with_commas(r.triangles) << " triangles";
  if (r.lines != 0) out << ", " << with_commas(r.lines) << " lines";
  if (r.points != 0) out << ", " << with_commas(r.points) << " points";
  out << (options.random != 0 && options.scenes == 0 && options.first_scene == 0
              ? " of " + with_commas(options.random) + " primitives"
              : "")
      << " sent to the RTL";
  out << ", " << label(config) << ", seed " << options.seed << ", stalls " << fixed(options.stalls, 2)
      << (options.memory == MemorySettings{} ? std::string() : ", memory " + memory_text(options.memory)) << '\n';
  for (const Mutant& mutant : mutants())
    if (mutant.id == options.mutant)
      out << "mutant      " << mutant.id << ", " << mutant.file << ": " << mutant.what << '\n';
  std::string line = "compared   ";
  for (const Arrow arrow : kCompared) {
    const std::string word = " " + std::string(info(arrow).name) + " " + with_commas(r.compared[index(arrow)]) + ",";
    if (line.size() + word.size() > 100) {
      out << line << '\n';
      line = std::string(11, ' ');
    }
    line += word;
  }
  out << line << " memory " << with_commas(r.memory_compared) << " stamps, counters "
      << with_commas(r.counters_compared) << '\n'
      << "cycles      " << with_commas(r.cycles);
  if (r.mismatch || r.is_stopped)
    out << " to where the run stopped; ";
  else
    out << " in all, " << with_commas(r.raster_cycles) << " from the first primitive to the last write, "
        << with_commas(r.tile_cycles) << " of them moving tiles; ";
  out << (session.seconds > 0 ? fixed(static_cast<double>(r.clocks) / 1e6 / session.seconds, 2) : "-")
      << " M cycles/s\n";
}

/// The result as JUnit: for a failure the text of the terminal, including paths and the repeat command.
void write_cosim_junit(const CosimOptions& options, const Config& config, const Session& session,
                       const SavedFinding* saved, const Json& result) {
  std::vector<JunitCase> cases;
  if (saved != nullptr) {
    std::ostringstream report;
    print_finding(report, *saved);
    report << "  first seen " << mismatch_line(*session.result.mismatch) << '\n';
    const JunitFinding finding{saved->finding.mismatch, report.str()};
    cases = junit_cases(session.result, &finding);
  } else {
    cases = junit_cases(session.result);
  }
  if (!session.disagreement.empty()) {
    cases.emplace_back();
    cases.back().name = "specification";
    cases.back().failure = session.disagreement;
  }
  write_junit(options.junit_path, "cosim." + label(config), cases, session.seconds, result, &config, is_interrupted());
}

/// The fate of the waveform of the whole run, or why there is none.
std::string trace_text(const CosimOptions& options, const DutFactory& factory, const Session& session) {
  const TraceWindow window = trace_window(options);
  const std::uint64_t clocks = session.result.clocks;
  if (session.has_trace)
    return options.trace_path + ", cycles " + with_commas(window.first) + " to " +
           with_commas(std::min(window.last, clocks - 1)) + " (cycle c begins at time 2 c)" +
           (options.trace_cycles.empty() && clocks > window.last ? "; --trace-cycles FIRST:LAST takes others" : "");
  if (!factory.has_trace) return "none: this design is built without tracing";
  return "none: the run has " + with_commas(clocks) + " cycles, and --trace-cycles begins behind them";
}

/// The scene with the fewest primitives that the model draws unlike the scalar engine; none: interrupted earlier.
std::optional<Reduced> smallest_disagreement(const CosimOptions& options, const Session& session) {
  Progress progress(options, "reducing");
  ReduceOptions reducing;
  reducing.seconds = kReduceSeconds;
  reducing.progress = [&progress](double fraction) { progress(fraction); };
  try {
    return reduce(*session.failed, session.config, {}, specification_test(session.config), reducing);
  } catch (const Interrupted&) {
    return std::nullopt;
  }
}

int run(const CosimOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  check_random_options(options, options, "run");
  const Config config = effective_config(options);
  require_sampled_hardware(config, "the RTL");
  (void)trace_window(options);
  if (!options.trace_path.empty()) (void)PartFile(options.trace_path);  // before a long run
  const DutFactory& factory = dut_for(options, config);
  double load_s = 0;
  std::optional<Scene> scene;
  if (options.random == 0) {
    scene = load_scene(options, config, load_s);
    check_hardware_scene(*scene, config);
  }
  const std::unique_ptr<Dut> dut = make_dut(factory);
  std::optional<cover::Collector> coverage;
  if (!options.coverage.empty()) coverage.emplace(config);
  const Session session = run_stimulus(
      options, config, *dut, scene ? single_scene(std::move(*scene)) : random_source(options, options, config),
      coverage ? &*coverage : nullptr);
  const bool is_empty = session.result.total() == 0 && !session.result.is_stopped;

  Json result = session_json(options, config, factory, session);
  std::optional<SavedFinding> saved;
  if (session.result.mismatch) {
    saved = save_finding(options, session.config, *dut, *session.failed, *session.result.mismatch, kReduceSeconds);
    result["first_mismatch"] = mismatch_json(
        *session.result.mismatch,
        options.scene == "-" ? saved->repeat : repeat_command(options, config, "", lockstep_options(options)));
    result["reduced"] = mismatch_json(saved->finding.mismatch, saved->repeat);
    result["reduced"]["capture"] = saved->capture;
    result["reduced"]["trace"] = or_null(saved->trace);
    result["reduced"]["triangles"] =
        saved->finding.reduced ? Json(saved->finding.reduced->primitives_after) : Json(nullptr);
  }
  std::optional<Reduced> reduced;
  if (!session.disagreement.empty()) reduced = smallest_disagreement(options, session);
  const bool is_partial = is_interrupted();
  const bool is_whole_run_traced = !options.trace_path.empty() && (!saved || saved->trace.empty());
  if (is_whole_run_traced) {
    const TraceWindow window = trace_window(options);
    result["trace"] = session.has_trace ? Json(options.trace_path) : Json(nullptr);
    result["trace_cycles"] =
        session.has_trace ? Json({window.first, std::min(window.last, session.result.clocks - 1)}) : Json(nullptr);
  }
  std::string covered;
  if (coverage) {
    coverage->add(session.result.use);
    covered = save_coverage(options.coverage, coverage->hits(), config,
                            {typed_command(), stimulus_text(options, options), label(config), options.seed},
                            cover::Source::rtl, result);
  }
  std::ostream& out = human(options);
  print_equal(out, options, config, session);
  if (!session.disagreement.empty()) {
    const Scene& smallest = reduced ? reduced->scene : *session.failed;
    out << "DIFFERENT   " << (reduced ? reduced->mismatch.hint : session.disagreement)
        << "\n            the RTL is the model's; scene saved in " << save_scene(options, smallest);
    if (reduced) out << ", " << reduced->primitives_after << " of " << reduced->primitives_before << " primitives";
    out << '\n';
  } else if (saved) {
    out << "first seen  " << mismatch_line(*session.result.mismatch);
    if (options.random != 0)
      out << ", in scene " << session.scene << " (--first-scene " << session.scene << " --scenes 1)";
    out << "\n\n";
    print_finding(out, *saved);
  } else {
    out << (is_empty ? std::string("FAILED: nothing was compared\n")
                     : std::string(is_partial ? "equal so far" : "equal      ") +
                           " every bit of every packet, of memory and counters; " +
                           (options.ignores_cycles
                                ? "no cycle was compared"
                                : "the cycle of each of " + with_commas(session.result.total_cycles_compared()) +
                                      " crossings") +
                           (options.random != 0 ? "; and the model's pictures the scalar engine's\n" : "\n"));
  }
  if (coverage) out << covered;
  if (is_whole_run_traced && session.trace_failure.empty())
    out << "waveform    " << trace_text(options, factory, session) << '\n';
  if (!options.junit_path.empty()) write_cosim_junit(options, config, session, saved ? &*saved : nullptr, result);
  finish_json(options, result, start, is_partial);
  if (is_partial) {
    print_partial(out);
    return exit_interrupted;
  }
  if (session.failed || is_empty) return exit_mismatch;
  if (!session.trace_failure.empty()) throw InputError(session.trace_failure);
  return exit_ok;
}

}  // namespace

void add_cosim_command(CLI::App& app, Action& selected) {
  const auto [command, options] =
      add_command<CosimOptions>(app, selected, "cosim", "RTL against model, packet by packet", run);
  add_scene_options(*command, *options);
  command->get_option("SCENE")->required(false);
  add_random_options(*command, *options,
                     "N random triangles, lines and points of all sizes and states instead of a scene", 1'000'000'000);
  add_cosim_options(*command, *options);
  add_text_option(*command, "--trace-cycles", options->trace_cycles,
                  "FIRST:LAST: cycles of a run without a mismatch that --trace records (default 0:9999)", "WINDOW");
  add_file_option(*command, "--save", options->save_path, "capture of a mismatch, .hpt (default out/cosim-NAME.hpt)",
                  ".hpt");
  add_file_option(*command, "--junit", options->junit_path, "result as JUnit XML");
  add_coverage_option(*command, options->coverage);
  command->footer(
      "\nA mismatch is reduced to the fewest primitives, saved as a capture with a waveform, and printed bit by bit.\n"
      "\nExample:\n  halfplane cosim --random 10000 --stalls 0.3 --seed 7");
}

}  // namespace halfplane
