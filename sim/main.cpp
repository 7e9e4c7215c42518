// halfplane COMMAND [SCENE] [options]
#include <algorithm>
#include <csignal>
#include <iostream>

#include "model/nearest_word.hpp"
#include "sim/cli/build_info.hpp"
#include "sim/cli/command_line.hpp"
#include "sim/cli/commands.hpp"
#include "sim/cli/options.hpp"
#include "sim/cosim/dut.hpp"
#include "sim/interrupt.hpp"
#include "sim/show/image/whole_file.hpp"

namespace {

using namespace halfplane;

/// Prints one line on stderr, whatever bytes a name in it has.
int fail(ExitStatus status, std::string message) {
  for (char& c : message)
    if (static_cast<unsigned char>(c) < ' ' || c == 0x7f) c = '?';
  std::cerr << "halfplane: " << message << '\n';
  return status;
}

/// CLI11 names missing arguments of a command, but not a command that does not exist.
void check_command(const CLI::App& app, int argc, char** argv) {
  if (argc < 2) throw InputError("no command; try `halfplane render teapot -o teapot.png` or `halfplane --help`");
  const std::string word = argv[1];
  if (word.starts_with("-")) return;
  const auto commands = app.get_subcommands({});
  std::vector<std::string_view> names;
  for (const CLI::App* command : commands) names.push_back(command->get_name());
  if (std::find(names.begin(), names.end(), word) != names.end()) return;
  throw InputError("no command '" + word + "' in this version;" + did_you_mean(word, names) + " give one of " +
                   joined(names));
}

/// CLI11 reports an unexpected word, but not the option that may have been meant; empty when none is near.
std::string option_hint(const CLI::App& app, int argc, char** argv) {
  for (const CommandText& command : command_texts(app)) {
    if (command.name != argv[1]) continue;
    std::vector<std::string_view> names;
    for (const OptionText& option : command.options)
      names.insert(names.end(), option.names.begin(), option.names.end());
    for (int i = 2; i < argc; ++i) {
      const std::string_view typed(argv[i]), word = typed.substr(0, typed.find('='));
      if (word.starts_with("--") && std::find(names.begin(), names.end(), word) == names.end())
        return did_you_mean(word, names);
    }
  }
  return "";
}

/// "halfplane 0.1.0 (commit 1a2b3c4, Release, GNU 12.2.0, RTL: embedded, tiny)"
std::string version_text() {
  const BuildInfo& info = build_info();
  std::vector<std::string> names;
  for (const DutFactory& dut : verilated_duts()) names.push_back(dut.name);
  const std::string rtl = names.empty() ? "none" : joined(names);
  return "halfplane " HALFPLANE_VERSION " (commit " + std::string(info.commit) + ", " + std::string(info.type) + ", " +
         std::string(info.compiler) + ", RTL: " + rtl + ")";
}

int run(int argc, char** argv) {
  CLI::App app{"Halfplane: a fixed-point raster pipeline as C++ model, RTL and golden.", "halfplane"};
  app.set_version_flag("--version", version_text);
  app.require_subcommand(1);
  app.footer(
      "\nExample:\n  halfplane render teapot --size 1280x720 -o teapot.png\n\n"
      "`halfplane COMMAND --help` shows a command's options. Exit status: 0 success, 1 a mismatch or\n"
      "a broken bound, 2 wrong usage or bad input, 3 something is missing, 130 interrupted,\n141 stdout is closed.");
  Action selected;
  for (AddCommand* add :
       {add_render_command, add_compare_command, add_cosim_command,   add_reduce_command,      add_mutants_command,
        add_depth_command,  add_bench_command,   add_stress_command,  add_scenes_command,      add_widths_command,
        add_config_command, add_convert_command, add_explain_command, add_vectors_command,     add_check_command,
        add_run_command,    add_regress_command, add_cover_command,   add_completions_command, add_man_command})
    add(app, selected);
  check_command(app, argc, argv);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    const std::string command = argv[1][0] == '-' ? "" : std::string(argv[1]) + " ";
    throw InputError(std::string(error.what()) + ";" + option_hint(app, argc, argv) + " see `halfplane " + command +
                     "--help`");
  }
  return selected();
}

}  // namespace

int main(int argc, char** argv) {
  // A closed reader and a file size limit appear as write errors, like a full disk: with these signals ignored no
  // half-written file remains, and every requested file is written even if stdout is no longer read.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  catch_signals();
  set_command_line(argc, argv);
  try {
    const int status = run(argc, argv);
    if (!std::cout.flush() && is_stdout_unread()) return status == exit_ok ? int{exit_unread} : status;
    if (!std::cout) throw InputError("writing to stdout failed; give a place that can be written, or --quiet");
    return status;
  } catch (const Interrupted&) {
    return fail(exit_interrupted, "interrupted: this command has no partial result, so nothing was written");
  } catch (const InputError& error) {
    return fail(exit_bad_input, error.what());
  } catch (const std::exception& error) {
    const bool is_of_memory = dynamic_cast<const std::bad_alloc*>(&error) != nullptr ||
                              dynamic_cast<const std::length_error*>(&error) != nullptr;
    return fail(exit_missing,
                is_of_memory ? "not enough memory for this scene and target; give a smaller --size" : error.what());
  }
}
