// The memory behind the RTL's memory port: one request a cycle, answers in order after a fixed latency.
#pragma once

#include <cstdint>

#include "model/engines/hardware.hpp"
#include "sim/cosim/packet_words.hpp"

namespace halfplane {

class MemoryModel {
 public:
  /// `latency`: cycles from the acceptance of a read to the first in which its answer is offered, at least 1.
  MemoryModel(const Config& config, const Widths& widths, int latency)
      : widths_(widths), latency_(latency), tiles_(config), answers_(words_of(packet_bits<MemoryResponse>(widths))) {}

  void accept(const std::uint32_t* words, std::uint64_t cycle) {
    const auto request = unpack_words<MemoryRequest>(words, widths_);
    const bool is_inside =  // a faulty design may ask for what is not there: nothing is kept of it
        request.tile_x < tiles_.tiles_x() && request.tile_y < tiles_.tiles_y() && request.stamp < tiles_.stamps();
    if (request.is_write != 0) {
      if (!is_inside) return;
      tiles_.write(request.is_color != 0, request.tile_x, request.tile_y, request.stamp, request.data);
      return;
    }
    MemoryResponse response;
    if (is_inside) tiles_.read(request.is_color != 0, request.tile_x, request.tile_y, request.stamp, response.data);
    pack_words(response, widths_, answers_.push(static_cast<std::uint32_t>(cycle)));
  }

  /// The answer that is due in this cycle, or null.
  [[nodiscard]] const std::uint32_t* due(std::uint64_t cycle) const {
    if (answers_.empty()) return nullptr;
    const std::uint32_t waited = static_cast<std::uint32_t>(cycle) - answers_.front_tag();  // modulo 2^32
    return waited >= static_cast<std::uint32_t>(latency_) ? answers_.front() : nullptr;
  }
  void pop() { answers_.pop(); }
  [[nodiscard]] bool is_idle() const { return answers_.empty(); }
  [[nodiscard]] const TileMemory& tiles() const { return tiles_; }

 private:
  const Widths& widths_;
  int latency_;
  TileMemory tiles_;
  PacketQueue answers_;
};

}  // namespace halfplane
