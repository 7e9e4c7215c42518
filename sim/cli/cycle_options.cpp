#include "sim/cli/cycle_options.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <ostream>
#include <utility>

#include "model/nearest_word.hpp"
#include "sim/cli/option_kinds.hpp"
#include "sim/cli/progress.hpp"
#include "sim/show/image/framebuffer_files.hpp"
#include "sim/show/image/panel.hpp"
#include "sim/show/image/png.hpp"
#include "sim/show/image/whole_file.hpp"
#include "sim/show/trace/timeline.hpp"
#include "sim/words.hpp"

namespace halfplane {

HALFPLANE_JSON_OF_MEMBERS(Trial, key, value, cycles)
HALFPLANE_JSON_OF_MEMBERS(OrderTrial, order, store, cycles, bytes)

namespace {

constexpr std::uint64_t kFewCycles = 4'000'000;  // cycles of a frame that is explained by default

/// "key=values". Throws InputError naming the option.
std::pair<std::string, std::string> key_and_values(const std::string& option, const std::string& text) {
  const auto equals = text.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
    throw InputError(option + ": '" + text + "' is not KEY=VALUE; write it so, as in cache.lines=16");
  return {text.substr(0, equals), text.substr(equals + 1)};
}

void change_for(const std::string& option, Hardware& hardware, const std::string& key, const std::string& value) {
  try {
    change(hardware, key, value);
    check(hardware);
  } catch (const InputError& error) {
    throw InputError(option + ": " + error.what());
  }
}

/// Every value of every --what-if, in order.
std::vector<std::pair<std::string, std::string>> variations(const CycleCommandOptions& options) {
  std::vector<std::pair<std::string, std::string>> all;
  for (const std::string& text : options.what_if) {
    const auto [key, values] = key_and_values("--what-if", text);
    for (const std::string& value : split(values, ',')) all.emplace_back(key, value);
  }
  return all;
}

/// Forwards to two sinks; either may be missing.
class Tee final : public TransferSink {
 public:
  Tee(TransferSink* first, TransferSink* second) : sinks_{first, second} {}
  void transfer(Arrow boundary, Cycle cycle) override {
    each([&](TransferSink& s) { s.transfer(boundary, cycle); });
  }
  void primitive(const HostPrimitive& p) override {
    each([&](TransferSink& s) { s.primitive(p); });
  }
  void visit(int x, int y) override {
    each([&](TransferSink& s) { s.visit(x, y); });
  }
  void move(MoveCause cause, bool is_color, int x, int y, Cycle from, Cycle to) override {
    each([&](TransferSink& s) { s.move(cause, is_color, x, y, from, to); });
  }
  void wait(Cycle from, Cycle to) override {
    each([&](TransferSink& s) { s.wait(from, to); });
  }

 private:
  template <class Visit>
  void each(Visit&& visit) {
    for (TransferSink* sink : sinks_)
      if (sink != nullptr) visit(*sink);
  }
  std::array<TransferSink*, 2> sinks_;
};

std::string percent(std::uint64_t part, std::uint64_t whole) {
  return whole == 0 ? "-" : fixed(100.0 * static_cast<double>(part) / static_cast<double>(whole), 1) + " %";
}

double per_second(std::uint64_t items, const CycleRun& run, const Hardware& hardware) {
  return static_cast<double>(items) * hardware.memory.mhz * 1e6 / static_cast<double>(std::max<Cycle>(run.cycles, 1));
}

double milliseconds(std::uint64_t cycles, const Hardware& hardware) {
  return static_cast<double>(cycles) / (1e3 * hardware.memory.mhz);
}

std::string kilobytes(std::uint64_t bytes) { return with_commas((bytes + 512) / 1024) + " KB"; }

/// The stage with most of the cycles, in words.
std::string bottleneck(const CycleResult& cycle) {
  const CycleRun& run = cycle.frame.run;
  const auto stages = stage_times(run);
  const StageTime* slowest = &stages.front();
  for (const StageTime& stage : stages)
    if (stage.works > slowest->works) slowest = &stage;
  std::string text;
  if (run.totals.move_cycles >= slowest->works)  // the framebuffer and memory, as one
    text = "framebuffer: for " + percent(run.totals.move_cycles, run.cycles) +
           " of all cycles it moves, marks or looks at tiles and takes no access" +
           (run.totals.memory_cycles == 0
                ? ""
                : ", and waits for the memory in " + percent(run.totals.memory_cycles, run.cycles));
  else
    text = std::string(slowest->name) + ": it works in " + percent(slowest->works, run.cycles) + " of all cycles";
  if (run.others.late_bands != 0)
    text += ". Memory is too slow for scan-out: " + with_commas(run.others.late_bands) + " of " +
            with_commas(run.others.bands) + " rows of blocks come late";
  for (const Trial& trial : cycle.reliefs)  // a tenth of the frame is worth its name
    if ((trial.key == "scan_out" || trial.key == "other_traffic") && trial.cycles < run.cycles - run.cycles / 10)
      text += trial.key == "scan_out" ? ". Scan-out limits: it takes memory from the frame"
                                      : ". Other masters limit: they take memory from the frame";
  if (!cycle.is_explained) return text + "; --explain tries what would relieve it";
  if (cycle.reliefs.empty()) return text + "; nothing that was tried relieves it";
  text += ". Tried: ";
  for (std::size_t i = 0; i < std::min<std::size_t>(3, cycle.reliefs.size()); ++i) {
    const Trial& trial = cycle.reliefs[i];
    text += (i == 0 ? "" : ", ") + trial.key + "=" + trial.value + " saves " +
            percent(run.cycles - trial.cycles, run.cycles);
  }
  return text;
}

/// A row for each value of --what-if. Throws Interrupted.
void vary(const CommonOptions& common, const CycleCommandOptions& options, const Scene& scene, const Stalls& stalls,
          CycleResult& result) {
  const Hardware& hardware = result.hardware;
  const Framebuffer& frame = result.frame.rendering.frame;
  const std::string color = color_hash(frame, hardware.config.color_format), depth = depth_hash(frame);
  const auto all = variations(options);
  if (all.empty()) return;
  Progress progress(common, "varying");
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto part = [&, i](double fraction) {
      progress((static_cast<double>(i) + fraction) / static_cast<double>(all.size()));
    };
    part(0);
    Hardware changed = hardware;
    change(changed, all[i].first, all[i].second);
    CycleOptions cycle;
    cycle.stalls = stalls;
    RenderOptions render;
    render.progress = part;
    const CycleRendering other = run_cycles(scene, changed, render, cycle);
    const bool has_depth =
        hardware.config.frame_store == FrameStore::all && changed.config.frame_store == FrameStore::all;
    const bool same = color_hash(other.rendering.frame, changed.config.color_format) == color &&
                      (!has_depth || depth_hash(other.rendering.frame) == depth);
    result.rows.push_back({all[i].first, all[i].second, other.run, milliseconds(other.run.cycles, changed),
                           traffic(other.run, changed.config).total(), same});
  }
}

}  // namespace

std::string CycleCommandOptions::given() const {
  const MemorySettings standard;
  std::string text;
  for (const auto& [option, is_given] : {std::pair{"--memory", memory_name(memory) != memory_name(standard)},
                                         {"--memory-latency", memory.latency != standard.latency},
                                         {"--mhz", memory.mhz != standard.mhz},
                                         {"--scan-out", memory.traffic.scan_out_hz != 0},
                                         {"--other-traffic", memory.traffic.other_bytes_per_s != 0},
                                         {"--timing", !timing.empty()},
                                         {"--what-if", !what_if.empty()},
                                         {"--stalls", stalls != 0},
                                         {"--explain", explain},
                                         {"--primitives", !primitives_path.empty()},
                                         {"--trace", !trace_path.empty()},
                                         {"--heat", !heat_path.empty()},
                                         {"--misses", !misses_path.empty()}})
    if (is_given) text += (text.empty() ? "" : ", ") + std::string(option);
  return text;
}

void add_cycle_options(CLI::App& app, CycleCommandOptions& options) {
  const std::string group = "For --engine cycle";
  CLI::Option_group& cycle = *app.add_option_group(group);
  add_memory_options(cycle, options.memory);
  add_traffic_options(cycle, options.memory);
  cycle
      .add_option("--timing", options.timing,
                  "KEY=VALUE: a size or rule of the cycle model that is fixed in the RTL (config --list)")
      ->type_name("KEY=VALUE");
  cycle.add_option("--what-if", options.what_if, "KEY=V1,V2,...: a table of the cycles with each of these values")
      ->type_name("KEY=LIST");
  add_real_option(cycle, "--stalls", options.stalls, 0.0, 0.95,
                  "probability with which each stream is held back in a cycle");
  cycle.add_flag("--explain", options.explain,
                 "try changes that might relieve the bottleneck, and measure what skipping saves");
  add_file_option(cycle, "--primitives", options.primitives_path, "listing: the cycles of each primitive, .csv",
                  ".csv");
  add_file_option(cycle, "--trace", options.trace_path, "timeline for ui.perfetto.dev, .json", ".json");
  add_file_option(cycle, "--heat", options.heat_path,
                  "sheet: cycles and draws of each pixel, .png; cycles alone: .npy");
  add_file_option(cycle, "--misses", options.misses_path,
                  "sheet: lines of texels that each pixel asked memory for, .png; these alone: .npy");
}

void check_cycle_options(const CycleCommandOptions& options, const Config& config) {
  const Hardware hardware = hardware_of(options, config);
  for (const auto& [key, value] : variations(options)) {
    Hardware changed = hardware;
    change_for("--what-if", changed, key, value);
  }
  const TimingParameters& p = hardware.parameters;
  if (!options.trace_path.empty() && p.triangle_queue + p.setup_queue + p.tile_queue + p.fragment_queue != 0)
    throw InputError(
        "--trace: a timeline shows stages and not the queues between them; leave out --trace, or --timing queue...");
  check_output(options.heat_path, options.heat_path.ends_with(".npy") ? ".npy" : ".png");
  check_output(options.misses_path, options.misses_path.ends_with(".npy") ? ".npy" : ".png");
  if (!options.misses_path.empty() && !has_texture_planes(config))
    throw InputError("--misses: there is no texture unit, and so no cache; add --set texture.unit=nearest");
}

Hardware hardware_of(const CycleCommandOptions& options, const Config& config) {
  Hardware hardware{config, {}, options.memory};
  for (const std::string& text : options.timing) {
    const auto [key, value] = key_and_values("--timing", text);
    if (find_timing_setting(key) == nullptr) {
      std::vector<std::string_view> keys;
      for (const TimingSetting& setting : timing_settings()) keys.push_back(setting.key);
      throw InputError("--timing: no setting '" + key + "';" + did_you_mean(key, keys) +
                       " 'halfplane config --list' has them, --set takes the others");
    }
    change_for("--timing", hardware, key, value);
  }
  return hardware;
}

CycleResult run_cycle_engine(const CommonOptions& common, const CycleCommandOptions& options, const Scene& scene,
                             const Config& config, RenderOptions render) {
  CycleResult result{hardware_of(options, config), options.stalls, {}, {}, {}, {}, false, {}};
  const Hardware& hardware = result.hardware;
  PrimitiveSpans spans;
  Timeline timeline(Json(common.scene + ", " + label(config)).dump(-1, ' ', false, Json::error_handler_t::replace));
  Tee tee(options.primitives_path.empty() ? nullptr : &spans, options.trace_path.empty() ? nullptr : &timeline);
  CycleOptions cycle;
  cycle.stalls = {common.seed, stall_threshold(options.stalls)};
  if (!options.primitives_path.empty() || !options.trace_path.empty()) cycle.sink = &tee;
  cycle.want_cost = !options.heat_path.empty();
  cycle.want_misses = !options.misses_path.empty();
  render.want_count |= cycle.want_cost || cycle.want_misses;
  result.frame = run_cycles(scene, hardware, render, cycle);
  const CycleRun& run = result.frame.run;

  if (!options.primitives_path.empty()) write_text_file(options.primitives_path, spans.finish());
  if (!options.trace_path.empty()) write_text_file(options.trace_path, timeline.finish());
  const Framebuffer& frame = result.frame.rendering.frame;
  const auto write_heat = [&](const std::string& path, const std::vector<float>& values, std::string_view unit) {
    if (path.ends_with(".npy"))
      write_npy(path, frame.width, frame.height, values);
    else if (!path.empty())
      write_png(path,
                heat_sheet(common.scene + ", " + label(config) + ", " + "memory " + memory_text(hardware.memory),
                           color_picture(frame, config.color_format), values, unit, result.frame.rendering.count));
  };
  write_heat(options.heat_path, result.frame.cost, "cycles");
  write_heat(options.misses_path, result.frame.misses, "misses");

  result.is_explained = options.explain || run.cycles <= kFewCycles;
  if (result.is_explained) {
    Progress progress(common, "trying what would relieve it");
    try {
      result.reliefs =
          try_reliefs(scene, hardware, cycle.stalls, run.cycles, [&](double fraction) { progress(0.6 * fraction); });
      result.orders =
          try_orders(scene, hardware, cycle.stalls, [&](double fraction) { progress(0.6 + 0.2 * fraction); });
      result.savings = measure_savings(scene, hardware, cycle.stalls, run.cycles,
                                       [&](double fraction) { progress(0.8 + 0.2 * fraction); });
    } catch (const Interrupted&) {  // half an explanation would mislead
      result.is_explained = false;
    }
  }
  try {
    vary(common, options, scene, cycle.stalls, result);
  } catch (const Interrupted&) {  // the rows so far are kept
  }
  return result;
}

void add_cycle_json(Json& result, const CycleResult& cycle) {
  const CycleRun& run = cycle.frame.run;
  const Hardware& hardware = cycle.hardware;
  result["cycles"] = run.cycles;
  result["raster_cycles"] = run.raster_cycles;
  result["tile_cycles"] = run.tile_cycles;
  result["stalls"] = cycle.stalls;
  result["memory"] = memory_json(hardware.memory);
  Json timing = Json::object();
  for (const TimingSetting& setting : timing_settings())
    timing[std::string(setting.key)] = hardware.parameters.*setting.member;
  result["timing"] = timing;
  const Counters& c = cycle.frame.rendering.counters;
  result["per_second"] = {{"frames", per_second(1, run, hardware)},
                          {"pixels", per_second(c.covered, run, hardware)},
                          {"primitives", per_second(c.primitives_in, run, hardware)}};
  Json stages = Json::object();
  for (const StageTime& stage : stage_times(run)) {
    Json waits = Json::object();
    for (const StageTime::Wait& wait : stage.waits) waits[std::string(wait.reason)] = wait.cycles;
    stages[std::string(stage.name)] = {
        {"busy", stage.use.busy},  {"stalled", stage.use.stalled}, {"starved", stage.use.starved},
        {"items", stage.use.busy}, {"works", stage.works},         {"no_item", stage.no_item},
        {"waits", waits}};
  }
  result["stages"] = stages;
  const Traffic bytes = traffic(run, hardware.config);
  for (std::size_t cause = 0; cause < kMoveCauses.size(); ++cause)
    result["traffic_bytes"][std::string(kMoveCauses[cause])] = {{"depth", bytes.bytes[cause][0]},
                                                                {"color", bytes.bytes[cause][1]}};
  if (has_texture_planes(hardware.config)) {
    result["traffic_bytes"]["fill"]["texture"] = bytes.texels;
    result["texture"]["bytes"] = bytes.texels;
  }
  if (!hardware.memory.traffic.is_none())
    result["other_masters"] = {{"scan_out_bytes", run.others.scan_out_bytes},
                               {"other_bytes", run.others.other_bytes},
                               {"bands", run.others.bands},
                               {"late_bands", run.others.late_bands}};
  result["bottleneck"] = bottleneck(cycle);
  if (cycle.is_explained) {
    Json saved = Json::object();
    for (const Saving& saving : cycle.savings) saved[std::string(saving.name)] = saving.cycles;
    result["reliefs"] = cycle.reliefs;
    result["orders"] = {{"tried", cycle.orders},
                        {"recommended", cycle.orders.empty() ? Json(nullptr) : Json(recommended(cycle.orders))}};
    result["saved_cycles"] = saved;
  }
  Json rows = Json::array();
  for (const CycleResult::Row& row : cycle.rows)
    rows.push_back({{"key", row.key},
                    {"value", row.value},
                    {"cycles", row.run.cycles},
                    {"ms", row.ms},
                    {"raster_cycles", row.run.raster_cycles},
                    {"tile_cycles", row.run.tile_cycles},
                    {"bytes", row.bytes},
                    {"same_picture", row.same_picture}});
  result["what_if"] = rows;
}

void print_cycles(std::ostream& out, const CycleResult& cycle) {
  const CycleRun& run = cycle.frame.run;
  const Hardware& hardware = cycle.hardware;
  const Counters& c = cycle.frame.rendering.counters;
  out << "cycles      " << with_commas(run.cycles) << " in all, " << with_commas(run.raster_cycles)
      << " from the first primitive to the last write, " << with_commas(run.tile_cycles) << " of them moving tiles"
      << (cycle.stalls == 0 ? std::string() : "; stalls " + fixed(cycle.stalls, 2)) << '\n'
      << left_aligned("at " + std::to_string(hardware.memory.mhz) + " MHz", 12)
      << fixed(milliseconds(run.cycles, hardware), 2) << " ms a frame, " << fixed(per_second(1, run, hardware), 1)
      << " frames, " << fixed(per_second(c.covered, run, hardware) / 1e6, 2) << " M covered pixels, "
      << fixed(per_second(c.primitives_in, run, hardware) / 1e6, 3) << " M primitives a second\n";
  const Traffic bytes = traffic(run, hardware.config);
  out << "memory      " << memory_text(hardware.memory) << "; " << kilobytes(bytes.total()) << " a frame:";
  for (std::size_t cause = 0; cause < kMoveCauses.size(); ++cause)
    out << (cause == 0 ? " " : ", ") << kMoveCauses[cause] << " " << kilobytes(bytes.bytes[cause][0]) << " depth, "
        << kilobytes(bytes.bytes[cause][1]) << " colour";
  if (has_texture_planes(hardware.config)) {
    const auto samples = static_cast<double>(std::max<std::uint64_t>(1, c.texture.samples));
    out << ", texels " << kilobytes(bytes.texels) << "\ntextures    " << with_commas(c.texture.samples) << " samples, "
        << fixed(100 * static_cast<double>(c.texture.hits) / samples, 1) << " % hit, "
        << fixed(static_cast<double>(bytes.texels) / samples, 2) << " bytes each from memory";
  }
  if (const MemoryUse& others = run.others; !hardware.memory.traffic.is_none())
    out << "\nothers      scan-out " << kilobytes(others.scan_out_bytes) << " in " << with_commas(others.bands)
        << " bands, " << with_commas(others.late_bands) << " of them late; other masters "
        << kilobytes(others.other_bytes);
  out << "\n\nstage                 items         works   no item       waits for\n";
  for (const StageTime& stage : stage_times(run)) {
    out << left_aligned(std::string(stage.name), 16) << right_aligned(with_commas(stage.use.busy), 11)
        << right_aligned(percent(stage.works, run.cycles), 14) << right_aligned(percent(stage.no_item, run.cycles), 10)
        << "       ";
    for (std::size_t i = 0; i < stage.waits.size(); ++i)
      out << (i == 0 ? "" : ", ") << stage.waits[i].reason << " " << percent(stage.waits[i].cycles, run.cycles);
    out << (stage.waits.empty() ? "-" : "") << '\n';
  }
  const auto saved = [&](std::string_view name) {
    for (const Saving& saving : cycle.savings)
      if (saving.name == name)
        return (saving.cycles < 0 ? ", costs " : ", saves ") +
               with_commas(static_cast<std::uint64_t>(std::abs(saving.cycles))) + " cycles";
    return std::string();
  };
  const auto& s = c.skipped;
  out << "\nskipped     tiles behind HiZ " << with_commas(s.tiles_hiz) << saved("tiles_hiz") << "; tiles outside "
      << with_commas(s.tiles_outside) << saved("tiles_outside") << "; fast clear" << saved("fast_clear") << "\n"
      << "            back faces " << with_commas(s.backface) << ", zero area " << with_commas(s.zero_area)
      << ", empty " << with_commas(s.empty) << ", no sample " << with_commas(s.no_sample) << ": nothing behind cull\n"
      << "bottleneck  " << bottleneck(cycle) << '\n';
  if (!cycle.orders.empty()) {
    out << "order       ";
    for (const OrderTrial& trial : cycle.orders)
      out << trial.order << (trial.store == "color" ? ", frame.store=color: " : ": ") << with_commas(trial.cycles)
          << " cycles, " << kilobytes(trial.bytes) << "; ";
    out << "recommended: frame.order=" << recommended(cycle.orders) << '\n';
  }
  if (cycle.rows.empty()) return;
  out << "\nwhat if                            cycles    change          ms     moving tiles      memory\n";
  const auto line = [&](const std::string& what, const CycleRun& other, double ms, std::uint64_t moved, bool same) {
    const double change = 100.0 * (static_cast<double>(other.cycles) / static_cast<double>(run.cycles) - 1);
    out << left_aligned(what, 28) << right_aligned(with_commas(other.cycles), 13)
        << right_aligned((change > 0 ? "+" : "") + fixed(change, 1) + " %", 10) << right_aligned(fixed(ms, 3), 12)
        << right_aligned(with_commas(other.tile_cycles), 17) << right_aligned(kilobytes(moved), 12)
        << (same ? "" : "   another picture") << '\n';
  };
  line("as it is", run, milliseconds(run.cycles, hardware), bytes.total(), true);
  for (const CycleResult::Row& row : cycle.rows)
    line(row.key + "=" + row.value, row.run, row.ms, row.bytes, row.same_picture);
}

}  // namespace halfplane
