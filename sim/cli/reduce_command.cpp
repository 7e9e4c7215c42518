#include <iostream>
#include <memory>

#include "sim/cli/commands.hpp"
#include "sim/cli/cosim_options.hpp"
#include "sim/cli/foreign_test.hpp"
#include "sim/cli/progress.hpp"

namespace halfplane {
namespace {

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
  check_output(options.save_path, ".hpt");
  check_distinct({options.scene, options.json, options.save_path});
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
  check_output(options.save_path, ".hpt");
  check_distinct({options.scene, options.json, options.save_path, options.trace_path});
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
  add_file_option(*command, "-o", options->save_path, "the reduced capture, .hpt (default out/cosim-NAME-reduced.hpt)");
  command->add_option("--seconds", options->seconds, "stop after that, with what there is by then")
      ->check(CLI::Range(1.0, 86400.0))
      ->capture_default_str();
  add_foreign_options(*command, options->foreign);
  command->footer("\nExample:\n  halfplane reduce out/cosim-random-7.hpt --mutant 3 -o small.hpt");
}

}  // namespace halfplane
