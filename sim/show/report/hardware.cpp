#include "sim/show/report/hardware.hpp"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "model/as_number.hpp"
#include "model/nearest_word.hpp"
#include "sim/config_file.hpp"

namespace halfplane {
namespace {

int number(std::string_view key, std::string_view value, int min, int max) {
  const auto result = as_number<int>(value);
  if (!result || *result < min || *result > max)
    throw InputError(std::string(key) + ": '" + std::string(value) + "' is no number in its range; give " +
                     std::to_string(min) + "..." + std::to_string(max));
  return *result;
}

/// `progress` gets the fraction of part `index` of `count`.
CycleRun run_of(const Scene& scene, const Hardware& hardware, const Stalls& stalls,
                const std::function<void(double)>& progress, std::size_t index, std::size_t count) {
  CycleOptions options;
  options.stalls = stalls;
  RenderOptions render;
  if (progress)
    render.progress = [&](double part) { progress((static_cast<double>(index) + part) / static_cast<double>(count)); };
  return run_cycles(scene, hardware, render, options).run;
}

std::uint64_t cycles_of(const Scene& scene, const Hardware& hardware, const Stalls& stalls,
                        const std::function<void(double)>& progress, std::size_t index, std::size_t count) {
  return run_of(scene, hardware, stalls, progress, index, count).cycles;
}

std::uint64_t part(std::uint64_t whole, std::uint64_t taken) { return whole > taken ? whole - taken : 0; }

/// The waits of the sender of `out`: for the next stage, and others counted in the totals.
std::vector<StageTime::Wait> waits_of(Arrow out, const CycleRun& run) {
  const TimingTotals& t = run.totals;
  const std::string_view next = info(info(out).to).name;
  const std::uint64_t stalled = run.use[index(out)].stalled;
  switch (out) {
    case Arrow::setup: return {{next, part(stalled, t.slot_cycles)}, {"a context slot", t.slot_cycles}};
    case Arrow::tile:
      return {{next, stalled},
              {"an earlier visit of the tile (HiZ)", t.bound_cycles},
              {"a place for one more visit", t.visit_cycles}};
    case Arrow::fragment:  // depth_test itself never waits
      return {{info(Stage::framebuffer).name, part(stalled, t.hazard_cycles)},
              {"the fragment before (hazard)", t.hazard_cycles}};
    case Arrow::request: return {{next, t.memory_cycles}};
    default: return {{next, stalled}};
  }
}

}  // namespace

void change(Hardware& hardware, std::string_view key, std::string_view value) {
  if (key == "memory") {
    set_memory(hardware.memory, value);
  } else if (key == "memory.width" || key == "memory.mhz") {
    MemorySettings other = hardware.memory;
    (key == "memory.width" ? other.sdram_width : other.sdram_mhz) = number(key, value, 1, 1000);
    set_memory(other, memory_name(other));
    hardware.memory = other;
  } else if (key == "scan_out") {
    hardware.memory.traffic.scan_out_hz = number(key, value, 0, kMaxScanOutHz);
  } else if (key == "other_traffic") {
    hardware.memory.traffic.other_bytes_per_s = static_cast<std::uint64_t>(number(key, value, 0, kMaxOtherBytes));
  } else if (key == "memory.latency") {
    hardware.memory.latency = number(key, value, 1, 10000);
  } else if (key == "mhz") {
    hardware.memory.mhz = number(key, value, 1, 1000);
  } else if (const TimingSetting* setting = find_timing_setting(key)) {
    hardware.parameters.*setting->member = number(key, value, setting->min, setting->max);
  } else if (find_setting(key) != nullptr) {
    set(hardware.config, key, value);
  } else {
    std::vector<std::string_view> keys(kMemoryKeys.begin(), kMemoryKeys.end());
    for (const TimingSetting& known : timing_settings()) keys.push_back(known.key);
    for (const Setting& known : settings()) keys.push_back(known.key);
    throw InputError(
        "no setting '" + std::string(key) + "';" + did_you_mean(key, keys) +
        " give one of 'halfplane config --list', memory, memory.latency, memory.width, memory.mhz, mhz, scan_out or "
        "other_traffic");
  }
}

std::string value_of(const Hardware& hardware, std::string_view key) {
  if (key == "memory") return memory_name(hardware.memory);
  if (key == "memory.width") return std::to_string(hardware.memory.sdram_width);
  if (key == "memory.mhz") return std::to_string(hardware.memory.sdram_mhz);
  if (key == "scan_out") return std::to_string(hardware.memory.traffic.scan_out_hz);
  if (key == "other_traffic") return std::to_string(hardware.memory.traffic.other_bytes_per_s);
  if (key == "memory.latency") return std::to_string(hardware.memory.latency);
  if (key == "mhz") return std::to_string(hardware.memory.mhz);
  if (const TimingSetting* setting = find_timing_setting(key))
    return std::to_string(hardware.parameters.*setting->member);
  return get(hardware.config, *find_setting(key));
}

void check(const Hardware& hardware) {
  validate(hardware.config);
  validate(hardware.parameters, hardware.config);
}

CycleRendering run_cycles(const Scene& scene, const Hardware& hardware, const RenderOptions& render,
                          CycleOptions options) {
  check(hardware);
  options.parameters = hardware.parameters;
  options.textures = hardware.memory;
  const auto memory = make_memory(hardware.memory, hardware.config);
  return render_cycle(scene, hardware.config, *memory, render, options);
}

std::vector<StageTime> stage_times(const CycleRun& run) {
  const TimingTotals& t = run.totals;
  std::vector<StageTime> stages;
  for (const Arrow out : kElastic) {
    const Stage sender = info(out).from;
    if (!info(sender).is_timed || out == Arrow::response) continue;  // for memory_port beats are counted
    StageTime stage{info(sender).name, run.use[index(out)], t.works[index(sender)], 0, {}};
    if (stage.use.busy == 0 && stage.works == 0) continue;  // absent, or without work
    std::uint64_t waited = 0;
    for (const StageTime::Wait& wait : waits_of(out, run)) {
      waited += wait.cycles;
      if (wait.cycles != 0) stage.waits.push_back(wait);
    }
    stage.works = std::min(stage.works, part(run.cycles, waited));  // where parts work while others wait
    stage.no_item = part(run.cycles, stage.works + waited);
    stages.push_back(std::move(stage));
  }
  return stages;
}

std::uint64_t Traffic::total() const {
  std::uint64_t sum = 0;
  for (const auto& cause : bytes) sum += cause[0] + cause[1];
  return sum + texels;
}

Traffic traffic(const CycleRun& run, const Config& config) {
  Traffic traffic;
  for (std::size_t cause = 0; cause < kMoveCauses.size(); ++cause)
    for (const bool is_color : {false, true})
      traffic.bytes[cause][is_color] =
          run.totals.beats[cause][is_color] * static_cast<std::uint64_t>(config.memory_port_bits / 8);
  traffic.texels = run.totals.texel_beats * static_cast<std::uint64_t>(derive_widths(config).texture_port_bytes);
  return traffic;
}

std::vector<Trial> try_reliefs(const Scene& scene, const Hardware& hardware, const Stalls& stalls, std::uint64_t cycles,
                               const std::function<void(double)>& progress) {
  const bool is_pipelined = hardware.config.setup_kind == SetupKind::pipelined;
  std::vector<Trial> trials;
  const auto times = [&](std::string_view key, int factor) {
    trials.push_back({std::string(key), std::to_string(std::stoi(value_of(hardware, key)) * factor), 0});
  };
  times("cache.lines", 4);
  times("stamp.size", 2);
  times("context.slots", 2);
  times("hiz.lag", 2);
  if (has_texture_planes(hardware.config)) times("texture.cache_kb", 4);
  if (is_pipelined) {
    for (const char* key : {"queue.tile", "queue.stamp", "queue.fragment"}) trials.push_back({key, "16", 0});
    times("divide.bits", 2);
    if (hardware.config.setup_plane_clocks != 1) trials.push_back({"setup.plane_clocks", "1", 0});
  } else {
    trials.push_back({"setup.kind", "pipelined", 0});
  }
  if (hardware.memory.kind != MemoryKind::fixed || hardware.memory.latency > 1)
    trials.push_back(hardware.memory.kind == MemoryKind::fixed ? Trial{"memory.latency", "1", 0}
                                                               : Trial{"memory", "sram", 0});
  if (hardware.memory.kind == MemoryKind::sdram && hardware.memory.sdram_width < kSdramWidths.back())
    times("memory.width", 2);
  for (const char* master : {"scan_out", "other_traffic"})
    if (value_of(hardware, master) != "0") trials.push_back({master, "0", 0});
  std::vector<Trial> helped;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    if (progress) progress(static_cast<double>(i) / static_cast<double>(trials.size()));
    Hardware changed = hardware;
    try {
      change(changed, trials[i].key, trials[i].value);
      trials[i].cycles = cycles_of(scene, changed, stalls, progress, i, trials.size());
    } catch (const InputError&) {
      continue;  // such hardware does not exist
    }
    if (trials[i].cycles < cycles) helped.push_back(trials[i]);
  }
  std::stable_sort(helped.begin(), helped.end(), [](const Trial& a, const Trial& b) { return a.cycles < b.cycles; });
  return helped;
}

std::vector<OrderTrial> try_orders(const Scene& scene, const Hardware& hardware, const Stalls& stalls,
                                   const std::function<void(double)>& progress) {
  const std::string store = value_of(hardware, "frame.store");
  std::vector<OrderTrial> trials;
  if (hardware.config.cache_kind == CacheKind::tiles || hardware.config.resolve_units != 0) return trials;  // one order
  trials = {{"program", store}, {"bins", store}};
  if (store == "all") trials.push_back({"bins", "color"});
  for (std::size_t i = 0; i < trials.size(); ++i) {
    Hardware changed = hardware;
    change(changed, "frame.order", trials[i].order);
    change(changed, "frame.store", trials[i].store);
    const CycleRun run = run_of(scene, changed, stalls, progress, i, trials.size());
    trials[i].cycles = run.cycles;
    trials[i].bytes = traffic(run, changed.config).total();
  }
  return trials;
}

const std::string& recommended(const std::vector<OrderTrial>& orders) {
  const auto cost = [&orders](std::size_t i) { return std::pair{orders[i].cycles, orders[i].bytes}; };
  return orders[cost(1) < cost(0) ? 1 : 0].order;
}

std::vector<Saving> measure_savings(const Scene& scene, const Hardware& hardware, const Stalls& stalls,
                                    std::uint64_t cycles, const std::function<void(double)>& progress) {
  constexpr std::array kSwitches{std::pair{"hiz.bits", "tiles_hiz"}, std::pair{"walk.reject", "tiles_outside"},
                                 std::pair{"clear.fast", "fast_clear"}};
  std::vector<Saving> savings;
  for (std::size_t i = 0; i < kSwitches.size(); ++i) {
    const auto& [key, name] = kSwitches[i];
    Hardware changed = hardware;
    if (value_of(changed, key) == "0") continue;
    change(changed, key, "0");
    savings.push_back(
        {name, static_cast<std::int64_t>(cycles_of(scene, changed, stalls, progress, i, kSwitches.size())) -
                   static_cast<std::int64_t>(cycles)});
  }
  return savings;
}

}  // namespace halfplane
