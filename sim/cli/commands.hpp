// The commands of the program. Each adds itself to the command line and returns its exit status when it is called.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <memory>
#include <string>

namespace halfplane {

using Action = std::function<int()>;

/// Adds a command to `app`, which sets `selected` when the user chooses it. Completions and man walk all of `app` when
/// they run.
using AddCommand = void(CLI::App& app, Action& selected);
AddCommand add_render_command, add_compare_command, add_cosim_command, add_reduce_command, add_mutants_command,
    add_depth_command, add_bench_command, add_stress_command, add_scenes_command, add_widths_command,
    add_config_command, add_convert_command, add_explain_command, add_vectors_command, add_check_command,
    add_run_command, add_regress_command, add_cover_command, add_completions_command, add_man_command;

template <class Options>
struct AddedCommand {
  CLI::App* command;
  std::shared_ptr<Options> options;
};

/// A command that calls `run` with its options.
template <class Options>
[[nodiscard]] AddedCommand<Options> add_command(CLI::App& app, Action& selected, const std::string& name,
                                                const std::string& meaning, int (*run)(const Options&)) {
  CLI::App* command = app.add_subcommand(name, meaning);
  auto options = std::make_shared<Options>();
  command->callback([&selected, options, run] { selected = [options, run] { return run(*options); }; });
  return {command, options};
}

}  // namespace halfplane
