#include "sim/study/compare/compare.hpp"
#include "sim/study/compare/per_vertex.hpp"
#include "sim/study/compare/transform_errors.hpp"

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <iterator>

#include "sim/cli/commands.hpp"
#include "sim/cli/compare_against.hpp"
#include "sim/cli/option_kinds.hpp"
#include "sim/cli/progress.hpp"
#include "sim/cli/study_options.hpp"
#include "sim/show/image/framebuffer_files.hpp"
#include "sim/show/image/panel.hpp"
#include "sim/show/image/png.hpp"
#include "sim/show/image/terminal.hpp"

namespace halfplane {

HALFPLANE_JSON_OF_MEMBERS(LayerRow, layers, pixels, max, rms, bound, part_of_bound)
HALFPLANE_JSON_OF_MEMBERS(PerVertexRow, area, triangles, pixels, max, rms)

namespace {

struct CompareCommand : CommonOptions {
  std::string golden = "binary64";
  StudyOptions study;
  AgainstWords against;
  std::string sheet_path, model_path, golden_path, junit_path;
  std::vector<std::string> panels;
};

/// Null for no samples; `count` shows that.
template <class Stats>
Json figure_of(const Stats& s, double value) {
  return or_null(s.count != 0, value);
}

template <class Stats>
Json part_json(const Stats& s) {
  return {{"count", s.count}, {"max", figure_of(s, s.max)}, {"rms", figure_of(s, s.rms)}};
}

Json moments_json(const ErrorMoments& s) {
  Json json = part_json(s);
  json["mean"] = figure_of(s, s.mean);
  return json;
}

Json host_errors_json(const HostErrors& errors) {
  return {{"pixels", moments_json(errors.pixels)}, {"depth_lsb", moments_json(errors.depth_lsb)}};
}

Json transform_json(const std::string& numbers, const TransformErrors& errors) {
  Json json = host_errors_json(errors.whole);
  json["numbers"] = numbers;
  json["parts"] = {{"transform", host_errors_json(errors.transform)},
                   {"clip", host_errors_json(errors.clip)},
                   {"divide", host_errors_json(errors.divide)}};
  json["cut"] = errors.cut;
  json["cut_otherwise"] = errors.cut_otherwise;
  json["without_w"] = errors.without_w;
  return json;
}

Json stats_json(const ErrorStats& s) {
  Json json = moments_json(s);
  json["p999"] = figure_of(s, s.p999);
  return json;
}

Json texture_json(const TextureErrors& t) {
  return {{"pixels", t.pixels},
          {"coordinate",
           {{"texels", part_json(t.coordinate)},
            {"footprints", part_json(t.footprints)},
            {"of_bound", t.coordinate_of_bound}}},
          {"level_of_detail", moments_json(t.level)},
          {"parts",
           {{"coordinate", part_json(t.part_coordinate)},
            {"level_of_detail", part_json(t.part_level)},
            {"weights", part_json(t.part_weights)},
            {"rounding", part_json(t.part_rounding)}}}};
}

Json cycles_json(const std::optional<PerVertexCycles>& cycles) {
  if (!cycles || !cycles->refused.empty()) return nullptr;
  return {{"at_vertices", cycles->vertices},
          {"at_fragments", cycles->fragments},
          {"without_unit", cycles->without_unit},
          {"set", cycles->set}};
}

Json comparison_json(const Comparison& c) {
  Json json{{"compared_pixels", c.compared_pixels},
            {"coverage",
             {{"missing", c.coverage.missing},
              {"extra", c.coverage.extra},
              {"missing_pixels", c.missing_pixels},
              {"extra_pixels", c.extra_pixels},
              {"near_edge", c.coverage.near_edge},
              {"other_visible", c.other_visible},
              {"oracle_samples", c.oracle.samples},
              {"oracle_mismatches", c.oracle.mismatches}}},
            {"depth_lsb", stats_json(c.depth_lsb)},
            {"depth_eye", c.depth_eye ? stats_json(*c.depth_eye) : Json(nullptr)},
            {"color_lsb", stats_json(c.color_lsb)},
            {"parts",
             {{"snap", part_json(c.parts.snap)},
              {"interpolation", part_json(c.parts.interpolation)},
              {"storage", part_json(c.parts.storage)},
              {"affine", part_json(c.affine)}}},
            {"affine_coordinate_texels", part_json(c.affine_coordinate)},
            {"color_parts",
             {{"snap", part_json(c.color_parts.snap)},
              {"interpolation", part_json(c.color_parts.interpolation)},
              {"storage", part_json(c.color_parts.storage)}}},
            {"datapath",
             {{"depth_lsb", moments_json(c.datapath)},
              {"line_depth_lsb", moments_json(c.line_datapath)},
              {"depth_bias", figure_of(c.datapath_bias, c.datapath_bias.mean)},
              {"color_lsb", moments_json(c.color_datapath)},
              {"color_over_w_lsb", part_json(c.color_over_w)},
              {"light_lsb", part_json(c.light)},
              {"fog_lsb", part_json(c.fog)},
              {"color_bias", figure_of(c.color_datapath_bias, c.color_datapath_bias.mean)},
              {"stage_mismatches", c.stage_mismatches}}},
            {"texture", c.texture ? texture_json(*c.texture) : Json(nullptr)},
            {"per_vertex", c.per_vertex},
            {"layers", c.layers}};
  return json;
}

template <class Stats>
std::string max_text(const Stats& s) {
  return s.count == 0 ? "-" : fixed(s.max, 3);
}

template <class Stats>
std::string rms_text(const Stats& s) {
  return s.count == 0 ? "-" : fixed(s.rms, 4);
}

template <class Stats>
std::string row(const std::string& name, const Stats& s) {
  return name + "\t" + max_text(s) + "\t" + rms_text(s);
}

/// For positions, whose errors in binary32 are small.
std::string two_digits(double value) { return formatted("%.2g", value); }

/// Caption of a picture: the figures of the row, each on one line with its name.
template <class Stats>
std::string figures(const Stats& s) {
  return "max\u00a0" + max_text(s) + "  rms\u00a0" + rms_text(s);
}

/// The bounds that hold, the broken ones, and those that do not apply to these rules.
std::vector<std::string> bound_lines(const std::vector<std::string>& broken, const std::vector<std::string>& given_up) {
  std::vector<std::string> lines = broken;
  if (broken.empty())
    lines.emplace_back(given_up.empty() ? "every bound holds" : "every bound holds that is not given up");
  for (const std::string& bound : given_up) lines.push_back("given up: " + bound);
  return lines;
}

/// Below the rows of light at vertices and at fragments: the time of each.
std::vector<std::string> cycles_lines(const PerVertexCycles& cycles) {
  if (!cycles.refused.empty()) return {"  no cycles: " + cycles.refused};
  std::string with = "shade.unit=1";
  if (!cycles.set.empty()) with.clear();
  for (const std::string& setting : cycles.set) with += (with.empty() ? "set " : ", ") + setting;
  return {"  cycles at vertices: " + with_commas(cycles.vertices) + ", at fragments: " + with_commas(cycles.fragments),
          "    " + with + "; at vertices with shade.unit=0: " + with_commas(cycles.without_unit)};
}

/// The figures to look at first, for terminal and picture.
std::vector<std::string> summary_lines(const Comparison& c, const std::optional<PerVertexCycles>& cycles,
                                       const std::vector<std::string>& bounds) {
  std::vector<std::string> lines{
      "oracle: " + with_commas(c.oracle.samples) + " samples, " + with_commas(c.oracle.mismatches) + " mismatches",
      "golden: " + with_commas(c.compared_pixels) + " pixels compared",
      "  pixels: " + with_commas(c.missing_pixels) + " missing, " + with_commas(c.extra_pixels) + " extra, " +
          with_commas(c.other_visible) + " other primitive",
      "  samples: " + with_commas(c.coverage.missing) + " missing, " + with_commas(c.coverage.extra) + " extra",
      "",
      "LSB\tmax\trms",
      row("depth, model - golden", c.depth_lsb),
      row("  snap", c.parts.snap),
      row("  interpolation", c.parts.interpolation),
      row("  storage", c.parts.storage),
      row("depth datapath", c.datapath)};
  if (c.line_datapath.count > 0) lines.push_back(row("lines, points: depth", c.line_datapath));
  lines.insert(lines.end(), {row("colour, all channels", c.color_lsb), row("colour datapath", c.color_datapath),
                             row("affine - perspective", c.affine)});
  if (c.color_over_w.count > 0) lines.push_back(row("colour over w", c.color_over_w));
  if (c.light.count > 0) lines.push_back(row("colour in light", c.light));
  if (c.fog.count > 0) lines.push_back(row("colour in fog", c.fog));
  if (c.texture) {
    const TextureErrors& t = *c.texture;
    lines.insert(lines.end(), {row("texel, model - exact", t.total), row("  coordinate", t.part_coordinate),
                               row("  level of detail", t.part_level), row("  weights", t.part_weights),
                               row("  rounding", t.part_rounding), row("coordinate, texels", t.coordinate),
                               row("coordinate, footprints", t.footprints), row("level of detail, levels", t.level)});
    if (c.affine_coordinate.max > 0) lines.push_back(row("affine - perspective, texels", c.affine_coordinate));
  }
  if (!c.per_vertex.empty()) lines.emplace_back("light at vertices - at fragments, by pixels of a triangle");
  for (const PerVertexRow& of : c.per_vertex)
    lines.push_back((of.area < 1 ? "  below 1" : "  from " + fixed(of.area, 0)) + ": " + with_commas(of.triangles) +
                    "\t" + fixed(of.max, 3) + "\t" + fixed(of.rms, 4));
  if (cycles)
    for (const std::string& line : cycles_lines(*cycles)) lines.push_back(line);
  // For many layers: powers of two and the last.
  for (const LayerRow& layer : c.layers)
    if ((layer.layers & (layer.layers - 1)) == 0 || &layer == &c.layers.back())
      lines.push_back("under " + std::to_string(layer.layers) + " layers\t" + fixed(layer.max, 3) + "\t" +
                      fixed(layer.rms, 4));
  lines.emplace_back();
  lines.insert(lines.end(), bounds.begin(), bounds.end());
  return lines;
}

/// Aligns "name\tmax\trms" in columns; other lines are unchanged.
void print_lines(std::ostream& out, const std::vector<std::string>& lines) {
  for (const std::string& line : lines) {
    const auto first = line.find('\t'), second = line.find('\t', first + 1);
    if (first == std::string::npos) {
      out << line << '\n';
      continue;
    }
    const auto cell = [](const std::string& text) {
      return std::string(12 - std::min<std::size_t>(11, text.size()), ' ') + text;
    };
    const std::string name = line.substr(0, first);
    out << name << std::string(26 - std::min<std::size_t>(25, name.size()), ' ')
        << cell(line.substr(first + 1, second - first - 1)) << cell(line.substr(second + 1)) << '\n';
  }
}

/// The panels of kTexturePanelNames.
std::vector<NamedPanel> texture_panels(const TextureErrors& t, int width, int height) {
  std::size_t next = 0;
  const auto panel = [&](const char* caption, const std::vector<float>& errors, const char* unit, bool diverging,
                         const std::string& note) {
    return NamedPanel{kTexturePanelNames[next++], error_panel(caption, width, height, errors, unit, diverging, note)};
  };
  return {panel("texture coordinate error", t.picture.coordinate, "texels", false, figures(t.coordinate)),
          panel("texture coordinate error", t.picture.footprints, "footprints", false, figures(t.footprints)),
          panel("level of detail error", t.picture.level, "levels", true, figures(t.level)),
          panel("filter weights, worst channel", t.picture.weights, "LSB", false,
                figures(t.part_weights) + " of all channels"),
          panel("texel rounding, worst channel", t.picture.rounding, "LSB", false,
                figures(t.part_rounding) + " of all channels")};
}

ComparisonSheet make_sheet(const Comparison& c, const Scene& scene, const Config& config, const std::string& title,
                           std::vector<std::string> summary) {
  ComparisonSheet sheet;
  sheet.title = title;
  sheet.width = scene.width;
  sheet.height = scene.height;
  sheet.model = color_picture(c.rendering.frame, config.color_format);
  sheet.golden = color_picture(c.golden.frame, config.color_format);
  sheet.coverage = c.coverage_class;
  sheet.depth_error = c.depth_error_lsb;
  sheet.color_error = c.color_error_lsb;
  sheet.depth_figures = figures(c.depth_lsb) + "  mean\u00a0" + fixed(c.depth_lsb.mean, 4);
  sheet.color_figures = figures(c.color_lsb) + " of all channels";
  sheet.summary = std::move(summary);
  if (c.texture) sheet.more = texture_panels(*c.texture, scene.width, scene.height);
  return sheet;
}

/// The panels of kAffinePanelNames: for an affine picture the perspective one, and the error.
std::vector<NamedPanel> affine_panels(const Comparison& c, const Config& config) {
  const int width = c.perspective.width, height = c.perspective.height;
  std::vector<NamedPanel> panels{
      {"perspective", picture_panel("golden in perspective", color_picture(c.perspective, config.color_format))},
      {"affine", error_panel("affine - perspective, worst channel", width, height, c.affine_error_lsb, "LSB", false,
                             figures(c.affine) + " of all channels")}};
  if (c.affine_coordinate.count > 0)
    panels.push_back(
        {"affine_coordinate", error_panel("affine - perspective, texture coordinate", width, height, c.affine_texels,
                                          "texels", false, figures(c.affine_coordinate))});
  return panels;
}

void write_compare_junit(const CompareCommand& options, const Config& config, const std::vector<std::string>& broken,
                         const Comparison& c, const std::optional<JudgedImage>& judged, const Json& result) {
  if (options.junit_path.empty()) return;
  JunitCase bounds;
  bounds.name = "bounds";
  if (broken.empty())
    bounds.output = with_commas(c.compared_pixels) + " pixels compared with the golden, every bound holds";
  else
    bounds.failure = broken.front();
  for (const std::string& bound : broken) bounds.details += bound + "\n";
  std::vector<JunitCase> cases{bounds};
  if (judged) cases.push_back(against_case(*judged));
  write_junit(options.junit_path, "compare." + label(config), cases, result["wall_s"], result, &config);
}

/// Checks the options before a scene is read.
void check_compare(const CompareCommand& options, const Config& config) {
  if (!options.against.path.empty()) require_one_sample(config, "compare --against");
  if (!options.panels.empty() && options.sheet_path.empty())
    throw InputError("--panels: there is no sheet to choose from; add -o FILE.png");
  for (const std::string& name : options.panels)
    if (options.against.path.empty() && std::ranges::find(kAgainstPanelNames, name) != kAgainstPanelNames.end())
      throw InputError("--panels: " + name + " is about another image; add --against FILE");
}

int run_folder(const CompareCommand& options) {
  if (options.against.path.empty())
    throw InputError(options.scene + ": a folder; add --against FOLDER with an image of each scene, or give one scene");
  for (const auto& [is_given, name] :
       {std::pair(!options.sheet_path.empty(), "-o"), std::pair(!options.model_path.empty(), "--model"),
        std::pair(!options.golden_path.empty(), "--golden-picture"), std::pair(!options.panels.empty(), "--panels")})
    if (is_given) throw InputError(std::string(name) + ": it is of one scene, and SCENE is a folder; leave it out");
  return compare_folder({options, options.study, options.against, options.junit_path});
}

int run(const CompareCommand& options) {
  if (std::filesystem::is_directory(options.scene)) return run_folder(options);
  const auto start = std::chrono::steady_clock::now();
  const Config config = drawing_config(options);
  const StudyRules rules = study_rules(options.study);
  const Tolerance tolerance = parse_tolerance(options.against);
  check_compare(options, config);
  double load_s = 0;
  const Scene scene = interpolated(load_scene(options, config, load_s), options.study.interpolation);
  warn_of_depth_bits(options, config);
  warn_of_scene(scene, config);
  std::optional<TransformErrors> transform;
  if (options.transform != "binary64") {
    CommonOptions exact = options;
    exact.transform = "binary64";
    const auto in_clip_space = [&config](const CommonOptions& o) {
      return prepared_in_clip_space(open_scene(o, config).at(moment_of(o)), o, config);
    };
    transform =
        transform_errors(in_clip_space(options), in_clip_space(exact), parse_transform(options.transform), config);
  }
  std::optional<JudgedImage> judged;
  if (!options.against.path.empty())
    judged = {options.against.path, read_foreign_image(options.against.path, scene.width, scene.height), tolerance, {}};
  Comparison c;
  {
    Progress progress(options, "comparing");
    CompareOptions compare_options;
    compare_options.skip = parse_skip(options.skip);
    compare_options.rules = rules;
    compare_options.precision =
        options.golden == "binary32" ? golden::Precision::binary32 : golden::Precision::binary64;
    compare_options.progress = [&progress](double fraction) { progress(fraction); };
    c = compare(scene, config, compare_options);
  }
  std::optional<PerVertexCycles> cycles;
  if (has_light_of_fragments(scene)) {
    Progress progress(options, "counting cycles");
    cycles = per_vertex_cycles(scene, config, [&progress](double fraction) { progress(fraction); });
  }
  if (judged) {
    Progress progress(options, "explaining differences");
    judged->result = compare_against(scene, config, c, judged->image,
                                     {rules, tolerance, static_cast<std::size_t>(options.against.listed),
                                      [&progress](double fraction) { progress(fraction); }});
  }
  for (const std::string& name : options.panels)
    if (!c.texture &&
        (name == "affine_coordinate" || std::ranges::find(kTexturePanelNames, name) != kTexturePanelNames.end()))
      throw InputError("--panels: " + name + " is about textures, and no pixel shows one; leave it out");
  if (c.texture && c.texture->footprints.max > 1)
    std::cerr << "halfplane: warning: texture coordinates are off by up to " << fixed(c.texture->footprints.max, 1)
              << " extents of a pixel, so borders of texels lie in other pixels; raise perspective.mantissa_bits (now "
              << config.perspective_mantissa_bits << ") or perspective.bits (" << config.perspective_bits
              << "), or split large triangles\n";
  const std::vector<std::string> broken = broken_bounds(c, config);
  const std::vector<std::string> given_up = given_up_bounds(rules);
  auto lines = summary_lines(c, cycles, bound_lines(broken, given_up));
  if (transform) {
    lines.emplace_back();
    lines.push_back("vertices in " + options.transform + "\tmax\trms");
    for (const auto& [name, part] :
         {std::pair("whole", &transform->whole), std::pair("transform", &transform->transform),
          std::pair("clip", &transform->clip), std::pair("divide", &transform->divide)}) {
      if (part->pixels.count == 0) continue;  // nothing is cut
      const auto& at = part->pixels;
      lines.push_back(std::string(name) + ", position, pixels\t" + two_digits(at.max) + "\t" + two_digits(at.rms));
      lines.push_back(row(std::string(name) + ", depth, LSB", part->depth_lsb));
    }
    if (transform->without_w > 0)
      lines.push_back("corners whose w is 0 or below, held to the smallest\t" + with_commas(transform->without_w));
  }
  std::string title = options.scene + ", " + std::to_string(scene.width) + "x" + std::to_string(scene.height) + ", " +
                      label(config) + ", seed " + std::to_string(options.seed);
  if (judged) std::ranges::move(against_lines(*judged), std::back_inserter(lines));
  Json study;
  add_study_json(study, options.study, scene, config);
  const bool is_study = rules != StudyRules{};
  const std::string unusual = study_text(study);
  if (!unusual.empty()) title += ", " + unusual;
  if (!options.model_path.empty()) write_png(options.model_path, color_picture(c.rendering.frame, config.color_format));
  if (!options.golden_path.empty()) write_png(options.golden_path, color_picture(c.golden.frame, config.color_format));
  if (!options.sheet_path.empty()) {
    ComparisonSheet sheet = make_sheet(c, scene, config, title, lines);
    sheet.panels = options.panels;
    const auto add = [&sheet](std::vector<NamedPanel> panels) {
      std::ranges::move(panels, std::back_inserter(sheet.more));
    };
    if (judged) add(against_panels(*judged));
    if (options.study.interpolation == "affine" || !options.panels.empty()) add(affine_panels(c, config));
    if (!options.panels.empty())  // less room
      sheet.title = std::filesystem::path(options.scene).filename().string() + ", " + label(config) +
                    (unusual.empty() ? "" : ", " + unusual);
    write_png(options.sheet_path, comparison_sheet(sheet));
  }

  Json result = result_head("compare", options, config);
  result["golden"] = options.golden;
  result["width"] = scene.width;
  result["height"] = scene.height;
  result["engine"] = is_study ? "scalar" : "functional";
  result.update(study);
  result["samples_tested"] = c.rendering.counters.samples_tested;
  result["time_s"] = {{"load", load_s}, {"geometry", c.rendering.geometry_s}, {"raster", c.rendering.raster_s}};
  result.update(comparison_json(c));
  result["per_vertex_cycles"] = cycles_json(cycles);
  if (judged) result["against"] = against_json(*judged);
  result["transform"] = transform ? transform_json(options.transform, *transform) : Json(nullptr);
  result["broken_bounds"] = broken;
  result["bounds"] = {{"broken", broken}, {"given_up", given_up}};
  result["wall_s"] = seconds_since(start);
  write_compare_junit(options, config, broken, c, judged, result);
  write_json(options, result);

  std::ostream& out = human(options);
  if (&out == &std::cout && terminal_style(1) == TerminalStyle::color)
    out << terminal_preview(color_picture(c.rendering.frame, config.color_format), terminal_size(1, 24),
                            TerminalStyle::color);
  out << title << "; model (" << result["engine"].get<std::string>() << ") against golden (" << options.golden << ")\n";
  if (judged) {
    const std::string explain = program_word() + " explain" + scene_arguments(options, config) + " --seed " +
                                std::to_string(options.seed) + study_arguments(options.study) + " " +
                                quoted(options.scene);
    const std::vector<std::string> pixels = difference_lines(*judged, explain);
    lines.insert(lines.end() - (pixels.empty() ? 0 : 1), pixels.begin(), pixels.end());  // before the verdict
  }
  print_lines(out, lines);
  return broken.empty() && (!judged || judged->result.different == 0) ? exit_ok : exit_mismatch;
}

}  // namespace

void add_compare_command(CLI::App& app, Action& selected) {
  const auto [command, options] = add_command<CompareCommand>(
      app, selected, "compare", "model against golden: coverage, depth and colour error with its parts", run);
  add_scene_options(*command, *options);
  add_choice_option(*command, "--golden", options->golden, {"binary64", "binary32"},
                    "binary64, or binary32 to see what single precision would show");
  add_study_options(*command, options->study);
  add_interpolation_option(*command, options->study);
  add_file_option(*command, "-o", options->sheet_path,
                  "one sheet: model, golden, coverage, depth and colour difference, .png", ".png");
  command->add_option("--panels", options->panels, "which panels of the sheet, and their order: model,depth")
      ->delimiter(',')
      ->check(CLI::IsMember(panel_names()));
  add_file_option(*command, "--model", options->model_path, "the model's picture alone, .png", ".png");
  add_file_option(*command, "--golden-picture", options->golden_path, "the golden's picture alone, .png", ".png");
  add_against_options(*command, options->against);
  add_file_option(*command, "--junit", options->junit_path, "result as JUnit XML");
  command->footer("\nExample:\n  halfplane compare teapot --config full -o compare.png --json=compare.json");
}

}  // namespace halfplane
