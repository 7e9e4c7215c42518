// Memory timing: when the memory behind the chip takes a request, and when it answers a read. No data. The harness puts
// the same object behind the RTL's memory port, so both see one memory. docs/memory.md gives the sources of the figures.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string_view>

#include "../packets.hpp"
#include "stalls.hpp"

namespace halfplane {

/// One stamp of one plane of one tile, or a word of flags (MemoryRequest).
struct MemoryAccess {
  bool is_write = false;
  TilePlane plane = TilePlane::depth;
  int tile_x = 0, tile_y = 0, stamp = 0;
};

/// Requests come in order, at most one a cycle; reads are answered in order.
class MemoryTiming {
 public:
  virtual ~MemoryTiming() = default;
  /// The first cycle in which the next request can be taken.
  [[nodiscard]] virtual Cycle room() const = 0;
  /// Takes the next request in `cycle` >= room(). Returns the first cycle in which the answer of a read is there.
  virtual Cycle accept(const MemoryAccess& access, Cycle cycle) = 0;
  /// Answers every read so many cycles later and takes a request in every cycle; 0: it does not.
  [[nodiscard]] virtual Cycle fixed_latency() const { return 0; }
};

enum class MemoryKind : std::uint8_t {
  fixed,  ///< ideal: a request a cycle, an answer after `latency` cycles
  sram,   ///< block RAM with an output register: fixed, 2 cycles
  sdram,  ///< 16-bit SDR SDRAM, 167 MHz
  psram,  ///< quad SPI PSRAM, 84 MHz
  ddr3    ///< 16-bit DDR3-800
};
inline constexpr std::array<std::string_view, 5> kMemoryKinds{"fixed", "sram", "sdram", "psram", "ddr3"};

struct MemorySettings {
  MemoryKind kind = MemoryKind::fixed;
  int latency = 8;  ///< of `fixed`: cycles, at least 1
  int mhz = 50;     ///< clock of the chip, MHz
  bool operator==(const MemorySettings&) const = default;
};

/// The kind of that name. Throws InputError when there is none.
[[nodiscard]] MemoryKind memory_kind(std::string_view name);

/// After its power-up. Tile-major, depth before colour, each row of a memory filled before the next bank's.
[[nodiscard]] std::unique_ptr<MemoryTiming> make_memory(const MemorySettings& settings, const Config& config);

/// Bytes of one request's data: of a stamp, of a word of flags.
[[nodiscard]] int stamp_bytes(const Config& config, bool is_color);
[[nodiscard]] int flag_word_bytes(const Widths& widths);

}  // namespace halfplane
