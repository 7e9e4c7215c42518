#include "sim/cli/options.hpp"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <sstream>
#include <string_view>

#include "model/as_number.hpp"
#include "model/capture/capture.hpp"
#include "sim/cli/option_kinds.hpp"
#include "sim/cli/progress.hpp"
#include "sim/config_file.hpp"
#include "sim/scene/convention.hpp"
#include "sim/scene/depth_collision.hpp"
#include "sim/scene/depth_mapping.hpp"
#include "sim/scene/host_geometry.hpp"
#include "sim/scene/text_cursor.hpp"
#include "sim/scene/texture_reach.hpp"
#include "sim/show/image/whole_file.hpp"
#include "sim/study/depth/variant.hpp"
#include "sim/words.hpp"

namespace halfplane {
namespace {

/// The option whose file is stdout, if any.
std::string& on_stdout() {
  static std::string option;
  return option;
}

/// Throws InputError when another option names the file, and one of the two writes it.
void claim_file(const std::string& path, bool is_read) {
  static std::vector<std::pair<std::string, bool>> claimed;
  if (path.empty() || path == "-") return;
  for (const auto& [other, other_is_read] : claimed)
    if (other == path && !(is_read && other_is_read))
      throw InputError("two options name the file '" + path + "', and one would replace the other; give each its own");
  claimed.emplace_back(path, is_read);
}

/// The words, each quoted for a shell, the program first.
std::vector<std::string>& typed_words() {
  static std::vector<std::string> words{"halfplane"};
  return words;
}

// Decimal only; CLI11 would read -1, 010 and too large numbers as other numbers.
std::uint64_t parse_seed(const std::string& text) {
  const auto seed = as_number<std::uint64_t>(text);
  if (!seed)
    throw InputError("--seed: '" + text + "' is not a seed; give a whole number from 0 to 18446744073709551615");
  return *seed;
}

}  // namespace

bool is_capture(const std::string& name) { return name == "-" || (name.size() > 4 && name.ends_with(".hpt")); }

void add_result_options(CLI::App& app, CommonOptions& options) {
  app.add_flag("--json{-}", options.json, "result as JSON on stdout, human text on stderr; --json=FILE: to a file")
      ->each([](const std::string& path) { check_output(path); })
      ->each(claim_output("--json"));
  app.add_flag("--quiet", options.quiet, "no human text");
}

void add_output_options(CLI::App& app, CommonOptions& options) {
  app.add_option("--config", options.config, "preset (tiny, small, embedded, full) or FILE.toml")
      ->capture_default_str();
  app.add_option("--set", options.settings, "key=value: one setting, repeatable (halfplane config --list)")
      ->allow_extra_args(false);
  add_result_options(app, options);
}

void add_seed_option(CLI::App& app, CommonOptions& options, const std::string& meaning) {
  const auto set_seed = [&options](const std::string& text) { options.seed = parse_seed(text); };
  app.add_option_function<std::string>("--seed", set_seed, meaning)->default_str("1")->type_name("N");
}

CLI::Option* add_output_option(CLI::App& app, const std::string& name, std::string& path, const std::string& meaning) {
  return add_text_option(app, name, path, meaning, "FILE")->each(claim_output(name));
}

void add_file_option(CLI::App& app, const std::string& name, std::string& path, const std::string& meaning,
                     const std::string& extension) {
  add_output_option(app, name, path, meaning)->each([extension](const std::string& word) {
    check_output(word, extension);
  });
}

std::function<void(std::string)> claim_output(const std::string& option) {
  return [option](const std::string& path) {
    claim_file(path, false);
    if (path != "-") return;
    if (!on_stdout().empty() && on_stdout() != option)
      throw InputError(on_stdout() + " and " + option + " both write to stdout; give one of them a file");
    on_stdout() = option;
  };
}

void claim_input(const std::string& path) { claim_file(path, true); }

void add_scene_options(CLI::App& app, CommonOptions& options) {
  app.add_option("SCENE", options.scene,
                 "built-in name (halfplane scenes), a file: .obj, .gltf, .glb, .hpt, or - for a capture on stdin")
      ->required()
      ->each(claim_input);
  add_output_options(app, options);
  add_text_option(app, "--size", options.size, "target, WxH pixels (default 640x480, or what a capture says)");
  app.add_option("--camera", options.camera,
                 "'eye=0,1,3;target=0,0,0;up=0,1,0;fov=45;near=.1;far=100' or 'ortho=HEIGHT' or "
                 "'name=NAME' for one of a glTF file's own; 'orbit' or 'orbit=DEGREES' turns it about the target");
  add_text_option(app, "--light", options.lights,
                  "a light, repeatable: 'from=X,Y,Z' (its direction), 'at=X,Y,Z;range=R' (its place) or 'eye', each "
                  "with ';color=R,G,B'; 'ambient=R,G,B'; 'phong' next to one of them: computed at fragments; 'off' "
                  "(default: the file's own, else one at the eye; docs/light.md)")
      ->allow_extra_args(false);
  app.add_option("--transform", options.transform,
                 "number format of a mesh's transform, clip, division by w and viewport: binary64, binary32 or s15.16; "
                 "compare shows the error of the smaller ones (docs/light.md)")
      ->capture_default_str();
  add_text_option(app, "--time", options.time,
                  "seconds into the animation of a glTF file (default: the file's rest pose)");
  add_text_option(app, "--animation", options.animation,
                  "which of the file's animations, by name or number (default: the first)");
  add_seed_option(app, options, "seed of scenes with random parts");
  app.add_option("--threads", options.threads, "use at most N threads (functional and cycle engine, depth)")
      ->check(whole_number(1, 1024));
  app.add_option("--skip", options.skip, "work that may be skipped: all, none or a list with commas")
      ->capture_default_str();
  app.add_option("--convention", options.convention,
                 "how the scene is stated: gl, d3d, mit3dcg or fcg (docs/conventions.md); NAME:reversed or "
                 "NAME:standard sets the order of depth")
      ->capture_default_str();
  app.add_option("--cull-objects", options.cull_objects,
                 "leave out objects whose bounding volume is outside the view: none, sphere, box or both")
      ->capture_default_str();
}

Size parse_size(const std::string& text) {
  if (text.empty()) return {};
  Size size;
  char x = 0, rest = 0;
  if (std::sscanf(text.c_str(), "%6d%c%6d%c", &size.width, &x, &size.height, &rest) != 3 || (x != 'x' && x != 'X') ||
      size.width < 1 || size.height < 1)
    throw InputError("--size: '" + text + "' is not a size; give WIDTHxHEIGHT of at least 1x1, as in 640x480");
  return size;
}

double parse_part(const std::string& text, const std::string& option) {
  const bool is_percent = text.ends_with('%');
  const double value =
      as_number<double>(text.substr(0, text.size() - (is_percent ? 1 : 0))).value_or(0) / (is_percent ? 100 : 1);
  if (!(value > 0 && value <= 1))
    throw InputError(option + ": '" + text + "' is not a fraction; give more than 0 and at most 1, as in 0.01 or 1%");
  return value;
}

void check_output(const std::string& path, const std::string& extension) {
  if (path.empty() || path == "-") return;
  namespace fs = std::filesystem;
  std::string end = path.substr(path.size() - std::min(path.size(), extension.size()));
  std::transform(end.begin(), end.end(), end.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (end != extension)
    throw InputError("cannot write '" + path + "': this option writes " + extension +
                     " files; give a name that ends in " + extension);
  std::error_code error;
  const fs::path folder = fs::path(path).parent_path();
  if (!folder.empty() && !fs::is_directory(folder, error))
    throw InputError("cannot write '" + path + "': there is no such folder; create it first");
  if (fs::is_directory(path, error))
    throw InputError("cannot write '" + path + "': it is a folder; choose another file");
}

namespace {

/// Whether depth.bits follow from depth.format, because they are not given.
bool chooses_depth_bits(const CommonOptions& options, const Config& config) {
  const bool is_said =
      options.config.find('.') != std::string::npos ||  // a file
      std::ranges::any_of(options.settings, [](const std::string& s) { return s.starts_with("depth.bits="); });
  return !is_said && config.depth_format.kind != DepthFormat::Kind::plane;
}

}  // namespace

Config effective_config(const CommonOptions& options) {
  Config config = config_from_option(options.config);
  for (const std::string& setting : options.settings) {
    const auto equals = setting.find('=');
    if (equals == std::string::npos)
      throw InputError("--set: '" + setting + "' has no '='; give key=value, as in depth.bits=20");
    set_by_key(config, setting.substr(0, equals), setting.substr(equals + 1));
  }
  validate(config);
  return config;
}

Config drawing_config(const CommonOptions& options) {
  Config config = effective_config(options);
  if (chooses_depth_bits(options, config)) {
    const bool is_linear = is_screen_linear(config.depth_mapping);
    constexpr int kMostOfFastPath = 30;  // under w and log, whose far codes fall between few of the plane's codes
    const int bits = interpolated_bits(config.depth_format, is_linear, is_linear ? 0 : kMostOfFastPath);
    config.depth_bits = is_linear || config.depth_format.is_float() ? bits : std::min(bits, kMostOfFastPath);
  }
  validate(config);
  return config;
}

void warn_of_depth_bits(const CommonOptions& options, const Config& config) {
  if (!options.quiet && chooses_depth_bits(options, config))
    std::cerr << "halfplane: depth.bits=" << config.depth_bits
              << ": chosen for depth.format=" << to_string(config.depth_format)
              << "; --set depth.bits=N overrides it\n";
}

Skip parse_skip(const std::string& text) {
  if (text == "all") return {};
  Skip skip = skip_none();
  if (text == "none") return skip;
  std::vector<std::string_view> names;
  for (const SkipName& entry : kSkipNames) names.emplace_back(entry.name);
  for (const std::string& name : split(text, ',')) {
    const auto* entry = std::find_if(std::begin(kSkipNames), std::end(kSkipNames),
                                     [&name](const SkipName& s) { return name == s.name; });
    if (entry == std::end(kSkipNames))
      throw InputError("--skip: no '" + name + "'; give all, none or some of " + joined(names));
    skip.*(entry->member) = true;
  }
  return skip;
}

std::optional<TimeSpan> parse_time(const std::string& text) {
  if (text.empty()) return std::nullopt;
  const std::size_t dots = text.find("..");
  const std::optional<double> from = parse_number(text.substr(0, dots));
  const std::optional<double> to =
      dots == std::string::npos ? from : parse_number(std::string_view(text).substr(dots + 2));
  if (!from || !to || *from < 0 || *to < *from)
    throw InputError("--time: '" + text +
                     "' is no time; give seconds from 0 on, as in 1.5, or with --frames as in 0..2");
  return TimeSpan{*from, dots == std::string::npos ? std::nullopt : to};
}

Moment moment_of(const CommonOptions& options) {
  const std::optional<TimeSpan> time = parse_time(options.time);
  if (time && time->to)
    throw InputError("--time: '" + options.time + "' is a span of time, for render --frames; give one time");
  return {time ? std::optional(time->from) : std::nullopt};
}

MovingScene open_scene(const CommonOptions& options, const Config& config) {
  const Size size = parse_size(options.size);
  SceneRequest request{options.scene, size.width, size.height, options.camera, options.seed, options.animation};
  request.lights = options.lights;
  request.transform = options.transform;
  if (options.leaves_out) request.leaves_out = parse_cull_objects(options.cull_objects);
  request.has_tree = options.has_tree;
  if (options.size.empty() && !is_capture(options.scene)) {
    request.width = std::min(640, config.target_width);
    request.height = std::min(480, config.target_height);
  }
  std::vector<std::string> warnings;
  MovingScene source = open_scene(request, warnings);
  for (const std::string& warning : warnings) std::cerr << "halfplane: warning: " << warning << '\n';
  return source;
}

Scene prepared_in_clip_space(Scene scene, const CommonOptions& options, const Config& config, ObjectCounts* objects) {
  const Convention convention = parse_convention(options.convention);
  const ObjectCounts counts = select_object_culling(scene, parse_cull_objects(options.cull_objects));
  if (objects != nullptr) *objects = counts;
  scene = in_convention(std::move(scene), convention);
  if (convention.has_reversed_z && config.depth_mapping != DepthMapping::projection)
    throw InputError("--convention " + options.convention +
                     " and depth.mapping both set the order of depth; leave one out");
  return in_depth_mapping(std::move(scene), config.depth_mapping);
}

Scene prepared(Scene scene, const CommonOptions& options, const Config& config, ObjectCounts* objects) {
  const TransformNumbers numbers = parse_transform(options.transform);
  return in_host_numbers(prepared_in_clip_space(std::move(scene), options, config, objects), numbers, config);
}

void warn_of_scene(const Scene& scene, const Config& config) {
  if (const auto collision = depth_collision(scene, config))
    std::cerr << "halfplane: warning: " << text(*collision) << '\n';
  if (const auto beyond = beyond_reach(scene)) std::cerr << "halfplane: warning: " << text(*beyond) << '\n';
}

Scene load_scene(const CommonOptions& options, const Config& config, double& load_s, ObjectCounts* objects) {
  (void)parse_convention(options.convention);  // before a long file is read
  (void)parse_cull_objects(options.cull_objects);
  const Moment moment = moment_of(options);
  const auto start = std::chrono::steady_clock::now();
  const MovingScene source = open_scene(options, config);
  Scene scene = prepared(source.at(moment), options, config, objects);
  if (objects != nullptr) add_work(*objects, source);
  load_s = seconds_since(start);
  return scene;
}

void add_work(ObjectCounts& objects, const MovingScene& source) {
  if (!source.work) return;
  objects.tests = source.work->bounds.tests;
  objects.nodes_outside = source.work->bounds.nodes_outside;
  objects.nodes_inside = source.work->bounds.nodes_inside;
  objects.vertices_skipped = source.work->vertices_skipped;
}

Json result_head(const std::string& command, const CommonOptions& options, const Config& config) {
  const bool has_scene = !options.scene.empty();
  return Json{{"schema", "halfplane." + command + "/1"},
              {"config", config_json(config)},
              {"scene", has_scene ? Json(options.scene) : Json(nullptr)},
              {"seed", has_scene ? Json(options.seed) : Json(nullptr)}};
}

std::ostream& human(const CommonOptions& options) {
  static std::ostream null(nullptr);
  return options.quiet ? null : !on_stdout().empty() ? std::cerr : std::cout;
}

void write_json(const CommonOptions& options, const Json& result) {
  if (options.json.empty()) return;
  Json whole = result;
  whole["command"] = typed_command();
  // File names may be any bytes, JSON is UTF-8.
  const std::string text = whole.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
  if (options.json != "-") return write_text_file(options.json, text);
  write_stdout({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, "--json",
               "give a place that can be written, or --json=FILE");
}

double seconds_since(TimePoint start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void finish_json(const CommonOptions& options, Json& result, TimePoint start, bool is_partial) {
  result["wall_s"] = seconds_since(start);
  if (is_partial) mark_partial(result);
  write_json(options, result);
}

void make_folder(const std::string& option, const std::string& folder) {
  if (folder.empty()) return;
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw InputError(option + ": cannot make the folder '" + folder + "'; choose another");
}

std::string capture_text(const Scene& scene) {
  std::ostringstream text;
  write_capture(scene, text);
  return text.str();
}

std::string with_commas(std::uint64_t value) {
  std::string digits = std::to_string(value);
  for (std::size_t i = digits.size(); i > 3; i -= 3) digits.insert(i - 3, ",");
  return digits;
}

std::string formatted(const char* format, double value) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::string decimal(int128 value) {
  std::string digits;
  auto rest = static_cast<uint128>(value < 0 ? -value : value);
  do {
    digits += static_cast<char>('0' + static_cast<int>(rest % 10));
    rest /= 10;
  } while (rest != 0);
  if (value < 0) digits += '-';
  return {digits.rbegin(), digits.rend()};
}

std::string refuse_empty(const std::string& text) { return text.empty() ? "the value is empty" : ""; }

std::string is_number(const std::string& text) {
  return std::isalpha(static_cast<unsigned char>(text.back())) != 0 ? "'" + text + "' is no number" : "";
}

std::string left_aligned(std::string text, std::size_t width) {
  text.resize(std::max(width, text.size()), ' ');
  return text;
}

std::string right_aligned(const std::string& text, std::size_t width) {
  return std::string(width > text.size() ? width - text.size() : 0, ' ') + text;
}

std::string quoted(const std::string& word) {
  const auto is_plain = [](unsigned char c) {
    return std::isalnum(c) != 0 || std::string_view("_-+=./:,%@").find(static_cast<char>(c)) != std::string_view::npos;
  };
  if (!word.empty() && std::all_of(word.begin(), word.end(), is_plain)) return word;
  return in_single_quotes(word);
}

const std::string& program_word() { return typed_words().front(); }

void set_command_line(int argc, char** argv) {
  if (argc > 0 && *argv[0] != 0) typed_words() = {quoted(argv[0])};
  for (int i = 1; i < argc; ++i) typed_words().push_back(quoted(argv[i]));
}

std::string typed_command() { return joined(typed_words(), " "); }

void write_junit(const std::string& path, const std::string& suite, const std::vector<JunitCase>& cases, double seconds,
                 const Json& result, const Config* config, bool is_partial) {
  if (path.empty()) return;
  std::vector<JunitProperty> properties;
  if (result["scene"].is_string()) properties.push_back({"scene", result["scene"].get<std::string>()});
  if (!result["seed"].is_null()) properties.push_back({"seed", result["seed"].dump()});
  if (config != nullptr) properties.push_back({"config", config_arguments(*config).substr(1)});
  properties.push_back({"command", typed_command()});
  if (is_partial) properties.push_back({"partial", "true"});
  write_text_file(path, junit_xml(suite, cases, seconds, properties));
}

std::string config_arguments(const Config& config) {
  std::string text = " --config " + config.preset;
  const Config base = preset(config.preset);
  for (const Setting& setting : settings())
    if (const std::string value = get(config, setting); value != get(base, setting))
      text += " --set " + quoted(std::string(setting.key) + "=" + value);
  return text;
}

std::string scene_arguments(const CommonOptions& options, const Config& config) {
  std::string text = config_arguments(config);
  if (!options.size.empty()) text += " --size " + quoted(options.size);
  if (!options.camera.empty()) text += " --camera " + quoted(options.camera);
  for (const std::string& light : options.lights) text += " --light " + quoted(light);
  if (options.transform != "binary64") text += " --transform " + quoted(options.transform);
  if (!options.time.empty()) text += " --time " + quoted(options.time);
  if (!options.animation.empty()) text += " --animation " + quoted(options.animation);
  if (options.convention != "gl") text += " --convention " + quoted(options.convention);
  if (options.cull_objects != "box") text += " --cull-objects " + quoted(options.cull_objects);
  return text;
}

std::string fixed(double value, int decimals) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  return text;
}

}  // namespace halfplane
