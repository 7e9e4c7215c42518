// Every intermediate of the pipeline: its range by interval arithmetic from the configuration, and the bits it needs.
//
// No width is typed in anywhere else. C++ checks its lanes against these, raster_pkg.sv and the table of `halfplane config
// --widths` are printed from them, and a configuration whose widths do not fit is refused by validate().
#pragma once

#include <string_view>
#include <vector>

#include "config.hpp"
#include "fixed.hpp"

namespace halfplane {

/// A closed range of integers.
struct Interval {
  int128 lo = 0, hi = 0;

  [[nodiscard]] friend constexpr Interval operator+(Interval a, Interval b) { return {a.lo + b.lo, a.hi + b.hi}; }
  [[nodiscard]] friend constexpr Interval operator-(Interval a, Interval b) { return {a.lo - b.hi, a.hi - b.lo}; }
  [[nodiscard]] friend constexpr Interval operator*(Interval a, Interval b) {
    const int128 p[4] = {a.lo * b.lo, a.lo * b.hi, a.hi * b.lo, a.hi * b.hi};
    Interval r{p[0], p[0]};
    for (const int128 q : p) r = {q < r.lo ? q : r.lo, q > r.hi ? q : r.hi};
    return r;
  }
  [[nodiscard]] friend constexpr Interval operator>>(Interval a, int bits) { return {a.lo >> bits, a.hi >> bits}; }
};

/// [-magnitude, magnitude].
[[nodiscard]] constexpr Interval symmetric(int128 magnitude) { return {-magnitude, magnitude}; }

/// One intermediate: what it is called, why it is no larger, and how many bits hold it.
struct Width {
  std::string_view name;   ///< "edge value"; also the base of its constant in raster_pkg.sv: EDGE_VALUE_BITS
  std::string_view bound;  ///< the formula behind `range`, in the symbols of docs/spec.md
  Interval range;          ///< every value it takes; for a modular quantity, the residues
  int bits = 0;
  bool is_signed = false;
  bool is_modular = false;  ///< lives modulo 2^bits; only its final value is decoded
};

/// The derived widths of a configuration, and the few derived constants beside them.
struct Widths {
  // Constants.
  int grid_bits = 0;       ///< s = max(S, 1): at S = 0 coordinates are doubled, so that pixel centres are integers
  int guard_bits = 0;      ///< G: fraction bits of a gradient per pixel below one LSB
  int plane_fraction = 0;  ///< F = G + s: fraction bits of a plane at subpixel resolution
  int tile_shift = 0;      ///< log2 of the tile size
  int stamps_per_row = 0;  ///< stamps along the side of a tile
  int color_channels = 0;  ///< channels that the colour format stores: 3 or 4
  int samples = 0;         ///< samples of a stamp
  int tiles_x = 0, tiles_y = 0;          ///< tiles along the sides of the widest and highest target
  int line_x_bits = 0, line_y_bits = 0;  ///< low bits of a tile's x and y that choose its cache line
  int line_guard_bits = 0;               ///< fraction bits of depth and colour along a line

  // Coverage.
  Width coordinate, delta, edge_product, area, edge_value, edge_step, tile_edge, sample_edge;
  // Planes.
  Width depth_code, depth_delta, depth_numerator, color_code, color_numerator;
  Width reciprocal, reciprocal_shift, depth_product, color_product;
  Width depth_plane, color_plane, local_depth, local_color;
  // Keys and positions.
  Width primitive_id, slot, tile_x, tile_y, tile_pixel, stamp_index, sample_mask, stored_color;
  Width kind, flag, depth_func, cull_mode, pixel_x, pixel_y, vertex_color, hiz_code, hiz_update, memory_lane, counter;
  // Lines.
  Width line_numerator, line_position, line_product;                           // line_setup
  Width line_error, line_stay, line_move, line_count, line_depth, line_color;  // registers and steps of line_raster

  /// All of them, in the order above: for tables and for raster_pkg.sv.
  [[nodiscard]] std::vector<const Width*> all() const&;
  std::vector<const Width*> all() const&& = delete;  // the pointers would outlive the widths
};

/// Derives every width. Precondition: every value within the range of its setting; whether the widths fit is validate()'s to say.
[[nodiscard]] Widths derive_widths(const Config& config);

/// Widths of the scalar engine's path without clipping (stages/homogeneous_setup). No hardware has them.
struct HomogeneousWidths {
  int fraction = 0;                       ///< m: the larger of |a|, |b| of an edge lies in [2^(m-1), 2^m]
  int weight_scale = 0;                   ///< P: the weights of a perspective colour are scaled to at most 2^P
  Width coefficient, offset, edge_value;  // edges, near and far
  Width weight_step, weight, color_step, color_weight;  // perspective colour

  [[nodiscard]] std::vector<const Width*> all() const&;
  std::vector<const Width*> all() const&& = delete;
};
[[nodiscard]] HomogeneousWidths derive_homogeneous_widths(const Config& config);

/// The farthest that a rounded edge lies from the true one inside the target, in pixels: at most half a subpixel.
[[nodiscard]] double homogeneous_edge_bound(const Config& config);

/// The largest depth error, in LSB, against the exact plane through the snapped vertices. validate() refuses above 1.
[[nodiscard]] double depth_error_bound(const Config& config);

/// The same along a line, against the exact value at the pixel's major coordinate. Without the 1/2 of storage it is
/// below 1/2 in every legal configuration, so no code ever leaves the range of the two ends, and none is clamped.
[[nodiscard]] double line_depth_error_bound(const Config& config);

}  // namespace halfplane
