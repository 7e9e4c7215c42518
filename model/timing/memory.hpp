// Memory timing: when the memory behind the chip takes a request, and when it answers a read. No data. The harness puts
// the same object behind the RTL's memory port, so both see one memory.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "../widths.hpp"
#include "stalls.hpp"

namespace halfplane {

/// One stamp of one plane of one tile.
struct MemoryAccess {
  bool is_write = false, is_color = false;
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

/// An ideal port. `latency`: cycles, at least 1.
class FixedMemory final : public MemoryTiming {
 public:
  explicit FixedMemory(int latency) : latency_(static_cast<Cycle>(latency)) {}
  [[nodiscard]] Cycle room() const override { return 0; }
  Cycle accept(const MemoryAccess&, Cycle cycle) override { return cycle + latency_; }
  [[nodiscard]] Cycle fixed_latency() const override { return latency_; }

 private:
  Cycle latency_;
};

}  // namespace halfplane
