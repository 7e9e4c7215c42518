// The boundaries between the stages at which the cycle model and the RTL are compared.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "../../timing/stalls.hpp"

namespace halfplane {

/// The streams that can be stalled. All but the last are the bits of raster_top's stall_i, the last is the memory's own.
enum StallStream : int {
  stall_primitive,
  stall_triangle,
  stall_setup,
  stall_tile,
  stall_stamp,
  stall_fragment,
  stall_request,
  stall_response,
  stall_line,
  stall_line_pixel,
  stall_memory,  ///< the memory takes no request
};
inline constexpr int kStallStreams = stall_memory + 1;

/// Where an item crosses from one stage to the next. In the order of the pipeline.
enum class Boundary : std::uint8_t {
  primitive,   ///< host -> cull
  line,        ///< host -> line_raster
  triangle,    ///< cull -> triangle_setup
  setup,       ///< triangle_setup -> coarse_raster, and the context RAM
  tile,        ///< coarse_raster -> fine_raster
  stamp,       ///< fine_raster -> interpolate
  line_pixel,  ///< line_raster -> primitive_join
  fragment,    ///< interpolate, primitive_join -> depth_test
  write,       ///< depth_test, rop -> framebuffer
  retire,      ///< depth_test -> coarse_raster
  request,     ///< framebuffer -> memory
  response     ///< memory -> framebuffer
};
inline constexpr std::size_t kBoundaries = 12;
inline constexpr std::array<std::string_view, kBoundaries> kBoundaryNames{
    "primitive",  "line",     "triangle", "setup",  "tile",    "stamp",
    "line_pixel", "fragment", "write",    "retire", "request", "response"};

/// The stage that sends across each of them.
inline constexpr std::array<std::string_view, kBoundaries> kBoundarySenders{
    "host",        "host",        "cull",       "triangle_setup", "coarse_raster", "fine_raster",
    "line_raster", "interpolate", "depth_test", "depth_test",     "framebuffer",   "memory"};

/// The stages that share the work. primitive_join, depth_test and rop add no cycles of their own.
enum class TimedStage : std::uint8_t {
  cull,
  triangle_setup,
  coarse_raster,
  fine_raster,
  line_raster,
  interpolate,
  framebuffer
};
inline constexpr std::size_t kTimedStages = 7;

/// Why a plane of a tile moves between chip and memory.
enum class MoveCause : std::uint8_t {
  fill,   ///< a tile is needed
  evict,  ///< its line is needed, or the flush wants it
  clear   ///< the flush writes the clear value of a tile that was never brought in again
};
inline constexpr std::array<std::string_view, 3> kMoveCauses{"fill", "evict", "clear"};

struct HostPrimitive;

/// Sees every item as it crosses a boundary: those of one boundary in order, different ones as the work happens.
struct TransferSink {
  virtual ~TransferSink() = default;
  virtual void transfer(Boundary boundary, Cycle cycle) = 0;
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
