#include "sim/cli/options.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <iostream>

#include "sim/config_file.hpp"
#include "sim/image/whole_file.hpp"
#include "sim/scene/load.hpp"

namespace halfplane {
namespace {

struct Size {
  int width = 0, height = 0;
};

Size parse_size(const std::string& text) {
  if (text.empty()) return {};
  Size size;
  char x = 0, rest = 0;
  if (std::sscanf(text.c_str(), "%6d%c%6d%c", &size.width, &x, &size.height, &rest) != 3 || (x != 'x' && x != 'X') ||
      size.width < 1 || size.height < 1)
    throw InputError("--size: '" + text + "' is not a size; give WIDTHxHEIGHT of at least 1x1, as in 640x480");
  return size;
}

bool is_capture(const std::string& name) { return name.size() > 4 && name.substr(name.size() - 4) == ".hpt"; }

struct SkipName {
  const char* name;
  bool Skip::*member;
};
constexpr SkipName kSkipNames[] = {{"frustum", &Skip::frustum},
                                   {"empty", &Skip::empty},
                                   {"tiles_outside", &Skip::tiles_outside},
                                   {"trivially_accepted", &Skip::trivially_accepted},
                                   {"fragments_early_z", &Skip::fragments_early_z}};

}  // namespace

void add_output_options(CLI::App& app, CommonOptions& options) {
  app.add_option("--config", options.config, "preset (tiny, embedded, full) or FILE.toml")->capture_default_str();
  app.add_option("--set", options.settings, "key=value: one setting, repeatable (halfplane config --list)")
      ->allow_extra_args(false);
  app.add_flag("--json{-}", options.json, "result as JSON on stdout, human text on stderr; --json=FILE: to a file");
  app.add_flag("--quiet", options.quiet, "no human text");
}

void add_scene_options(CLI::App& app, CommonOptions& options) {
  app.add_option("SCENE", options.scene, "built-in name (halfplane scenes), .obj or .hpt file")->required();
  add_output_options(app, options);
  app.add_option("--size", options.size, "target, WxH pixels (default 640x480, or what a capture says)");
  app.add_option("--camera", options.camera,
                 "'eye=0,1,3;target=0,0,0;up=0,1,0;fov=45;near=.1;far=100' or 'ortho=HEIGHT'");
  app.add_option("--seed", options.seed, "seed of scenes with something random in them")->capture_default_str();
  app.add_option("--threads", options.threads, "use at most N threads (this version uses one)")
      ->check(CLI::Range(1, 1024));
  app.add_option("--skip", options.skip, "work that may be skipped: all, none or a list with commas")
      ->capture_default_str();
  app.add_option("--convention", options.convention, "gl: pixel centres at halves, origin top left, clip z -w...w")
      ->capture_default_str();
}

Config effective_config(const CommonOptions& options) {
  Config config = config_from_option(options.config);
  for (const std::string& setting : options.settings) {
    const auto equals = setting.find('=');
    if (equals == std::string::npos)
      throw InputError("--set: '" + setting + "' has no '='; give key=value, as in depth.bits=20");
    set(config, setting.substr(0, equals), setting.substr(equals + 1));
  }
  validate(config);
  return config;
}

Skip parse_skip(const std::string& text) {
  if (text == "all") return {};
  Skip skip{false, false, false, false, false};
  if (text == "none") return skip;
  std::string names;
  for (const auto& entry : kSkipNames) names += std::string(names.empty() ? "" : ", ") + entry.name;
  for (std::size_t start = 0; start <= text.size();) {
    const std::size_t end = std::min(text.find(',', start), text.size());
    const std::string name = text.substr(start, end - start);
    const auto* entry = std::find_if(std::begin(kSkipNames), std::end(kSkipNames),
                                     [&name](const SkipName& s) { return name == s.name; });
    if (entry == std::end(kSkipNames))
      throw InputError("--skip: no '" + name + "'; give all, none or some of " + names);
    skip.*entry->member = true;
    start = end + 1;
  }
  return skip;
}

Scene load_scene(const CommonOptions& options, const Config& config, double& load_s) {
  if (options.convention != "gl")
    throw InputError("--convention " + options.convention + " is not in this version; give gl");
  const auto start = std::chrono::steady_clock::now();
  const Size size = parse_size(options.size);
  SceneRequest request{options.scene, size.width, size.height, options.camera, options.seed};
  if (options.size.empty() && !is_capture(options.scene)) {
    request.width = std::min(640, config.target_width);
    request.height = std::min(480, config.target_height);
  }
  std::vector<std::string> warnings;
  Scene scene = load_scene(request, warnings);
  for (const std::string& warning : warnings) std::cerr << "halfplane: warning: " << warning << '\n';
  load_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return scene;
}

Json config_json(const Config& config) {
  Json json{{"preset", config.preset}};
  for (const Setting& setting : settings()) {
    const std::string value = get(config, setting);
    if (std::holds_alternative<int Config::*>(setting.member))
      json[std::string(setting.key)] = std::stoi(value);
    else
      json[std::string(setting.key)] = value;
  }
  return json;
}

Json result_head(const std::string& command, const CommonOptions& options, const Config& config) {
  return Json{{"schema", "halfplane." + command + "/1"},
              {"config", config_json(config)},
              {"scene", options.scene},
              {"seed", options.seed}};
}

std::ostream& human(const CommonOptions& options) {
  static std::ostream null(nullptr);
  return options.quiet ? null : options.json == "-" ? std::cerr : std::cout;
}

void write_json(const CommonOptions& options, const Json& result) {
  if (options.json.empty()) return;
  const std::string text = result.dump(2) + "\n";
  if (options.json == "-") {
    std::cout << text << std::flush;
    if (!std::cout) throw InputError("--json: writing to stdout failed");
    return;
  }
  write_whole_file(options.json, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

Progress::Progress(const CommonOptions& options, std::string what)
    : what_(std::move(what)),
      start_(std::chrono::steady_clock::now()),
      is_enabled_(!options.quiet && isatty(STDERR_FILENO) != 0) {}

Progress::~Progress() {
  if (is_shown_) std::cerr << "\r\033[K" << std::flush;
}

void Progress::operator()(double fraction) {
  if (!is_enabled_ || std::chrono::steady_clock::now() - start_ < std::chrono::seconds(2)) return;
  is_shown_ = true;
  std::cerr << '\r' << what_ << ' ' << static_cast<int>(100 * std::clamp(fraction, 0.0, 1.0)) << " %\033[K"
            << std::flush;
}

std::string with_commas(std::uint64_t value) {
  std::string digits = std::to_string(value);
  for (std::size_t i = digits.size(); i > 3; i -= 3) digits.insert(i - 3, ",");
  return digits;
}

std::string fixed(double value, int decimals) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  return text;
}

}  // namespace halfplane
