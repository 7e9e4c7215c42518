#include <iostream>

#include "sim/cli/commands.hpp"
#include "sim/cli/options.hpp"
#include "sim/scene/builtin.hpp"

namespace halfplane {
namespace {

Json scenes_json() {
  Json list = Json::array();
  for (const Builtin& scene : all_builtin_scenes()) {
    Json entry{{"name", scene.name}, {"description", scene.description}};
    if (!scene.size.empty())
      entry["n"] = {
          {"counts", scene.size}, {"min", scene.min_size}, {"max", scene.max_size}, {"default", scene.default_size}};
    list.push_back(entry);
  }
  return list;
}

void print_scenes(std::ostream& out) {
  for (const Builtin& scene : all_builtin_scenes()) {
    out << scene.name << std::string(12 - std::min<std::size_t>(11, scene.name.size()), ' ') << scene.description
        << '\n';
    if (!scene.size.empty())
      out << std::string(12, ' ') << scene.name << ":N   N = " << scene.size << ", " << scene.min_size << "..."
          << scene.max_size << ", default " << scene.default_size << '\n';
  }
}

int run(const CommonOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  Json result = result_head("scenes", options, effective_config(options));
  result["scenes"] = scenes_json();
  finish_json(options, result, start);
  print_scenes(human(options));
  return exit_ok;
}

}  // namespace

void add_scenes_command(CLI::App& app, Action& selected) {
  const auto [command, options] = add_command<CommonOptions>(app, selected, "scenes", "lists the built-in scenes", run);
  add_output_options(*command, *options);
  command->footer("\nExample:\n  halfplane scenes\n  halfplane render city:32 -o city.png");
}

}  // namespace halfplane
