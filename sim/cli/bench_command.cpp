#include <algorithm>
#include <chrono>
#include <iostream>
#include <memory>

#include "model/engines/functional.hpp"
#include "model/engines/scalar.hpp"
#include "sim/cli/commands.hpp"
#include "sim/cli/cycle_options.hpp"
#include "sim/cosim/rtl_engine.hpp"

namespace halfplane {
namespace {

struct BenchCommand : CommonOptions {
  std::vector<std::string> scenes{"teapot", "city"};
  std::vector<std::string> engines{"functional", "cycle", "rtl"};
  int repeat = 5;
};

/// One engine on one scene.
struct BenchRow {
  std::string engine, scene;
  std::vector<double> frame_s;  ///< host side and raster
  std::uint64_t cycles = 0;     ///< 0: the engine has none
  Counters counters;

  [[nodiscard]] double median() const {
    auto sorted = frame_s;
    std::sort(sorted.begin(), sorted.end());
    return std::max(sorted[sorted.size() / 2], 1e-9);  // an empty scene
  }
  [[nodiscard]] double cycles_per_s() const { return static_cast<double>(cycles) / median(); }
};

void run_once(BenchRow& row, const Scene& scene, const Config& config, Dut* dut) {
  Rendering rendering;
  if (row.engine == "cycle") {
    CycleRendering cycle = run_cycles(scene, {config, {}, {}});
    row.cycles = cycle.run.cycles;
    rendering = std::move(cycle.rendering);
  } else if (row.engine == "rtl") {
    RtlRendering rtl = render_rtl(*dut, scene, config, {});
    row.cycles = rtl.run.cycles;
    rendering = std::move(rtl.rendering);
  } else {
    rendering = row.engine == "scalar" ? render_scalar(scene, config) : render_functional(scene, config);
  }
  row.frame_s.push_back(rendering.geometry_s + rendering.raster_s);
  row.counters = rendering.counters;
}

Json row_json(const BenchRow& row, const Config& config) {
  const double seconds = row.median();
  return {{"engine", row.engine},
          {"config", label(config)},
          {"scene", row.scene},
          {"frame_s", seconds},
          {"mtri_s", static_cast<double>(row.counters.primitives_in) / 1e6 / seconds},
          {"mpix_s", static_cast<double>(row.counters.covered) / 1e6 / seconds},
          {"cycles", row.cycles == 0 ? Json(nullptr) : Json(row.cycles)},
          {"cycles_per_s", row.cycles == 0 ? Json(nullptr) : Json(row.cycles_per_s())}};
}

void print_rows(std::ostream& out, const std::vector<BenchRow>& rows) {
  out << "scene         engine          ms a frame     M prim/s     M pix/s        cycles  M cycles/s   x RTL\n";
  for (const BenchRow& row : rows) {
    const auto rtl = std::find_if(rows.begin(), rows.end(), [&](const BenchRow& other) {
      return other.engine == "rtl" && other.scene == row.scene;
    });
    out << left_aligned(row.scene, 14) << left_aligned(row.engine, 12)
        << right_aligned(fixed(1e3 * row.median(), 2), 14)
        << right_aligned(fixed(static_cast<double>(row.counters.primitives_in) / 1e6 / row.median(), 3), 13)
        << right_aligned(fixed(static_cast<double>(row.counters.covered) / 1e6 / row.median(), 2), 12);
    if (row.cycles != 0)
      out << right_aligned(with_commas(row.cycles), 14) << right_aligned(fixed(row.cycles_per_s() / 1e6, 2), 12);
    else
      out << std::string(26, ' ');
    if (rtl != rows.end()) out << right_aligned(fixed(rtl->median() / row.median(), 1), 8);
    out << '\n';
  }
}

int run(const BenchCommand& options) {
  const auto start = std::chrono::steady_clock::now();
  const Config config = effective_config(options);
  std::unique_ptr<Dut> dut;
  for (const std::string& engine : options.engines) {
    if (engine != "functional" && engine != "scalar" && engine != "cycle" && engine != "rtl")
      throw InputError("--engines: no engine '" + engine + "'; give functional, scalar, cycle or rtl");
    if (engine == "rtl") dut = make_dut(find_dut(config));
  }
  std::vector<BenchRow> rows;
  std::vector<Scene> scenes;
  for (const std::string& name : options.scenes) {
    CommonOptions one = options;
    one.scene = name;
    double load_s = 0;
    scenes.push_back(load_scene(one, config, load_s));
    check_hardware_scene(scenes.back(), config);
    for (const std::string& engine : options.engines) rows.push_back({engine, name, {}, 0, {}});
  }
  {
    Progress progress(options, "measuring");
    // In turns, so that what else the machine does falls on all of them alike; the first turn warms up.
    for (int turn = 0; turn <= options.repeat; ++turn)
      for (std::size_t i = 0; i < rows.size(); ++i) {
        progress(static_cast<double>(turn) / (options.repeat + 1));
        if (turn == 1) rows[i].frame_s.clear();
        run_once(rows[i], scenes[i / options.engines.size()], config, dut.get());
      }
  }
  Json result = result_head("bench", options, config);
  result["repeat"] = options.repeat;
  result["rows"] = Json::array();
  for (const BenchRow& row : rows) result["rows"].push_back(row_json(row, config));
  result["wall_s"] = seconds_since(start);
  write_json(options, result);
  std::ostream& out = human(options);
  out << label(config) << ", " << scenes.front().width << "x" << scenes.front().height << ", median of "
      << options.repeat << ", one thread, engines in turns\n";
  print_rows(out, rows);
  return exit_ok;
}

}  // namespace

void add_bench_command(CLI::App& app, Action& selected) {
  CLI::App* command = app.add_subcommand("bench", "run time of the engines, side by side");
  auto options = std::make_shared<BenchCommand>();
  add_output_options(*command, *options);
  add_seed_option(*command, *options, "of scenes that depend on one");
  command->add_option("SCENES", options->scenes, "names or files")->capture_default_str();
  command->add_option("--size", options->size, "WxH of the pictures")->default_str("fits the target");
  command->add_option("--engines", options->engines, "functional, scalar, cycle, rtl")
      ->delimiter(',')
      ->capture_default_str();
  command->add_option("--repeat", options->repeat, "turns behind the first, of which the median counts")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->footer("\nExample:\n  halfplane bench teapot city --size 1280x720 --engines functional,cycle,rtl");
  command->callback([&selected, options] { selected = [options] { return run(*options); }; });
}

}  // namespace halfplane
