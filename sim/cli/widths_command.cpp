#include "sim/cli/widths_command.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <iostream>
#include <memory>
#include <sstream>

#include "model/widths.hpp"
#include "sim/cli/commands.hpp"
#include "sim/cli/option_kinds.hpp"
#include "sim/cli/progress.hpp"
#include "sim/show/image/whole_file.hpp"
#include "sim/study/compare/surface_oracle.hpp"
#include "sim/study/widths/study.hpp"

namespace halfplane {
namespace {

/// A number if every reader of JSON has it exactly, else text.
Json integer_json(int128 value) {
  constexpr int128 exact = int128{1} << 53;
  if (value >= -exact && value <= exact) return static_cast<std::int64_t>(value);
  return decimal(value);
}

/// All digits if they fit their column.
std::string short_decimal(int128 value) {
  std::string text = decimal(value);
  if (text.size() <= 11) return text;
  return formatted("%.5g", static_cast<double>(value));
}

std::string file_name(const Width& width) {
  std::string name(width.name);
  std::replace(name.begin(), name.end(), ' ', '-');
  return name + ".hpt";
}

Json probe_json(const Probe& probe, const Config& config) {
  Json vertices = Json::array();
  const Scene scene = probe_scene(probe, config);
  for (std::size_t i = 0; i < scene.vertices.size(); ++i)
    vertices.push_back({{"x", scene.vertices[i].x},
                        {"y", scene.vertices[i].y},
                        {"depth_code", probe.v[i].depth()},
                        {"rgba", color_channels(probe.v[i].code)}});
  Json json{{"kind", probe.is_line ? "line" : "triangle"}};
  if (probe.is_line) json["line_rule"] = probe.rule == LineRule::diamond ? "diamond" : "midpoint";
  json["vertices"] = vertices;
  return json;
}

Json width_json(const Width& width) {
  return {{"name", width.name},
          {"formula", width.bound},
          {"lo", integer_json(width.range.lo)},
          {"hi", integer_json(width.range.hi)},
          {"bits", width.bits},
          {"signed", width.is_signed},
          {"modular", width.is_modular}};
}

Json row_json(const WidthRow& row, const Config& config) {
  Json json = width_json(row.width);
  json["observed"] = row.is_observed;
  if (!row.is_observed || row.seen.count == 0) return json;
  json["values_lo"] = integer_json(row.range.lo);
  json["values_hi"] = integer_json(row.range.hi);
  json["seen_lo"] = integer_json(row.seen.lo);
  json["seen_hi"] = integer_json(row.seen.hi);
  json["attained"] = {{"lo", row.attains_lo()}, {"hi", row.attains_hi()}};
  json["used"] = row.used();
  json["spare_bits"] = row.spare_bits();
  json["overflows_first"] = nullptr;
  if (row.overflows) {
    Json overflow{{"value", integer_json(row.overflows->value)}};
    overflow["random_primitives"] = row.overflows->random_probes;
    overflow["first_random_primitive"] = or_null(row.overflows->random_probes != 0, row.overflows->first_probe);
    overflow["input"] = probe_json(row.overflows->probe, config);
    json["overflows_first"] = overflow;
  }
  return json;
}

constexpr std::array kTextureSides{256, 1024, 4096};

/// The bound of the ratio of w over a triangle for which errors over w are proven.
Json over_w_json(const Config& config) {
  const PerspectiveFormat format = perspective_format(config);
  Json coordinate = Json::array();
  for (const int texels : kTextureSides)
    coordinate.push_back({{"texels", texels},
                          {"error_texels", kProvenTexels},
                          {"w_ratio", proven_w_ratio(texels, format, config.tile_size)}});
  return {{"coordinate", coordinate},
          {"color",
           {{"error_lsb", kProvenColor},
            {"w_ratio", proven_w_ratio(255, kProvenColor, format, format.color, config.tile_size)}}},
          {"level_of_detail", {{"error_levels", 0.1}, {"w_ratio", largest_level_w_ratio(format)}}}};
}

Json study_json(const WidthStudy& study, const Config& config) {
  Json widths = Json::array(), order = Json::array(), homogeneous = Json::array();
  for (const WidthRow& row : study.rows) widths.push_back(row_json(row, config));
  for (const std::size_t place : study.overflow_order()) order.push_back(study.rows[place].width.name);
  const HomogeneousWidths scalar = derive_homogeneous_widths(config);
  for (const Width* width : scalar.all()) homogeneous.push_back(width_json(*width));
  return {{"probes", study.probes},
          {"widths", widths},
          {"overflow_order", order},
          {"homogeneous", homogeneous},
          {"error_bounds",
           {{"depth_lsb", depth_error_bound(config)},
            {"line_depth_lsb", line_depth_error_bound(config)},
            {"homogeneous_edge_pixels", homogeneous_edge_bound(config)},
            {"over_w", over_w_json(config)}}}};
}

/// "=" where the end is attained.
std::string end_text(int128 value, bool is_attained) { return (is_attained ? "=" : "") + short_decimal(value); }

void print_rows(std::ostream& out, const WidthStudy& study) {
  const auto cell = [&](const std::string& text, std::size_t width) { out << right_aligned(text, width); };
  out << "                            -------- derived ---------  ---------- seen ----------\n"
         "width             bits          least      largest        least      largest   used  spare  formula\n";
  for (const WidthRow& row : study.rows) {
    if (!row.is_observed) continue;
    out << left_aligned(std::string(row.width.name), 18);
    cell(std::to_string(row.width.bits), 4);
    out << (row.width.is_modular ? " m" : row.width.is_signed ? " s" : "  ");
    cell(short_decimal(row.range.lo), 13);
    cell(short_decimal(row.range.hi), 13);
    if (row.seen.count == 0) {
      out << "  no input reached it" << std::string(26, ' ');
    } else {
      cell(end_text(row.seen.lo, row.attains_lo()), 13);
      cell(end_text(row.seen.hi, row.attains_hi()), 13);
      cell(fixed(100 * row.used(), 1) + "%", 7);
      cell(std::to_string(row.spare_bits()), 7);
    }
    out << "  " << row.width.bound << '\n';
  }
  out << "s: signed; m: modulo 2^bits, and the ranges are those of the values read back at covered samples; =: "
         "attained\n";
}

void print_exact(std::ostream& out, const WidthStudy& study) {
  std::vector<std::string> names;
  for (const WidthRow& row : study.rows)
    if (!row.is_observed) names.push_back(std::string(row.width.name) + ' ' + std::to_string(row.width.bits));
  out << "\nexact by construction, counts of states, slots and numbers:\n  " << joined(names) << '\n';
}

/// One line: "triangle (-2048, 3.5) (...) ...", pixels.
std::string probe_text(const Probe& probe, const Config& config) {
  std::ostringstream text;
  text << (probe.is_line ? "line" : "triangle");
  for (const Vertex& v : probe_scene(probe, config).vertices) text << " (" << v.x << ", " << v.y << ')';
  return text.str();
}

void print_overflows(std::ostream& out, const WidthStudy& study, const Config& config, const std::string& folder) {
  out << "\nOne bit less: what overflows first. 'first' is the number of the first random primitive that does it, 'of "
         "all' "
         "how many do;\nwhere none does, the search found the input.\n"
         "width               with        value  first   of all  input, pixels\n";
  for (const std::size_t place : study.overflow_order()) {
    const WidthRow& row = study.rows[place];
    const std::uint64_t count = row.overflows->random_probes;
    out << left_aligned(std::string(row.width.name), 18) << right_aligned(std::to_string(row.width.bits - 1), 6)
        << right_aligned(short_decimal(row.overflows->value), 13)
        << right_aligned(count == 0 ? "-" : std::to_string(row.overflows->first_probe), 7)
        << right_aligned(with_commas(count), 9) << "  "
        << (folder.empty() ? probe_text(row.overflows->probe, config)
                           : (std::filesystem::path(folder) / file_name(row.width)).string())
        << '\n';
  }
  std::vector<std::string_view> spare;
  for (const WidthRow& row : study.rows)
    if (row.is_observed && !row.overflows) spare.push_back(row.width.name);
  if (!spare.empty()) out << "nothing seen overflows with a bit less: " << joined(spare) << '\n';
}

void print_over_w(std::ostream& out, const Config& config) {
  const PerspectiveFormat format = perspective_format(config);
  const auto ratio = [](const std::optional<double>& r) {
    return r ? with_commas(static_cast<std::uint64_t>(*r)) : std::string("none");
  };
  out << "proven over w, for ratios of w over a triangle up to: a coordinate to 1/16 texel,";
  for (const int texels : kTextureSides)
    out << ' ' << ratio(proven_w_ratio(texels, format, config.tile_size)) << " (" << texels << " texels),";
  out << " a colour to 2 LSB, " << ratio(proven_w_ratio(255, kProvenColor, format, format.color, config.tile_size))
      << ", a level of detail to 0.1, " << ratio(largest_level_w_ratio(format))
      << "; beyond, the bound says how much\n";
}

void print_bounds(std::ostream& out, const Config& config) {
  out << "\nerror bounds that the widths keep: depth " << fixed(depth_error_bound(config), 4) << " LSB, along lines "
      << fixed(line_depth_error_bound(config), 4) << " LSB\n"
      << "the scalar engine's path without clipping (not tried here): edges within "
      << fixed(homogeneous_edge_bound(config), 5) << " pixels;";
  const HomogeneousWidths scalar = derive_homogeneous_widths(config);
  std::vector<std::string> names;
  for (const Width* width : scalar.all()) names.push_back(std::string(width->name) + ' ' + std::to_string(width->bits));
  out << ' ' << joined(names) << '\n';
  print_over_w(out, config);
}

void write_captures(const std::string& folder, const WidthStudy& study, const Config& config) {
  for (const WidthRow& row : study.rows) {
    if (!row.overflows) continue;
    write_text_file(std::filesystem::path(folder) / file_name(row.width),
                    capture_text(probe_scene(row.overflows->probe, config)));
  }
}

int run_table(const WidthsCommand& options) {
  const auto start = std::chrono::steady_clock::now();
  const Config config = effective_config(options);
  require_one_sample(config, "widths");
  make_folder("--captures", options.captures);
  WidthStudy study;
  {
    Progress progress(options, "trying widths", "probes");
    WidthStudyOptions study_options;
    study_options.seed = options.seed;
    study_options.samples = options.samples;
    study_options.progress = [&progress](double fraction, std::uint64_t probes) { progress(fraction, probes); };
    study = study_widths(config, study_options);
  }
  const bool is_partial = is_interrupted();
  if (!options.captures.empty()) write_captures(options.captures, study, config);
  Json result = result_head("widths", options, config);
  result["seed"] = options.seed;
  result["samples"] = options.samples;
  result.update(study_json(study, config));
  finish_json(options, result, start, is_partial);

  std::ostream& out = human(options);
  out << label(config) << "; seed " << options.seed << ", " << with_commas(options.samples) << " random primitives, "
      << with_commas(study.probes) << " in all\n\n";
  print_rows(out, study);
  print_exact(out, study);
  print_overflows(out, study, config, options.captures);
  print_bounds(out, config);
  int status = exit_ok;
  for (const WidthRow& row : study.rows)
    if (!row.is_within()) {
      out << "BROKEN: " << row.width.name << " leaves its derived range\n";
      status = exit_mismatch;
    }
  return ended(out, is_partial, status);
}

}  // namespace

void add_widths_command(CLI::App& app, Action& selected) {
  CLI::App* command = app.add_subcommand("widths", "every intermediate value: bound, width, largest value seen, slack");
  auto options = std::make_shared<WidthsCommand>();
  add_output_options(*command, *options);
  add_seed_option(*command, *options, "seed of the random primitives, and of scenes with random parts");
  CLI::Option* samples = add_number_option(*command, "--samples", options->samples, 1, 100000000,
                                           "random primitives, in addition to the search for extremes");
  CLI::Option* captures = add_text_option(*command, "--captures", options->captures,
                                          "writes each input that overflows one bit less, as a capture", "FOLDER");
  CLI::Option* smallest = command->add_flag("--smallest", options->smallest,
                                            "the smallest configuration that keeps the bounds below on the scenes");
  smallest->excludes(samples)->excludes(captures);
  command->add_option("--scene", options->scenes, "with --smallest: scenes, with commas")
      ->delimiter(',')
      ->needs(smallest)
      ->type_name("SCENE,...");
  add_text_option(*command, "--size", options->size,
                  "with --smallest: target, WxH pixels (default 320x240, or what a capture says)")
      ->needs(smallest);
  command
      ->add_option("--depth-error", options->depth_error,
                   "with --smallest: largest error against the exact plane: '0.75lsb' of the starting depth.bits, or "
                   "'1e-4' of the depth range")
      ->needs(smallest);
  command
      ->add_option("--fight-rate", options->fight_rate,
                   "with --smallest: less than this part of the overlapping pairs of fragments is stored out of order "
                   "or equal: '0.01' or '1%'")
      ->type_name("PART")
      ->needs(smallest);
  command
      ->add_option("--coverage-error", options->coverage_error,
                   "with --smallest: most pixels that are missing or extra in a scene, against unsnapped vertices")
      ->needs(smallest);
  command
      ->add_option("--color-error", options->color_error,
                   "with --smallest: largest error against the exact plane: '0.75lsb' of the stored colour")
      ->needs(smallest);
  command
      ->add_option("--texture-error", options->texture_error,
                   "with --smallest: largest error of texture coordinates, in texels: '0.0625'")
      ->needs(smallest)
      ->type_name("TEXELS");
  command->footer(
      "\nExample:\n  halfplane widths --config tiny\n  halfplane widths --smallest --scene teapot --size 160x120 "
      "--depth-error 1lsb");
  command->callback([&selected, options] {
    selected = [options] { return options->smallest ? run_smallest(*options) : run_table(*options); };
  });
}

}  // namespace halfplane
