// halfplane COMMAND [SCENE] [options]
#include <iostream>

#include "sim/cli/commands.hpp"
#include "sim/cli/options.hpp"

int main(int argc, char** argv) {
  using namespace halfplane;
  CLI::App app{"Halfplane: a fixed-point raster pipeline as C++ model, RTL and golden.", "halfplane"};
  app.set_version_flag("--version", "halfplane " HALFPLANE_VERSION);
  app.require_subcommand(1);
  app.footer(
      "\nExample:\n  halfplane render teapot --size 1280x720 -o teapot.png\n\n`halfplane COMMAND --help` shows a "
      "command's options.");
  Action selected;
  add_render_command(app, selected);
  add_compare_command(app, selected);
  add_scenes_command(app, selected);
  add_config_command(app, selected);
  try {
    app.parse(argc, argv);
    return selected();
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    std::cerr << "halfplane: " << error.what() << "; see halfplane " << (argc > 1 && argv[1][0] != '-' ? argv[1] : "")
              << " --help\n";
    return kBadInput;
  } catch (const InputError& error) {
    std::cerr << "halfplane: " << error.what() << '\n';
    return kBadInput;
  } catch (const std::bad_alloc&) {
    std::cerr << "halfplane: not enough memory for this scene and target\n";
    return kMissing;
  } catch (const std::exception& error) {
    std::cerr << "halfplane: " << error.what() << '\n';
    return kMissing;
  }
}
