#include <iostream>
#include <memory>

#include "sim/cli/commands.hpp"
#include "sim/cli/options.hpp"
#include "sim/scene/builtin.hpp"

namespace halfplane {

void add_scenes_command(CLI::App& app, Action& selected) {
  CLI::App* command = app.add_subcommand("scenes", "lists the built-in scenes");
  auto options = std::make_shared<CommonOptions>();
  command->add_flag("--json{-}", options->json, "result as JSON on stdout; --json=FILE: to a file");
  command->add_flag("--quiet", options->quiet, "no human text");
  command->footer("\nExample:\n  halfplane scenes\n  halfplane render city:32 -o city.png");
  command->callback([&selected, options] {
    selected = [options] {
      Json list = Json::array();
      std::ostream& out = human(*options);
      for (const Builtin& scene : builtin_scenes()) {
        const std::string name(scene.name);
        out << name << std::string(12 - std::min<std::size_t>(11, name.size()), ' ') << scene.description << '\n';
        Json entry{{"name", name}, {"description", scene.description}};
        if (!scene.size.empty()) {
          out << std::string(12, ' ') << name << ":N   N = " << scene.size << ", " << scene.min_size << "..."
              << scene.max_size << ", default " << scene.default_size << '\n';
          entry["n"] = {{"counts", scene.size},
                        {"min", scene.min_size},
                        {"max", scene.max_size},
                        {"default", scene.default_size}};
        }
        list.push_back(entry);
      }
      write_json(*options, {{"schema", "halfplane.scenes/1"}, {"scenes", list}});
      return static_cast<int>(kOk);
    };
  });
}

}  // namespace halfplane
