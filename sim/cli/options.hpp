// Shared by all commands: options, the effective configuration, and the places of text and results.
#pragma once

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <iosfwd>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "model/config.hpp"
#include "model/engines/render.hpp"
#include "model/fixed.hpp"
#include "model/scene.hpp"
#include "sim/cosim/junit.hpp"
#include "sim/scene/load.hpp"
#include "sim/scene/object_cull.hpp"

/// An optional value is null in JSON if missing.
template <class T>
struct nlohmann::adl_serializer<std::optional<T>> {
  template <class Json>
  static void to_json(Json& json, const std::optional<T>& value) {
    json = value ? Json(*value) : Json(nullptr);
  }
};

/// Makes JSON of a struct of the namespace it stands in: the members as keys, in this order.
#define HALFPLANE_JSON_OF_MEMBERS(Struct, ...)                                    \
  inline void to_json(nlohmann::ordered_json& json, const Struct& of) {           \
    NLOHMANN_JSON_EXPAND(NLOHMANN_JSON_PASTE(HALFPLANE_JSON_MEMBER, __VA_ARGS__)) \
  }
#define HALFPLANE_JSON_MEMBER(name) json[#name] = of.name;

namespace halfplane {

using Json = nlohmann::ordered_json;

/// Exit status: the same for every command.
enum ExitStatus : int {
  exit_ok = 0,
  exit_mismatch = 1,
  exit_bad_input = 2,
  exit_missing = 3,
  exit_interrupted = 130,
  exit_unread = 141  ///< success, but stdout is no longer read: as a shell reports a tool ended by SIGPIPE
};

/// The common options as typed.
struct CommonOptions {
  std::string scene;
  std::string config = "embedded";
  std::vector<std::string> settings;  ///< key=value
  std::string size;                   ///< WxH
  std::string camera;
  std::vector<std::string> lights;
  std::string transform = "binary64";
  std::string time, animation;
  std::uint64_t seed = 1;
  int threads = 1;
  std::string skip = "all";
  std::string convention = "gl";
  std::string cull_objects = "box";
  bool leaves_out = false;  ///< objects outside by `cull_objects` are not computed: for commands that only draw
  bool has_tree = true;     ///< false: each object is tested separately
  std::string json;         ///< empty: none, "-": stdout, else a file
  bool quiet = false;
};

/// Adds --json and --quiet.
void add_result_options(CLI::App& app, CommonOptions& options);

/// Adds --config, --set, --json and --quiet.
void add_output_options(CLI::App& app, CommonOptions& options);

void add_seed_option(CLI::App& app, CommonOptions& options, const std::string& meaning);

/// Adds an option that takes the name of a file or folder to write, or - for stdout, with claim_output().
CLI::Option* add_output_option(CLI::App& app, const std::string& name, std::string& path, const std::string& meaning);

/// The same for a file, with check_output().
void add_file_option(CLI::App& app, const std::string& name, std::string& path, const std::string& meaning,
                     const std::string& extension = "");

/// For CLI11: notes a file that is read, and what `option` writes. Throws InputError for a file that is written and has
/// another option's name, and for a second output on stdout.
void claim_input(const std::string& path);
[[nodiscard]] std::function<void(std::string)> claim_output(const std::string& option);

/// Adds SCENE and every common option.
void add_scene_options(CLI::App& app, CommonOptions& options);

/// Throws InputError when `path` lies in no folder, is a folder, or does not end in `extension` (lower case, as ".npy";
/// "" for any). Called before the work, so that no time is lost for a result that cannot be saved. An empty path is
/// valid, and so is -.
void check_output(const std::string& path, const std::string& extension = "");

/// `--size WxH`, pixels; 0x0 for an empty text. Throws InputError.
struct Size {
  int width = 0, height = 0;
};
[[nodiscard]] Size parse_size(const std::string& text);

/// A fraction, above 0 and at most 1: "0.01" or "1%". Throws InputError, which begins with `option`.
[[nodiscard]] double parse_part(const std::string& text, const std::string& option);

/// Whether a scene with that name is read as a capture.
[[nodiscard]] bool is_capture(const std::string& name);

/// Preset or file, then every --set, validated. Throws InputError.
[[nodiscard]] Config effective_config(const CommonOptions& options);
/// The same for a picture: a depth.format is made from a plane with enough codes, unless depth.bits is given.
[[nodiscard]] Config drawing_config(const CommonOptions& options);
/// Reports the bits chosen.
void warn_of_depth_bits(const CommonOptions& options, const Config& config);

/// `--skip all|none|NAME,NAME...`. Throws InputError naming the legal names.
[[nodiscard]] Skip parse_skip(const std::string& text);

/// `--time T` or `--time A..B`, seconds.
struct TimeSpan {
  double from = 0;
  std::optional<double> to;
};
/// None for an empty text. Throws InputError.
[[nodiscard]] std::optional<TimeSpan> parse_time(const std::string& text);

/// The moment of `--time`, one time. Throws InputError for a span.
[[nodiscard]] Moment moment_of(const CommonOptions& options);

/// Opens the requested scene, before a moment is chosen. Prints warnings to stderr. See load_scene().
[[nodiscard]] MovingScene open_scene(const CommonOptions& options, const Config& config);

/// A scene of open_scene() before projection: without objects outside the view, in the options' convention and the
/// configuration's mapping of depth.
[[nodiscard]] Scene prepared_in_clip_space(Scene scene, const CommonOptions& options, const Config& config,
                                           ObjectCounts* objects = nullptr);

/// The same in the engines' form: with --transform clipped, divided and mapped in lower precision.
[[nodiscard]] Scene prepared(Scene scene, const CommonOptions& options, const Config& config,
                             ObjectCounts* objects = nullptr);

/// Loads the requested scene, in its convention; without a given size it fits the configuration's target. Prints
/// warnings to stderr, sets `load_s`, and `objects` if there is one.
[[nodiscard]] Scene load_scene(const CommonOptions& options, const Config& config, double& load_s,
                               ObjectCounts* objects = nullptr);

/// Warns of colliding depths in the scene (depth_collision()), and of coordinates out of reach (beyond_reach()).
void warn_of_scene(const Scene& scene, const Config& config);

/// Adds the work for the last scene of `source`.
void add_work(ObjectCounts& objects, const MovingScene& source);

/// `objects` of a result.
HALFPLANE_JSON_OF_MEMBERS(ObjectCounts, in, culled_sphere, culled_box, primitives_skipped, tests, nodes_outside,
                          nodes_inside, vertices_skipped)

/// {schema, config, scene, seed}: the head of every result; the last two are null for a command without a scene.
/// `command` as in "render".
[[nodiscard]] Json result_head(const std::string& command, const CommonOptions& options, const Config& config);

/// The stream for human text: stdout, or stderr when a result or a file is on stdout; a null stream with --quiet.
[[nodiscard]] std::ostream& human(const CommonOptions& options);

/// Writes the result to the place of --json, with `command`, which repeats it. Call it before the human text: if it
/// fails, its one line stands alone.
void write_json(const CommonOptions& options, const Json& result);

using TimePoint = std::chrono::steady_clock::time_point;
[[nodiscard]] double seconds_since(TimePoint start);

/// Adds `wall_s` and, for work that a signal cut short, `"partial": true`; then write_json().
void finish_json(const CommonOptions& options, Json& result, TimePoint start, bool is_partial = false);

/// Creates the folder that `option` names, unless it is empty. Throws InputError.
void make_folder(const std::string& option, const std::string& folder);

[[nodiscard]] std::string capture_text(const Scene& scene);

/// 1234567 as "1,234,567".
[[nodiscard]] std::string with_commas(std::uint64_t value);

/// The words with `separator` between them.
template <class Range>
[[nodiscard]] std::string joined(const Range& words, std::string_view separator = ", ") {
  std::string text;
  for (const auto& word : words) {
    if (&word != &*std::begin(words)) text.append(separator);
    text.append(word);
  }
  return text;
}

/// `printf` of one number.
[[nodiscard]] std::string formatted(const char* format, double value);

[[nodiscard]] std::string decimal(int128 value);

[[nodiscard]] inline Json or_null(bool is_known, const Json& value) { return is_known ? value : Json(nullptr); }
/// Null for an empty text.
[[nodiscard]] inline Json or_null(const std::string& text) { return or_null(!text.empty(), text); }

/// A check for CLI11: an empty word is no value.
[[nodiscard]] std::string refuse_empty(const std::string& text);

/// A check for CLI11, whose Range accepts NaN.
[[nodiscard]] std::string is_number(const std::string& text);

/// `text` padded to `width` with blanks after it, and before it.
[[nodiscard]] std::string left_aligned(std::string text, std::size_t width);
[[nodiscard]] std::string right_aligned(const std::string& text, std::size_t width);

/// A word quoted for a POSIX shell.
[[nodiscard]] std::string quoted(const std::string& word);

/// The program as it was called, quoted for a shell: the first word of every printed command.
[[nodiscard]] const std::string& program_word();

/// To be called once, with the arguments of main().
void set_command_line(int argc, char** argv);

/// The command as typed, quoted for a shell: in the same folder, and with the same stdin, it gives the same result.
[[nodiscard]] std::string typed_command();

/// Writes a suite as JUnit XML, unless `path` is empty, with its inputs: scene and seed of `result`, the configuration
/// (null: many), the command that repeats it.
void write_junit(const std::string& path, const std::string& suite, const std::vector<JunitCase>& cases, double seconds,
                 const Json& result, const Config* config, bool is_partial = false);

/// " --config PRESET --set KEY=VALUE ..." for exactly this configuration, quoted for a shell.
[[nodiscard]] std::string config_arguments(const Config& config);

/// The same, and --size, --camera and all other options of the scene; not the scene's name, nor the seed.
[[nodiscard]] std::string scene_arguments(const CommonOptions& options, const Config& config);

/// `value` with `decimals` decimals.
[[nodiscard]] std::string fixed(double value, int decimals);

}  // namespace halfplane
