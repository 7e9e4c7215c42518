// The hardware simulated by `render --engine cycle`, and its settings by name, varied by --what-if.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "model/engines/cycle/cycle_model.hpp"

namespace halfplane {

struct Hardware {
  Config config;
  TimingParameters parameters;
  MemorySettings memory;
};

/// Keys of change() that are no settings of the configuration or the timing.
inline constexpr std::array<std::string_view, 7> kMemoryKeys{"memory", "memory.latency", "memory.width", "memory.mhz",
                                                             "mhz",    "scan_out",       "other_traffic"};
inline constexpr int kMaxScanOutHz = 1000, kMaxOtherBytes = 2'000'000'000;  ///< pictures, bytes a second

/// Changes one setting: a key of the configuration, of the timing parameters, or of the memory. Throws InputError for
/// an unknown key or a value outside its range.
void change(Hardware& hardware, std::string_view key, std::string_view value);

/// The value of one setting of change().
[[nodiscard]] std::string value_of(const Hardware& hardware, std::string_view key);

/// validate(), and refuses parameters unsupported by this kind of hardware. Throws InputError.
void check(const Hardware& hardware);

/// Renders with its own memory.
[[nodiscard]] CycleRendering run_cycles(const Scene& scene, const Hardware& hardware, const RenderOptions& render = {},
                                        CycleOptions options = {});

/// One stage over a run, in cycles.
struct StageTime {
  std::string_view name;
  StreamUse use;              ///< of its output, as in `render --engine rtl`
  std::uint64_t works = 0;    ///< its narrowest part was at work
  std::uint64_t no_item = 0;  ///< it neither worked nor waited for the next stage
  struct Wait {
    std::string_view reason;
    std::uint64_t cycles;
  };
  std::vector<Wait> waits;  ///< for the next stage, by cause; entries with 0 cycles are left out
};

/// In the order of the pipeline.
[[nodiscard]] std::vector<StageTime> stage_times(const CycleRun& run);

/// Bytes between chip and memory, by cause and buffer.
struct Traffic {
  std::array<std::array<std::uint64_t, 2>, kMoveCauses.size()> bytes{};  ///< [MoveCause][depth, colour]
  std::uint64_t texels = 0;                                              ///< read by a texture unit
  [[nodiscard]] std::uint64_t total() const;
};
[[nodiscard]] Traffic traffic(const CycleRun& run, const Config& config);

/// A change, and its effect on the cycles of a frame.
struct Trial {
  std::string key, value;
  std::uint64_t cycles = 0;
};

/// Tries changes that might relieve the hardware, best first; ineffective ones are left out. Here and below `progress`
/// may be empty, and may end the work by throwing.
[[nodiscard]] std::vector<Trial> try_reliefs(const Scene& scene, const Hardware& hardware, const Stalls& stalls,
                                             std::uint64_t cycles, const std::function<void(double)>& progress);

/// A frame in one order of its primitives: frame.order and frame.store.
struct OrderTrial {
  std::string order, store;
  std::uint64_t cycles = 0, bytes = 0;
};

/// Program order and bins, both with the buffers that `hardware` stores; if these are all, also bins that store only
/// colour. None for a cache of tiles.
[[nodiscard]] std::vector<OrderTrial> try_orders(const Scene& scene, const Hardware& hardware, const Stalls& stalls,
                                                 const std::function<void(double)>& progress);

/// The run with fewer cycles of the first two; if equal, with fewer bytes.
[[nodiscard]] const std::string& recommended(const std::vector<OrderTrial>& orders);

/// Work that hardware skips, and the additional cycles of a frame without skipping. Negative: the test costs more.
struct Saving {
  std::string_view name;  ///< "tiles_hiz", "tiles_outside", "fast_clear"
  std::int64_t cycles;
};
[[nodiscard]] std::vector<Saving> measure_savings(const Scene& scene, const Hardware& hardware, const Stalls& stalls,
                                                  std::uint64_t cycles, const std::function<void(double)>& progress);

}  // namespace halfplane
