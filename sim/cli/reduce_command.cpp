#include <algorithm>
#include <csignal>
#include <iostream>
#include <memory>
#include <string>
#include <thread>
#include <unordered_map>
#include <vector>

#include "model/as_number.hpp"
#include "model/draw_states.hpp"
#include "sim/cli/child.hpp"
#include "sim/cli/commands.hpp"
#include "sim/cli/cosim_options.hpp"
#include "sim/cli/option_kinds.hpp"
#include "sim/cli/progress.hpp"
#include "sim/cosim/reduce.hpp"
#include "sim/interrupt.hpp"
#include "sim/show/image/whole_file.hpp"

namespace halfplane {
namespace {

// --command: a program of somebody else's says whether a scene fails.

struct ForeignOptions {
  std::string command;  ///< for sh, {} being a capture; empty: none
  std::string status;   ///< number, "timeout", or empty: any but 0
  double timeout_s = 10;
  std::vector<std::string> kept;  ///< ReduceOptions::kept
};

constexpr int kRunsBefore = 3;  // of the whole scene, to see whether the program does the same each time

/// The command with each {} replaced by a file.
std::string with_file(const std::string& command, const std::string& file) {
  std::string text;
  for (std::size_t at = 0;;) {
    const std::size_t next = command.find("{}", at);
    text += command.substr(at, next - at);
    if (next == std::string::npos) return text;
    text += quoted(file);
    at = next + 2;
  }
}

/// Runs the program on scenes, one at a time.
class ForeignProgram {
 public:
  explicit ForeignProgram(const ForeignOptions& options) : options_(options) {}

  std::size_t runs = 0;

  /// "0", "1", "139", "timeout": of the program's last run on this scene, if there was one. Throws Interrupted.
  std::string status_of(const Scene& scene) {
    const std::string text = capture_text(scene);
    const auto known = known_.find(std::hash<std::string>{}(text));
    return known == known_.end() ? run(text) : known->second;
  }

  /// The status of another run. Throws Interrupted.
  std::string run(const std::string& text) {
    ++runs;
    return known_[std::hash<std::string>{}(text)] = status_of_run(text);
  }

 private:
  std::string status_of_run(const std::string& text) {
    const std::string file = folder_.file("scene.hpt");
    write_text_file(file, text);
    Child child(
        {"/bin/sh", "-c", with_file(options_.command, file)}, own_environment(),
        {.output = ChildOptions::Output::to_file, .file = "/dev/null", .has_group = true, .signal_if_orphan = SIGKILL});
    const auto start = std::chrono::steady_clock::now();
    while (!child.has_ended()) {
      stop_if_interrupted();
      if (seconds_since(start) > options_.timeout_s) {
        child.end();
        return "timeout";
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return std::to_string(child.status());
  }

  ForeignOptions options_;
  TemporaryFolder folder_;
  std::unordered_map<std::size_t, std::string> known_;  // statuses, by hashes of scenes
};

/// Adds --command, --status, --timeout and --keep.
void add_foreign_options(CLI::App& app, ForeignOptions& options) {
  add_text_option(app, "--command", options.command,
                  "instead of the RTL: a command for sh, {} being the capture, that fails with a status other than 0",
                  "COMMAND");
  add_text_option(app, "--status", options.status,
                  "of --command: only this exit status is the failure: a number, or timeout", "STATUS");
  add_real_option(app, "--timeout", options.timeout_s, 0.01, 86400.0,
                  "of --command: seconds after which a run is stopped")
      ->capture_default_str();
  app.add_option("--keep", options.kept,
                 "of --command: what its program has no other of, states and target (its size), comma-separated; it is "
                 "not made simpler")
      ->delimiter(',')
      ->type_name("NAMES");
}

/// The test of a scene: whether the program ends with the status that it has for the whole scene. A scene fails with any
/// status but 0, unless one is named; with the end of its time if that is named, or is how the whole scene ends.
struct ForeignTest {
  FailTest test;
  std::string status;                       ///< of the whole scene: "1", "timeout"
  std::shared_ptr<const std::size_t> runs;  ///< of the program, up to now; a scene that comes again is not run again
};

/// Runs the program on the whole scene, three times. Throws InputError when it does not fail, not each time with the same
/// status, or cannot be run, or for a name that cannot be kept.
ForeignTest foreign_test(const ForeignOptions& options, const Scene& scene) {
  if (options.command.find("{}") == std::string::npos)
    throw InputError(
        "--command: no {} in it, so it gets no scene; write it where the capture belongs, as in './sim {}'");
  const auto number = as_number<int>(options.status);
  if (!options.status.empty() && options.status != "timeout" && !(number && *number >= 1 && *number <= 255))
    throw InputError("--status: '" + options.status + "' is no failure; give 1 to 255, or timeout");
  for (const std::string& name : options.kept)
    if (name != "target" && std::none_of(draw_states().begin(), draw_states().end(),
                                         [&name](const DrawState& row) { return row.name == name; }))
      throw InputError("--keep: no state '" + name + "'; give target, or states by their names in captures, as shade");
  const auto program = std::make_shared<ForeignProgram>(options);
  const std::string text = capture_text(scene);
  std::string whole, seen;
  bool is_steady = true;
  for (int i = 0; i < kRunsBefore; ++i) {
    const std::string status = program->run(text);
    if (status == "126" || status == "127")
      throw InputError("--command: sh cannot run it (status " + status + "); check its path");
    is_steady = is_steady && (i == 0 || status == whole);
    whole = i == 0 ? status : whole;
    seen += (i == 0 ? "" : ", ") + status;
  }
  if (!is_steady)
    throw InputError("--command: the same scene ends with status " + seen +
                     "; a reduction needs a program that does the same each time: fix its seed");
  if (options.status.empty() ? whole == "0" : whole != options.status)
    throw InputError("--command: the scene does not fail, it ends with status " + whole +
                     "; give a scene that fails, or --status with how it does");
  const bool is_any = options.status.empty() && whole != "timeout";
  return {[program, is_any, whole](const Scene& next, const LockstepOptions&) -> std::optional<Mismatch> {
            const std::string status = program->status_of(next);
            if (is_any ? status == "0" || status == "timeout" : status != whole) return {};
            Mismatch mismatch;
            mismatch.stage = "command";
            mismatch.hint = "status " + status;
            return mismatch;
          },
          whole, std::shared_ptr<const std::size_t>(program, &program->runs)};
}

struct ReduceCommand : CosimOptions {
  double seconds = 60;
  ForeignOptions foreign;
};

/// The scene's mismatch. Throws Interrupted.
std::optional<Mismatch> first_mismatch(const ReduceCommand& options, const Config& config, Dut& dut,
                                       const Scene& scene) {
  Progress progress(options, "running the scene");
  LockstepOptions lockstep = lockstep_options(options);
  lockstep.progress = [&progress](double fraction) {
    progress(fraction);
    return true;
  };
  return lockstep_test(dut, config)(scene, lockstep);
}

/// The same for a program of others in the place of the RTL.
int run_foreign(const ReduceCommand& options) {
  const auto start = std::chrono::steady_clock::now();
  const std::pair<bool, const char*> of_rtl[]{{options.mutant != 0, "--mutant"},
                                              {options.stalls != 0, "--stalls"},
                                              {options.resets != 0, "--resets"},
                                              {!(options.memory == MemorySettings{}), "--memory"},
                                              {!options.trace_path.empty(), "--trace"}};
  for (const auto& [is_given, name] : of_rtl)
    if (is_given) throw InputError(std::string(name) + ": the RTL is not run with --command; leave it out");
  const Config config = effective_config(options);
  double load_s = 0;
  const Scene scene = load_scene(options, config, load_s);
  Progress progress(options, "reducing");
  const ForeignTest foreign = foreign_test(options.foreign, scene);
  ReduceOptions reducing;
  reducing.seconds = options.seconds;
  reducing.kept = options.foreign.kept;
  reducing.progress = [&progress](double fraction) { progress(fraction); };
  const auto reduced = reduce(scene, config, {}, foreign.test, reducing);
  if (!reduced) throw InputError("--command: the scene failed three times, and then did not; fix the program's seed");
  const std::string capture = save_scene(options, reduced->scene);
  const bool is_partial = is_interrupted();
  Json result = result_head("reduce", options, config);
  result["first_mismatch"] = nullptr;
  result["status"] = foreign.status;
  result["capture"] = capture;
  result["trace"] = nullptr;
  result["triangles"] = {{"before", reduced->primitives_before}, {"after", reduced->primitives_after}};
  result["runs"] = *foreign.runs;
  result["minimal"] = reduced->is_minimal;
  finish_json(options, result, start, is_partial);
  std::ostream& out = human(options);
  out << "fails with  " << (foreign.status == "timeout" ? "the end of its time" : "status " + foreign.status) << '\n'
      << "saved       " << capture << ", " << reduced->primitives_after << " of " << reduced->primitives_before
      << " primitives (" << *foreign.runs << " runs" << (reduced->is_minimal ? "" : "; it may get smaller") << ")\n";
  return ended(out, is_partial, exit_ok);
}

int run(const ReduceCommand& options) {
  if (!options.foreign.command.empty()) return run_foreign(options);
  if (!options.foreign.status.empty()) throw InputError("--status: there is no program that has one; add --command");
  if (!options.foreign.kept.empty()) throw InputError("--keep: there is no program that has no other; add --command");
  const auto start = std::chrono::steady_clock::now();
  const Config config = effective_config(options);
  const DutFactory& factory = dut_for(options, config);
  double load_s = 0;
  const Scene scene = load_scene(options, config, load_s);
  check_hardware_scene(scene, config);
  const std::unique_ptr<Dut> dut = make_dut(factory);
  const auto mismatch = first_mismatch(options, config, *dut, scene);
  if (!mismatch)
    throw InputError("'" + options.scene +
                     "' does not fail with these options, so there is nothing to reduce; give the --seed, --stalls, "
                     "--config and --mutant with which it fails");
  const SavedFinding saved = save_finding(options, config, *dut, scene, *mismatch, options.seconds);

  Json result = result_head("reduce", options, config);
  result["first_mismatch"] = mismatch_json(saved.finding.mismatch, saved.repeat);
  result["capture"] = saved.capture;
  result["trace"] = or_null(saved.trace);
  if (saved.finding.reduced) {
    result["triangles"] = {{"before", saved.finding.reduced->primitives_before},
                           {"after", saved.finding.reduced->primitives_after}};
    result["runs"] = saved.finding.reduced->runs;
    result["minimal"] = saved.finding.reduced->is_minimal;
  }
  const bool is_partial = is_interrupted();
  finish_json(options, result, start, is_partial);
  print_finding(human(options), saved);
  return ended(human(options), is_partial, exit_ok);
}

}  // namespace

void add_reduce_command(CLI::App& app, Action& selected) {
  const auto [command, options] = add_command<ReduceCommand>(
      app, selected, "reduce", "the fewest primitives and simplest state with which RTL and model still differ", run);
  add_scene_options(*command, *options);
  add_cosim_options(*command, *options);
  add_file_option(*command, "-o", options->save_path, "the reduced capture, .hpt (default out/cosim-NAME-reduced.hpt)",
                  ".hpt");
  command->add_option("--seconds", options->seconds, "stop after that, with what there is by then")
      ->check(CLI::Range(1.0, 86400.0))
      ->capture_default_str();
  add_foreign_options(*command, options->foreign);
  command->footer("\nExample:\n  halfplane reduce out/cosim-random-7.hpt --mutant 3 -o small.hpt");
}

}  // namespace halfplane
