// What the cycle model shows of a run: when items cross the arrows of the pipeline, and what keeps them.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "../../pipeline_graph.hpp"
#include "../../timing/stalls.hpp"

namespace halfplane {

/// Why a plane of a tile moves between chip and memory.
enum class MoveCause : std::uint8_t {
  fill,   ///< a tile is needed
  evict,  ///< its line is needed, or the flush wants it
  clear   ///< the flush writes the clear value of a tile that was never brought in again
};
inline constexpr std::array<std::string_view, 3> kMoveCauses{"fill", "evict", "clear"};

struct HostPrimitive;

/// Sees every item as it crosses a boundary (kBoundaries): those of one in order, different ones as the work happens.
struct TransferSink {
  virtual ~TransferSink() = default;
  virtual void transfer(Arrow boundary, Cycle cycle) = 0;
  /// What crosses from now on belongs to this primitive.
  virtual void primitive(const HostPrimitive&) {}
  /// The next tile, and what crosses from now on behind it, belongs to this visit.
  virtual void visit(int /*tile_x*/, int /*tile_y*/) {}
  /// A plane moved: from the first request to the cycle behind the last request or answer.
  virtual void move(MoveCause, bool /*is_color*/, int /*tile_x*/, int /*tile_y*/, Cycle /*from*/, Cycle /*to*/) {}
  /// depth_test waited while the framebuffer brought in a tile, marked or looked at tiles: [from, to).
  virtual void wait(Cycle /*from*/, Cycle /*to*/) {}
};

}  // namespace halfplane
