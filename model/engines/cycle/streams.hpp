// A run of the cycle model as seen from outside: when items cross the arrows of the pipeline, and the causes of stalls.
#pragma once

#include "../../pipeline_graph.hpp"
#include "../../timing/stalls.hpp"
#include "timing_totals.hpp"

namespace halfplane {

struct HostPrimitive;

/// Sees every item as it crosses a boundary (kBoundaries): the items of one boundary in order, boundaries interleaved
/// as the work happens.
struct TransferSink {
  virtual ~TransferSink() = default;
  virtual void transfer(Arrow boundary, Cycle cycle) = 0;
  /// Later crossings belong to this primitive.
  virtual void primitive(const HostPrimitive&) {}
  /// The next tile, and later crossings downstream of it, belong to this visit.
  virtual void visit(int /*tile_x*/, int /*tile_y*/) {}
  /// A buffer of a tile moved: from the first request to the cycle after the last request or answer.
  virtual void move(MoveCause, bool /*is_color*/, int /*tile_x*/, int /*tile_y*/, Cycle /*from*/, Cycle /*to*/) {}
  /// depth_test waited while the framebuffer brought in a tile, marked or looked at tiles: [from, to).
  virtual void wait(Cycle /*from*/, Cycle /*to*/) {}
};

}  // namespace halfplane
