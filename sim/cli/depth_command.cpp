// halfplane depth: the effect of a depth buffer's mapping, format and planes, in theory and on a scene.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "sim/cli/commands.hpp"
#include "sim/cli/depth_study.hpp"
#include "sim/cli/option_kinds.hpp"
#include "sim/cli/progress.hpp"
#include "sim/show/image/whole_file.hpp"
#include "sim/show/report/page.hpp"
#include "sim/words.hpp"

namespace halfplane {
namespace {

struct DepthCommand : CommonOptions {
  std::string near, far, mappings, formats, z, range;
  std::string error;                ///< a length: where bins exceed it, and the bits needed
  std::string slope;                ///< slope of two surfaces, for their minimum separation
  std::string fight_rate = "0.01";  ///< share of overlapping pairs, for the fewest bits
  double fov = 45;                  ///< degrees, vertical
  int bits = 0;                     ///< short for --format u<bits>
  bool sweeps = false;
  std::string csv_path;
  DepthPaths paths;
};

std::vector<std::string> comma_parts(const std::string& option, const std::string& text) {
  std::vector<std::string> parts = split(text, ',');
  if (std::ranges::find(parts, "") != parts.end())
    throw InputError(option + ": '" + text + "' has an empty part; give a list with commas");
  return parts;
}

DepthMapping parse_mapping(const std::string& name) {
  const auto names = depth_mapping_names();
  for (std::size_t i = 1; i < names.size(); ++i)
    if (names[i] == name) return static_cast<DepthMapping>(i);
  throw InputError("--mapping: no mapping '" + name + "'; give some of " + joined(names.subspan(1)));
}

/// near, the powers of ten between, far.
std::vector<std::string> default_depths(const DepthQuestion& question) {
  std::vector<std::string> z{question.near_text};
  const double near = question.planes[0], far = question.planes[1];
  for (int power = static_cast<int>(std::floor(std::log10(near))) + 1; std::pow(10.0, power) < far; ++power)
    if (std::pow(10.0, power) > near) z.push_back(depth_number(std::pow(10.0, power)));
  z.push_back(question.far_text);
  return z;
}

DepthQuestion read_question(const DepthCommand& options, const Config& config,
                            const std::optional<DepthPlanes>& scene_planes) {
  DepthQuestion question;
  question.config = config;
  question.seed = options.seed;
  question.fight_rate = parse_part(options.fight_rate, "--fight-rate");
  const auto plane = [&](const char* name, const std::string& given, std::size_t which) {
    if (!given.empty()) return given;
    if (!scene_planes)
      throw InputError(std::string("depth: give ") + name + ", the eye depth of that plane, or --scene");
    if (std::isinf((*scene_planes)[which]))
      throw InputError("depth: the scene's camera has an infinite far plane; give --far, the depth to look at");
    return depth_number((*scene_planes)[which]);
  };
  question.near_text = plane("--near", options.near, 0);
  question.far_text = plane("--far", options.far, 1);
  question.near = parse_decimal(question.near_text, "--near");
  question.far = parse_decimal(question.far_text, "--far");
  if (!(question.near > 0 && question.near < question.far))
    throw InputError("--near " + question.near_text + " --far " + question.far_text + ": give 0 < near < far");
  if (question.near.get_d() < 1e-30 || question.far.get_d() > 1e30)
    throw InputError("--near and --far: give depths from 1e-30 to 1e30");
  question.planes = {std::stod(question.near_text), std::stod(question.far_text)};
  if (!(question.planes[0] < question.planes[1]))
    throw InputError("--near and --far are the same in binary64; bring them farther apart");
  if (question.far / question.near > Rational(mpz_class("1000000000000000"), 1))
    throw InputError("--near and --far: far / near is above 1e15; bring them nearer to each other");
  for (const std::string& name : comma_parts("--mapping", options.mappings))
    question.mappings.push_back(parse_mapping(name));
  if (options.bits != 0 && !options.formats.empty())
    throw InputError("--bits and --format exclude each other, --bits N is --format uN; leave one of them out");
  const std::string formats = !options.formats.empty() ? options.formats
                              : options.bits != 0      ? "u" + std::to_string(options.bits)
                                                       : "u16";
  for (const std::string& name : comma_parts("--format", formats)) {
    question.formats.push_back(parse_depth_format(name));
    if (question.formats.back().kind == DepthFormat::Kind::plane)
      throw InputError("--format: name the stored format, as in u16");
  }
  question.z = options.z.empty() ? default_depths(question) : comma_parts("--z", options.z);
  for (const std::string& text : question.z) {
    const Rational z = parse_decimal(text, "--z");
    if (z < question.near || z > question.far)
      throw InputError("--z: " + text + " is not between near and far; give depths from " + question.near_text +
                       " to " + question.far_text);
  }
  if (!options.range.empty()) {
    const auto ends = comma_parts("--range", options.range);
    if (ends.size() != 2) throw InputError("--range: '" + options.range + "' is not two depths; give A,B as in 10,100");
    question.low = parse_decimal(ends[0], "--range");
    question.high = parse_decimal(ends[1], "--range");
    if (!(question.near <= *question.low && *question.low < *question.high && *question.high <= question.far))
      throw InputError("--range: '" + options.range + "' is not a range between near and far; give A,B with " +
                       question.near_text + " <= A < B <= " + question.far_text);
  }
  const auto positive = [](const std::string& text, const char* option, bool zero) -> std::optional<double> {
    if (text.empty()) return std::nullopt;
    const double value = parse_decimal(text, option).get_d();
    if (value < 0 || (value == 0 && !zero))
      throw InputError(std::string(option) + ": '" + text + "' is " +
                       (zero ? "below 0; give 0 or more" : "not above 0; give more"));
    return value;
  };
  question.length = positive(options.error, "--error", false);
  if (const auto slope = positive(options.slope, "--slope", true)) {
    const Size size = options.size.empty() ? Size{640, 480} : parse_size(options.size);
    question.view = SurfaceView{*slope, options.fov, size.width, size.height};
  }
  return question;
}

std::string command_line(const DepthCommand& options, const DepthQuestion& question) {
  std::string text = "halfplane depth";
  if (!options.scene.empty()) text += " --scene " + quoted(options.scene);
  text += " --near " + question.near_text + " --far " + question.far_text + " --mapping " + options.mappings;
  std::vector<std::string> formats;
  for (const DepthFormat& format : question.formats) formats.push_back(to_string(format));
  text += " --format " + joined(formats, ",");
  for (const auto& [option, value] : {std::pair{" --z ", options.z},
                                      {" --error ", options.error},
                                      {" --range ", options.range},
                                      {" --slope ", options.slope},
                                      {" --size ", options.size}})
    if (!value.empty()) text += option + value;
  if (options.fight_rate != "0.01") text += " --fight-rate " + options.fight_rate;
  if (options.fov != 45) text += " --fov " + depth_number(options.fov);
  if (!options.camera.empty()) text += " --camera " + quoted(options.camera);
  if (options.config != "embedded") text += " --config " + quoted(options.config);
  for (const std::string& setting : options.settings) text += " --set " + quoted(setting);
  if (options.seed != 1) text += " --seed " + std::to_string(options.seed);
  return text;
}

int thread_count(const DepthCommand& options) {
  return options.threads > 0 ? options.threads
                             : static_cast<int>(std::clamp(std::thread::hardware_concurrency(), 1U, 16U));
}

/// Keeps the complete part of an interrupted study: the variants with their measurements, or only the theory.
void keep_whole(std::vector<DepthVariant>& variants, std::vector<DepthMeasurement>& measured) {
  std::vector<DepthVariant> whole;
  for (std::size_t i = 0; i < measured.size(); ++i)
    if (measured[i].is_whole) whole.push_back(variants[i]);
  std::erase_if(measured, [](const DepthMeasurement& m) { return !m.is_whole; });
  if (!whole.empty()) variants = std::move(whole);
}

/// Keeps the measured variants, if there are any.
SceneStudy study_scene(const DepthCommand& options, const DepthQuestion& question, const Scene& scene,
                       std::vector<DepthVariant>& variants) {
  SceneStudy study;
  const int threads = thread_count(options);
  const bool has_report = !options.paths.page.empty(), has_sweeps = has_report || options.sweeps;
  Progress progress(options, "measuring");
  const auto part = [&progress](double from, double to) {
    return [&progress, from, to](double fraction) { progress(from + (to - from) * fraction); };
  };
  MeasureOptions measure;
  measure.wants_maps = has_report || !options.paths.heat.empty() || !options.paths.fights.empty();
  measure.progress = part(0, 0.15);
  study.measured = measure_depths(scene, variants, measure, threads);
  keep_whole(variants, study.measured);
  if (study.measured.empty()) return study;
  if (study.measured[0].fragments == 0)
    throw InputError(options.scene +
                     ": no filled triangle covers a sample between the planes: there is nothing to measure");
  if (is_interrupted()) {
    study.answers = depth_answers(variants[0], study.measured[0], {});
    return study;
  }
  study.trials = try_changes(scene, variants[0], study.measured[0], threads, part(0.15, 0.3));
  study.answers = depth_answers(variants[0], study.measured[0], study.trials);
  if (study.measured[0].order.pairs > 0 && !is_interrupted())
    study.fewest = fewest_depth_bits(scene, question.config, question.mappings, variants[0].planes, question.fight_rate,
                                     threads, part(0.3, 0.4));
  if (!study.fewest.empty())
    study.answers.insert(study.answers.begin(),
                         fewest_bits_answer(study.fewest, variants[0].planes, question.fight_rate));
  // At the size of the scene: another size would give another rate at the crossing of sweep and table.
  if (has_sweeps && !is_interrupted())
    study.sweeps = sweep_depth(scene, question.config, question.mappings, variants[0].format.bits, variants[0].planes,
                               threads, part(0.4, 1));
  return study;
}

constexpr const char* kBroken =
    "a measured error exceeds its bound, surfaces at their separation fight, or a stored code is not what the stages "
    "compute";

/// Whether every tested prediction holds: if not, this program is wrong.
bool holds(const std::vector<DepthRow>& rows, const SceneStudy& study) {
  // Rounding in binary64 may exceed a bound that is reached exactly.
  const auto is_good = [](const DepthMeasurement& m) { return m.worst_share <= 1 + 1e-6 && m.stage_mismatches == 0; };
  return std::all_of(study.measured.begin(), study.measured.end(), is_good) &&
         std::all_of(study.trials.begin(), study.trials.end(),
                     [&](const DepthTrial& t) { return is_good(t.result); }) &&
         std::none_of(rows.begin(), rows.end(),
                      [](const DepthRow& row) { return row.metric == "fights_at_separation" && row.value > 0; });
}

/// Refuses options that contradict each other or their files, before any work.
void check_depth_options(const DepthCommand& options, const Config& config) {
  if (config.depth_mapping != DepthMapping::projection || config.depth_format.kind != DepthFormat::Kind::plane)
    throw InputError(
        "depth.mapping and depth.format: this command takes them by --mapping and --format; leave them out of --config "
        "and --set");
  require_one_sample(config, "depth");
  for (const std::string& setting : options.settings)
    if (setting.starts_with("depth.bits="))
      throw InputError("depth: the interpolated bits follow from --format; leave depth.bits out");
  if (options.scene.empty() && !options.camera.empty())
    throw InputError("--camera: there is no scene to look at; add --scene, or leave --camera out");
  if (!options.range.empty() && options.error.empty())
    throw InputError("--range: there is no --error to hold in it; add --error, or leave --range out");
  if (options.scene.empty() && (!options.paths.heat.empty() || !options.paths.fights.empty()))
    throw InputError("--heat and --fights: there is no scene to show; add --scene, or leave them out");
  if (!options.paths.page.empty()) require_chart_library();
}

bool uses_depth(const State& state) { return state.depth_test != DepthFunc::always || state.depth_write; }

/// Whether the near plane is at z = -w and the far one at z = w.
bool has_usual_clip_space(const State& state) {
  return state.space == Space::clip && state.clip_z == ClipZ::minus_one_one;
}

/// The vertices that the scene draws, each as often as it is used.
std::vector<Vertex> drawn_vertices(const Scene& scene) {
  std::vector<Vertex> vertices;
  for (const Command& command : scene.commands)
    if (const auto* draw = std::get_if<Draw>(&command))
      for (std::size_t i = draw->first; i < draw->first + draw->count; ++i)
        if (scene.indices[i] != kRestart) vertices.push_back(scene.vertices[scene.indices[i]]);
  return vertices;
}

/// Near and far plane of the perspective projection that gave clip z = a w + b, -w at the near plane and w at the far one. None
/// if the vertices are not of one projection.
std::optional<std::array<double, 2>> projection_planes(const std::vector<Vertex>& vertices) {
  constexpr double kRounding = 0x1p-20;  // of programs that compute in binary32
  const auto [nearest, farthest] = std::ranges::minmax(vertices, {}, &Vertex::w);
  const double a = (farthest.z - nearest.z) / (farthest.w - nearest.w), b = nearest.z - a * nearest.w;
  const double largest = std::max({std::abs(farthest.w), std::abs(nearest.w), std::abs(b)});
  if (!std::ranges::all_of(vertices,
                           [&](const Vertex& v) { return std::abs(a * v.w + b - v.z) <= kRounding * largest; }))
    return {};
  const double near = -b / (1 + a), far = b / (1 - a);
  if (!(near > 0 && near < far && std::isfinite(far))) return {};
  return std::array{near, far};
}

/// The requested scene, if any, without draws that have no part in the depths, as a program's text over its picture. Throws
/// InputError when its depth range is unknown.
std::optional<Scene> depth_scene(const DepthCommand& options, const Config& config) {
  if (options.scene.empty()) return std::nullopt;
  double load_s = 0;
  Scene scene = load_scene(options, config, load_s);
  std::erase_if(scene.commands, [&](const Command& command) {
    const auto* draw = std::get_if<Draw>(&command);
    return draw != nullptr && !uses_depth(scene.states[draw->state]);
  });
  if (scene.planes) return scene;
  const std::vector<Vertex> vertices = drawn_vertices(scene);
  if (vertices.empty()) throw InputError(options.scene + ": no draw tests or writes depth; nothing to measure");
  const bool is_flat = std::ranges::all_of(vertices, [&](const Vertex& v) { return v.w == vertices[0].w; });
  if (is_flat)
    throw InputError(options.scene +
                     ": every w is the same: no perspective projection, so no eye depth is known; "
                     "give a scene seen in perspective");
  if (std::ranges::all_of(scene.states, has_usual_clip_space)) scene.planes = projection_planes(vertices);
  if (!scene.planes && (options.near.empty() || options.far.empty()))
    throw InputError(options.scene + ": its near and far plane are not known; give --near and --far");
  return scene;
}

std::string depth_title(const DepthCommand& options, const DepthQuestion& question, const std::optional<Scene>& scene) {
  std::string title = scene ? options.scene : "theory";
  if (scene) title += ", " + std::to_string(scene->width) + "x" + std::to_string(scene->height);
  if (question.view)
    title += ", surfaces of slope " + short_text(question.view->slope) + " seen at " +
             std::to_string(question.view->width) + "x" + std::to_string(question.view->height) + " and " +
             short_text(question.view->fov) + " degrees";
  return title + ", near " + short_text(question.planes[0]) + ", far " + short_text(question.planes[1]) + ", " +
         label(question.config) + ", seed " + std::to_string(options.seed);
}

/// Adds the theory of every mapping and format, until a signal comes.
void add_theory(const DepthCommand& options, const DepthQuestion& question, std::vector<DepthRow>& rows,
                std::vector<DepthVariant>& variants) {
  Progress progress(options, "working out the theory");
  const auto all = static_cast<double>(question.mappings.size() * question.formats.size());
  for (const DepthMapping mapping : question.mappings)
    for (const DepthFormat& format : question.formats) {
      const std::size_t before = rows.size();
      const auto part = [&](double fraction) { progress((static_cast<double>(variants.size()) + fraction) / all); };
      try {
        part(0);
        add_theory_rows(question, mapping, format, part, rows);
      } catch (const Interrupted&) {
        rows.erase(rows.begin() + static_cast<std::ptrdiff_t>(before), rows.end());
        return;
      }
      variants.push_back(make_variant(question.config, mapping, format, question.planes));
    }
}

int run_depth(const DepthCommand& options) {
  const auto start = std::chrono::steady_clock::now();
  const Config config = effective_config(options);
  check_depth_options(options, config);
  const std::optional<Scene> scene = depth_scene(options, config);
  const DepthQuestion question = read_question(options, config, scene ? scene->planes : std::nullopt);

  std::vector<DepthRow> rows;
  std::vector<DepthVariant> variants;
  add_theory(options, question, rows, variants);
  const std::vector<DepthRow> theory_rows = rows;
  SceneStudy study;
  if (scene && !is_interrupted()) study = study_scene(options, question, *scene, variants);
  const bool is_partial = is_interrupted(), is_measured = !study.measured.empty();
  for (std::size_t i = 0; i < study.measured.size(); ++i)
    add_measured_rows(question, variants[i], study.measured[i], rows);
  add_fewest_rows(question, study.fewest, rows);
  if (question.length)
    for (const std::string& answer : length_answers(question)) study.answers.push_back(answer);

  const std::string title = depth_title(options, question, scene) + (is_partial ? ", interrupted: partial" : "");
  Json result = result_head("depth", options, config);
  result["near"] = question.planes[0];
  result["far"] = question.planes[1];
  result["command"] = command_line(options, question);
  result.update(study_json(question, rows, variants, study));
  result["wall_s"] = seconds_since(start);
  if (is_partial) mark_partial(result);
  write_depth_files(options.paths, title, question, result, is_measured ? &*scene : nullptr, variants, study);
  if (is_partial) rows.push_back({"", "", question.near_text, question.far_text, "", "partial", 1});
  const std::string csv = depth_csv(rows);
  if (!options.csv_path.empty() && options.csv_path != "-") write_text_file(options.csv_path, csv);
  write_json(options, result);
  const bool is_broken = !holds(rows, study);
  if (is_broken) std::cerr << "halfplane: " << kBroken << '\n';
  const int status = is_partial ? exit_interrupted : is_broken ? exit_mismatch : exit_ok;
  if (options.csv_path == "-") {
    std::cout << csv;
    return status;
  }
  std::ostream& out = human(options);
  out << title << '\n';
  const std::size_t first = study.fewest.empty() ? 0 : 1;  // the answer to how many bits comes before all tables
  if (first == 1) out << study.answers[0] << "\n\n";
  print_theory(out, theory_rows);
  if (is_measured) print_measured(out, variants, study);
  if (study.answers.size() > first) out << '\n';
  for (std::size_t i = first; i < study.answers.size(); ++i) out << study.answers[i] << '\n';
  if (is_partial) print_partial(out);
  return status;
}

}  // namespace

void add_depth_command(CLI::App& app, Action& selected) {
  const auto [command, options] = add_command<DepthCommand>(
      app, selected, "depth", "depth quantization: theory, and measured on a scene", run_depth);
  options->threads = 0;
  command->add_option("--near", options->near, "eye depth of the near plane (default: the scene's)")->type_name("Z");
  command->add_option("--far", options->far, "eye depth of the far plane (default: the scene's)")->type_name("Z");
  command->add_option("--mapping", options->mappings, "some of std, rev, stdinf, revinf, w, log")
      ->default_str("std,rev,w")
      ->type_name("LIST");
  options->mappings = "std,rev,w";
  command->add_option("--format", options->formats, "some of u<b>, bins<b>, f16, f32, uf<e>.<m> (default u16)")
      ->type_name("LIST");
  command->add_option("--bits", options->bits, "short for --format u<N>")->check(whole_number(2, 32))->type_name("N");
  add_text_option(*command, "--z", options->z, "eye depths to look at (default: near, powers of ten, far)", "LIST");
  command
      ->add_option("--error", options->error,
                   "a length: the depth where bins exceed it, the fewest bits and the least near plane that keep it")
      ->type_name("LENGTH");
  command->add_option("--range", options->range, "the depths that --error is about (default: near,far)")
      ->type_name("A,B");
  command
      ->add_option("--slope", options->slope,
                   "also the minimum separation of two surfaces of this slope, in units of depth per unit across (0: "
                   "facing the eye), tried on such surfaces")
      ->type_name("S");
  command
      ->add_option("--fight-rate", options->fight_rate,
                   "with --scene: find the fewest bits with which less than this part of the overlapping pairs of "
                   "fragments fight: '0.01' or '1%'")
      ->type_name("PART")
      ->capture_default_str();
  add_real_option(*command, "--fov", options->fov, 0.01, 179.0, "for --slope: vertical, degrees")
      ->capture_default_str();
  command->add_option("--scene", options->scene, "measure it on this scene: built-in name or file");
  add_text_option(*command, "--size", options->size, "target, WxH pixels");
  command->add_option("--camera", options->camera, "as for render");
  add_seed_option(*command, *options, "seed of scenes with random parts");
  command->add_option("--threads", options->threads, "use at most N threads (default: as many as there are cores)")
      ->check(whole_number(1, 1024));
  add_output_options(*command, *options);
  add_file_option(*command, "--csv", options->csv_path, "rows of mapping,format,near,far,z,metric,value; - for stdout");
  add_file_option(*command, "-o", options->paths.page, "everything as one HTML page, .html", ".html");
  command->add_flag("--sweep", options->sweeps,
                    "with --scene: also how the fights fall with storage and subpixel bits (always with -o)");
  add_file_option(*command, "--heat", options->paths.heat, "errors of the visible surfaces, side by side, .png",
                  ".png");
  add_file_option(*command, "--fights", options->paths.fights, "where surfaces fight, side by side, .png", ".png");
  command->footer(
      "\nExamples:\n  halfplane depth --near 1 --far 1000 --mapping std,rev,w --format u16,u24,uf4.12 --z 10,100,900 "
      "--csv "
      "-\n  halfplane depth --scene coplanar --bits 16 -o report.html");
}

}  // namespace halfplane
