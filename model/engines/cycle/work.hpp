// Input of the timing besides the bits: how long an item takes in each stage, and why.
#pragma once

#include <algorithm>
#include <cstdint>

#include "../../config.hpp"
#include "../../timing/stalls.hpp"
#include "../../widths.hpp"

namespace halfplane {

/// From a visit's retirement until another one may start in its place: written, looked up, and seen (hiz.sv).
inline constexpr int kVisitIsSeen = 3;

/// Cycles of the pipelined stages that are the same in every configuration.
struct PipelinedCycles {
  static constexpr int cull_sort = 4, cull_decide = 4;  ///< the two parts of cull: from a primitive in to its hand-over
  static constexpr int cull_state = 1;                  ///< the same for a state, where states have a lane
  /// coarse_raster: from a setup to the walk at its first tile, a cycle from its offer.
  static constexpr Cycle walk_begins = 2;
  /// With HiZ bounds, cycles after each visit: the next tile's bound is read, and compared.
  static constexpr Cycle read_again = 2;
  static constexpr Cycle clear_ends = 1;       ///< after the clear of bounds
  static constexpr int interpolate_steps = 6;  ///< each holds one stamp, the last but one is the FIFO
};

/// A primitive on its way through cull and triangle_setup.
struct PrimitiveWork {
  bool is_triangle = false, is_line = false, is_counted = false;
  bool is_state = false;     ///< a token that sets a register
  bool is_dropped = false;   ///< by cull
  bool is_negative = false;  ///< the signed area, with the vertices as sorted by cull_serial
  int log2_area = 0;         ///< ceil(log2 of twice the area); 0 for other kinds
};

/// A visit of one tile in fine_raster.
struct TileVisitWork {
  bool ends_primitive = false;
  int first_row = 0, last_row = 0, first_column = 0, last_column = 0;  ///< of stamps, in the box
};

/// The phases of the pipelined triangle_setup, a cycle each, and its parts, with a triangle each.
struct SetupCycles {
  int part;                          ///< phases of a part: the clocks of all planes
  int parts;                         ///< without the last, from which the setup is on offer
  int last;                          ///< from entering the last part to the offer
  int latency;                       ///< from the triangle in to the offer
  bool has_state_lane;               ///< states bypass the phases; states and triangles join in one more register
  static constexpr int kStates = 8;  ///< states that wait there
  SetupCycles(const Config& config, const Widths& widths, int divide_bits)
      : part(widths.planes * config.setup_plane_clocks), has_state_lane(halfplane::has_state_lane(widths)) {
    const int divide = (widths.reciprocal.bits + divide_bits) / divide_bits;  // one bit more, for the rounding
    // Highest bit, quotient; rounding, product, shift, move; then the values of all planes.
    const int offer = 1 + divide + 4 + part;
    parts = offer / part;
    last = offer % part + 1;
    latency = offer + (has_state_lane ? 2 : 1);
  }
};

/// Cycles of the serial stages: bit-serial products, so they follow from widths.
struct SerialCycles {
  static constexpr Cycle sort = 6, box = 5;    ///< cycles of cull
  static constexpr Cycle turn = 4;             ///< cycles of coarse_raster: the edges rotate once
  static constexpr int interpolate_steps = 2;  ///< each holds one stamp
  int product;                                 ///< of one cross product in cull

  explicit SerialCycles(const Widths& widths)
      : product(std::max(widths.area.bits, widths.grid_bits + widths.edge_value.bits - 1) + 2), widths_(widths) {}

  /// From the triangle's arrival to the offer of its setup.
  [[nodiscard]] Cycle setup(int log2_area) const {
    const int delta = widths_.delta.bits, fraction = widths_.plane_fraction, kept = widths_.reciprocal.bits;
    const int lead = std::max(fraction + 3 - kept, 0);
    const int dropped = lead - fraction - 2 + log2_area + kept;  // bits of a product below the gradient's bits
    int chain = 0, gradient = 0;                                 // cycles of one pass over all planes
    for (std::size_t p = 0; p < static_cast<std::size_t>(widths_.planes); ++p) {
      const int bits = widths_.of_plane(p).plane.bits;
      chain += bits;
      gradient += lead < 2 ? dropped + bits : std::max(dropped + bits, bits + lead + 1);
    }
    // SUBTRACT; for y and x FIRST, TURN_A, SECOND, GRADIENT; between them TURN_B; TURN_C, VALUE_X, TURN_D, VALUE_Y
    return static_cast<Cycle>(8 * delta + 2 * (2 * chain + 2 * delta + gradient) + 2 * delta + 5 * delta + 4 * delta +
                              2 * chain);
  }

 private:
  Widths widths_;
};

}  // namespace halfplane
