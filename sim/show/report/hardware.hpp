// The hardware that `render --engine cycle` simulates, and its settings by name, which --what-if varies.
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

/// Changes one setting: a key of the configuration, of the timing parameters, or memory, memory.latency, mhz. Throws
/// InputError for an unknown key or a value outside its range.
void change(Hardware& hardware, std::string_view key, std::string_view value);

/// The value of one setting that change() takes.
[[nodiscard]] std::string value_of(const Hardware& hardware, std::string_view key);

/// validate(), and refuses parameters that this kind of hardware does not have. Throws InputError.
void check(const Hardware& hardware);

/// Renders with a memory of its own.
[[nodiscard]] CycleRendering run_cycles(const Scene& scene, const Hardware& hardware, const RenderOptions& render = {},
                                        CycleOptions options = {});

/// One stage over a run, in cycles.
struct StageTime {
  std::string_view name;
  StreamUse use;              ///< of its output, as `render --engine rtl` has it
  std::uint64_t works = 0;    ///< its narrowest part was at work
  std::uint64_t no_item = 0;  ///< it neither worked nor waited to go on
  struct Wait {
    std::string_view reason;
    std::uint64_t cycles;
  };
  std::vector<Wait> waits;  ///< to go on, by what it waited for; none with 0 cycles
};

/// In the order of the pipeline.
[[nodiscard]] std::vector<StageTime> stage_times(const CycleRun& run);

/// Bytes between chip and memory, by cause and plane.
struct Traffic {
  std::array<std::array<std::uint64_t, 2>, kMoveCauses.size()> bytes{};  ///< [MoveCause][depth, colour]
  std::uint64_t texels = 0;                                              ///< read by a texture unit
  [[nodiscard]] std::uint64_t total() const;
};
[[nodiscard]] Traffic traffic(const CycleRun& run, const Config& config);

/// A change, and what it did to the cycles of a frame.
struct Trial {
  std::string key, value;
  std::uint64_t cycles = 0;
};

/// Tries what might relieve the hardware, best first; those that change nothing are left out. Here and below `progress` may
/// be empty, and may end the work by throwing.
[[nodiscard]] std::vector<Trial> try_reliefs(const Scene& scene, const Hardware& hardware, const Stalls& stalls,
                                             std::uint64_t cycles, const std::function<void(double)>& progress);

/// A frame in one order of its primitives: frame.order and frame.store.
struct OrderTrial {
  std::string order, store;
  std::uint64_t cycles = 0, bytes = 0;
};

/// Program order and bins, both with what `hardware` stores; where that is all, also bins that store colour alone. None for
/// a cache of tiles.
[[nodiscard]] std::vector<OrderTrial> try_orders(const Scene& scene, const Hardware& hardware, const Stalls& stalls,
                                                 const std::function<void(double)>& progress);

/// Of the first two of these the one with fewer cycles; if they are equal, with fewer bytes.
[[nodiscard]] const std::string& recommended(const std::vector<OrderTrial>& orders);

/// A thing that hardware skips, and the cycles more that a frame takes when it does not. Negative: finding out costs more.
struct Saving {
  std::string_view name;  ///< "tiles_hiz", "tiles_outside", "fast_clear"
  std::int64_t cycles;
};
[[nodiscard]] std::vector<Saving> measure_savings(const Scene& scene, const Hardware& hardware, const Stalls& stalls,
                                                  std::uint64_t cycles, const std::function<void(double)>& progress);

}  // namespace halfplane
