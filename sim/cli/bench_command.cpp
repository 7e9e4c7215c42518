// halfplane bench: run time against error, engine by engine, configuration by configuration; the savings of skipping,
// and the growth of the cost.
#include <algorithm>
#include <chrono>
#include <iostream>
#include <map>
#include <memory>
#include <optional>
#include <sstream>
#include <thread>
#include <tuple>

#include "sim/cli/bench_study.hpp"
#include "sim/cli/commands.hpp"
#include "sim/cli/option_kinds.hpp"
#include "sim/cli/progress.hpp"
#include "sim/cli/space_study.hpp"
#include "sim/config_file.hpp"
#include "sim/interrupt.hpp"
#include "sim/show/report/page.hpp"
#include "sim/study/bench/engines.hpp"
#include "sim/study/space/gates.hpp"
#include "sim/words.hpp"

namespace halfplane {
namespace {

/// --vary: a key and its values.
struct Variation {
  std::string key;
  std::vector<std::string> values;
};

struct BenchCommand : CommonOptions {
  std::vector<std::string> scenes;
  std::vector<std::string> engines;  ///< empty: the default, without a message about engines that do not fit
  std::vector<std::string> variations;
  std::vector<int> thread_counts{1};
  int repeat = 5;
  bool has_no_errors = false, wants_skips = false, wants_growth = false, wants_all = false, wants_antialiasing = false;
  std::size_t growth_max = 1'000'000;
  std::string page;
  SpaceOptions space;

  [[nodiscard]] bool wants_rows() const { return wants_all || !(wants_skips || wants_growth); }
};

std::vector<Variation> parse_variations(const std::vector<std::string>& texts, const Config& config) {
  std::vector<Variation> variations;
  for (const std::string& text : texts) {
    const std::string shown = "--vary: '" + text + "'";
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals + 1 == text.size())
      throw InputError(shown + " names no values; give KEY=VALUE,VALUE... as in subpixel.bits=0,4,8");
    Variation variation{text.substr(0, equals), split(text.substr(equals + 1), ',')};
    for (const std::string& value : variation.values) {
      if (value.empty()) throw InputError(shown + " has an empty value; give KEY=VALUE,VALUE...");
      if (std::count(variation.values.begin(), variation.values.end(), value) > 1)
        throw InputError(shown + " names the value " + value + " twice; give every value once");
      Config trial = config;
      set_by_key(trial, variation.key, value);  // throws for an invalid value
    }
    for (const Variation& other : variations)
      if (other.key == variation.key)
        throw InputError("--vary: " + other.key + " is varied twice; give all of its values at once");
    variations.push_back(std::move(variation));
  }
  return variations;
}

struct VariedConfig {
  Config config;
  std::string name;  ///< "depth.bits=24 tile.size=16"; empty for the base configuration
};

/// Every combination of the values, after the base configuration if it is wanted; combinations that no hardware
/// supports are left out.
std::vector<VariedConfig> varied_configs(const Config& base, const std::vector<Variation>& variations, bool has_base) {
  std::vector<VariedConfig> product{{base, ""}};
  for (const Variation& variation : variations) {
    std::vector<VariedConfig> next;
    for (const VariedConfig& one : product)
      for (const std::string& value : variation.values) {
        VariedConfig varied = one;
        set(varied.config, variation.key, value);
        varied.name += (one.name.empty() ? "" : " ") + variation.key + "=" + value;
        next.push_back(std::move(varied));
      }
    product = std::move(next);
  }
  std::vector<VariedConfig> configs;
  if (has_base) configs.push_back({base, ""});
  for (VariedConfig& one : product) {
    if (has_base && one.config == base) continue;
    try {
      validate(one.config);
      configs.push_back(std::move(one));
    } catch (const InputError& error) {
      std::cerr << "halfplane: left out: " << one.name << ": " << error.what() << '\n';
    }
  }
  return configs;
}

/// Loads a scene once for all configurations that load it equally.
class BenchScenes {
 public:
  explicit BenchScenes(const BenchCommand& options) : options_(options) {}

  std::shared_ptr<const Scene> get(const std::string& name, const Config& config) {
    // The inputs of load_scene(): the mapping, and the target if no size was given.
    const auto key = std::tuple(name, config.depth_mapping, config.target_width, config.target_height);
    auto& scene = scenes_[key];
    if (!scene) scene = load(name, config, options_.cull_objects).scene;
    return scene;
  }

  [[nodiscard]] SkipScene load(const std::string& name, const Config& config, const std::string& cull_objects) const {
    CommonOptions one = options_;
    one.scene = name;
    one.cull_objects = cull_objects;
    double load_s = 0;
    ObjectCounts objects;
    SkipScene loaded;
    loaded.scene = std::make_shared<const Scene>(load_scene(one, config, load_s, &objects));
    loaded.primitives_culled = objects.primitives_skipped;
    return loaded;
  }

 private:
  const BenchCommand& options_;
  std::map<std::tuple<std::string, DepthMapping, int, int>, std::shared_ptr<const Scene>> scenes_;
};

std::vector<BenchCase> bench_cases(const BenchCommand& options, const std::vector<VariedConfig>& configs) {
  BenchScenes scenes(options);
  std::vector<BenchCase> cases;
  const std::vector<std::string> defaults{"teapot", "city"};
  for (const std::string& name : options.scenes.empty() ? defaults : options.scenes)
    for (const VariedConfig& varied : configs) {
      try {
        cases.push_back({name, scenes.get(name, varied.config), varied.config, varied.name});
      } catch (const InputError& error) {
        if (varied.name.empty() || configs.size() == 1) throw;  // the scene itself is invalid
        std::cerr << "halfplane: left out: " << name << ", " << varied.name << ": " << error.what() << '\n';
      }
    }
  return cases;
}

void measure_bench_rows(const BenchCommand& options, const std::vector<VariedConfig>& configs, BenchStudy& study) {
  study.cases = bench_cases(options, configs);
  Progress progress(options, "measuring");
  BenchPlan plan;
  plan.engines = options.engines;
  if (plan.engines.empty()) plan.engines = {"functional", "scalar", "golden", "cycle"};
  plan.threads = options.thread_counts;
  plan.repeat = options.repeat;
  plan.wants_errors = !options.has_no_errors;
  plan.progress = [&progress](double fraction) { progress(fraction); };
  plan.poll = stop_if_interrupted;
  plan.left_out = [&options](const std::string& engine, const std::string& line) {
    if (engine == "cycle" && options.engines.empty()) return;
    std::cerr << "halfplane: left out: " << line << '\n';
  };
  study.rows = measure_rows(study.cases, plan);
}

void measure_bench_skips(const BenchCommand& options, const Config& config, BenchStudy& study) {
  Progress progress(options, "measuring what skipping saves");
  const BenchScenes scenes(options);
  SkipPlan plan;
  plan.config = config;
  const Size size = options.size.empty() ? Size{640, 480} : parse_size(options.size);
  plan.width = std::min(size.width, config.target_width);
  plan.height = std::min(size.height, config.target_height);
  plan.threads = options.thread_counts.front();
  plan.repeat = options.repeat;
  if (!options.wants_all) plan.scenes = options.scenes;
  plan.load = [&](const std::string& name, bool culls) { return scenes.load(name, config, culls ? "box" : "none"); };
  plan.open = [&](const std::string& name, bool has_nodes) {
    auto one = std::make_shared<CommonOptions>(options);
    one->scene = name;
    one->cull_objects = "box";
    one->leaves_out = one->has_tree = has_nodes;
    const auto source = std::make_shared<const MovingScene>(open_scene(*one, config));
    const Moment moment = moment_of(*one);
    return SkipMaker{[=] { return prepared(source->at(moment), *one, config); },
                     [=] { return source->work ? source->work->vertices_skipped : 0; }};
  };
  plan.progress = [&progress](double fraction) { progress(fraction); };
  study.skips = measure_skips(plan);
}

void measure_bench_growth(const BenchCommand& options, const Config& config, BenchStudy& study) {
  Progress progress(options, "measuring how cost grows");
  GrowthPlan plan;
  plan.config = config;
  plan.threads = options.thread_counts.front();
  plan.repeat = options.repeat;
  plan.most_threads = static_cast<int>(std::clamp(std::thread::hardware_concurrency(), 1U, 64U));
  plan.most_triangles = options.growth_max;
  plan.progress = [&progress](double fraction) { progress(fraction); };
  plan.left_out = [](const std::string& line) { std::cerr << "halfplane: left out: " << line << '\n'; };
  study.growth = measure_growth(plan);
}

// Checks everything that can be refused before a scene is read.
void check_bench_options(const BenchCommand& options) {
  for (const std::string& engine : options.engines) {
    if (std::find(kBenchEngines.begin(), kBenchEngines.end(), engine) == kBenchEngines.end())
      throw InputError("--engines: no engine '" + engine +
                       "'; give some of functional, scalar, golden, cycle, rtl, llvmpipe");
    if (std::count(options.engines.begin(), options.engines.end(), engine) > 1)
      throw InputError("--engines: " + engine + " is named twice; give every engine once");
  }
  for (const int threads : options.thread_counts)
    if (std::count(options.thread_counts.begin(), options.thread_counts.end(), threads) > 1)
      throw InputError("--threads: " + std::to_string(threads) + " is named twice; give every number once");
  if (!options.wants_rows() && !(options.engines.empty() && options.variations.empty()))
    throw InputError(
        "--skips and --growth measure the functional engine only; leave out --engines and --vary, or add --all");
  const bool is_space = options.space.is_wanted();
  if (is_space && (options.wants_all || options.wants_skips || options.wants_growth || !options.engines.empty()))
    throw InputError("--area and --space measure the hardware; leave out --engines, --skips, --growth and --all");
  if (options.wants_antialiasing &&
      (options.wants_all || options.wants_skips || options.wants_growth || !options.scenes.empty() ||
       !options.engines.empty() || !options.variations.empty() || options.space.wants_more_than_area()))
    throw InputError(
        "--antialiasing has scenes and engines of its own; only --area and -o go with it: leave the others out");
  check_space_options(options, options.space, options.page);
  if (!options.page.empty()) require_chart_library();
}

/// The command that repeats the measurement.
std::string bench_command_line(const BenchCommand& options) {
  std::string text = "halfplane bench";
  for (const std::string& scene : options.scenes) text += " " + quoted(scene);
  if (!options.engines.empty()) text += " --engines " + joined(options.engines, ",");
  if (options.config != "embedded") text += " --config " + quoted(options.config);
  for (const std::string& setting : options.settings) text += " --set " + quoted(setting);
  for (const std::string& variation : options.variations) text += " --vary " + quoted(variation);
  if (!options.size.empty()) text += " --size " + options.size;
  std::string threads;
  for (const int n : options.thread_counts) threads += (threads.empty() ? "" : ",") + std::to_string(n);
  if (threads != "1") text += " --threads " + threads;
  text += " --repeat " + std::to_string(options.repeat);
  if (options.seed != 1) text += " --seed " + std::to_string(options.seed);
  if (options.has_no_errors) text += " --no-errors";
  if (options.wants_all) text += " --all";
  if (!options.wants_all && options.wants_skips) text += " --skips";
  if (!options.wants_all && options.wants_growth) text += " --growth";
  if (options.growth_max != BenchCommand{}.growth_max) text += " --growth-max " + std::to_string(options.growth_max);
  return text + space_arguments(options.space) + (options.page.empty() ? "" : " -o " + quoted(options.page));
}

Json bench_head(const BenchCommand& options, const Config& config, const BenchStudy& study = {}) {
  Json result = result_head("bench", options, config);
  result["seed"] = options.seed;
  result["repeat"] = options.repeat;
  result["label"] = label(config);
  add_bench_json(result, study);
  return result;
}

/// --area, --space, --slurm, --collect.
int run_space(const BenchCommand& options, const Config& config, std::chrono::steady_clock::time_point start) {
  SpaceStudy study;
  study.page = options.page;
  study.command = bench_command_line(options);
  study.result = bench_head(options, config);
  study.result["memory"] = memory_json(options.space.memory);
  study.result["points"] = Json::array();
  if (!options.space.collect.empty()) {
    collect_space(options.space, study);
  } else {
    const auto configs = varied_configs(config, parse_variations(options.variations, config), false);
    const std::vector<BenchCase> cases = bench_cases(options, configs);
    if (!options.space.slurm.empty()) {
      const auto arguments = [&](const BenchCase& at) {
        std::string text = scene_arguments(options, config) + " --seed " + std::to_string(options.seed);
        std::istringstream settings(at.variation);
        for (std::string setting; settings >> setting;) text += " --vary " + halfplane::quoted(setting);
        return text;
      };
      write_cluster(options, options.space, cases, arguments, study);
      return exit_ok;
    }
    measure_space(options, options.space, cases, study);
  }
  study.result["wall_s"] = seconds_since(start);
  if (study.is_partial) mark_partial(study.result);
  finish_space(options, options.space, study);
  return study.is_partial ? exit_interrupted : exit_ok;
}

int run_antialiasing(const BenchCommand& options, const Config& config, std::chrono::steady_clock::time_point start) {
  require_one_sample(config, "bench --antialiasing sets samples itself and");
  Json result = bench_head(options, config);
  std::optional<Gates> gates;
  if (options.space.wants_area) gates.emplace(options.space.rtl, options.space.cache, std::vector<std::string>{"ecp5"});
  measure_antialiasing(options, config, options.repeat, gates ? &*gates : nullptr, result);
  if (!options.page.empty()) write_antialiasing_page(options.page, result, bench_command_line(options));
  finish_json(options, result, start);
  return exit_ok;
}

int run_bench(const BenchCommand& options) {
  const auto start = std::chrono::steady_clock::now();
  const Config config = effective_config(options);
  check_bench_options(options);
  if (options.wants_antialiasing) return run_antialiasing(options, config, start);
  if (options.space.is_wanted()) return run_space(options, config, start);
  const auto configs = varied_configs(config, parse_variations(options.variations, config), true);
  BenchStudy study;
  if (options.wants_rows()) measure_bench_rows(options, configs, study);
  if ((options.wants_skips || options.wants_all) && !is_interrupted()) measure_bench_skips(options, config, study);
  if ((options.wants_growth || options.wants_all) && !is_interrupted()) measure_bench_growth(options, config, study);
  const bool is_partial = is_interrupted();

  Json result = bench_head(options, config, study);
  result["wall_s"] = seconds_since(start);
  if (is_partial) mark_partial(result);
  write_bench_page(options.page, result, bench_command_line(options));
  write_json(options, result);
  std::ostream& out = human(options);
  out << label(config);
  if (!study.cases.empty()) out << ", " << study.cases[0].scene->width << "x" << study.cases[0].scene->height;
  out << ", median of " << options.repeat << (options.repeat == 1 ? " frame" : " frames") << ", in turns\n";
  print_bench(out, study);
  return ended(out, is_partial, exit_ok);
}

}  // namespace

void add_bench_command(CLI::App& app, Action& selected) {
  const auto [command, options] =
      add_command<BenchCommand>(app, selected, "bench", "run time against error, engine by engine", run_bench);
  command->add_option("SCENES", options->scenes, "names or files (default: teapot city)")->each(claim_input);
  add_output_options(*command, *options);
  command->add_option("--engines", options->engines, "some of functional, scalar, golden, cycle, rtl, llvmpipe")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->default_str("functional,scalar,golden,cycle")
      ->type_name("LIST");
  command
      ->add_option("--vary", options->variations,
                   "KEY=VALUE,VALUE...: every value besides what is set, repeatable; all combinations")
      ->allow_extra_args(false)
      ->type_name("KEY=LIST");
  command
      ->add_option(
          "--threads", options->thread_counts,
          "numbers of threads: a row of each, for functional, cycle and llvmpipe; the first for --skips and --growth")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(whole_number(1, 1024))
      ->default_str("1")
      ->type_name("LIST");
  add_text_option(*command, "--size", options->size, "target, WxH pixels")->default_str("fits the target");
  add_number_option(*command, "--repeat", options->repeat, 1, 1000,
                    "measurements after the first; their median counts");
  add_seed_option(*command, *options, "seed of scenes with random parts");
  command->add_flag("--no-errors", options->has_no_errors, "only the time: no comparison with the golden");
  command->add_flag("--skips", options->wants_skips,
                    "instead: the savings of each kind of skipping, on SCENES, or on scenes made for it and others");
  command->add_flag("--growth", options->wants_growth,
                    "instead: time by triangle size, triangle count, depth complexity, resolution and threads");
  add_number_option(*command, "--growth-max", options->growth_max, 100, 10'000'000,
                    "triangles of the largest frame of --growth");
  command->add_flag(
      "--antialiasing", options->wants_antialiasing,
      "instead: error against the exact area of triangles in pixels, and time, cycles and bytes, of 1 to 8 samples a "
      "pixel, supersampling and smooth lines; with --area gates, too");
  command->add_flag("--all", options->wants_all, "rows of SCENES, and --skips and --growth on scenes of their own");
  add_space_options(*command, options->space);
  add_file_option(*command, "-o", options->page, "everything as one HTML page, .html", ".html");
  command->footer(
      "\nExamples:\n  halfplane bench teapot --vary subpixel.bits=0,4,8 --vary depth.bits=16,24 -o bench.html\n  "
      "halfplane "
      "bench city --size 1280x720 --engines functional,cycle --threads 1,2\n  halfplane bench city --area --vary "
      "depth.bits=16,24 --vary "
      "stamp.size=1,2,4 -o space.html");
}

}  // namespace halfplane
