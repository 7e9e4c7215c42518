#include <optional>
#include <ostream>

#include "sim/cli/commands.hpp"
#include "sim/cli/convert_trace.hpp"
#include "sim/cli/random_options.hpp"
#include "sim/show/image/whole_file.hpp"

namespace halfplane {
namespace {

struct ConvertOptions : CommonOptions, RandomOptions {
  std::string output, frames;
};

/// FILE.hpt as FILE-1.hpt, if there are several.
std::string numbered(const std::string& path, std::size_t number) {
  const std::size_t stem = path.size() - std::string_view(".hpt").size();
  return path.substr(0, stem) + "-" + std::to_string(number) + path.substr(stem);
}

/// One scene, or the successive scenes of `cosim --random`.
SceneSource scenes_of(const ConvertOptions& options, const Config& config) {
  if (options.random != 0) return random_source(options, options, config);
  double load_s = 0;
  Config plain = config;  // a program that draws the capture maps its depth, and would map it twice
  plain.depth_mapping = DepthMapping::projection;
  return single_scene(load_scene(options, plain, load_s));
}

int run(const ConvertOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  check_random_options(options, options, "convert");
  if (is_trace(options.scene)) {
    Json result = result_head("convert", options, effective_config(options));
    result["seed"] = options.seed;
    result["random"] = nullptr;
    result["captures"] = Json::array();
    const int status = convert_trace(options, {options.frames, options.output}, result);
    if (status == exit_ok) finish_json(options, result, start);
    return status;
  }
  if (!options.frames.empty()) throw InputError("--frame takes frames of a FILE.trace; leave it out");
  const bool is_stdout = options.output == "-";
  check_output(options.output, ".hpt");
  const Config config = effective_config(options);
  const SceneSource next = scenes_of(options, config);
  std::optional<Scene> scene = next(), following = next();
  const bool is_several = following.has_value();
  if (is_stdout && is_several)
    throw InputError("--random " + std::to_string(options.random) +
                     " makes several scenes, and stdout takes one capture; give fewer primitives, or -o FILE.hpt");
  Json result = result_head("convert", options, config);
  result["seed"] = options.seed;
  add_random_json(result, options);
  result["captures"] = Json::array();
  std::ostream& out = human(options);
  for (std::size_t number = std::max<std::size_t>(1, options.first_scene); scene;
       ++number, scene = std::move(following), following = next()) {
    const std::string text = capture_text(*scene);
    const std::string path = is_several ? numbered(options.output, number) : options.output;
    write_text_file(path, text);
    result["captures"].push_back(capture_json(path, *scene, text.size()));
    out << (path == "-" ? "stdout" : path) << "  " << scene->width << "x" << scene->height << ", "
        << with_commas(scene->vertices.size()) << " vertices, " << with_commas(scene->commands.size()) << " commands, "
        << with_commas(text.size()) << " bytes\n";
  }
  finish_json(options, result, start);
  return exit_ok;
}

}  // namespace

void add_convert_command(CLI::App& app, Action& selected) {
  const auto [command, options] =
      add_command<ConvertOptions>(app, selected, "convert", "any scene as a capture, exact to the bit", run);
  add_scene_options(*command, *options);
  command->get_option("SCENE")->required(false);
  add_random_options(
      *command, *options,
      "the scenes of `cosim --random N` with this --config and --seed: FILE-1.hpt and on where they are several",
      1'000'000'000);
  command->add_option("--frame", options->frames, "of a FILE.trace: frame N, or A to B, counted from 0 (default: all)")
      ->type_name("N|A..B");
  add_output_option(
      *command, "-o", options->output,
      "the capture, .hpt, or - for stdout; of a FILE.trace with several frames FILE-0000.hpt and on, or a "
      "folder for them")
      ->required();
  command->footer(
      "\nA mesh is written as its camera sees it, in clip space, in the convention gl. --set depth.mapping is not\n"
      "written: give it to the command that draws the capture.\n"
      "\nA FILE.trace is a program that `apitrace trace` recorded; the driver of `halfplane run` draws it again, "
      "without\n"
      "the program, a window or a graphics card: docs/programs.md.\n"
      "\nExample:\n  halfplane convert model.glb --camera name=main --size 320x240 -o model.hpt");
}

}  // namespace halfplane
