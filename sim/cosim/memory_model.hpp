// The memory behind the RTL's memory port: the data, and the time of a MemoryTiming.
#pragma once

#include <cstdint>

#include "model/engines/hardware.hpp"
#include "model/timing/memory.hpp"
#include "sim/cosim/packet_queue.hpp"

namespace halfplane {

class MemoryModel {
 public:
  MemoryModel(const Config& config, const Widths& widths, const MemorySettings& settings)
      : widths_(widths),
        tiles_(config),
        timing_(make_memory(settings, config)),
        answers_(words_of(packet_bits<MemoryResponse>(widths))) {}

  /// Whether a request can be taken in this cycle.
  [[nodiscard]] bool is_ready(std::uint64_t cycle) const { return timing_->room() <= cycle; }

  void accept(const std::uint32_t* words, std::uint64_t cycle) {
    const auto request = unpack_words<MemoryRequest>(words, widths_);
    const bool is_inside = tiles_.has(request);  // a faulty design may ask for what is not there: nothing is kept of it
    const Cycle due =
        timing_->accept({request.is_write, request.plane, request.tile_x, request.tile_y, request.stamp}, cycle);
    if (request.is_write) {
      if (is_inside) tiles_.write(request);
      return;
    }
    MemoryResponse response;
    if (is_inside)
      tiles_.read(request.plane == TilePlane::color, request.tile_x, request.tile_y, request.stamp, response.data);
    pack_words(response, widths_, answers_.push(static_cast<std::uint32_t>(due)));
  }

  /// The answer that is due in this cycle, or null.
  [[nodiscard]] const std::uint32_t* due(std::uint64_t cycle) const {
    if (answers_.empty()) return nullptr;
    const std::uint32_t late = static_cast<std::uint32_t>(cycle) - answers_.front_tag();  // modulo 2^32
    return late < 1U << 31 ? answers_.front() : nullptr;
  }
  void pop() { answers_.pop(); }
  [[nodiscard]] bool is_idle() const { return answers_.empty(); }
  [[nodiscard]] const TileMemory& tiles() const { return tiles_; }
  [[nodiscard]] TileMemory& tiles() { return tiles_; }

 private:
  const Widths& widths_;
  TileMemory tiles_;
  std::unique_ptr<MemoryTiming> timing_;
  PacketQueue answers_;
};

}  // namespace halfplane
