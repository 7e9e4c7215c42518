// The commands of the program. Each adds itself to the command line and returns its exit status when it is called.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace halfplane {

using Action = std::function<int()>;

/// Each sets `selected` when the user chose the command.
void add_render_command(CLI::App& app, Action& selected);
void add_compare_command(CLI::App& app, Action& selected);
void add_cosim_command(CLI::App& app, Action& selected);
void add_reduce_command(CLI::App& app, Action& selected);
void add_mutants_command(CLI::App& app, Action& selected);
void add_depth_command(CLI::App& app, Action& selected);
void add_bench_command(CLI::App& app, Action& selected);
void add_scenes_command(CLI::App& app, Action& selected);
void add_stress_command(CLI::App& app, Action& selected);
void add_widths_command(CLI::App& app, Action& selected);
void add_config_command(CLI::App& app, Action& selected);
void add_convert_command(CLI::App& app, Action& selected);
void add_explain_command(CLI::App& app, Action& selected);
void add_vectors_command(CLI::App& app, Action& selected);
void add_check_command(CLI::App& app, Action& selected);

/// These walk the whole of `app` when they run.
void add_completions_command(CLI::App& app, Action& selected);
void add_man_command(CLI::App& app, Action& selected);

}  // namespace halfplane
