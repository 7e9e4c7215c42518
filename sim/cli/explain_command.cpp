#include <cmath>
#include <memory>
#include <ostream>

#include "model/engines/render.hpp"
#include "model/stages/depth_encode.hpp"
#include "sim/cli/commands.hpp"
#include "sim/cli/explain_output.hpp"
#include "sim/cli/option_kinds.hpp"
#include "sim/cli/options.hpp"
#include "sim/cli/progress.hpp"
#include "sim/cli/study_options.hpp"
#include "sim/cosim/dut.hpp"
#include "sim/show/image/png.hpp"
#include "sim/show/report/page.hpp"
#include "sim/study/explain/explain.hpp"
#include "sim/study/explain/picture.hpp"

namespace halfplane {

HALFPLANE_JSON_OF_MEMBERS(Rect, x, y, width, height)

namespace {

constexpr int kMostPixels = 4096;  // in --box: a history of each is kept

struct ExplainOptions : CommonOptions {
  int x = 0, y = 0;  ///< pixels
  std::string box = "1x1";
  double near = 1;  ///< pixels
  StudyOptions study;
  bool rtl = false, steps = false;
  int mutant = 0;
  std::string output;  ///< .png or .html
  int margin = 4;      ///< of the picture, pixels
};

bool is_page(const std::string& path) { return path.ends_with(".html"); }

/// Row by row.
std::vector<explain::Pixel> box_pixels(int x, int y, int width, int height) {
  std::vector<explain::Pixel> pixels;
  for (int j = 0; j < height; ++j)
    for (int i = 0; i < width; ++i) pixels.push_back({x + i, y + j});
  return pixels;
}

std::unique_ptr<Dut> explained_rtl(const ExplainOptions& options, const Config& config) {
  if (!options.rtl) {
    if (options.mutant != 0) throw InputError("--mutant is a fault of the RTL; give --rtl as well");
    return nullptr;
  }
  const DutFactory& factory = find_dut(config);
  if (options.mutant != 0 && !factory.has_mutants)
    throw InputError("--mutant: the RTL of " + factory.name + " has no mutants; use --config embedded");
  return make_dut(factory);
}

Json explain_json(const ExplainOptions& options, const Config& config, const Scene& scene,
                  const explain::Explanation& told) {
  Json result = result_head("explain", options, config);
  result["width"] = scene.width;
  result["height"] = scene.height;
  result["primitives"] = told.primitives;
  result["near"] = options.near;
  add_rules_json(result, options.study);
  result["hardware"] = {{"has_scene", told.no_hardware.empty()}, {"why_not", or_null(told.no_hardware)}};
  result["checks"] = told.checks;
  result["differences"] = told.differences;
  result["pixels"] = Json::array();
  for (const explain::PixelSamples& pixel : explain::pixels_of(told))
    result["pixels"].push_back(explain::pixel_json(pixel, told, scene, config));
  return result;
}

void print_explanation(std::ostream& out, const ExplainOptions& options, const Config& config, const Scene& scene,
                       const explain::Explanation& told) {
  out << options.scene << ", " << scene.width << "x" << scene.height << ", " << label(config) << ": "
      << with_commas(told.primitives) << " primitives; those that pass within " << options.near
      << " pixels, in program order\n";
  Json rules;
  add_rules_json(rules, options.study);
  if (const std::string study = study_text(rules); !study.empty()) out << "study: " << study << '\n';
  if (!told.no_hardware.empty()) out << "without hardware: " << told.no_hardware << '\n';
  for (const explain::PixelSamples& pixel : explain::pixels_of(told))
    explain::print_pixel(out, pixel, told, scene, config);
  out << with_commas(told.checks) << " figures compared with each other, "
      << (told.differences.empty() ? "all agree" : std::to_string(told.differences.size()) + " differ") << '\n';
  for (const std::string& difference : told.differences) out << "  " << difference << '\n';
}

void check_picture(const ExplainOptions& options) {
  if (options.output.empty()) return;
  if (options.output == "-") throw InputError("-o: give a file, .png or .html");
  if (!options.output.ends_with(".png") && !is_page(options.output))
    throw InputError("cannot write '" + options.output + "': give a name that ends in .png or .html");
}

std::string explain_repeat(const ExplainOptions& options, const Config& config) {
  std::string command = program_word() + " explain " + quoted(options.scene) + " " + std::to_string(options.x) + " " +
                        std::to_string(options.y) + scene_arguments(options, config) + " --seed " +
                        std::to_string(options.seed);
  const ExplainOptions defaults;
  if (options.box != defaults.box) command += " --box " + quoted(options.box);
  if (options.near != defaults.near) command += " --near " + Json(options.near).dump();
  if (options.rtl) command += " --rtl";
  command += study_arguments(options.study);
  if (options.steps) command += " --steps";
  if (options.mutant != defaults.mutant) command += " --mutant " + std::to_string(options.mutant);
  if (options.margin != defaults.margin) command += " --margin " + std::to_string(options.margin);
  return command + " -o " + quoted(options.output);
}

/// The data for the page's script (sim/show/report/explain.js). `around`: explained pixels of the window, row by row.
Json page_json(const explain::Explanation& around, const explain::Window& window, const Rect& box, const Scene& scene,
               const Config& config) {
  using namespace explain;
  const int depth_bits = DepthEncode(config, scene.planes).format().bits;
  const Rendering empty = make_rendering(scene, config, {});
  const std::size_t at = empty.frame.at(box.x, box.y);
  Json page{{"label", label(config)},
            {"version", HALFPLANE_VERSION},
            {"primitives", around.primitives},
            {"checks", around.checks},
            {"differences", around.differences},
            {"color_format", config.color_format == ColorFormat::rgb565 ? "rgb565" : "rgba8888"},
            {"window", {{"x", window.left}, {"y", window.top}, {"width", window.width}, {"height", window.height}}},
            {"box", box},
            {"empty",
             {{"depth", hex_text(empty.frame.depth[at], depth_bits)},
              {"color", hex_text(empty.frame.color[at], config.color_format == ColorFormat::rgb565 ? 16 : 32)}}}};
  page["samples"] = Json::array();  // their places in each pixel
  const std::vector<PixelSamples> pixels = pixels_of(around);
  for (const PixelHistory& sample : pixels.front())
    page["samples"].push_back(
        {std::ldexp(sample.place.x, -kPatternFraction), std::ldexp(sample.place.y, -kPatternFraction)});
  page["pixels"] = Json::array();
  for (const PixelSamples& pixel : pixels) {
    Json json = pixel_json(pixel, around, scene, config);
    for (Json& entry : json["history"]) {
      Json& hardware = entry["model"]["hardware"];
      if (hardware.is_object())
        for (Json& packet : hardware["packets"]) packet.erase("fields");  // most of the bytes, and not shown
    }
    page["pixels"].push_back(std::move(json));
  }
  return page;
}

/// Draws the box and its surroundings.
void write_picture(const ExplainOptions& options, const Rect& box, const explain::Window& window,
                   const explain::Explanation& around, const Scene& scene, const Config& config) {
  if (!is_page(options.output)) {
    const std::string title =
        options.scene + ", " + label(config) + ", pixel " + std::to_string(box.x) + " " + std::to_string(box.y);
    write_png(options.output, explain::neighbourhood_picture(around, window, box, config, title));
    return;
  }
  Json page = page_json(around, window, box, scene, config);
  page["scene"] = options.scene;
  page["command"] = explain_repeat(options, config);
  write_page(options.output, kExplainPage, page);
}

int run(const ExplainOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  Size box;
  try {
    box = parse_size(options.box);
  } catch (const InputError&) {
    throw InputError("--box: '" + options.box + "' is no box; give WIDTHxHEIGHT of at least 1x1, as in 4x4");
  }
  if (box.width > kMostPixels || box.height > kMostPixels || box.width * box.height > kMostPixels)
    throw InputError("--box: " + options.box + " is more than " + std::to_string(kMostPixels) +
                     " pixels; give a smaller one");
  if (options.skip != "all") throw InputError("--skip: explain tells what the default leaves out; leave it out");
  check_picture(options);
  const Config config = drawing_config(options);
  const std::unique_ptr<Dut> dut = explained_rtl(options, config);
  double load_s = 0;
  const Scene scene = interpolated(load_scene(options, config, load_s), options.study.interpolation);
  Progress progress(options, "explaining");
  explain::Options how;
  how.near = options.near;
  how.rules = study_rules(options.study);
  how.wants_steps = options.steps;
  how.rtl = dut.get();
  how.mutant = static_cast<std::uint16_t>(options.mutant);
  how.progress = [&progress](double fraction) { progress(fraction); };
  const Rect told_box{options.x, options.y, box.width, box.height};
  explain::require_inside(scene, {{options.x, options.y}});  // before the box, whose end may exceed every int
  explain::require_inside(scene, box_pixels(options.x, options.y, box.width, box.height));
  const bool draws = !options.output.empty();  // including its surroundings, in one run
  const explain::Window window = explain::window_around(told_box, draws ? options.margin : 0, scene);
  explain::Explanation told =
      explain::explain(scene, config, box_pixels(window.left, window.top, window.width, window.height), how);
  warn_of_depth_bits(options, config);
  if (draws) write_picture(options, told_box, window, told, scene, config);
  std::erase_if(told.pixels, [&](const explain::PixelHistory& p) { return !explain::is_in(told_box, p.at); });
  Json result = explain_json(options, config, scene, told);
  finish_json(options, result, start);
  print_explanation(human(options), options, config, scene, told);
  return told.differences.empty() ? exit_ok : exit_mismatch;
}

}  // namespace

void add_explain_command(CLI::App& app, Action& selected) {
  const auto [command, options] = add_command<ExplainOptions>(
      app, selected, "explain", "one pixel's history: the primitives that touched it, and why it has its values", run);
  add_scene_options(*command, *options);
  add_study_options(*command, options->study);
  add_interpolation_option(*command, options->study);
  command->add_option("X", options->x, "column of the pixel; the top left one is 0 0")->required();
  command->add_option("Y", options->y, "row of the pixel")->required();
  add_text_option(*command, "--box", options->box, "WxH pixels with X Y as the top left one", "SIZE")
      ->capture_default_str();
  add_real_option(*command, "--near", options->near, 1.0, 100000.0, "also list primitives that pass within N pixels")
      ->capture_default_str()
      ->type_name("N");
  command->add_flag("--rtl", options->rtl, "the RTL's packets too, bit by bit, and the cycles in which they crossed");
  add_file_option(*command, "-o", options->output,
                  "the neighbourhood enlarged, .png: grid, samples, edges; or .html: a page to step through");
  add_number_option(*command, "--margin", options->margin, 0, 24, "of -o: pixels shown on each side")->type_name("N");
  command->add_flag("--steps", options->steps, "every pixel of lines and triangles, step by step");
  command->add_option("--mutant", options->mutant, "with --rtl: one of the RTL's built-in faults, 0 for none")
      ->check(whole_number(0, 65535))
      ->type_name("N");
  command->footer(
      "\nSpecification, hardware model, functional engine, golden and oracle are compared with each other: the exit\n"
      "status is 1 where they differ.\n"
      "\nExample:\n  halfplane explain teapot 320 240 -o pixel.html");
}

}  // namespace halfplane
