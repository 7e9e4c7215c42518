// halfplane depth: what a depth buffer's mapping, format and planes do, in theory and on a scene.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <iostream>
#include <sstream>
#include <thread>

#include "sim/cli/commands.hpp"
#include "sim/cli/options.hpp"
#include "sim/depth/answers.hpp"
#include "sim/depth/error_bound.hpp"
#include "sim/depth/maps.hpp"
#include "sim/depth/report.hpp"
#include "sim/depth/theory.hpp"
#include "sim/depth/two_planes.hpp"
#include "sim/image/color_map.hpp"
#include "sim/image/panel.hpp"
#include "sim/image/png.hpp"
#include "sim/image/whole_file.hpp"

namespace halfplane {
namespace {

struct DepthCommand : CommonOptions {
  std::string near, far, mappings, formats, z, range;
  std::string error;  ///< a length: where bins exceed it, and what it takes
  std::string slope;  ///< of two surfaces: their minimum separation
  double fov = 45;    ///< degrees, vertical
  int bits = 0;       ///< short for --format u<bits>
  bool sweeps = false;
  std::string csv_path, report_path, heat_path, fights_path;
};

/// One line of the result, as in the CSV.
struct DepthRow {
  std::string mapping, format, near, far, z, metric;
  double value;
};

/// What the options ask for, read.
struct DepthQuestion {
  Config config;
  Rational near, far;
  std::string near_text, far_text;
  DepthPlanes planes{};  ///< the same, to the nearest binary64
  std::vector<DepthMapping> mappings;
  std::vector<DepthFormat> formats;
  std::vector<std::string> z;
  std::optional<Rational> low, high;  ///< --range
  std::optional<double> length, slope;
};

std::string depth_number(double value) {
  if (std::isinf(value)) return "inf";
  std::array<char, 32> text{};
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), end};
}

std::string short_text(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.3g", value);
  return text.data();
}

std::vector<std::string> comma_parts(const std::string& option, const std::string& text) {
  std::vector<std::string> parts;
  std::istringstream words(text);
  std::string part;
  while (std::getline(words, part, ',')) parts.push_back(part);
  if (parts.empty() || text.back() == ',' || std::count(parts.begin(), parts.end(), "") != 0)
    throw InputError(option + ": '" + text + "' has an empty part; give a list with commas");
  return parts;
}

DepthMapping parse_mapping(const std::string& name) {
  const auto names = depth_mapping_names();
  for (std::size_t i = 1; i < names.size(); ++i)
    if (names[i] == name) return static_cast<DepthMapping>(i);
  std::string all;
  for (std::size_t i = 1; i < names.size(); ++i) all += (i == 1 ? "" : ", ") + std::string(names[i]);
  throw InputError("--mapping: no mapping '" + name + "'; give some of " + all);
}

std::string mapping_name(DepthMapping mapping) {
  return std::string(depth_mapping_names()[static_cast<std::size_t>(mapping)]);
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
  question.planes = {std::stod(question.near_text), std::stod(question.far_text)};
  if (!(question.near > 0 && question.near < question.far && question.planes[0] < question.planes[1]))
    throw InputError("--near " + question.near_text + " --far " + question.far_text + ": give 0 < near < far");
  if (question.far / question.near > Rational(mpz_class("1000000000000000"), 1))
    throw InputError("--near and --far: far / near is above 1e15; bring them nearer to each other");
  if (question.planes[0] < 1e-30 || question.planes[1] > 1e30)
    throw InputError("--near and --far: give depths from 1e-30 to 1e30");
  for (const std::string& name : comma_parts("--mapping", options.mappings))
    question.mappings.push_back(parse_mapping(name));
  if (options.bits != 0 && !options.formats.empty()) throw InputError("--bits is short for --format; give one of them");
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
    if (ends.size() != 2) throw InputError("--range: give two depths, as in 10,100");
    question.low = parse_decimal(ends[0], "--range");
    question.high = parse_decimal(ends[1], "--range");
    if (!(question.near <= *question.low && *question.low < *question.high && *question.high <= question.far))
      throw InputError("--range: give near <= low < high <= far");
  }
  const auto positive = [](const std::string& text, const char* option, bool zero) -> std::optional<double> {
    if (text.empty()) return std::nullopt;
    const double value = parse_decimal(text, option).get_d();
    if (value < 0 || (value == 0 && !zero)) throw InputError(std::string(option) + ": give a positive number");
    return value;
  };
  question.length = positive(options.error, "--error", false);
  question.slope = positive(options.slope, "--slope", true);
  return question;
}

/// The rows of one mapping and format.
void add_depth_rows(const DepthQuestion& question, const DepthCommand& options, DepthMapping mapping,
                    const DepthFormat& format, std::vector<DepthRow>& rows) {
  const ExactDepth theory(mapping, format, question.near, question.far);
  const DepthRow head{mapping_name(mapping), to_string(format), question.near_text, question.far_text, "", "", 0};
  const auto add = [&](const std::string& z, const char* metric, double value) {
    rows.push_back(head);
    rows.back().z = z;
    rows.back().metric = metric;
    rows.back().value = value;
  };
  for (const std::string& z : question.z) {
    const DepthFigures figures = theory.at(parse_decimal(z, "--z"));
    add(z, "code", figures.code);
    add(z, "bin_width", figures.bin_width);
    add(z, "max_recon_err", figures.max_recon_err);
    add(z, "first_order", figures.first_order);
    if (!question.slope) continue;
    const DepthVariant variant = make_variant(question.config, mapping, format, question.planes);
    const DepthBound bound(variant);
    const double depth = std::stod(z);
    const Size size = options.size.empty() ? Size{640, 480} : parse_size(options.size);
    const SurfaceView view{*question.slope, options.fov, size.width, size.height};
    const DepthBound::Separation separation = surface_separation(bound, depth, view);
    add(z, "separation", separation.total());
    add(z, "separation_storage", separation.storage);
    add(z, "separation_datapath", separation.datapath);
    add(z, "separation_snap", separation.snap);
    // Tried: the part of overlapping fragments that fight.
    MeasureOptions order_alone;
    order_alone.wants_errors = false;
    for (const auto& [metric, part] : {std::pair{"fights_at_separation", 1.0}, {"fights_at_half", 0.5}}) {
      const DepthOrder order =
          measure_depth(two_planes(bound, depth, view, part, options.seed), variant, order_alone).order;
      if (order.pairs > 0) add(z, metric, order.rate());
    }
  }
  if (!question.length) return;
  const Rational low = question.low.value_or(question.near), high = question.high.value_or(question.far);
  add("", "longest_bin", theory.longest_bin(low, high));
  if (const auto z = theory.first_exceeding(*question.length, low, high)) add("", "z_exceeds", *z);
  if (const auto near = best_near(mapping, format, question.far, low, high, *question.length))
    add("", "best_near", *near);
  if (const auto bits = fewest_bits(mapping, question.near, question.far, low, high, *question.length))
    add("", "fewest_bits", *bits);
}

/// What a scene measured, as rows: of the whole with an empty z, of a decade with the z that it begins at.
void add_measured_rows(const DepthQuestion& question, const DepthVariant& variant, const DepthMeasurement& m,
                       std::vector<DepthRow>& rows) {
  const auto add = [&](const std::string& z, const char* metric, double value) {
    rows.push_back({mapping_name(variant.mapping), to_string(variant.format), question.near_text, question.far_text, z,
                    metric, value});
  };
  add("", "pairs", static_cast<double>(m.order.pairs));
  add("", "ties", static_cast<double>(m.order.ties));
  add("", "inversions", static_cast<double>(m.order.inversions));
  add("", "fight_rate", m.order.rate());
  add("", "error_max", m.total.max);
  add("", "error_rms", m.total.rms);
  for (const DepthDecade& d : m.decades) {
    const std::string from = depth_number(d.from);
    add(from, "error_max", d.error.max);
    add(from, "error_rms", d.error.rms);
    add(from, "error_bound", d.bound);
    add(from, "snap_rms", d.snap.rms);
    add(from, "interpolation_rms", d.interpolation.rms);
    add(from, "storage_rms", d.storage.rms);
  }
}

/// Which mapping keeps every step of the range below the length with the fewest bits: as integers, and as reversed floats.
std::vector<std::string> length_answers(const DepthQuestion& question) {
  const Rational low = question.low.value_or(question.near), high = question.high.value_or(question.far);
  std::vector<std::pair<int, std::string>> needs;  // bits, who
  for (std::size_t i = 1; i < depth_mapping_names().size(); ++i) {
    const auto mapping = static_cast<DepthMapping>(i);
    if (const auto bits = fewest_bits(mapping, question.near, question.far, low, high, *question.length))
      needs.emplace_back(*bits, mapping_name(mapping) + " u" + std::to_string(*bits));
  }
  for (const DepthMapping mapping : {DepthMapping::rev, DepthMapping::revinf})
    if (const auto format = smallest_float(mapping, question.near, question.far, low, high, *question.length))
      needs.emplace_back(format->bits, mapping_name(mapping) + " " + to_string(*format));
  std::stable_sort(needs.begin(), needs.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  const std::string range = "every step between " + short_text(low.get_d()) + " and " + short_text(high.get_d()) +
                            " at most " + short_text(*question.length) + " long";
  if (needs.empty()) return {"Nothing up to 32 bits makes " + range + "."};
  std::string text = "With the fewest bits, " + needs[0].second + " makes " + range;
  for (std::size_t i = 1; i < needs.size(); ++i) text += (i == 1 ? "; then " : ", ") + needs[i].second;
  return {text + "."};
}

void print_sweep(std::ostream& out, const DepthSweep& sweep) {
  out << "\nfighting by " << sweep.what << '\n';
  for (const auto& line : sweep.lines) {
    out << left_aligned(line.name, 10);
    for (std::size_t i = 0; i < line.x.size(); ++i)
      out << "  " << line.x[i] << ": " << short_text(100 * line.rate[i]) << " %";
    out << '\n';
  }
}

std::string depth_csv(const std::vector<DepthRow>& rows) {
  std::string text = "mapping,format,near,far,z,metric,value\n";
  for (const DepthRow& row : rows)
    text += row.mapping + ',' + row.format + ',' + row.near + ',' + row.far + ',' + row.z + ',' + row.metric + ',' +
            depth_number(row.value) + '\n';
  return text;
}

Json rows_json(const std::vector<DepthRow>& rows) {
  Json list = Json::array();
  for (const DepthRow& row : rows)
    list.push_back({{"mapping", row.mapping},
                    {"format", row.format},
                    {"near", row.near},
                    {"far", row.far},
                    {"z", row.z},
                    {"metric", row.metric},
                    {"value", row.value}});  // null for infinity
  return list;
}

Json depth_part_json(const ErrorMoments& m) { return {{"max", m.max}, {"rms", m.rms}}; }

Json measured_json(const DepthMeasurement& m) {
  Json decades = Json::array();
  for (const DepthDecade& d : m.decades)
    decades.push_back({{"from", d.from},
                       {"to", d.to},
                       {"fragments", d.error.count},
                       {"max", d.error.max},
                       {"rms", d.error.rms},
                       {"mean", d.error.mean},
                       {"p999", d.error.p999},
                       {"bound", d.bound},
                       {"worst_share_of_bound", d.worst_share},
                       {"parts",
                        {{"snap", depth_part_json(d.snap)},
                         {"interpolation", depth_part_json(d.interpolation)},
                         {"storage", depth_part_json(d.storage)}}}});
  return {{"fragments", m.fragments},
          {"beyond", m.beyond},
          {"eye_min", m.eye_min},
          {"eye_max", m.eye_max},
          {"pairs", m.order.pairs},
          {"ties", m.order.ties},
          {"inversions", m.order.inversions},
          {"rate", m.order.rate()},
          {"fighting_pixels", m.order.fighting_pixels},
          {"nearest_fight", m.order.fights() == 0 ? Json(nullptr) : Json(m.order.nearest_fight)},
          {"worst_share_of_bound", m.worst_share},
          {"stage_mismatches", m.stage_mismatches},
          {"parts",
           {{"snap", depth_part_json(m.snap)},
            {"interpolation", depth_part_json(m.interpolation)},
            {"storage", depth_part_json(m.storage)},
            {"total", depth_part_json(m.total)}}},
          {"decades", decades}};
}

/// One series of the report: a mapping and a format, without what is measured.
Json series_json(const DepthVariant& variant, const DepthQuestion& question) {
  const ExactDepth theory(variant.mapping, variant.format, question.near, question.far);
  const DepthCurve curve = depth_curve(theory, 181);
  Json decades = Json::array(), exceeds = Json::array();
  for (const CodeShare& share : codes_by_decade(theory))
    decades.push_back({{"from", share.from}, {"to", share.to}, {"codes", share.codes}, {"share", share.share}});
  const double far = question.planes[1];
  std::vector<double> lengths;
  for (int power = -6; power <= -2; ++power)
    lengths.push_back(std::pow(10.0, std::floor(std::log10(far) + 0.5) + power));
  if (question.length) lengths.push_back(*question.length);
  std::sort(lengths.begin(), lengths.end());
  for (const double length : lengths) {
    const auto z = theory.first_exceeding(length, question.near, question.far);
    exceeds.push_back({{"length", length}, {"z", z ? Json(*z) : Json(nullptr)}});
  }
  const DepthEncode encode(variant.config, variant.planes);
  const bool is_turned = is_reversed(variant.mapping);
  return {{"name", variant.name()},
          {"mapping", mapping_name(variant.mapping)},
          {"format", to_string(variant.format)},
          {"storage_bits", variant.format.bits},
          {"plane_bits", variant.config.depth_bits},
          {"order", is_turned ? "greater" : "less"},
          {"clear_code", encode.of_window(is_turned ? 0 : 1)},
          {"hardware", hardware_cost(variant)},
          {"codes_used", codes_in_use(theory)},
          {"curve",
           {{"z", curve.z},
            {"bin_width", curve.bin_width},
            {"max_recon_err", curve.max_recon_err},
            {"first_order", curve.first_order}}},
          {"decades", decades},
          {"exceeds", exceeds},
          {"measured", nullptr}};
}

std::string data_uri(const Picture& picture) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const std::vector<std::uint8_t> bytes = encode_png(picture);
  std::string text = "data:image/png;base64,";
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t three = 0;
    for (std::size_t k = 0; k < 3; ++k) three = three << 8 | (i + k < bytes.size() ? bytes[i + k] : 0U);
    for (std::size_t k = 0; k < 4; ++k) text += i + k <= bytes.size() ? kDigits[three >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

/// The same scale for the errors of every variant: two decades below the largest p99.9 to it.
std::pair<double, double> map_range(const std::vector<DepthMeasurement>& measured) {
  double high = 0;
  for (const DepthMeasurement& m : measured) high = std::max(high, m.total.p999);
  if (!(high > 0)) high = 1;
  return {high / 1e4, high};
}

const std::vector<std::string> kFightLegend{"grey: two surfaces or more, in order", "yellow: two with the same code",
                                            "red: two that are swapped"};

std::vector<std::string> heat_legend(const std::pair<double, double>& range) {
  return {"error of the visible surface (log)",
          "dark: " + short_text(range.first) + " or less; bright: " + short_text(range.second),
          "in eye depth, one scale for all"};
}

std::string in_one_line(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += (text.empty() ? "" : "; ") + line;
  return text;
}

/// Pictures of all variants on one sheet, and what their colours mean.
void write_depth_sheet(const std::string& path, const std::string& title, const std::vector<std::string>& legend,
                       const std::vector<DepthVariant>& variants, const std::vector<Picture>& pictures,
                       const std::vector<std::string>& notes) {
  if (path.empty()) return;
  std::vector<Panel> panels;
  for (std::size_t i = 0; i < variants.size(); ++i)
    panels.push_back({variants[i].name(), notes[i], pictures[i], {}, {}});
  panels.push_back({"colours", "", {}, {}, legend});
  write_png(path, compose_sheet(title, panels, std::min(3, static_cast<int>(panels.size()))));
}

void print_theory(std::ostream& out, const std::vector<DepthRow>& rows) {
  out << "mapping   format         z               code      bin width     max error   first order\n";
  for (std::size_t i = 0; i + 3 < rows.size(); ++i) {
    if (rows[i].metric != "code") continue;
    char line[160];
    std::snprintf(line, sizeof line, "%-9s %-9s %10s %16.0f %14.6g %13.6g %13.6g\n", rows[i].mapping.c_str(),
                  rows[i].format.c_str(), short_number(std::stod(rows[i].z)).c_str(), rows[i].value, rows[i + 1].value,
                  rows[i + 2].value, rows[i + 3].value);
    out << line;
  }
  for (const DepthRow& row : rows)
    if (row.z.empty() || row.metric.starts_with("separation") || row.metric.starts_with("fights"))
      out << row.mapping << ' ' << row.format << ": " << row.metric << (row.z.empty() ? "" : " at " + row.z) << ' '
          << depth_number(row.value) << '\n';
}

void print_measured(std::ostream& out, const std::vector<DepthVariant>& variants,
                    const std::vector<DepthMeasurement>& measured) {
  out << "variant         fighting        ties       swaps     rms error     max error  of bound\n";
  for (std::size_t i = 0; i < variants.size(); ++i) {
    const DepthMeasurement& m = measured[i];
    char line[160];
    std::snprintf(line, sizeof line, "%-13s %8.4f %% %11llu %11llu %13.6g %13.6g %7.0f %%\n",
                  variants[i].name().c_str(), 100 * m.order.rate(), static_cast<unsigned long long>(m.order.ties),
                  static_cast<unsigned long long>(m.order.inversions), m.total.rms, m.total.max, 100 * m.worst_share);
    out << line;
  }
}

std::string command_line(const DepthCommand& options, const DepthQuestion& question) {
  std::string text = "halfplane depth";
  if (!options.scene.empty()) text += " --scene " + options.scene;
  text += " --near " + question.near_text + " --far " + question.far_text + " --mapping " + options.mappings;
  std::string formats;
  for (const DepthFormat& format : question.formats) formats += (formats.empty() ? "" : ",") + to_string(format);
  text += " --format " + formats;
  if (!options.size.empty()) text += " --size " + options.size;
  if (!options.camera.empty()) text += " --camera '" + options.camera + "'";
  if (options.config != "embedded") text += " --config " + options.config;
  for (const std::string& setting : options.settings) text += " --set " + setting;
  if (options.seed != 1) text += " --seed " + std::to_string(options.seed);
  return text;
}

int thread_count(const DepthCommand& options) {
  return options.threads > 0 ? options.threads
                             : static_cast<int>(std::clamp(std::thread::hardware_concurrency(), 1U, 16U));
}

/// What a scene adds: measurements, trials, sweeps, pictures.
struct SceneStudy {
  std::vector<DepthMeasurement> measured;
  std::vector<DepthTrial> trials;
  std::vector<DepthSweep> sweeps;
  std::vector<std::string> answers;
};

SceneStudy study_scene(const DepthCommand& options, const DepthQuestion& question, const Scene& scene,
                       const std::vector<DepthVariant>& variants) {
  SceneStudy study;
  const int threads = thread_count(options);
  const bool has_report = !options.report_path.empty(), has_sweeps = has_report || options.sweeps;
  Progress progress(options, "measuring");
  const auto part = [&progress](double from, double to) {
    return [&progress, from, to](double fraction) { progress(from + (to - from) * fraction); };
  };
  MeasureOptions measure;
  measure.wants_maps = has_report || !options.heat_path.empty() || !options.fights_path.empty();
  measure.progress = part(0, 0.4);
  study.measured = measure_depths(scene, variants, measure, threads);
  study.trials = try_changes(scene, variants[0], study.measured[0], threads, part(0.4, 0.8));
  study.answers = depth_answers(variants[0], study.measured[0], study.trials);
  if (has_sweeps) {
    Scene small = scene;  // clip space has no size of its own
    const bool is_scalable = std::all_of(scene.states.begin(), scene.states.end(),
                                         [](const State& state) { return !state.viewport && !state.scissor; });
    if (is_scalable) {
      small.width = std::max(1, scene.width / 4);
      small.height = std::max(1, scene.height / 4);
    }
    study.sweeps = sweep_depth(small, question.config, question.mappings, variants[0].format.bits, variants[0].planes,
                               threads, part(0.8, 1));
  }
  return study;
}

int run_depth(const DepthCommand& options) {
  const auto start = std::chrono::steady_clock::now();
  const Config config = effective_config(options);
  if (config.depth_mapping != DepthMapping::projection || config.depth_format.kind != DepthFormat::Kind::plane)
    throw InputError("depth: give mappings and formats by --mapping and --format, not by --set");
  check_output(options.report_path, options.report_path.empty() ? "" : ".html");
  check_output(options.heat_path, options.heat_path.empty() ? "" : ".png");
  check_output(options.fights_path, options.fights_path.empty() ? "" : ".png");
  if (options.csv_path != "-") check_output(options.csv_path);
  check_distinct({options.report_path, options.heat_path, options.fights_path, options.csv_path, options.json});
  if (options.csv_path == "-" && options.json == "-")
    throw InputError("--csv - and --json both want stdout; name a file");
  if (options.scene.empty() && (!options.heat_path.empty() || !options.fights_path.empty()))
    throw InputError("--heat and --fights are pictures of a scene; give --scene");
  if (!options.report_path.empty()) require_chart_library();
  std::optional<Scene> scene;
  double load_s = 0;
  if (!options.scene.empty()) scene = load_scene(options, config, load_s);
  if (scene && !scene->planes) {
    const bool is_flat = std::all_of(scene->vertices.begin(), scene->vertices.end(),
                                     [&](const Vertex& v) { return v.w == scene->vertices[0].w; });
    if (is_flat || options.near.empty() || options.far.empty())
      throw InputError(options.scene + ": " +
                       (is_flat ? "every w is the same: this is no perspective projection, and no eye depth is known"
                                : "its near and far plane are not known; give --near and --far"));
  }
  const DepthQuestion question = read_question(options, config, scene ? scene->planes : std::nullopt);

  std::vector<DepthRow> rows;
  std::vector<DepthVariant> variants;
  for (const DepthMapping mapping : question.mappings)
    for (const DepthFormat& format : question.formats) {
      add_depth_rows(question, options, mapping, format, rows);
      variants.push_back(make_variant(config, mapping, format, question.planes));
    }
  const std::vector<DepthRow> theory_rows = rows;
  SceneStudy study;
  if (scene) study = study_scene(options, question, *scene, variants);
  for (std::size_t i = 0; i < study.measured.size(); ++i)
    add_measured_rows(question, variants[i], study.measured[i], rows);
  if (question.length) {
    const auto answers = length_answers(question);
    study.answers.insert(study.answers.end(), answers.begin(), answers.end());
  }

  std::string title = options.scene.empty() ? "theory" : options.scene;
  if (scene) title += ", " + std::to_string(scene->width) + "x" + std::to_string(scene->height);
  title += ", near " + short_text(question.planes[0]) + ", far " + short_text(question.planes[1]) + ", " +
           label(config) + ", seed " + std::to_string(options.seed);

  Json result = result_head("depth", options, config);
  result["near"] = question.planes[0];
  result["far"] = question.planes[1];
  result["command"] = command_line(options, question);
  result["rows"] = rows_json(rows);
  Json series = Json::array();
  for (std::size_t i = 0; i < variants.size(); ++i) {
    series.push_back(series_json(variants[i], question));
    if (scene) series.back()["measured"] = measured_json(study.measured[i]);
  }
  result["series"] = series;
  Json trials = Json::array();
  for (const DepthTrial& trial : study.trials)
    trials.push_back({{"what", trial.what},
                      {"options", trial.options},
                      {"name", trial.variant.name()},
                      {"measured", measured_json(trial.result)}});
  result["trials"] = trials;
  Json sweeps = Json::array();
  for (const DepthSweep& sweep : study.sweeps) {
    Json lines = Json::array();
    for (const auto& line : sweep.lines) lines.push_back({{"name", line.name}, {"x", line.x}, {"rate", line.rate}});
    sweeps.push_back({{"what", sweep.what}, {"unit", sweep.unit}, {"lines", lines}});
  }
  result["sweeps"] = sweeps;
  result["answers"] = study.answers;
  result["wall_s"] = seconds_since(start);

  if (scene && !study.measured[0].error.empty()) {
    const auto range = map_range(study.measured);
    std::vector<Picture> heats, fights;
    std::vector<std::string> heat_notes, fight_notes;
    for (const DepthMeasurement& m : study.measured) {
      heats.push_back(error_map(scene->width, scene->height, m.error, range.first, range.second, 640));
      fights.push_back(fight_map(scene->width, scene->height, m.fights, 640));
      heat_notes.push_back("max " + short_text(m.total.max) + ", rms " + short_text(m.total.rms));
      fight_notes.push_back(std::to_string(m.order.ties) + " ties, " + std::to_string(m.order.inversions) +
                            " swaps of " + std::to_string(m.order.pairs) + " pairs");
    }
    write_depth_sheet(options.heat_path, title, heat_legend(range), variants, heats, heat_notes);
    write_depth_sheet(options.fights_path, title, kFightLegend, variants, fights, fight_notes);
    if (!options.report_path.empty()) {
      Json page = result;
      page["version"] = HALFPLANE_VERSION;
      page["config"] = label(config);
      page["scene"] = {{"name", options.scene},
                       {"width", scene->width},
                       {"height", scene->height},
                       {"fragments", study.measured[0].fragments},
                       {"triangles", study.measured[0].triangles},
                       {"eye_min", study.measured[0].eye_min},
                       {"eye_max", study.measured[0].eye_max}};
      page["heat_legend"] = in_one_line(heat_legend(range));
      page["fight_legend"] = in_one_line(kFightLegend);
      for (std::size_t i = 0; i < variants.size(); ++i) {
        page["series"][i]["measured"]["heat"] = data_uri(heats[i]);
        page["series"][i]["measured"]["fight"] = data_uri(fights[i]);
      }
      const std::string html = depth_report(page.dump());
      write_whole_file(options.report_path, {reinterpret_cast<const std::uint8_t*>(html.data()), html.size()});
    }
  } else if (!options.report_path.empty()) {
    Json page = result;
    page["version"] = HALFPLANE_VERSION;
    page["config"] = label(config);
    const std::string html = depth_report(page.dump());
    write_whole_file(options.report_path, {reinterpret_cast<const std::uint8_t*>(html.data()), html.size()});
  }
  const std::string csv = depth_csv(rows);
  if (!options.csv_path.empty() && options.csv_path != "-")
    write_whole_file(options.csv_path, {reinterpret_cast<const std::uint8_t*>(csv.data()), csv.size()});
  write_json(options, result);
  if (options.csv_path == "-") {
    std::cout << csv;
    return exit_ok;
  }
  std::ostream& out = human(options);
  out << title << '\n';
  print_theory(out, theory_rows);
  if (scene) {
    out << '\n';
    print_measured(out, variants, study.measured);
    for (const DepthSweep& sweep : study.sweeps) print_sweep(out, sweep);
  }
  if (!study.answers.empty()) out << '\n';
  for (const std::string& answer : study.answers) out << answer << '\n';
  // A bound that does not hold, or a code that the stages do not explain, is a fault of this program.
  const bool is_broken = std::any_of(study.measured.begin(), study.measured.end(), [](const DepthMeasurement& m) {
    return m.worst_share > 1 || m.stage_mismatches != 0;
  });
  if (is_broken) out << "a measured error exceeds its bound, or a stored code is not what the stages compute\n";
  return is_broken ? exit_mismatch : exit_ok;
}

}  // namespace

void add_depth_command(CLI::App& app, Action& selected) {
  CLI::App* command = app.add_subcommand("depth", "depth quantization: theory, and measured on a scene");
  auto options = std::make_shared<DepthCommand>();
  options->threads = 0;
  command->add_option("--near", options->near, "eye depth of the near plane (default: the scene's)")->type_name("Z");
  command->add_option("--far", options->far, "eye depth of the far plane (default: the scene's)")->type_name("Z");
  command->add_option("--mapping", options->mappings, "some of std, rev, stdinf, revinf, w, log")
      ->default_str("std,rev,w")
      ->type_name("LIST");
  options->mappings = "std,rev,w";
  command->add_option("--format", options->formats, "some of u<b>, bins<b>, f16, f32, uf<e>.<m> (default u16)")
      ->type_name("LIST");
  command->add_option("--bits", options->bits, "short for --format u<N>")->check(CLI::Range(2, 32))->type_name("N");
  command->add_option("--z", options->z, "eye depths to look at (default: near, powers of ten, far)")
      ->type_name("LIST");
  command
      ->add_option("--error", options->error,
                   "a length: the depth where bins exceed it, the fewest bits and the least near plane that keep it")
      ->type_name("LENGTH");
  command->add_option("--range", options->range, "the depths that --error is about (default: near,far)")
      ->type_name("A,B");
  command
      ->add_option("--slope", options->slope,
                   "also the minimum separation of two surfaces that recede so many units for each unit across (0: "
                   "facing), tried on such surfaces")
      ->type_name("S");
  command->add_option("--fov", options->fov, "for --slope: vertical, degrees")
      ->check(CLI::Range(0.01, 179.0))
      ->check(is_number)
      ->capture_default_str();
  command->add_option("--scene", options->scene, "measure it on this scene: built-in name or file");
  command->add_option("--size", options->size, "target, WxH pixels")->check([](const std::string& text) {
    return text.empty() ? std::string("nothing given, where a value is due") : std::string();
  });
  command->add_option("--camera", options->camera, "as for render");
  add_seed_option(*command, *options, "seed of scenes with something random in them");
  command->add_option("--threads", options->threads, "use at most N threads (default: as many as there are cores)")
      ->check(CLI::Range(1, 1024));
  add_output_options(*command, *options);
  add_file_option(*command, "--csv", options->csv_path, "rows of mapping,format,near,far,z,metric,value; - for stdout");
  add_file_option(*command, "-o", options->report_path, "everything as one HTML page, .html");
  command->add_flag("--sweep", options->sweeps,
                    "with --scene: also how the fights fall with storage and subpixel bits (always with -o)");
  add_file_option(*command, "--heat", options->heat_path, "errors of the visible surfaces, side by side, .png");
  add_file_option(*command, "--fights", options->fights_path, "where surfaces fight, side by side, .png");
  command->footer(
      "\nExamples:\n  halfplane depth --near 1 --far 1000 --mapping std,rev,w --format u16,u24,uf4.12 --z 10,100,900 "
      "--csv "
      "-\n  halfplane depth --scene coplanar --bits 16 -o report.html");
  command->callback([&selected, options] { selected = [options] { return run_depth(*options); }; });
}

}  // namespace halfplane
