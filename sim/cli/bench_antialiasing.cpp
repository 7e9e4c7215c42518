// halfplane bench --antialiasing: how far each kind is from the exact area, and what a frame of it takes.
#include <iostream>

#include "sim/cli/bench_study.hpp"
#include "sim/cli/progress.hpp"
#include "sim/study/antialiasing/study.hpp"

namespace halfplane {

namespace {

/// Measures one scene, into an object of the result and a table.
Json measured(const CommonOptions& options, const Config& config, int repeat, const Scene& scene, const char* name) {
  antialiasing::AreaStudy study;
  {
    Progress progress(options, std::string("measuring areas of ") + name);
    study = antialiasing::measure_areas(scene, config, repeat, [&progress](double fraction) { progress(fraction); });
  }
  Json json = {
      {"width", scene.width}, {"height", scene.height}, {"edge_pixels", study.edge_pixels}, {"rows", Json::array()}};
  std::vector<std::vector<std::string>> lines{{"kind", "samples", "ms a frame", "rms", "worst", "mean", ""}};
  for (const antialiasing::AreaRow& row : study.rows) {
    json["rows"].push_back({{"kind", row.kind},
                            {"samples", row.samples},
                            {"frame_s", row.frame_s},
                            {"rms", row.rms},
                            {"max", row.max},
                            {"mean", row.mean},
                            {"is_front", row.is_front}});
    lines.push_back({row.kind, row.samples == 0 ? "area" : std::to_string(row.samples), fixed(1e3 * row.frame_s, 2),
                     fixed(row.rms, 4), fixed(row.max, 4), fixed(row.mean, 4), row.is_front ? "front" : ""});
  }
  std::ostream& out = human(options);
  out << label(config) << ", " << name << ", " << scene.width << "x" << scene.height << ", "
      << with_commas(study.edge_pixels) << " pixels covered in part; errors are parts of a pixel\n";
  print_bench_table(out, lines, 1);
  return json;
}

}  // namespace

void measure_antialiasing(const CommonOptions& options, const Config& config, int repeat, Json& result) {
  const Size size = options.size.empty() ? Size{640, 480} : parse_size(options.size);
  const int width = std::min(size.width, config.target_width), height = std::min(size.height, config.target_height);
  Json& json = result["antialiasing"];
  json = measured(options, config, repeat, antialiasing::blades(width, height, options.seed), "blades");
  json["lines"] = measured(options, config, repeat, antialiasing::spokes(width, height, options.seed), "lines");
  human(options) << "front: no other kind is both as near and as fast.\n";
}

}  // namespace halfplane
