#include <algorithm>
#include <array>
#include <chrono>
#include <iostream>
#include <string_view>

#include "model/engines/functional.hpp"
#include "model/engines/scalar.hpp"
#include "model/golden/golden.hpp"
#include "model/stages/depth_encode.hpp"
#include "sim/cli/commands.hpp"
#include "sim/cli/option_kinds.hpp"
#include "sim/cli/progress.hpp"
#include "sim/cli/render_frames.hpp"
#include "sim/show/image/framebuffer_files.hpp"
#include "sim/show/image/panel.hpp"
#include "sim/show/image/png.hpp"
#include "sim/show/image/terminal.hpp"
#include "sim/study/antialiasing/supersample.hpp"
#include "sim/study/compare/compare.hpp"

namespace halfplane {
namespace {

constexpr std::array<std::string_view, 6> kEngines{"functional", "scalar", "cycle", "rtl", "golden", "golden32"};

Rendering render_golden(const Scene& scene, const Config& config, golden::Precision precision,
                        const RenderOptions& render) {
  golden::Options options;
  options.precision = precision;
  options.clipping = render.rules.clipping;
  options.progress = render.progress;
  const auto start = std::chrono::steady_clock::now();
  golden::Image image = golden::render(scene, config, options);
  Rendering rendering;
  rendering.frame = std::move(image.frame);
  rendering.counters = image.counters;
  rendering.count = std::move(image.count);
  rendering.ids = std::move(image.ids);
  rendering.raster_s = seconds_since(start);
  return rendering;
}

/// One picture of run_engine().
Rendering draw_once(const RenderCommand& options, const Scene& scene, const Config& config, CycleFacts* facts,
                    const std::function<void(double)>& progress, const Framebuffer* onto, bool keeps_samples) {
  RenderOptions render;
  render.onto = onto;
  render.skip = parse_skip(options.skip);
  render.threads = options.threads;
  render.rules = study_rules(options.study);
  render.want_count = !options.count_path.empty() || !options.draws_path.empty();
  render.want_ids = !options.ids_path.empty();
  render.progress = progress;
  render.resolved_only = !keeps_samples;
  if (options.engine == "functional") return render_functional(scene, config, render);
  if (options.engine == "scalar") return render_scalar(scene, config, render);
  if (options.engine == "rtl") {
    RtlRendering rtl = render_rtl(*make_dut(find_dut(config)), scene, config, render);
    if (facts != nullptr) facts->rtl = rtl.run;
    return std::move(rtl.rendering);
  }
  if (options.engine == "cycle" && facts == nullptr)
    return run_cycles(scene, hardware_of(options.cycle, config), render).rendering;
  if (options.engine == "cycle") {
    facts->cycle = run_cycle_engine(options, options.cycle, scene, config, render);
    return facts->cycle->frame.rendering;
  }
  if (options.engine == "golden") return render_golden(scene, config, golden::Precision::binary64, render);
  return render_golden(scene, config, golden::Precision::binary32, render);  // check_options() refuses all others
}

}  // namespace

Rendering run_engine(const RenderCommand& options, const Scene& scene, const Config& config, CycleFacts* facts,
                     const std::function<void(double)>& progress, const Framebuffer* onto, bool keeps_samples) {
  if (options.supersample.empty()) return draw_once(options, scene, config, facts, progress, onto, keeps_samples);
  const antialiasing::SupersampleGrid grid = antialiasing::parse_supersample(options.supersample);
  const double pictures = grid.side * grid.side;
  int done = 0;
  return antialiasing::supersampled(scene, config, grid, [&](const Scene& moved) {
    const int at = done++;
    const auto part_of_all = [&progress, at, pictures](double part) {
      if (progress) progress((at + part) / pictures);
    };
    return draw_once(options, moved, config, facts, part_of_all, nullptr, false);
  });
}

namespace {

// Checks everything that can be refused before a scene is read.
void check_options(const RenderCommand& options, const Config& config) {
  if (std::find(kEngines.begin(), kEngines.end(), options.engine) == kEngines.end())
    throw InputError("--engine: no engine '" + options.engine +
                     "' in this version; give functional, scalar, cycle, rtl, golden or golden32");
  check_study_rules(options.study, options.engine);
  if (options.engine == "rtl" && !(options.count_path.empty() && options.ids_path.empty()))
    throw InputError(
        "--count and --ids: the engine rtl is hardware, which keeps neither; leave out --count and --ids, or use "
        "another --engine");
  if (options.engine == "rtl" && !options.draws_path.empty())
    throw InputError(
        "--draws: the engine rtl is hardware, which keeps no counts; leave out --draws, or use another --engine");
  const bool chooses_bins =
      options.frames != 0 && compares_bins(config) && (options.skip == "none" || options.skip == "bins");
  if ((options.engine == "rtl" || options.engine == "cycle") && options.skip != "all" && !chooses_bins)
    throw InputError(
        "--skip: the engine " + options.engine +
        " skips by the hardware's rules, except for bins of successive frames: give none or bins with "
        "--frames, frame.order=bins and frame.store=color; else leave out --skip, or use another --engine");
  if (options.engine != "cycle" && !options.cycle.given().empty())
    throw InputError(options.cycle.given() + ": the engine " + options.engine +
                     " does not have it; add --engine cycle, or leave it out");
  if (options.engine == "cycle") check_cycle_options(options.cycle, config);
  if (options.engine == "rtl") (void)find_dut(config);
  (void)parse_skip(options.skip);
  if (!options.supersample.empty()) {
    (void)antialiasing::parse_supersample(options.supersample);
    if (options.engine == "cycle" || options.engine == "rtl")
      throw InputError("--supersample: the engine " + options.engine +
                       " counts the cycles of one picture; use functional, scalar, golden or golden32");
  }
  if (!options.depth_path.empty() && config.frame_store == FrameStore::color)
    throw InputError("--depth: with frame.store=color no depth is stored; leave out --depth, or use frame.store=all");
  if (!options.depth_path.empty()) check_depth_path(options.depth_path, stored_format(config).bits);
  check_frames(options);
}

}  // namespace

Json counters_json(const Counters& c) {
  Json skipped = Json::object();
  for (const SkipName& one : kSkipNames) skipped[one.name] = c.skipped.*one.counter;
  return {{"primitives", {{"in", c.primitives_in}, {"culled", c.culled}, {"drawn", c.drawn}, {"clipped", c.clipped}}},
          {"fragments",
           {{"covered", c.covered},
            {"depth_passed", c.depth_passed},
            {"alpha_killed", c.alpha_killed},
            {"written", c.written}}},
          {"samples_tested", c.samples_tested},
          {"tiles_visited", c.tiles_visited},
          {"skipped", std::move(skipped)}};
}

namespace {

/// {stage: {busy, stalled, starved, items}}, in cycles of the stage's output.
Json stages_json(const LockstepResult& run) {
  Json stages = Json::object();
  for (std::size_t i = 0; i < kStreams.size(); ++i) {
    const StreamUse& use = run.use[i];
    stages[std::string(sender_name(kStreams[i]))] = {
        {"busy", use.busy},
        {"stalled", use.stalled},
        {"starved", use.starved - (run.clocks - run.cycles)},  // without the clocks after the last packet
        {"items", use.busy}};
  }
  return stages;
}

/// Renders again N times after the first, or until a signal comes. {min, median} of the engine's own time.
Json measure(const RenderCommand& options, const Scene& scene, const Config& config) {
  std::vector<double> times;
  Progress progress(options, "repeating", "frames");
  const auto part = [&](double fraction) {
    progress((static_cast<double>(times.size()) + fraction) / options.repeat, times.size());
  };
  try {
    while (times.size() < static_cast<std::size_t>(options.repeat)) {
      part(0);
      const Rendering rendering = run_engine(options, scene, config, nullptr, part);
      times.push_back(rendering.geometry_s + rendering.raster_s);
    }
  } catch (const Interrupted&) {  // the frames so far count
    if (times.empty()) return nullptr;
  }
  std::sort(times.begin(), times.end());
  Json json{{"min", times.front()}, {"median", times[times.size() / 2]}};
  if (is_interrupted()) json["frames"] = times.size();
  return json;
}

}  // namespace

void write_files(const RenderCommand& options, const Rendering& rendering, const Config& config,
                 const std::string& title) {
  const Framebuffer& frame = rendering.frame;
  if (!options.color_path.empty()) write_png(options.color_path, color_picture(frame, config.color_format));
  if (!options.depth_path.empty()) write_depth(options.depth_path, frame, stored_format(config).bits);
  if (!options.count_path.empty()) write_npy(options.count_path, frame.width, frame.height, rendering.count);
  if (!options.ids_path.empty()) write_npy(options.ids_path, frame.width, frame.height, rendering.ids);
  if (!options.draws_path.empty())
    write_png(options.draws_path, draws_sheet(title, color_picture(frame, config.color_format), rendering.count));
}

namespace {

/// "1,234 samples tested", and why that may be fewer than are covered.
std::string tested_text(const Counters& c) {
  const std::uint64_t tiles = c.skipped.trivially_accepted;
  std::string text = with_commas(c.samples_tested) + " samples tested";
  if (tiles > 0)
    text += " (lines, points and " + with_commas(tiles) + " tiles inside a triangle are covered untested)";
  else if (c.covered > c.samples_tested)
    text += " (lines and points are covered untested)";
  return text;
}

/// ", 12 dropped: 5 outside the view, 7 facing away": the reasons for primitives that are not drawn.
std::string dropped_text(const Counters& c) {
  if (c.culled == 0) return "";
  const auto& skipped = c.skipped;
  const std::uint64_t others = skipped.frustum + skipped.backface + skipped.zero_area + skipped.empty;
  std::string reasons;
  const auto add = [&reasons](std::uint64_t count, const char* reason) {
    if (count > 0) reasons += (reasons.empty() ? ": " : ", ") + with_commas(count) + " " + reason;
  };
  add(skipped.frustum, "outside the view");
  add(skipped.backface, "facing the culled side");
  add(skipped.zero_area, "without area");
  add(skipped.empty, "with no pixel centre in their box");
  if (others < c.culled) add(c.culled - others, "of objects outside the view");
  return ", " + with_commas(c.culled) + " dropped" + reasons;
}

/// Prints the text for people, with the figures of `result`.
void print_result(const RenderCommand& options, const Config& config, const Rendering& rendering,
                  const CycleFacts& facts, const Json& result) {
  const Counters& c = rendering.counters;
  std::ostream& out = human(options);
  if (options.color_path.empty() && &out == &std::cout && terminal_style(1) == TerminalStyle::color)
    out << terminal_preview(color_picture(rendering.frame, config.color_format), terminal_size(1),
                            TerminalStyle::color);
  out << options.scene << ", " << rendering.frame.width << "x" << rendering.frame.height << ", " << label(config)
      << ", engine " << options.engine << ", seed " << options.seed << '\n'
      << "primitives  " << with_commas(c.primitives_in) << " in, " << with_commas(c.drawn) << " drawn ("
      << with_commas(c.clipped) << " clipped)" << dropped_text(c) << '\n'
      << "fragments   " << with_commas(c.covered) << " covered, " << with_commas(c.depth_passed) << " passed, "
      << with_commas(c.written) << " written; " << tested_text(c) << '\n'
      << "time        load " << fixed(1e3 * result["time_s"]["load"].get<double>(), 1) << " ms, geometry "
      << fixed(1e3 * rendering.geometry_s, 2) << " ms, raster " << fixed(1e3 * rendering.raster_s, 2) << " ms\n";
  if (const Json& objects = result["objects"]; objects["primitives_skipped"] != 0)
    out << "objects     " << objects["in"] << " in, outside the view by sphere " << objects["culled_sphere"]
        << ", by box " << objects["culled_box"] << ": "
        << with_commas(objects["primitives_skipped"].get<std::uint64_t>()) << " primitives skipped\n";
  if (!study_text(result).empty()) out << "study       " << study_text(result) << '\n';
  for (const std::string& bound : given_up_bounds(study_rules(options.study))) out << "given up    " << bound << '\n';
  if (config.frame_order == FrameOrder::bins && result.contains("frame"))
    out << "bins        " << with_commas(c.pairs) << " primitives sent in " << with_commas(c.bins) << " bins\n";
  if (options.engine == "rtl")
    out << "cycles      " << with_commas(facts.rtl.cycles) << " in all, " << with_commas(facts.rtl.raster_cycles)
        << " from the first primitive to the last write, " << with_commas(facts.rtl.tile_cycles)
        << " of them moving tiles\n";
  if (facts.cycle) print_cycles(out, *facts.cycle);
  if (options.repeat > 0 && !result["frame_s"].is_null())
    out << "frame       min " << fixed(1e3 * result["frame_s"]["min"].get<double>(), 2) << " ms, median "
        << fixed(1e3 * result["frame_s"]["median"].get<double>(), 2) << " ms of "
        << result["frame_s"].value("frames", options.repeat) << '\n';
  out << "hashes      colour " << result["color_hash"].get<std::string>() << ", depth "
      << (result["depth_hash"].is_null() ? "not stored" : result["depth_hash"].get<std::string>()) << '\n';
}

int run(const RenderCommand& given) {
  const auto start = std::chrono::steady_clock::now();
  const Config config = drawing_config(given);
  check_options(given, config);
  RenderCommand options = given;
  options.leaves_out = !options.engine.starts_with("golden");  // golden also draws marked objects
  if (options.frames != 0) return run_frames(options, config);
  double load_s = 0;
  ObjectCounts objects;
  const Scene scene = interpolated(load_scene(options, config, load_s, &objects), options.study.interpolation);
  warn_of_scene(scene, config);
  CycleFacts facts;
  const Rendering rendering = [&] {
    Progress progress(options, "rendering");
    return run_engine(options, scene, config, &facts, [&progress](double fraction) { progress(fraction); });
  }();
  warn_of_depth_bits(options, config);
  Json result = result_head("render", options, config);
  result["engine"] = options.engine;
  result["width"] = scene.width;
  result["height"] = scene.height;
  result["threads"] = options.engine == "functional" ? options.threads
                      : options.engine == "cycle"    ? std::min(options.threads, 2)
                                                     : 1;  // the others have one
  result["supersample"] = or_null(options.supersample);
  result["objects"] = objects;
  if (options.engine == "scalar") add_study_json(result, options.study, scene, config);
  if (options.engine == "scalar" || options.engine == "golden")
    result["bounds"]["given_up"] = given_up_bounds(study_rules(options.study));
  if (options.engine == "golden") result["clipping"] = options.study.clipping;
  result["interpolation"] = options.study.interpolation;
  result.update(counters_json(rendering.counters));
  result["time_s"] = {{"load", load_s}, {"geometry", rendering.geometry_s}, {"raster", rendering.raster_s}};
  if (options.engine == "cycle" || options.engine == "rtl")
    result["frame"] = {{"order", result["config"]["frame.order"]},
                       {"bins", rendering.counters.bins},
                       {"pairs", rendering.counters.pairs}};
  if ((options.engine == "cycle" || options.engine == "rtl") && has_texture_planes(config)) {
    const auto& texture = rendering.counters.texture;
    result["texture"] = {{"requests", texture.samples},
                         {"hits", texture.hits},
                         {"fills", texture.fills},
                         {"samples", texture.samples},
                         {"misses", texture.fills}};
  }
  if (options.engine == "rtl") {
    result["cycles"] = facts.rtl.cycles;
    result["raster_cycles"] = facts.rtl.raster_cycles;
    result["tile_cycles"] = facts.rtl.tile_cycles;
    result["stages"] = stages_json(facts.rtl);
  }
  if (facts.cycle) add_cycle_json(result, *facts.cycle);
  if (options.repeat > 0) result["frame_s"] = measure(options, scene, config);
  result["color_hash"] = color_hash(rendering.frame, config.color_format);
  result["depth_hash"] = config.frame_store == FrameStore::color ? Json(nullptr) : Json(depth_hash(rendering.frame));
  const StudyRules rules = study_rules(options.study);
  const std::string title = rules.clipping == Clipping::homogeneous ? "clipping homogeneous, engine " + options.engine
                            : rules.gradients != Gradients::one_reciprocal || rules.accumulator != Accumulator::wrap ||
                                    rules.weights != Weights::eight
                                ? study_text(result)
                            : rules != StudyRules{}
                                ? "fill rule " + options.study.fill_rule + ", traversal " + options.study.traversal
                                : "engine " + options.engine;
  write_files(options, rendering, config, title);
  const bool is_partial = is_interrupted();
  finish_json(options, result, start, is_partial);
  print_result(options, config, rendering, facts, result);
  return ended(human(options), is_partial, exit_ok);
}

}  // namespace

void add_render_command(CLI::App& app, Action& selected) {
  const auto [command, options] = add_command<RenderCommand>(app, selected, "render", "one image from one engine", run);
  add_scene_options(*command, *options);
  command
      ->add_option("--engine", options->engine,
                   "functional (fast), scalar (the stages, one packet at a time), cycle (with the cycles of the "
                   "hardware), rtl (the Verilated hardware itself), golden, golden32")
      ->capture_default_str();
  add_study_options(*command, options->study);
  add_clipping_option(*command, options->study);
  add_interpolation_option(*command, options->study);
  add_cycle_options(*command, options->cycle);
  add_file_option(*command, "-o", options->color_path, "colour picture, .png", ".png");
  add_file_option(*command, "--depth", options->depth_path, "depth codes, .npy or (up to 16 bits) .png");
  add_file_option(*command, "--count", options->count_path, "covered samples per pixel before the depth test, .npy",
                  ".npy");
  add_file_option(*command, "--ids", options->ids_path, "visible primitive per pixel, -1 for none, .npy", ".npy");
  add_file_option(*command, "--draws", options->draws_path,
                  "sheet: the picture, and how often each sample was drawn, .png", ".png");
  command
      ->add_option("--supersample", options->supersample,
                   "NxN or NxN:rotated: the mean of N*N pictures, each moved by a part of a pixel; depth and ids are "
                   "those of the first, counts the sum of all")
      ->type_name("GRID");
  command->add_option("--repeat", options->repeat, "render N more times and print min and median")
      ->check(whole_number(1, 100000));
  add_frames_options(*command, *options);
  command->footer(
      "\nExample:\n  halfplane render teapot --size 1280x720 -o teapot.png --depth teapot.npy --json\n"
      "  halfplane render city --engine cycle --what-if cache.lines=16,64,256 --trace city.json\n"
      "  halfplane render teapot --size 160x120 --frames 12 --camera orbit --engine cycle --csv turn.csv");
}

}  // namespace halfplane
