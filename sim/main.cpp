// halfplane COMMAND [SCENE] [options]
#include <csignal>
#include <iostream>

#include "sim/cli/commands.hpp"
#include "sim/cli/options.hpp"
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
  std::string names;
  for (const CLI::App* command : app.get_subcommands({})) {
    if (command->get_name() == word) return;
    names += (names.empty() ? "" : ", ") + command->get_name();
  }
  throw InputError("no command '" + word + "' in this version; give one of " + names);
}

int run(int argc, char** argv) {
  CLI::App app{"Halfplane: a fixed-point raster pipeline as C++ model, RTL and golden.", "halfplane"};
  app.set_version_flag("--version", "halfplane " HALFPLANE_VERSION);
  app.require_subcommand(1);
  app.footer(
      "\nExample:\n  halfplane render teapot --size 1280x720 -o teapot.png\n\n"
      "`halfplane COMMAND --help` shows a command's options. Exit status: 0 as it should be, 1 a mismatch or\n"
      "a broken bound, 2 wrong usage or bad input, 3 something is lacking, 141 nobody reads stdout any more.");
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
  check_command(app, argc, argv);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    const std::string command = argv[1][0] == '-' ? "" : std::string(argv[1]) + " ";
    throw InputError(std::string(error.what()) + "; see `halfplane " + command + "--help`");
  }
  return selected();
}

}  // namespace

int main(int argc, char** argv) {
  // A reader that went away and a file size limit show at the write, like a full disk: without the signals no
  // half-written file stays behind, and every file that was asked for is written though nobody reads stdout.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  set_program_word(argv[0]);
  try {
    const int status = run(argc, argv);
    if (!std::cout.flush() && is_stdout_unread()) return status == exit_ok ? int{exit_unread} : status;
    if (!std::cout) throw InputError("writing to stdout failed; give a place that takes it, or --quiet");
    return status;
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
