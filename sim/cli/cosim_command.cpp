#include <iostream>
#include <memory>
#include <sstream>

#include "sim/cli/commands.hpp"
#include "sim/cli/cosim_options.hpp"
#include "sim/cosim/report.hpp"
#include "sim/show/image/whole_file.hpp"

namespace halfplane {
namespace {

constexpr double kReduceSeconds = 20;

/// Runs the whole stimulus, with progress over all of it.
Session run_stimulus(const CosimOptions& options, const Config& config, Dut& dut, SceneSource source) {
  Progress progress(options, "co-simulating");
  LockstepOptions lockstep = lockstep_options(options);
  std::uint64_t triangles = 0, before = 0;  // given out, and of those before the scene at work
  const auto counted = [&]() -> std::optional<Scene> {
    auto scene = source();
    before = triangles;
    if (scene) triangles += scene->indices.size() / 3;
    return scene;
  };
  lockstep.progress = [&](double fraction) {
    const double total = static_cast<double>(options.random != 0 ? options.random : triangles);
    progress((static_cast<double>(before) + fraction * static_cast<double>(triangles - before)) / total);
    return true;
  };
  return run_session(dut, config, lockstep, counted);
}

Json session_json(const CosimOptions& options, const Config& config, const DutFactory& factory,
                  const Session& session) {
  const LockstepResult& r = session.result;
  Json result = result_head("cosim", options, config);
  result["seed"] = options.seed;
  result["random"] = options.random != 0 ? Json(options.random) : Json(nullptr);
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
  result["triangles"] = r.triangles;
  result["lines"] = r.lines;
  result["points"] = r.points;
  result["scenes"] = session.scenes;
  result["mismatches"] = r.mismatch ? 1 : 0;  // the run stops at the first
  result["first_mismatch"] = nullptr;
  Json crossings = Json::object();
  for (const Arrow boundary : kBoundaries)
    crossings[std::string(info(boundary).name)] = r.cycles_compared[index(boundary)];
  result["crossings"] = crossings;
  const bool is_late = r.mismatch && r.mismatch->kind == Mismatch::Kind::cycle && !r.mismatch->fields.empty();
  const auto error = [&r] {
    const FieldPair& cycle = r.mismatch->fields.front();
    return cycle.model > cycle.rtl ? cycle.model - cycle.rtl : cycle.rtl - cycle.model;
  };
  const bool has_cycles = !r.mismatch && r.total_cycles_compared() > 0;
  result["cycles"] = {{"model", has_cycles ? Json(r.model_cycles) : Json(nullptr)},
                      {"rtl", r.cycles},
                      {"raster", r.raster_cycles},
                      {"tiles", r.tile_cycles},
                      // The run stops at the first difference; with other bits, or none, cycles mean nothing.
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
  out << (options.random != 0 ? " of " + with_commas(options.random) + " primitives" : "") << " sent to the RTL";
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
      << "cycles      " << with_commas(r.cycles) << " in all, " << with_commas(r.raster_cycles)
      << " from the first primitive to the last write, " << with_commas(r.tile_cycles) << " of them moving tiles; "
      << (session.seconds > 0 ? fixed(static_cast<double>(r.clocks) / 1e6 / session.seconds, 2) : "-")
      << " M cycles/s\n";
}

/// The result as JUnit: of a failure what the terminal says, paths and the repeat command too.
void write_junit(const CosimOptions& options, const Config& config, const Session& session, const SavedFinding* saved) {
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
  const std::string xml = junit_xml("cosim." + label(config), cases, session.seconds);
  write_whole_file(options.junit_path, {reinterpret_cast<const std::uint8_t*>(xml.data()), xml.size()});
}

int run(const CosimOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  if (options.scene.empty() == (options.random == 0))
    throw InputError(options.scene.empty() ? "nothing to run; give a SCENE or --random N"
                                           : "a scene and --random together; give one of them");
  const Config config = effective_config(options);
  check_output(options.save_path, ".hpt");
  check_output(options.junit_path);
  const DutFactory& factory = dut_for(options, config);
  double load_s = 0;
  std::optional<Scene> scene;
  if (options.random == 0) {
    scene = load_scene(options, config, load_s);
    check_hardware_scene(*scene, config);
  }
  const std::unique_ptr<Dut> dut = make_dut(factory);
  const Session session =
      run_stimulus(options, config, *dut,
                   scene ? single_scene(std::move(*scene)) : random_scenes(config, options.seed, options.random));
  const bool is_empty = session.result.total() == 0;

  Json result = session_json(options, config, factory, session);
  std::optional<SavedFinding> saved;
  if (session.failed) {
    saved = save_finding(options, config, *dut, *session.failed, *session.result.mismatch, kReduceSeconds);
    result["first_mismatch"] = mismatch_json(*session.result.mismatch,
                                             repeat_command(options, config, options.scene, lockstep_options(options)));
    result["reduced"] = mismatch_json(saved->finding.mismatch, saved->repeat);
    result["reduced"]["capture"] = saved->capture;
    result["reduced"]["trace"] = saved->trace.empty() ? Json(nullptr) : Json(saved->trace);
    result["reduced"]["triangles"] =
        saved->finding.reduced ? Json(saved->finding.reduced->primitives_after) : Json(nullptr);
  }
  std::ostream& out = human(options);
  print_equal(out, options, config, session);
  if (saved) {
    out << "first seen  " << mismatch_line(*session.result.mismatch) << "\n\n";
    print_finding(out, *saved);
  } else {
    out << (is_empty ? std::string("FAILED: nothing was compared\n")
                     : "equal       every bit of every packet, of memory and counters; the cycle of each of " +
                           with_commas(session.result.total_cycles_compared()) + " crossings\n");
  }
  if (!options.junit_path.empty()) write_junit(options, config, session, saved ? &*saved : nullptr);
  result["wall_s"] = seconds_since(start);
  write_json(options, result);
  return session.failed || is_empty ? exit_mismatch : exit_ok;
}

}  // namespace

void add_cosim_command(CLI::App& app, Action& selected) {
  CLI::App* command = app.add_subcommand("cosim", "RTL against model, packet by packet");
  auto options = std::make_shared<CosimOptions>();
  add_scene_options(*command, *options);
  command->get_option("SCENE")->required(false);
  command
      ->add_option("--random", options->random,
                   "N random triangles, lines and points of all sizes and states instead of a scene")
      ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1'000'000'000}))
      ->type_name("N");
  add_cosim_options(*command, *options);
  add_file_option(*command, "--save", options->save_path, "capture of a mismatch, .hpt (default out/cosim-NAME.hpt)");
  add_file_option(*command, "--junit", options->junit_path, "result as JUnit XML");
  command->footer(
      "\nA mismatch is reduced to the fewest primitives, saved as a capture with a waveform, and printed bit by bit.\n"
      "\nExample:\n  halfplane cosim --random 10000 --stalls 0.3 --seed 7");
  command->callback([&selected, options] { selected = [options] { return run(*options); }; });
}

}  // namespace halfplane
