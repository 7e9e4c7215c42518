#include <algorithm>
#include <array>
#include <iomanip>
#include <iostream>
#include <tuple>

#include "model/engines/cycle/stage_table.hpp"
#include "model/generate/c_header.hpp"
#include "model/generate/dpi_package.hpp"
#include "model/generate/raster_pkg.hpp"
#include "model/generate/raster_taps.hpp"
#include "model/widths.hpp"
#include "sim/cli/commands.hpp"
#include "sim/cli/options.hpp"
#include "sim/config_file.hpp"
#include "sim/show/image/whole_file.hpp"

namespace halfplane {
namespace {

/// Key, value, range with unit, meaning: without --list the last two are left out.
using Row = std::array<std::string, 4>;

std::vector<Row> setting_rows(const Config& config) {
  std::vector<Row> rows;
  for (const Setting& setting : settings()) {
    const bool is_number = setting.is_number();
    const std::string range =
        is_number ? std::to_string(setting.min) + "..." + std::to_string(setting.max) + " " : std::string();
    rows.push_back({std::string(setting.key), get(config, setting), range + std::string(setting.unit),
                    std::string(setting.meaning)});
  }
  return rows;
}

/// The settings that only the cycle model can vary.
std::vector<Row> timing_rows() {
  std::vector<Row> rows;
  const TimingParameters rtl;
  for (const TimingSetting& setting : timing_settings())
    rows.push_back({std::string(setting.key), std::to_string(rtl.*setting.member),
                    std::to_string(setting.min) + "..." + std::to_string(setting.max), std::string(setting.meaning)});
  return rows;
}

void print_settings(std::ostream& out, const Config& config, bool is_list) {
  const std::vector<Row> rows = setting_rows(config), timing = is_list ? timing_rows() : std::vector<Row>();
  std::array<std::size_t, 3> widths{24, 10, 0};  // as wide as the widest row of both tables
  for (const auto* table : {&rows, &timing})
    for (const Row& row : *table)
      for (std::size_t i = 0; i < widths.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  const auto print = [&](const Row& row) {
    out << left_aligned(row[0], widths[0]) << ' ' << right_aligned(row[1], widths[1]);
    if (is_list) out << "   " << left_aligned(row[2], widths[2]) << "  " << row[3];
    out << '\n';
  };
  out << "preset = " << config.preset << '\n';
  for (const Row& row : rows) print(row);
  if (is_list) out << "\nfor --timing and --what-if of the cycle engine; the RTL has the value shown\n";
  for (const Row& row : timing) print(row);
}

std::string bound_text(const Width& width) {
  return formatted("%.6g", static_cast<double>(std::max(-width.range.lo, width.range.hi)));
}

/// The hardware's widths, then widths of the scalar engine alone.
std::vector<const Width*> all_widths(const Widths& widths, const HomogeneousWidths& homogeneous) {
  std::vector<const Width*> all = widths.all();
  const auto more = homogeneous.all();
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

void print_widths(std::ostream& out, const std::vector<const Width*>& widths) {
  out << "\nderived width            bits           largest   bound\n";
  for (const Width* width : widths)
    out << std::left << std::setw(24) << width->name << std::right << std::setw(4) << width->bits
        << (width->is_modular  ? " modular"
            : width->is_signed ? " signed "
                               : "        ")
        << std::setw(14) << bound_text(*width) << "   " << width->bound << '\n';
}

Json widths_json(const std::vector<const Width*>& widths) {
  Json list = Json::array();
  for (const Width* width : widths)
    list.push_back({{"name", width->name},
                    {"bits", width->bits},
                    {"signed", width->is_signed},
                    {"modular", width->is_modular},
                    {"bound", width->bound}});
  return list;
}

struct ConfigOptions : CommonOptions {
  bool list = false, widths = false, stages = false, sv = false, taps = false, dpi = false, c_header = false,
       toml = false;
  std::string path;
};

int run(const ConfigOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  const Config config = effective_config(options);
  if (options.path == "-" && (options.toml || options.sv || options.taps || options.dpi || options.c_header))
    throw InputError("-o - and another output both write to stdout; leave one of them out");
  std::ostream& out = human(options);
  if (!options.path.empty()) write_text_file(options.path, config_toml(config));
  const std::string file = options.toml       ? config_toml(config)
                           : options.sv       ? raster_pkg(config)
                           : options.dpi      ? vectors::dpi_package(config)
                           : options.c_header ? c_header(config)
                           : options.taps     ? raster_taps()
                                              : "";
  if (!file.empty()) {
    std::cout << file;
    return exit_ok;
  }
  const Widths hardware = derive_widths(config);
  const HomogeneousWidths homogeneous = derive_homogeneous_widths(config);
  const auto widths = all_widths(hardware, homogeneous);
  Json result = result_head("config", options, config);
  if (options.list) {
    Json list = Json::array();
    for (const Setting& setting : settings()) {
      Json entry{{"key", setting.key}, {"value", result["config"][std::string(setting.key)]}, {"unit", setting.unit}};
      if (setting.is_number()) entry["range"] = {setting.min, setting.max};
      entry["meaning"] = setting.meaning;
      list.push_back(entry);
    }
    result["settings"] = list;
    Json timing = Json::array();
    const TimingParameters rtl;
    for (const TimingSetting& setting : timing_settings())
      timing.push_back({{"key", setting.key},
                        {"value", rtl.*setting.member},
                        {"range", {setting.min, setting.max}},
                        {"meaning", setting.meaning}});
    result["timing_settings"] = timing;
  }
  if (options.widths) result["widths"] = widths_json(widths);
  if (options.stages) {
    Json stages = Json::array();
    for (const StageRow& row : stage_table(config))
      stages.push_back({{"stage", info(row.stage).name},
                        {"latency", row.latency},
                        {"interval", row.interval},
                        {"holds", row.holds}});
    result["stages"] = stages;
  }
  finish_json(options, result, start);
  print_settings(out, config, options.list);
  if (options.widths) print_widths(out, widths);
  if (options.stages) out << '\n' << stage_table_markdown(config);
  return exit_ok;
}

}  // namespace

void add_config_command(CLI::App& app, Action& selected) {
  const auto [command, options] = add_command<ConfigOptions>(
      app, selected, "config", "shows or lists the settings and the widths derived from them", run);
  add_output_options(*command, *options);
  command->get_option("--config")->each(claim_input);
  command->add_flag("--list", options->list, "every setting with its range and meaning");
  command->add_flag("--widths", options->widths, "every derived width with its bound");
  command->add_flag("--stages", options->stages, "latency and interval of every stage, in cycles");
  // Each of these is all of the output.
  std::vector<std::string> others{"--list", "--widths", "--stages", "--json"};
  for (const auto& [name, flag, meaning] :
       {std::tuple{"--sv", &options->sv, "prints raster_pkg.sv for this configuration"},
        {"--taps", &options->taps, "prints cosim/taps.svh, the taps of the co-simulation"},
        {"--dpi", &options->dpi, "prints halfplane_dpi.sv, the stages as functions of SystemVerilog"},
        {"--c-header", &options->c_header, "prints this configuration as a C header, for driver/"},
        {"--toml", &options->toml, "prints this configuration as --config reads it"}}) {
    CLI::Option* const option = command->add_flag(name, *flag, meaning);
    for (const std::string& other : others) option->excludes(other);
    others.emplace_back(name);
  }
  add_file_option(*command, "-o", options->path, "writes this configuration as --config reads it, .toml", ".toml");
  command->footer(
      "\nExample:\n  halfplane config --set depth.bits=20 -o mine.toml\n  halfplane config --list\n  halfplane config "
      "--config full --set depth.bits=20 --widths");
}

}  // namespace halfplane
