// Memory timing: the cycles in which memory accepts a request and answers a read. No data. The harness connects the same object
// to the RTL's memory port, so both see one memory. docs/memory.md gives the sources of the figures.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "../config.hpp"
#include "../enum_names.hpp"
#include "other_masters.hpp"
#include "stalls.hpp"

namespace halfplane {

/// The transfer of a burst (MemoryBeat).
struct MemoryBurst {
  bool is_write = false;
  std::uint64_t address = 0;  ///< of its first byte
  int beats = 1;
};

/// Times of the answers to a burst: beat by beat for a read, or once for a complete write.
struct BurstAnswer {
  std::uint64_t first = 0, step = 1;  ///< of the first beat, and from one beat to the next, in units
  std::uint64_t unit = 1;             ///< of a cycle
  Cycle behind = 0;                   ///< additional cycles
  [[nodiscard]] Cycle at(int beat) const {
    const std::uint64_t time = first + static_cast<std::uint64_t>(beat) * step;
    return (unit == 1 ? time : (time + unit - 1) / unit) + behind;
  }
};

/// Bursts come in order, at most a beat a cycle, and are answered in order, at most one answer a cycle.
class MemoryTiming {
 public:
  virtual ~MemoryTiming() = default;
  /// The first cycle in which the first beat of the next burst can be taken; the others are taken as they come.
  [[nodiscard]] virtual Cycle room() const = 0;
  /// The last beat of the next burst is taken in `cycle` (the only beat of a read).
  virtual BurstAnswer accept(const MemoryBurst& burst, Cycle cycle) = 0;
  /// The size of the picture that scan-out shows from now on, width and height: that of the frame that begins.
  virtual void show(int, int) {}
  /// Traffic of other masters up to the last burst.
  [[nodiscard]] virtual MemoryUse use() const { return {}; }
  /// Cycles from the last beat of a burst to its answer, in a memory with one master that always has room. None of other
  /// memories. Where it has a value, the engine may leave out room() and accept(): beats follow by one a cycle.
  [[nodiscard]] virtual std::optional<Cycle> ideal_latency() const { return std::nullopt; }
};

enum class MemoryKind : std::uint8_t {
  fixed,  ///< ideal: a request a cycle, an answer after `latency` cycles
  sram,   ///< block RAM with an output register: fixed, 2 cycles
  sdram,  ///< SDR SDRAM, 16 bits and 167 MHz unless said otherwise
  psram,  ///< quad SPI PSRAM, 84 MHz
  ddr3    ///< 16-bit DDR3-800
};
inline constexpr auto kMemoryKinds = kNamesOf<MemoryKind>;

struct MemorySettings {
  MemoryKind kind = MemoryKind::fixed;
  int latency = 8;                        ///< of `fixed`: cycles, at least 1
  int mhz = 50;                           ///< clock of the chip, MHz
  int sdram_width = 16, sdram_mhz = 167;  ///< of `sdram`: bits, and its own clock
  MemoryTraffic traffic{};                ///< of other masters
  bool operator==(const MemorySettings&) const = default;
};

inline constexpr std::array kSdramWidths{8, 16, 32, 64};
inline constexpr int kSdramMinMhz = 50, kSdramMaxMhz = 200;

/// The kind with that name, and of sdram its parameters: "sdram,width=32,mhz=133". Throws InputError.
void set_memory(MemorySettings& settings, std::string_view text);

/// Arguments of set_memory().
[[nodiscard]] std::string memory_name(const MemorySettings& settings);

/// The same memory with nothing but the hardware's port, as that of textures is.
[[nodiscard]] inline MemorySettings without_traffic(MemorySettings settings) {
  settings.traffic = {};
  return settings;
}

/// The kind with that name. Throws InputError when there is none.
[[nodiscard]] MemoryKind memory_kind(std::string_view name);

/// A memory after power-up. Each row is filled before the next bank's. Throws InputError, as its accept() may, when other
/// masters ask for more than it gives.
[[nodiscard]] std::unique_ptr<MemoryTiming> make_memory(const MemorySettings& settings, const Config& config);

}  // namespace halfplane
