#include "sim/study/compare/compare.hpp"

#include <filesystem>
#include <iostream>
#include <memory>

#include "sim/cli/commands.hpp"
#include "sim/cli/progress.hpp"
#include "sim/cli/study_options.hpp"
#include "sim/show/image/framebuffer_files.hpp"
#include "sim/show/image/panel.hpp"
#include "sim/show/image/png.hpp"
#include "sim/show/image/terminal.hpp"

namespace halfplane {
namespace {

struct CompareCommand : CommonOptions {
  std::string golden = "binary64";
  StudyOptions study;
  std::string sheet_path, model_path, golden_path;
  std::vector<std::string> panels;
};

Json stats_json(const ErrorStats& s) { return {{"max", s.max}, {"mean", s.mean}, {"rms", s.rms}, {"p999", s.p999}}; }
Json moments_json(const ErrorMoments& s) { return {{"max", s.max}, {"mean", s.mean}, {"rms", s.rms}}; }
Json part_json(const PartStats& s) { return {{"max", s.max}, {"rms", s.rms}}; }

Json comparison_json(const Comparison& c) {
  Json json{{"compared_pixels", c.compared_pixels},
            {"coverage",
             {{"missing", c.coverage.missing},
              {"extra", c.coverage.extra},
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
            {"color_parts",
             {{"snap", part_json(c.color_parts.snap)},
              {"interpolation", part_json(c.color_parts.interpolation)},
              {"storage", part_json(c.color_parts.storage)}}},
            {"datapath",
             {{"depth_lsb", moments_json(c.datapath)},
              {"line_depth_lsb", moments_json(c.line_datapath)},
              {"depth_bias", c.datapath_bias.mean},
              {"color_lsb", moments_json(c.color_datapath)},
              {"color_bias", c.color_datapath_bias.mean},
              {"stage_mismatches", c.stage_mismatches}}}};
  return json;
}

std::string row(const std::string& name, double max, double rms) {
  return name + "\t" + fixed(max, 3) + "\t" + fixed(rms, 4);
}

/// The figures that a person looks at first, for terminal and picture alike.
std::vector<std::string> summary_lines(const Comparison& c, const std::vector<std::string>& broken) {
  std::vector<std::string> lines{
      "oracle: " + with_commas(c.oracle.samples) + " samples, " + with_commas(c.oracle.mismatches) + " mismatches",
      "golden: " + with_commas(c.compared_pixels) + " pixels compared",
      "  samples: " + with_commas(c.coverage.missing) + " missing, " + with_commas(c.coverage.extra) + " extra",
      "",
      "LSB\tmax\trms",
      row("depth, model - golden", c.depth_lsb.max, c.depth_lsb.rms),
      row("  snap", c.parts.snap.max, c.parts.snap.rms),
      row("  interpolation", c.parts.interpolation.max, c.parts.interpolation.rms),
      row("  storage", c.parts.storage.max, c.parts.storage.rms),
      row("depth datapath", c.datapath.max, c.datapath.rms),
      row("colour, model - golden", c.color_lsb.max, c.color_lsb.rms),
      row("colour datapath", c.color_datapath.max, c.color_datapath.rms),
      row("affine - perspective", c.affine.max, c.affine.rms),
      ""};
  if (c.line_datapath.count > 0)
    lines.insert(lines.end() - 1, row("lines, points: depth", c.line_datapath.max, c.line_datapath.rms));
  if (broken.empty()) lines.push_back("every bound holds");
  lines.insert(lines.end(), broken.begin(), broken.end());
  return lines;
}

/// "name\tmax\trms" in columns; other lines as they are.
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
  sheet.summary = std::move(summary);
  return sheet;
}

int run(const CompareCommand& options) {
  const auto start = std::chrono::steady_clock::now();
  const Config config = effective_config(options);
  const StudyRules rules = study_rules(options.study);
  for (const std::string* path : {&options.sheet_path, &options.model_path, &options.golden_path})
    check_output(*path, ".png");
  if (!options.panels.empty() && options.sheet_path.empty())
    throw InputError("--panels: there is no sheet to choose from; add -o FILE.png");
  double load_s = 0;
  const Scene scene = load_scene(options, config, load_s);
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
  const std::vector<std::string> broken = broken_bounds(c, config);
  const auto lines = summary_lines(c, broken);
  std::string title = options.scene + ", " + std::to_string(scene.width) + "x" + std::to_string(scene.height) + ", " +
                      label(config) + ", seed " + std::to_string(options.seed);
  Json study;
  add_study_json(study, rules, scene, config);
  const bool is_study = rules != StudyRules{};
  if (is_study) title += ", " + study_text(study);
  if (!options.model_path.empty()) write_png(options.model_path, color_picture(c.rendering.frame, config.color_format));
  if (!options.golden_path.empty()) write_png(options.golden_path, color_picture(c.golden.frame, config.color_format));
  if (!options.sheet_path.empty()) {
    ComparisonSheet sheet = make_sheet(c, scene, config, title, lines);
    sheet.panels = options.panels;
    if (!options.panels.empty())  // room for less
      sheet.title = std::filesystem::path(options.scene).filename().string() + ", " + label(config) +
                    (is_study ? ", " + study_text(study) : "");
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
  result["broken_bounds"] = broken;
  result["wall_s"] = seconds_since(start);
  write_json(options, result);

  std::ostream& out = human(options);
  if (&out == &std::cout && terminal_style(1) == TerminalStyle::color)
    out << terminal_preview(color_picture(c.rendering.frame, config.color_format), terminal_size(1, 24),
                            TerminalStyle::color);
  out << title << "; model (" << result["engine"].get<std::string>() << ") against golden (" << options.golden << ")\n";
  print_lines(out, lines);
  return broken.empty() ? exit_ok : exit_mismatch;
}

}  // namespace

void add_compare_command(CLI::App& app, Action& selected) {
  CLI::App* command =
      app.add_subcommand("compare", "model against golden: coverage, depth and colour error with its parts");
  auto options = std::make_shared<CompareCommand>();
  add_scene_options(*command, *options);
  command->add_option("--golden", options->golden, "binary64, or binary32 to see what single precision would show")
      ->check(CLI::IsMember({"binary64", "binary32"}))
      ->capture_default_str();
  add_study_options(*command, options->study);
  add_file_option(*command, "-o", options->sheet_path,
                  "one sheet: model, golden, coverage, depth and colour difference, .png");
  command->add_option("--panels", options->panels, "which panels of the sheet, and their order: model,depth")
      ->delimiter(',')
      ->check(CLI::IsMember(std::vector<std::string>(kPanelNames.begin(), kPanelNames.end())));
  add_file_option(*command, "--model", options->model_path, "the model's picture alone, .png");
  add_file_option(*command, "--golden-picture", options->golden_path, "the golden's picture alone, .png");
  command->footer("\nExample:\n  halfplane compare teapot --config full -o compare.png --json=compare.json");
  command->callback([&selected, options] { selected = [options] { return run(*options); }; });
}

}  // namespace halfplane
