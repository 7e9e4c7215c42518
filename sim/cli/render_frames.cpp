#include "sim/cli/render_frames.hpp"

#include <algorithm>
#include <iostream>

#include "model/engines/functional.hpp"
#include "sim/cli/progress.hpp"
#include "sim/scene/capture_frames.hpp"
#include "sim/show/image/framebuffer_files.hpp"
#include "sim/show/image/whole_file.hpp"
#include "sim/show/report/page.hpp"

namespace halfplane {
namespace {

constexpr int kMostFrames = 100'000;

/// A frame to be drawn.
struct PlannedFrame {
  Moment moment;
  std::function<Scene()> scene;
  bool is_of_capture = false;
  bool goes_on = false;  ///< on the picture of the frame before
};

/// One frame's figures, in the order of the columns of --csv.
Json frame_row(int frame, const Moment& moment, const Rendering& rendering, const CycleFacts& facts,
               const RenderCommand& options, const Config& config) {
  Json row{{"frame", frame}, {"time", moment.time}, {"turn", moment.turn}};
  row.update(counters_json(rendering.counters));
  const bool is_hardware = options.engine == "cycle" || options.engine == "rtl";
  row["bins"] = is_hardware ? Json(rendering.counters.bins) : Json(nullptr);
  row["pairs"] = is_hardware ? Json(rendering.counters.pairs) : Json(nullptr);
  row["time_s"] = {{"geometry", rendering.geometry_s}, {"raster", rendering.raster_s}};
  row["cycles"] = options.engine == "rtl" ? Json(facts.rtl.cycles)
                  : facts.cycle           ? Json(facts.cycle->frame.run.cycles)
                                          : Json(nullptr);
  row["bytes"] =
      facts.cycle ? Json(traffic(facts.cycle->frame.run, facts.cycle->hardware.config).total()) : Json(nullptr);
  row["color_hash"] = color_hash(rendering.frame, config.color_format);
  row["depth_hash"] = config.frame_store == FrameStore::color ? Json(nullptr) : Json(depth_hash(rendering.frame));
  return row;
}

/// Throws InputError if a frame draws on the picture of the previous frame, and the engine no longer has it.
void refuse_to_go_on(const RenderCommand& options, std::size_t frame) {
  const bool keeps = options.engine == "functional" || options.engine == "scalar";
  if (keeps && options.supersample.empty()) return;
  const std::string number = std::to_string(frame);
  throw InputError(options.scene + ": frame " + number + " draws on the picture of frame " + std::to_string(frame - 1) +
                   " (it does not begin by clearing every buffer that it reads), which " +
                   (keeps ? "--supersample" : "the engine " + options.engine) +
                   " does not keep; begin it with `clear color ... depth ...`, or use --engine functional or scalar" +
                   (keeps ? " without --supersample" : ""));
}

/// The first frames of a capture, or all of them.
std::vector<PlannedFrame> capture_frames(const RenderCommand& options, Scene scene) {
  const auto whole = std::make_shared<const Scene>(std::move(scene));
  std::vector<FrameCommands> parts = frames_of(*whole);
  const std::string count = std::to_string(parts.size());
  if (options.frames > 0 && static_cast<std::size_t>(options.frames) > parts.size())
    throw InputError("--frames " + std::to_string(options.frames) + ": " + options.scene + " has " + count +
                     (parts.size() == 1 ? " frame" : " frames") +
                     "; give at most so many, or all, or more `frame` lines");
  if (parts.size() > kMostFrames)
    throw InputError("--frames: " + options.scene + " has " + count + " frames; give at most " +
                     std::to_string(kMostFrames));
  if (options.frames > 0) parts.resize(static_cast<std::size_t>(options.frames));
  std::vector<PlannedFrame> frames;
  for (const FrameCommands& part : parts) {
    const bool has_picture_before = !frames.empty() && goes_on(*whole, part);
    if (has_picture_before) refuse_to_go_on(options, frames.size());
    frames.push_back({{}, [whole, part] { return frame_scene(*whole, part); }, true, has_picture_before});
  }
  return frames;
}

/// The frames of an animation, with their moments.
std::vector<PlannedFrame> moving_frames(const RenderCommand& options, const MovingScene& source) {
  if (options.frames == kAllFrames)
    throw InputError("--frames all: that is for captures, and " + options.scene + " is none; give a number");
  std::optional<TimeSpan> time = parse_time(options.time);
  if (const std::optional<double> end = time ? std::nullopt : source.end()) time = TimeSpan{0, *end};
  if (!time && !source.has_orbit)
    throw InputError("--frames: nothing moves in " + options.scene +
                     "; add --camera orbit, or give a glTF file with an animation");
  std::vector<PlannedFrame> result;
  for (int i = 0; i < options.frames; ++i) {
    Moment moment;
    moment.turn = static_cast<double>(i) / options.frames;
    if (time) moment.time = time->from + (time->to.value_or(time->from) - time->from) * moment.turn;
    result.push_back({moment, [&source, moment] { return source.at(moment); }});
  }
  return result;
}

/// The options of one frame: its own files.
RenderCommand options_of(const RenderCommand& options, int frame, int frames) {
  RenderCommand own = options;
  for (std::string* path : {&own.color_path, &own.depth_path, &own.count_path, &own.ids_path, &own.draws_path,
                            &own.cycle.primitives_path, &own.cycle.trace_path, &own.cycle.heat_path})
    *path = numbered(*path, frame, frames);
  return own;
}

/// Draws frame after frame. An engine that skips bins is kept over all frames, like hardware; other engines begin each
/// frame with an empty target.
class FrameDrawer {
 public:
  FrameDrawer(const RenderCommand& options, const Config& config) : options_(options) {
    if (!is_picture_alone(options) || study_rules(options.study) != StudyRules{} || !options.supersample.empty())
      return;
    if (options.engine == "functional") functional_.emplace(config);
    if (!compares_bins(config)) return;
    if (options.engine == "cycle") {
      hardware_ = hardware_of(options.cycle, config);
      CycleOptions cycle;
      cycle.stalls = {options.seed, stall_threshold(options.cycle.stalls)};
      cycle.parameters = hardware_->parameters;
      cycle.textures = hardware_->memory;
      memory_ = make_memory(hardware_->memory, hardware_->config);
      cycle_.emplace(hardware_->config, *memory_, cycle);
    } else if (options.engine == "rtl") {
      dut_ = make_dut(find_dut(config));
      rtl_.emplace(*dut_, config);
    }
  }

  /// `onto`: the picture to draw on; null: an empty one. `keeps_samples`: as run_engine().
  Rendering draw(const RenderCommand& own, const Scene& scene, const Config& config, CycleFacts& facts,
                 const std::function<void(double)>& progress, const Framebuffer* onto, bool keeps_samples) {
    if (!functional_ && !cycle_ && !rtl_) return run_engine(own, scene, config, &facts, progress, onto, keeps_samples);
    RenderOptions render;
    render.skip = parse_skip(options_.skip);
    render.progress = progress;
    render.threads = options_.threads;
    render.follows = onto == nullptr;
    render.onto = onto;
    if (functional_) return functional_->render(scene, render);
    if (rtl_) {
      RtlRendering rtl = rtl_->draw(scene, render);
      facts.rtl = rtl.run;
      return std::move(rtl.rendering);
    }
    facts.cycle = CycleResult{*hardware_, options_.cycle.stalls, cycle_->draw(scene, render), {}, {}, {}, false, {}};
    return facts.cycle->frame.rendering;
  }

 private:
  /// Whether no requested output needs every draw of the frame.
  [[nodiscard]] static bool is_picture_alone(const RenderCommand& options) {
    const CycleCommandOptions& cycle = options.cycle;
    return options.count_path.empty() && options.ids_path.empty() && options.draws_path.empty() &&
           cycle.primitives_path.empty() && cycle.trace_path.empty() && cycle.heat_path.empty() &&
           cycle.misses_path.empty();
  }

  const RenderCommand& options_;
  std::optional<FunctionalEngine> functional_;
  std::optional<Hardware> hardware_;
  std::unique_ptr<MemoryTiming> memory_;
  std::optional<CycleFrames> cycle_;
  std::unique_ptr<Dut> dut_;
  std::optional<RtlFrames> rtl_;
};

/// "bins        4,120 left alone: they held what was to be drawn in them"
void print_bins(std::ostream& out, const Json& rows) {
  std::uint64_t left = 0;
  for (const Json& row : rows) left += row["skipped"]["bins"].get<std::uint64_t>();
  if (left == 0) return;
  out << "bins        " << with_commas(left) << " left alone: they held what was to be drawn in them\n";
}

}  // namespace

std::string csv_text(const Json& rows) {
  std::string text;
  for (const Json& row : rows) {
    std::string names, values;
    const Json cells = row.flatten();
    for (const auto& [pointer, value] : cells.items()) {
      std::string name = pointer.substr(1);
      std::replace(name.begin(), name.end(), '/', '.');
      names += (names.empty() ? "" : ",") + name;
      values += (values.empty() ? "" : ",") + (value.is_string() ? value.get<std::string>()
                                               : value.is_null() ? std::string()
                                                                 : value.dump());
    }
    if (text.empty()) text = names + "\n";
    text += values + "\n";
  }
  return text;
}

void print_range(std::ostream& out, const std::string& name, std::vector<std::uint64_t> values) {
  std::sort(values.begin(), values.end());
  out << left_aligned(name, 12) << "least " << with_commas(values.front()) << ", median "
      << with_commas(values[values.size() / 2]) << ", most " << with_commas(values.back()) << " a frame\n";
}

void add_frames_options(CLI::App& app, RenderCommand& options) {
  const auto number = [range = CLI::Range(1, kMostFrames)](std::string& word) {
    if (word != "all") return range(word);
    word = std::to_string(kAllFrames);
    return std::string();
  };
  app.add_option("--frames", options.frames,
                 "N pictures of a moving scene: --time A..B of its animation (default: all of it), --camera orbit; or "
                 "the first N frames of a capture with `frame` lines, or all of them; files are numbered")
      ->transform(CLI::Validator(number, "N or all"));
  add_file_option(app, "--csv", options.csv_path, "of --frames: a row of figures for each, .csv", ".csv");
  add_file_option(app, "--chart", options.chart_path, "of --frames: the figures over time, .html", ".html");
}

void check_frames(const RenderCommand& options) {
  (void)parse_time(options.time);
  if (options.frames == 0) {
    if (!options.csv_path.empty() || !options.chart_path.empty())
      throw InputError("--csv and --chart: figures of several frames; add --frames N");
    return;
  }
  if (options.repeat > 0 || options.cycle.explain || !options.cycle.what_if.empty())
    throw InputError("--frames: each frame is drawn once; leave out --repeat, --explain and --what-if");
  for (const std::string* path :
       {&options.color_path, &options.depth_path, &options.count_path, &options.ids_path, &options.draws_path})
    if (*path == "-") throw InputError("--frames: several files do not fit on stdout; give a name in place of -");
  if (!options.chart_path.empty()) require_chart_library();
}

std::string numbered(const std::string& path, int frame, int frames) {
  if (path.empty() || path == "-") return path;
  const std::size_t width = std::max<std::size_t>(4, std::to_string(frames - 1).size());
  const std::string digits = std::to_string(frame);
  const std::size_t dot = path.rfind('.');
  const bool has_extension = dot != std::string::npos && path.find('/', dot) == std::string::npos;
  const std::size_t end = has_extension ? dot : path.size();
  return path.substr(0, end) + "-" + std::string(width - digits.size(), '0') + digits + path.substr(end);
}

int run_frames(const RenderCommand& options, const Config& config) {
  const auto start = std::chrono::steady_clock::now();
  const MovingScene source = open_scene(options, config);
  const bool is_of_capture = is_capture(options.scene) && parse_time(options.time) == std::nullopt && !source.has_orbit;
  const std::vector<PlannedFrame> all =
      is_of_capture ? capture_frames(options, source.at({})) : moving_frames(options, source);
  const int frames = static_cast<int>(all.size());
  Json rows = Json::array();
  int width = 0, height = 0;
  FrameDrawer drawer(options, config);
  Rendering rendering;  // rendering of the previous frame
  try {
    Progress progress(options, "rendering", "frames");
    for (int i = 0; i < frames; ++i) {
      const auto part = [&](double fraction) { progress((i + fraction) / frames, static_cast<std::uint64_t>(i)); };
      part(0);
      const PlannedFrame& frame = all[static_cast<std::size_t>(i)];
      const RenderCommand own = options_of(options, i, frames);
      const auto scene_start = std::chrono::steady_clock::now();
      ObjectCounts objects;
      const Scene scene = interpolated(prepared(frame.scene(), options, config, &objects), options.study.interpolation);
      add_work(objects, source);
      const double scene_s = seconds_since(scene_start);
      CycleFacts facts;
      rendering =
          drawer.draw(own, scene, config, facts, part, frame.goes_on ? &rendering.frame : nullptr, frame.is_of_capture);
      width = scene.width;
      height = scene.height;
      write_files(own, rendering, config, "frame " + std::to_string(i) + ", engine " + options.engine);
      rows.push_back(frame_row(i, frame.moment, rendering, facts, options, config));
      if (frame.is_of_capture) rows.back()["goes_on"] = frame.goes_on;
      rows.back()["objects"] = objects;
      rows.back()["time_s"]["scene"] = scene_s;
    }
  } catch (const Interrupted&) {  // the frames so far count
    if (rows.empty()) throw;
  }
  Json result = result_head("frames", options, config);
  result["engine"] = options.engine;
  result["width"] = width;
  result["height"] = height;
  result["frames"] = rows;
  result["wall_s"] = seconds_since(start);
  const bool is_partial = is_interrupted();
  if (is_partial) mark_partial(result);
  if (!options.csv_path.empty()) write_text_file(options.csv_path, csv_text(rows));
  if (!options.chart_path.empty()) write_page(options.chart_path, kFramesPage, result);
  write_json(options, result);
  std::ostream& out = human(options);
  out << options.scene << ", " << width << "x" << height << ", " << label(config) << ", engine " << options.engine
      << ", seed " << options.seed << '\n'
      << "frames      " << rows.size() << " in " << fixed(result["wall_s"].get<double>(), 2) << " s";
  if (all.front().moment.time)
    out << ", time " << fixed(*all.front().moment.time, 3) << " to " << fixed(*all.back().moment.time, 3) << " s";
  out << '\n';
  for (const char* key : {"cycles", "bytes"}) {
    if (rows[0][key].is_null()) continue;
    std::vector<std::uint64_t> values;
    for (const Json& row : rows) values.push_back(row[key].get<std::uint64_t>());
    print_range(out, key, std::move(values));
  }
  print_bins(out, rows);
  if (!options.color_path.empty())
    out << "pictures    " << numbered(options.color_path, 0, frames) << " to "
        << numbered(options.color_path, static_cast<int>(rows.size()) - 1, frames) << '\n';
  return ended(out, is_partial, exit_ok);
}

}  // namespace halfplane
