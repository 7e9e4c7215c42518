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

/// One line on stderr, whatever bytes a name in it holds.
int fail(ExitStatus status, std::string message) {
  for (char& c : message)
    if (static_cast<unsigned char>(c) < ' ' || c == 0x7f) c = '?';
  std::cerr << "halfplane: " << message << '\n';
  return status;
}

/// CLI11 names what a command lacks, but not the command that does not exist.
void check_command(const CLI::App& app, int argc, char** argv) {
  if (argc < 2) throw InputError("no command; try `halfplane render teapot -o teapot.png` or `halfplane --help`");
  const std::string word = argv[1];
  if (word.starts_with("-")) return;
  const auto commands = app.get_subcommands({});
  std::vector<std::string_view> words;
  std::string names;
  for (const CLI::App* command : commands) {
    if (command->get_name() == word) return;
    names += (names.empty() ? "" : ", ") + command->get_name();
  }
  for (const CLI::App* command : commands) words.push_back(command->get_name());
  throw InputError("no command '" + word + "' in this version;" + did_you_mean(word, words) + " give one of " + names);
}

/// CLI11 says that a word is unexpected, but not which option it may have been; empty when there is none near.
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
  std::string rtl;
  for (const DutFactory& dut : verilated_duts()) rtl += (rtl.empty() ? "" : ", ") + dut.name;
  return "halfplane " HALFPLANE_VERSION " (commit " + std::string(info.commit) + ", " + std::string(info.type) + ", " +
         std::string(info.compiler) + ", RTL: " + (rtl.empty() ? "none" : rtl) + ")";
}

int run(int argc, char** argv) {
  CLI::App app{"Halfplane: a fixed-point raster pipeline as C++ model, RTL and golden.", "halfplane"};
  app.set_version_flag("--version", version_text);
  app.require_subcommand(1);
  app.footer(
      "\nExample:\n  halfplane render teapot --size 1280x720 -o teapot.png\n\n"
      "`halfplane COMMAND --help` shows a command's options. Exit status: 0 as it should be, 1 a mismatch or\n"
      "a broken bound, 2 wrong usage or bad input, 3 something is lacking, 130 interrupted,\n141 nobody reads stdout "
      "any more.");
  Action selected;
  add_render_command(app, selected);
  add_compare_command(app, selected);
  add_cosim_command(app, selected);
  add_reduce_command(app, selected);
  add_mutants_command(app, selected);
  add_depth_command(app, selected);
  add_bench_command(app, selected);
  add_stress_command(app, selected);
  add_scenes_command(app, selected);
  add_widths_command(app, selected);
  add_config_command(app, selected);
  add_convert_command(app, selected);
  add_explain_command(app, selected);
  add_vectors_command(app, selected);
  add_check_command(app, selected);
  add_completions_command(app, selected);
  add_man_command(app, selected);
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
  // A reader that went away and a file size limit show at the write, like a full disk: without the signals no
  // half-written file stays behind, and every file that was asked for is written though nobody reads stdout.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  catch_signals();
  set_command_line(argc, argv);
  try {
    const int status = run(argc, argv);
    if (!std::cout.flush() && is_stdout_unread()) return status == exit_ok ? int{exit_unread} : status;
    if (!std::cout) throw InputError("writing to stdout failed; give a place that takes it, or --quiet");
    return status;
  } catch (const Interrupted&) {
    return fail(exit_interrupted, "interrupted: this work is whole or nothing, so nothing was written");
  } catch (const InputError& error) {
    return fail(exit_bad_input, error.what());
  } catch (const std::bad_alloc&) {
    return fail(exit_missing, "not enough memory for this scene and target; give a smaller --size");
  } catch (const std::length_error&) {
    return fail(exit_missing, "not enough memory for this scene and target; give a smaller --size");
  } catch (const std::exception& error) {
    return fail(exit_missing, error.what());
  }
}
