// Measurement and output of `bench --area`.
#include <algorithm>
#include <filesystem>
#include <iostream>

#include "sim/cli/option_kinds.hpp"
#include "sim/cli/progress.hpp"
#include "sim/cli/space_study.hpp"
#include "sim/cli/task_folder.hpp"
#include "sim/show/image/color_map.hpp"
#include "sim/show/image/whole_file.hpp"
#include "sim/show/report/page.hpp"
#include "sim/study/space/gates.hpp"
#include "sim/study/space/points.hpp"

namespace halfplane {

namespace {

namespace fs = std::filesystem;

}  // namespace

void write_cluster(const CommonOptions& common, const SpaceOptions& options, const std::vector<BenchCase>& cases,
                   const std::function<std::string(const BenchCase&)>& arguments, const SpaceStudy& study) {
  if (options.wants_area)
    (void)Gates(options.rtl, options.cache, options.parts);  // reports early the tools that the cluster would miss
  std::error_code error;
  const fs::path folder = fs::absolute(options.slurm, error).lexically_normal();
  make_task_folder("--slurm", folder, "points");
  const std::string cache = options.cache.empty() ? (folder / "cache").string() : fs::absolute(options.cache).string();
  std::vector<std::string> tasks;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const BenchCase& at = cases[i];
    const fs::path file = fs::absolute(at.scene_name, error);
    std::string task = quoted(own_program()) + " bench " +
                       quoted(fs::exists(file, error) ? file.string() : at.scene_name) + arguments(at);
    if (options.wants_area) {
      task += " --area --cache " + quoted(cache) + " --parts " + joined(options.parts, ",");
      if (!options.rtl.empty()) task += " --rtl " + quoted(fs::absolute(options.rtl).string());
    } else {
      task += " --space";
    }
    tasks.push_back(task + memory_arguments(options.memory) + " --quiet --json=" + task_result("points", i));
  }
  Json manifest = study.result;
  manifest["schema"] = "halfplane.space/1";
  manifest["command"] = study.command;
  manifest["labels"] = Json::array();
  for (const BenchCase& at : cases) manifest["labels"].push_back({at.scene_name, at.variation});
  write_tasks(folder, "points", tasks);
  write_text_file(folder / "space.json", manifest.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
  if (common.quiet) return;
  std::cout << tasks_text(folder, cases.size(),
                          program_word() + " bench --collect " + quoted(options.slurm) + " -o space.html");
}

namespace {

/// Adds the points of one folder to the study, and its head if there is none yet. Returns the number of missing points.
std::size_t collect_folder(const fs::path& folder, SpaceStudy& study, bool is_first) {
  Json manifest = read_task_json(folder / "space.json", "--collect takes a folder that --slurm has made");
  if (manifest.value("schema", "") != "halfplane.space/1" || !manifest.contains("labels"))
    throw InputError((folder / "space.json").string() + ": not written by --slurm; give the folder that it has made");
  const Json labels = manifest["labels"];
  study.command += (study.command.empty() ? "" : "\n") + manifest.value("command", "");
  if (is_first) {
    manifest.erase("labels");
    manifest.erase("command");
    manifest["schema"] = "halfplane.bench/1";
    study.result = std::move(manifest);
    study.result["points"] = Json::array();
  }
  std::size_t missing = 0;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const fs::path path = folder / task_result("points", i);
    if (!fs::exists(path)) {
      ++missing;
      continue;
    }
    const Json one = read_task_json(path, "its task makes it again");
    const bool is_point = one.contains("points") && one["points"].is_array() && one["points"].size() == 1;
    if (!is_point || one["points"][0].value("label", "") != labels[i][1])
      throw InputError(path.string() + ": not the point of this task; remove it, and its task makes it again");
    study.result["points"].push_back(one["points"][0]);
    study.result["points"].back()["scene"] = labels[i][0];
  }
  return missing;
}

}  // namespace

std::size_t collect_space(const SpaceOptions& options, SpaceStudy& study) {
  study.command.clear();
  std::size_t missing = 0;
  for (const std::string& folder : options.collect)
    missing += collect_folder(folder, study, &folder == &options.collect.front());
  study.result["missing"] = missing;
  return missing;
}

namespace {

std::string csv_of(const Json& points) {
  std::vector<std::string> settings, figures;
  for (const Json& point : points) {
    for (const auto& entry : point.at("settings").items())
      if (std::find(settings.begin(), settings.end(), entry.key()) == settings.end()) settings.push_back(entry.key());
    for (const std::string& name : figures_of(Json::array({point})))
      if (std::find(figures.begin(), figures.end(), name) == figures.end()) figures.push_back(name);
  }
  std::string text = "scene";
  for (const std::string& key : settings) text += "," + key;
  for (const std::string& name : figures) text += "," + name;
  text += ",on_front\n";
  for (const Json& point : points) {
    const std::string scene = point.at("scene");
    text += scene.find_first_of(",\"\n") == std::string::npos ? scene : Json(scene).dump();
    for (const std::string& key : settings) text += "," + point.at("settings").value(key, "");
    for (const std::string& name : figures) {
      const auto value = figure(point, name);
      text += "," + (value ? Json(*value == static_cast<double>(static_cast<std::int64_t>(*value))
                                      ? Json(static_cast<std::int64_t>(*value))
                                      : Json(*value))
                                 .dump()
                           : std::string());
    }
    text += point.at("on_front").get<bool>() ? ",1\n" : ",0\n";
  }
  return text;
}

std::string short_figure(const Json& point, const std::string& name) {
  const auto value = figure(point, name);
  if (!value) return "-";
  return *value == static_cast<double>(static_cast<std::uint64_t>(*value)) && *value >= 0
             ? with_commas(static_cast<std::uint64_t>(*value))
             : short_number(*value);
}

void print_points(std::ostream& out, const Json& points) {
  struct Column {
    const char *head, *name;
  };
  static constexpr Column kColumns[]{{"depth rms, LSB", "depth_lsb_rms"},
                                     {"depth rms, eye", "depth_eye_rms"},
                                     {"max, eye", "depth_eye_max"},
                                     {"colour max, LSB", "color_lsb_max"},
                                     {"cycles", "cycles"},
                                     {"ms", "ms"},
                                     {"bytes", "bytes"},
                                     {"ECP5 places", "ecp5.places"},
                                     {"FF", "ecp5.ff"},
                                     {"mult.", "ecp5.multipliers"},
                                     {"block RAM", "ecp5.block_rams"},
                                     {"iCE40 LUT4", "ice40.lut4"},
                                     {"FF", "ice40.ff"},
                                     {"RAM", "ice40.block_rams"}};
  std::vector<std::vector<std::string>> lines{{"scene", "configuration"}};
  for (const Column& column : kColumns) lines[0].emplace_back(column.head);
  lines[0].emplace_back("");
  for (const Json& point : points) {
    const std::string label = point.at("label");
    lines.push_back({point.at("scene"), label.empty() ? "as configured" : label});
    for (const Column& column : kColumns) lines.back().push_back(short_figure(point, column.name));
    lines.back().emplace_back(point.at("on_front").get<bool>() ? "front" : "");
  }
  print_bench_table(out, lines, 2);
}

}  // namespace

void add_space_options(CLI::App& command, SpaceOptions& options) {
  command.add_flag(
      "--area", options.wants_area,
      "instead: the design space, a point of each combination of --vary: error, cycles, bytes, milliseconds "
      "and the gates of the RTL, by Yosys; the Pareto front marked");
  command.add_flag("--space", options.wants_space, "the same without gates");
  command.add_option("--parts", options.parts, "of --area: some of ecp5, ice40")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->default_str("ecp5,ice40")
      ->type_name("LIST");
  command
      .add_option("--front", options.front,
                  "figures that the front is of, as depth_eye_rms,cycles,ecp5.places (default: error, cycles, places, "
                  "block RAM)")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("LIST");
  add_text_option(command, "--cache", options.cache,
                  "folder that keeps gates, module by module (default: the user's cache)");
  add_text_option(command, "--rtl", options.rtl, "folder of raster_top.sv (default: that of this program)");
  add_file_option(command, "--csv", options.csv, "the points as CSV; - for stdout");
  add_text_option(command, "--slurm", options.slurm,
                  "measures nothing: writes DIR/tasks, a command for each point, and DIR/job.sh for sbatch", "DIR");
  add_text_option(
      command, "--collect", options.collect,
      "measures nothing: gathers the points that the tasks of DIR have written; repeatable, for one page of all", "DIR")
      ->allow_extra_args(false);
  add_memory_options(command, options.memory);
  add_traffic_options(command, options.memory);
}

std::string space_arguments(const SpaceOptions& options) {
  std::string text = options.wants_area ? " --area" : options.is_wanted() ? " --space" : "";
  if (options.wants_area && options.parts != SpaceOptions{}.parts) text += " --parts " + joined(options.parts, ",");
  if (!options.front.empty()) text += " --front " + joined(options.front, ",");
  return text + memory_arguments(options.memory);
}

void check_space_options(const CommonOptions& common, const SpaceOptions& options, const std::string& page) {
  if (!options.is_wanted()) {
    if (const std::string given = memory_arguments(options.memory); !given.empty())
      throw InputError("'" + given.substr(1) + "' is for --area and --space; add one of them");
    return;
  }
  for (const std::string& part : options.parts)
    if (std::find(kGateParts.begin(), kGateParts.end(), part) == kGateParts.end())
      throw InputError("--parts: no part '" + part + "'; give some of ecp5, ice40");
  if (!options.slurm.empty() && !options.collect.empty())
    throw InputError("--slurm writes the tasks and --collect reads what they left; give one of them");
  if (!options.slurm.empty() && !(page.empty() && options.csv.empty() && common.json.empty()))
    throw InputError("--slurm measures nothing: -o, --csv and --json are for --collect DIR, when the tasks are done");
}

void measure_space(const CommonOptions& common, const SpaceOptions& options, const std::vector<BenchCase>& cases,
                   SpaceStudy& study) {
  std::optional<Gates> gates;
  if (options.wants_area) gates.emplace(options.rtl, options.cache, options.parts);
  Progress progress(common, options.wants_area ? "measuring and counting gates" : "measuring");
  PointStudy points(options.memory);
  Json& out = study.result["points"];
  try {
    for (std::size_t i = 0; i < cases.size(); ++i) {
      const auto part = [&](double fraction) {
        progress((static_cast<double>(i) + fraction) / static_cast<double>(cases.size()));
      };
      part(0);
      Json point;
      try {
        point = points.measure(cases[i], part);
      } catch (const InputError& error) {
        if (cases.size() == 1) throw;
        std::cerr << "halfplane: left out: " << cases[i].scene_name << ", " << cases[i].variation << ": "
                  << error.what() << '\n';
        continue;
      }
      if (gates) point.update(gates->of(cases[i].config));
      out.push_back(std::move(point));
    }
  } catch (const Interrupted&) {
    study.is_partial = true;
  }
}

void finish_space(const CommonOptions& common, const SpaceOptions& options, SpaceStudy& study) {
  Json& points = study.result["points"];
  const auto axes = options.front.empty() ? default_axes(points) : options.front;
  if (!points.empty()) {
    const auto known = figures_of(points);
    for (const std::string& axis : axes)
      if (std::find(known.begin(), known.end(), axis) == known.end() && !options.front.empty()) {
        throw InputError("--front: not every point has a figure '" + axis + "'; give some of " + joined(known));
      }
  }
  mark_front(points, axes);
  study.result["front_axes"] = axes;
  if (!study.page.empty()) {
    Json page = study.result;
    page["version"] = HALFPLANE_VERSION;
    page["command"] = study.command;
    write_page(study.page, kSpacePage, page);
  }
  if (!options.csv.empty()) write_text_file(options.csv, csv_of(points));
  write_json(common, study.result);
  std::ostream& out = options.csv == "-" ? std::cerr : human(common);
  if (common.quiet) return;
  const auto on_front =
      std::count_if(points.begin(), points.end(), [](const Json& p) { return p.at("on_front").get<bool>(); });
  out << points.size() << (points.size() == 1 ? " point, " : " points, ") << on_front << " on the front of "
      << joined(axes) << '\n';
  print_points(out, points);
  if (study.result.value("missing", 0) > 0)
    out << study.result["missing"] << " points are not there yet; the same job, or parallel, goes on with them\n";
  if (study.is_partial) print_partial(out);
}

}  // namespace halfplane
