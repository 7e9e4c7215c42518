// halfplane bench --antialiasing: the error of each kind against the exact area, and the cost of a frame.
#include <iostream>
#include <optional>

#include "sim/cli/bench_study.hpp"
#include "sim/cli/progress.hpp"
#include "sim/show/report/page.hpp"
#include "sim/study/antialiasing/study.hpp"
#include "sim/study/space/gates.hpp"
#include "sim/study/space/points.hpp"

namespace halfplane {

namespace antialiasing {
HALFPLANE_JSON_OF_MEMBERS(AreaRow, kind, samples, frame_s, rms, max, mean, is_front)
}

namespace {

/// Figures plotted against the error, each with a front of its own, by their keys in a row of the result.
constexpr std::array<const char*, 4> kCosts{"frame_s", "cycles", "bytes", "ecp5.places"};

/// Marks, for each kind, the figures for which no other kind has less at an rms as low.
void mark_fronts(Json& rows) {
  Json points = rows;
  for (Json& point : points) {
    point["scene"] = "";
    point["abilities"] = Json::object();
  }
  for (Json& row : rows) row["fronts"] = Json::array();
  for (const char* name : kCosts) {
    mark_front(points, {"rms", name});
    for (std::size_t i = 0; i < rows.size(); ++i)
      if (points[i].at("on_front").get<bool>()) rows[i]["fronts"].push_back(name);
  }
}

std::string cell(const Json& row, const char* name, double scale) {
  const auto value = figure(row, name);
  return value ? with_commas(static_cast<std::uint64_t>(*value * scale + 0.5)) : "-";
}

void print(std::ostream& out, const Json& rows) {
  std::vector<std::vector<std::string>> lines{
      {"kind", "samples", "rms", "worst", "mean", "ms a frame", "cycles", "KB", "ECP5 places", "block RAM", ""}};
  for (const Json& row : rows) {
    const int samples = row.at("samples");
    std::vector<std::string> names;
    for (const std::string name : row.at("fronts"))
      names.push_back(name == "frame_s" ? "ms" : name == "ecp5.places" ? "places" : name);
    const std::string fronts = joined(names);
    lines.push_back({row.at("kind"), samples == 0 ? "area" : std::to_string(samples), fixed(row.at("rms"), 4),
                     fixed(row.at("max"), 4), fixed(row.at("mean"), 4), fixed(1e3 * row.at("frame_s").get<double>(), 2),
                     cell(row, "cycles", 1), cell(row, "bytes", 1.0 / 1024), cell(row, "ecp5.places", 1),
                     cell(row, "ecp5.block_rams", 1), fronts.empty() ? "" : "front: " + fronts});
  }
  print_bench_table(out, lines, 1);
}

/// Measures one scene, into an object of the result and a table. `gates`: null if they are not counted.
Json measured(const CommonOptions& options, const Config& config, int repeat, const Scene& scene, const char* name,
              const Gates* gates) {
  antialiasing::AreaStudy study;
  {
    Progress progress(options, std::string("measuring areas of ") + name);
    study = antialiasing::measure_areas(scene, config, repeat, [&progress](double fraction) { progress(fraction); });
  }
  Json json = {
      {"width", scene.width}, {"height", scene.height}, {"edge_pixels", study.edge_pixels}, {"rows", Json::array()}};
  Json& rows = json["rows"];
  std::optional<Progress> counting;
  if (gates != nullptr) counting.emplace(options, std::string("counting gates of ") + name);
  for (const antialiasing::AreaRow& row : study.rows) {
    Json entry = row;
    if (row.hardware) {
      entry["hardware"] = label(row.hardware->config);
      entry["cycles"] = row.hardware->cycles;
      entry["bytes"] = row.hardware->bytes;
      if (gates != nullptr) entry.update(gates->of(row.hardware->config));
    }
    rows.push_back(entry);
    if (counting) (*counting)(static_cast<double>(rows.size()) / static_cast<double>(study.rows.size()));
  }
  counting.reset();
  mark_fronts(rows);
  std::ostream& out = human(options);
  out << label(config) << ", " << name << ", " << scene.width << "x" << scene.height << ", "
      << with_commas(study.edge_pixels) << " pixels covered in part; errors are parts of a pixel\n";
  print(out, rows);
  return json;
}

/// The kinds as points of a space, for the page.
void add_points(Json& points, const std::string& scene, const Json& rows) {
  for (const Json& row : rows) {
    Json point = {{"scene", scene},
                  {"label", row.at("kind")},
                  {"settings", {{"kind", row.at("kind")}}},
                  {"coverage_rms", row.at("rms")},
                  {"coverage_max", row.at("max")},
                  {"functional_ms", 1e3 * row.at("frame_s").get<double>()}};
    for (const char* key : {"cycles", "bytes", "ecp5"})
      if (row.contains(key)) point[key] = row.at(key);
    point["abilities"] = Json::object();
    points.push_back(point);
  }
}

}  // namespace

void measure_antialiasing(const CommonOptions& options, const Config& config, int repeat, const Gates* gates,
                          Json& result) {
  const Size size = options.size.empty() ? Size{640, 480} : parse_size(options.size);
  const int width = std::min(size.width, config.target_width), height = std::min(size.height, config.target_height);
  Json& json = result["antialiasing"];
  json = measured(options, config, repeat, antialiasing::blades(width, height, options.seed), "blades", gates);
  json["lines"] = measured(options, config, repeat, antialiasing::spokes(width, height, options.seed), "lines", gates);
  human(options) << "front: no other kind has both a lower rms and less of that.\n";
}

void write_antialiasing_page(const std::string& path, const Json& result, const std::string& command) {
  Json page = result;
  const Json& study = result.at("antialiasing");
  Json& points = page["points"] = Json::array();
  add_points(points, "blades", study.at("rows"));
  add_points(points, "lines", study.at("lines").at("rows"));
  std::vector<std::string> axes{"coverage_rms"};
  for (const std::string& name : figures_of(points))
    if (name == "cycles" || name == "bytes" || name == "ecp5.places") axes.push_back(name);
  if (axes.size() == 1) axes.emplace_back("functional_ms");
  mark_front(points, axes);
  page["front_axes"] = axes;
  page["title"] = "Antialiasing";
  page["version"] = HALFPLANE_VERSION;
  page["command"] = command;
  write_page(path, kSpacePage, page);
}

}  // namespace halfplane
