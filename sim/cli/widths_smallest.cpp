// `widths --smallest`: the search's answer as text and JSON.
#include <algorithm>
#include <cmath>
#include <iostream>

#include "model/as_number.hpp"
#include "model/stages/surface.hpp"
#include "model/widths.hpp"
#include "sim/cli/progress.hpp"
#include "sim/cli/widths_command.hpp"
#include "sim/study/widths/smallest.hpp"
#include "sim/study/widths/study.hpp"

namespace halfplane {
namespace {

/// A positive number, all of `text`.
std::optional<double> positive(std::string_view text) {
  const auto value = as_number<double>(text);
  return value && std::isfinite(*value) && *value > 0 ? value : std::nullopt;
}

std::optional<double> positive_lsb(std::string_view text) {
  if (!text.ends_with("lsb")) return std::nullopt;
  return positive(text.substr(0, text.size() - 3));
}

double one_lsb(const Config& config) { return 1 / (std::ldexp(1.0, config.depth_bits) - 1); }

ErrorBounds parse_bounds(const WidthsCommand& options, const Config& start) {
  ErrorBounds bounds;
  if (!options.depth_error.empty()) {
    const auto lsb = positive_lsb(options.depth_error), part = positive(options.depth_error);
    bounds.depth = lsb ? *lsb * one_lsb(start) : part;
    if (!bounds.depth || *bounds.depth >= 1)
      throw InputError("--depth-error: '" + options.depth_error +
                       "' is no bound; give LSB, as in 0.75lsb, or a part of the depth range below 1, as in 1e-4");
  }
  if (!options.color_error.empty()) {
    bounds.color = positive_lsb(options.color_error);
    if (!bounds.color)
      throw InputError("--color-error: '" + options.color_error + "' is no bound; give LSB, as in 0.75lsb");
  }
  if (!options.coverage_error.empty()) {
    bounds.coverage = as_number<std::uint64_t>(options.coverage_error);
    if (!bounds.coverage)
      throw InputError("--coverage-error: '" + options.coverage_error +
                       "' is no number of pixels; give a whole one, as in 100");
  }
  if (!options.texture_error.empty()) {
    bounds.texture = positive(options.texture_error);
    if (!bounds.texture)
      throw InputError("--texture-error: '" + options.texture_error + "' is no bound; give texels, as in 0.0625");
  }
  if (!options.fight_rate.empty()) bounds.fights = parse_part(options.fight_rate, "--fight-rate");
  if (!bounds.depth && !bounds.color && !bounds.coverage && !bounds.texture && !bounds.fights)
    throw InputError(
        "--smallest: no bound; give --fight-rate, --depth-error, --color-error, --coverage-error or --texture-error");
  return bounds;
}

Json errors_json(const SceneErrors& errors, const Config& config) {
  return {{"depth", errors.depth},
          {"depth_lsb", errors.depth / one_lsb(config)},
          {"coverage", errors.coverage},
          {"color_lsb", errors.color},
          {"texture_texels", errors.texture},
          {"fight_rate", errors.fights}};
}

Json bits_json(const HardwareBits& bits) {
  return {{"total", bits.total()},     {"packets", bits.packets}, {"context", bits.context},
          {"products", bits.products}, {"tiles", bits.tiles},     {"over_w", bits.over_w}};
}

Json trial_json(const TriedConfig& trial, const std::vector<std::string>& names, bool has_over_w) {
  Json scenes = Json::array();
  for (std::size_t i = 0; i < trial.scenes.size(); ++i) {
    Json scene{{"scene", names[i]}};
    scene.update(errors_json(trial.scenes[i], trial.config));
    scenes.push_back(scene);
  }
  const auto ratio = proven_w_ratio(1024, perspective_format(trial.config), trial.config.tile_size);
  return {{"config", label(trial.config)},
          {"bits", bits_json(hardware_bits(trial.config, has_over_w))},
          {"scenes", scenes},
          {"proven",
           {{"depth_lsb", depth_error_bound(trial.config)},
            {"line_depth_lsb", line_depth_error_bound(trial.config)},
            {"coordinate_w_ratio", ratio}}},
          {"broken", or_null(trial.broken)}};
}

/// The options that turn the start into `config`.
std::string set_options(const Config& config, const Config& start) {
  std::string text;
  for (const Setting& setting : settings())
    if (const std::string value = get(config, setting); value != get(start, setting))
      text += " --set " + std::string(setting.key) + "=" + value;
  return text;
}

std::string start_options(const WidthsCommand& options) {
  std::string text = "--config " + quoted(options.config);
  for (const std::string& setting : options.settings) text += " --set " + quoted(setting);
  return text;
}

void print_bits(std::ostream& out, const char* name, const HardwareBits& bits) {
  const auto cell = [](long n) { return right_aligned(with_commas(static_cast<std::uint64_t>(n)), 10); };
  out << left_aligned(name, 10) << cell(bits.total()) << cell(bits.packets) << cell(bits.context) << cell(bits.products)
      << cell(bits.tiles) << (bits.over_w != 0 ? cell(bits.over_w) : "") << '\n';
}

std::string part_text(double part) { return formatted("%.4g", part); }

void print_found(std::ostream& out, const Smallest& smallest, const Config& start, const ErrorBounds& bounds,
                 bool has_over_w, const WidthsCommand& options) {
  const TriedConfig& found = *smallest.found;
  out << start_options(options) << set_options(found.config, start) << "\n\n";
  out << "bits           total   packets   context  products     tiles" << (has_over_w ? "    over w" : "") << '\n';
  print_bits(out, "start", hardware_bits(start, has_over_w));
  print_bits(out, "smallest", hardware_bits(found.config, has_over_w));
  out << "packets: a register for each packet between stages; context: the context RAM; products: the multipliers'\n"
         "outputs, two of each; tiles: the on-chip depth and colour"
      << (has_over_w ? ";\nover w: planes in the context RAM, and the products of their divisions" : "") << "\n\n";
  const SceneErrors worst = found.worst();
  const double lsb = one_lsb(found.config);
  char line[160];
  out << "error             measured        bound\n";
  if (worst.fights) {
    std::snprintf(line, sizeof line, "fights          %10s %12s   of the overlapping pairs, the worst scene%s\n",
                  part_text(*worst.fights).c_str(), bounds.fights ? part_text(*bounds.fights).c_str() : "-",
                  bounds.fights ? "" : "; --fight-rate bounds them");
    out << line;
  }
  std::snprintf(line, sizeof line,
                "depth           %10.4g %12s   of the depth range; %.3f LSB of %d bits, proven %.3f (lines %.3f)\n",
                worst.depth, bounds.depth ? part_text(*bounds.depth).c_str() : "-", worst.depth / lsb,
                found.config.depth_bits, depth_error_bound(found.config), line_depth_error_bound(found.config));
  out << line;
  std::snprintf(line, sizeof line, "coverage        %10llu %12s   pixels missing or extra, the worst scene\n",
                static_cast<unsigned long long>(worst.coverage),
                bounds.coverage ? std::to_string(*bounds.coverage).c_str() : "-");
  out << line;
  std::snprintf(line, sizeof line, "colour          %10.3f %12s   LSB\n", worst.color,
                bounds.color ? fixed(*bounds.color, 3).c_str() : "-");
  out << line;
  if (bounds.texture) {
    const auto ratio = proven_w_ratio(1024, perspective_format(found.config), found.config.tile_size);
    std::snprintf(line, sizeof line, "coordinate      %10.4f %12.4f   texels; 1/16 of 1024 proven to a w ratio of %s\n",
                  worst.texture, *bounds.texture, ratio ? fixed(*ratio, 0).c_str() : "none");
    out << line;
  }
  if (!smallest.one_less.empty()) out << "\nOne bit less of                what breaks\n";
  for (const OneLess& less : smallest.one_less)
    out << left_aligned(std::string(less.key) + " = " + std::to_string(less.value), 31)
        << (less.is_fixed         ? "not searched: no given bound speaks of it"
            : less.broken.empty() ? "nothing on these scenes"
                                  : less.broken)
        << '\n';
}

}  // namespace

int run_smallest(const WidthsCommand& options) {
  const auto begin = std::chrono::steady_clock::now();
  const Config start = effective_config(options);
  require_one_sample(start, "widths");
  const ErrorBounds bounds = parse_bounds(options, start);
  if (options.scenes.empty()) throw InputError("--smallest: no scene; give --scene, as in --scene teapot,city");
  if (start.depth_format != DepthFormat{} || start.depth_mapping != DepthMapping::projection)
    throw InputError("--smallest: it measures the planes; leave depth.format and depth.mapping as they are");
  std::vector<Scene> scenes;
  for (const std::string& name : options.scenes) {
    CommonOptions scene_options = options;
    scene_options.scene = name;
    if (options.size.empty() && !name.ends_with(".hpt"))  // the search draws each scene some twenty times
      scene_options.size =
          std::to_string(std::min(320, start.target_width)) + "x" + std::to_string(std::min(240, start.target_height));
    double load_s = 0;
    scenes.push_back(load_scene(scene_options, start, load_s));
  }
  const bool has_over_w =
      std::ranges::any_of(scenes, [](const Scene& scene) { return std::ranges::any_of(scene.states, has_surface); });
  Smallest smallest;
  {
    Progress progress(options, "measuring", "configurations");
    const double unknown = std::nan("");  // the total is unknown
    smallest = find_smallest(scenes, start, bounds,
                             [&](int trials) { progress(unknown, static_cast<std::uint64_t>(trials)); });
  }
  const bool is_partial = is_interrupted();
  Json result = result_head("widths", options, start);
  result["seed"] = options.seed;
  result["scenes"] = options.scenes;
  result["measured"] = true;  // on these scenes; not proven
  result["bounds"] = {{"depth", bounds.depth},
                      {"coverage", bounds.coverage},
                      {"color_lsb", bounds.color},
                      {"texture_texels", bounds.texture},
                      {"fight_rate", bounds.fights}};
  result["trials"] = smallest.trials;
  result["start_bits"] = bits_json(hardware_bits(start, has_over_w));
  result["widest"] = smallest.trials > 0 ? trial_json(smallest.widest, options.scenes, has_over_w) : Json(nullptr);
  result["smallest"] = smallest.found ? trial_json(*smallest.found, options.scenes, has_over_w) : Json(nullptr);
  if (smallest.found) result["smallest"]["set"] = start_options(options) + set_options(smallest.found->config, start);
  Json one_less = Json::array();
  for (const OneLess& less : smallest.one_less)
    one_less.push_back(
        {{"key", less.key}, {"value", less.value}, {"searched", !less.is_fixed}, {"broken", or_null(less.broken)}});
  result["one_less"] = one_less;
  finish_json(options, result, begin, is_partial);

  std::ostream& out = human(options);
  std::string names;
  for (std::size_t i = 0; i < scenes.size(); ++i)
    names += (i == 0 ? "" : ", ") + options.scenes[i] + " at " + std::to_string(scenes[i].width) + "x" +
             std::to_string(scenes[i].height);
  out << "the smallest configuration for " << names << ", measured and not proven: another scene may need more\n"
      << smallest.trials << " configurations measured, from " << label(start) << "; seed " << options.seed << '\n';
  if (is_partial) {
    if (smallest.found) print_found(out, smallest, start, bounds, has_over_w, options);
    print_partial(out);
    return exit_interrupted;
  }
  if (!smallest.found) {
    out << "none keeps the bounds; the widest (" << label(smallest.widest.config) << ") breaks "
        << smallest.widest.broken << '\n';
    return exit_mismatch;
  }
  print_found(out, smallest, start, bounds, has_over_w, options);
  return exit_ok;
}

}  // namespace halfplane
