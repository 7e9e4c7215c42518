#include <algorithm>
#include <fstream>
#include <iostream>
#include <thread>

#include "sim/cli/bench_study.hpp"
#include "sim/show/image/color_map.hpp"
#include "sim/show/report/page.hpp"

namespace halfplane {

HALFPLANE_JSON_OF_MEMBERS(BenchErrors, depth_lsb_max, depth_lsb_rms, depth_range_max, depth_range_rms, color_lsb_max,
                          color_lsb_rms, depth_eye_max, depth_eye_rms, coverage_mismatches, coverage_missing,
                          coverage_extra)
HALFPLANE_JSON_OF_MEMBERS(GrowthSeries, name, x, meaning)

void print_bench_table(std::ostream& out, const std::vector<std::vector<std::string>>& lines, std::size_t left) {
  std::vector<std::size_t> widths(lines.front().size());
  std::vector<bool> is_used(widths.size());
  for (std::size_t i = 0; i < lines.size(); ++i)
    for (std::size_t k = 0; k < widths.size(); ++k) {
      widths[k] = std::max(widths[k], lines[i][k].size());
      is_used[k] = is_used[k] || (i > 0 && !lines[i][k].empty() && lines[i][k] != "-");
    }
  for (const auto& line : lines) {
    std::string text;
    for (std::size_t k = 0; k < widths.size(); ++k)
      if (is_used[k])
        text += k < left ? left_aligned(line[k], widths[k] + 2) : right_aligned(line[k], widths[k]) + "  ";
    text.erase(text.find_last_not_of(' ') + 1);
    out << text << '\n';
  }
}

namespace {

Json bench_row_json(const BenchRow& row, const BenchCase& at) {
  const bool has_cycles = row.times.cycles != 0;
  Json json{{"engine", row.engine},
            {"config", label(at.config)},
            {"label", at.variation},
            {"scene", at.scene_name},
            {"width", at.scene->width},
            {"height", at.scene->height},
            {"threads", row.threads},
            {"frames", row.times.seconds.size()},
            {"frame_s", row.times.median()},
            {"frame_s_min", row.times.min()},
            {"mtri_s", row.mtri_s()},
            {"mpix_s", row.mpix_s()},
            {"cycles", or_null(has_cycles, row.times.cycles)},
            {"cycles_per_s", or_null(has_cycles, row.cycles_per_s())},
            {"primitives", row.facts.counters.primitives_in},
            {"fragments", row.facts.counters.covered},
            {"coverage", row.facts.coverage}};
  json["depth_bits"] = at.config.depth_bits;
  // Without errors their keys are null.
  const Json errors = row.facts.errors.value_or(BenchErrors{});
  for (const auto& [key, value] : errors.items()) json[key] = or_null(row.facts.errors.has_value(), value);
  return json;
}

Json skip_row_json(const SkipRow& row) {
  return {{"skip", row.skip},
          {"scene", row.scene},
          {"made_for", row.is_made_for},
          {"with_s", row.with.median()},
          {"without_s", row.without.median()},
          {"saved", row.saved()},
          {"counter", row.counter}};
}

Json growth_row_json(const GrowthRow& row) {
  return {{"series", row.series},
          {"x", row.x},
          {"primitives", row.primitives},
          {"fragments", row.fragments},
          {"frames", row.times.seconds.size()},
          {"frame_s", row.times.median()},
          {"mtri_s", row.mtri_s()},
          {"mpix_s", row.mpix_s()}};
}

/// The processor's name, where the system gives it.
std::string processor_name() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("model name") && line.find(": ") != std::string::npos) return line.substr(line.find(": ") + 2);
  return "";
}

/// The speedup over `engine` on the same scene, with as many threads and the same configuration if present.
std::string times_as_fast(const BenchStudy& study, const BenchRow& row, const std::string& engine) {
  const BenchRow* best = nullptr;
  int best_rank = -1;
  for (const BenchRow& other : study.rows) {
    if (other.engine != engine || study.cases[other.case_index].scene_name != study.cases[row.case_index].scene_name)
      continue;
    if (engine == "rtl" && other.case_index != row.case_index) continue;
    const int rank = (other.threads == row.threads ? 2 : 0) + (other.case_index == row.case_index ? 1 : 0);
    if (rank > best_rank) best = &other;
    best_rank = std::max(rank, best_rank);
  }
  if (best == nullptr) return "";
  const double ratio = best->times.median() / row.times.median();
  return fixed(ratio, ratio < 10 ? 2 : 1);
}

/// Whether it was too slow to be measured as often as the others.
bool is_single(const BenchStudy& study, const BenchRow& row) {
  return row.times.seconds.size() == 1 && std::any_of(study.rows.begin(), study.rows.end(), [](const BenchRow& other) {
           return other.times.seconds.size() > 1;
         });
}

/// Whether the rows have different LSBs of depth.
bool has_many_lsbs(const BenchStudy& study) {
  return std::any_of(study.rows.begin(), study.rows.end(), [&](const BenchRow& row) {
    return study.cases[row.case_index].config.depth_bits != study.cases[study.rows[0].case_index].config.depth_bits;
  });
}

/// Whether rows with several LSBs lack an eye depth for comparison.
bool needs_range(const BenchStudy& study) {
  return has_many_lsbs(study) && std::any_of(study.rows.begin(), study.rows.end(), [](const BenchRow& row) {
           return row.facts.errors && row.facts.errors->depth_lsb_rms && !row.facts.errors->depth_eye_rms;
         });
}

std::vector<std::string> row_cells(const BenchStudy& study, const BenchRow& row) {
  const BenchCase& at = study.cases[row.case_index];
  std::vector<std::string> cells{at.scene_name,
                                 row.engine,
                                 at.variation,
                                 std::to_string(row.threads),
                                 fixed(1e3 * row.times.median(), 2) + (is_single(study, row) ? "*" : " "),
                                 fixed(row.mtri_s(), 3),
                                 fixed(row.mpix_s(), 2)};
  const bool has_cycles = row.times.cycles != 0;
  cells.push_back(has_cycles ? with_commas(row.times.cycles) : "");
  cells.push_back(has_cycles ? fixed(row.cycles_per_s() / 1e6, 2) : "");
  if (row.facts.errors) {
    const BenchErrors& e = *row.facts.errors;
    const auto lsb = [](const std::optional<double>& value, int digits) { return value ? fixed(*value, digits) : "-"; };
    const auto shorter = [](const std::optional<double>& value, double scale) {
      return value ? short_number(*value * scale) : "-";
    };
    const bool has_ppm = needs_range(study);
    cells.insert(cells.end(), {lsb(e.depth_lsb_rms, 3), lsb(e.depth_lsb_max, 2), shorter(e.depth_eye_rms, 1),
                               shorter(e.depth_eye_max, 1), has_ppm ? shorter(e.depth_range_rms, 1e6) : "",
                               has_ppm ? shorter(e.depth_range_max, 1e6) : "", lsb(e.color_lsb_max, 2),
                               with_commas(e.coverage_mismatches), with_commas(e.coverage_missing + e.coverage_extra)});
  } else {
    cells.insert(cells.end(), 9, "-");
  }
  for (const char* engine : {"rtl", "llvmpipe"}) cells.push_back(times_as_fast(study, row, engine));
  return cells;
}

void print_bench_rows(std::ostream& out, const BenchStudy& study) {
  std::vector<std::vector<std::string>> lines{{"scene",       "engine",         "variation", "threads",
                                               "ms a frame ", "M prim/s",       "M pix/s",   "cycles",
                                               "M cycles/s",  "depth rms, LSB", "max, LSB",  "depth rms, eye",
                                               "max, eye",    "depth rms, ppm", "max, ppm",  "colour max, LSB",
                                               "mismatches",  "missing+extra",  "x rtl",     "x llvmpipe"}};
  bool is_any_single = false;
  for (const BenchRow& row : study.rows) {
    lines.push_back(row_cells(study, row));
    is_any_single = is_any_single || is_single(study, row);
  }
  print_bench_table(out, lines, 3);
  if (is_any_single) out << "* a single frame\n";
  if (!has_many_lsbs(study)) return;
  out << "An LSB is that of each row's own depth.bits; eye depth is in scene units and the same for all rows.\n";
  if (needs_range(study))
    out << "Where no eye depth is known: ppm is millionths of the depth range, the same for all rows of one depth "
           "mapping.\n";
}

void print_skips(std::ostream& out, const std::vector<SkipRow>& skips) {
  std::vector<std::vector<std::string>> lines{{"skip", "scene", "ms with", "ms without", "saved", "skipped"}};
  for (const SkipRow& row : skips)
    lines.push_back({row.skip, row.scene, fixed(1e3 * row.with.median(), 2), fixed(1e3 * row.without.median(), 2),
                     fixed(100 * row.saved(), 1) + " %", with_commas(row.counter)});
  print_bench_table(out, lines, 2);
}

void print_growth(std::ostream& out, const std::vector<GrowthRow>& growth) {
  for (const GrowthSeries& series : growth_series()) {
    std::vector<std::vector<std::string>> lines{{series.x, "ms a frame", "M tri/s", "M pix/s"}};
    for (const GrowthRow& row : growth)
      if (row.series == series.name)
        lines.push_back({with_commas(static_cast<std::uint64_t>(row.x)), fixed(1e3 * row.times.median(), 2),
                         fixed(row.mtri_s(), 3), fixed(row.mpix_s(), 2)});
    if (lines.size() == 1) continue;
    out << series.name << ": " << series.meaning << '\n';
    print_bench_table(out, lines, 0);
  }
}

}  // namespace

void add_bench_json(Json& result, const BenchStudy& study) {
  result["machine"] = {{"processor", processor_name()}, {"threads", std::thread::hardware_concurrency()}};
  result["rows"] = Json::array();
  for (const BenchRow& row : study.rows) result["rows"].push_back(bench_row_json(row, study.cases[row.case_index]));
  for (const SkipRow& row : study.skips) result["skips"].push_back(skip_row_json(row));
  for (const GrowthRow& row : study.growth) result["growth"].push_back(growth_row_json(row));
}

void write_bench_page(const std::string& path, const Json& result, const std::string& command) {
  if (path.empty()) return;
  Json page = result;
  page["version"] = HALFPLANE_VERSION;
  page["command"] = command;
  page["growth_series"] = growth_series();
  write_page(path, kBenchPage, page);
}

void print_bench(std::ostream& out, const BenchStudy& study) {
  if (!study.rows.empty()) print_bench_rows(out, study);
  if (!study.rows.empty() && !study.skips.empty()) out << '\n';
  if (!study.skips.empty()) print_skips(out, study.skips);
  if (!(study.rows.empty() && study.skips.empty()) && !study.growth.empty()) out << '\n';
  if (!study.growth.empty()) print_growth(out, study.growth);
}

}  // namespace halfplane
