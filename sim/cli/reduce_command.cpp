#include <iostream>
#include <memory>

#include "sim/cli/commands.hpp"
#include "sim/cli/cosim_options.hpp"
#include "sim/cli/progress.hpp"

namespace halfplane {
namespace {

struct ReduceCommand : CosimOptions {
  double seconds = 60;
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

int run(const ReduceCommand& options) {
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
  command->footer("\nExample:\n  halfplane reduce out/cosim-random-7.hpt --mutant 3 -o small.hpt");
}

}  // namespace halfplane
