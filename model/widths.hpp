// Every intermediate of the pipeline: its range by interval arithmetic from the configuration, and the bits it needs.
//
// No width is written anywhere else. C++ checks its lanes against these, raster_pkg.sv and the table of `halfplane
// config --widths` are printed from them, and a configuration whose widths do not fit is refused by validate().
#pragma once

#include <array>
#include <string>
#include <vector>

#include "attributes.hpp"
#include "config.hpp"
#include "fixed.hpp"
#include "samples.hpp"

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

/// One intermediate: its name, the reason for its bound, and its number of bits.
struct Width {
  std::string name;   ///< "edge value"; also the base of its constant in raster_pkg.sv: EDGE_VALUE_BITS
  std::string bound;  ///< the formula of `range`, in the symbols of docs/spec.md
  Interval range;     ///< all its values; for a modular quantity, the residues
  int bits = 0;
  bool is_signed = false;
  bool is_modular = false;  ///< kept modulo 2^bits; only its final value is decoded
};

/// Widths of each plane of an attribute.
struct AttributeWidths {
  Width code, delta, numerator, reciprocal, product, plane, local;
  Width step;               ///< step of a local plane; with several samples s bits more, whose upper bits d uses
  Width fragment;           ///< its value in a fragment: the code, or without a clamp the local value
  Width line, affine_code;  ///< along a line, and a clamped code; no bits if the attribute has none

  /// r: significant bits of the reciprocal.
  [[nodiscard]] int reciprocal_bits() const { return reciprocal.bits - 1; }
  /// l: fraction bits of a local plane.
  [[nodiscard]] int guard_bits() const { return local.bits - code.bits - 1; }
};

/// The content of a cache line: 4x4 pixels of a tile, or a stamp if that is larger; with cache.kind tiles a tile. Powers
/// of two, so that a place needs shifts.
struct BlockGrid {
  int side = 1;      ///< stamps along the side of a block
  int per_tile = 1;  ///< blocks along the side of a tile
  int side_log2 = 0, per_tile_log2 = 0;
  int flag_word = 1;  ///< flags in a word: of blocks in one row; a power of two

  [[nodiscard]] constexpr int stamps() const { return side * side; }  ///< of a block
  bool operator==(const BlockGrid&) const = default;
};

/// Layout of stamps and flags in memory, as logarithms of bytes; the host's choices are in MemoryLayout (packets.hpp).
struct MemoryGrid {
  int port = 0;                                         ///< a beat
  std::array<int, 2> sample{};                          ///< a sample of depth, of colour
  std::array<int, 2> stamp{};                           ///< a stamp
  int pixel_color = 0;                                  ///< its colours, one per pixel
  int flag_word = 0;                                    ///< a word of flags
  int plane = 0;                                        ///< a buffer of a tile
  int flag_row = 0;                                     ///< from the flags of one row of blocks to the next
  [[nodiscard]] int tile() const { return plane + 1; }  ///< from one tile of a row to the next: both buffers
};

/// The place of a code in the value of a local plane, modulo a power of two: its bits from `shift` on, less `offset`. In a
/// fragment planes over w keep the whole value.
struct CodePlace {
  int shift = 0;
  std::uint32_t offset = 0, mask = 0;
};

/// A primitive of at most so many tiles in x and in y is never tested against HiZ bounds.
inline constexpr int kHizUntestedTiles = 2;

/// The derived widths of a configuration, and a few derived constants.
struct Widths {
  // In widths.cpp: a hundred strings, inline they were a tenth of the library's code.
  Widths();
  Widths(const Widths&);
  Widths(Widths&&) noexcept;
  Widths& operator=(const Widths&);
  Widths& operator=(Widths&&) noexcept;
  ~Widths();

  // Constants.
  int grid_bits = 0;       ///< s, see coordinate_grid_bits()
  int guard_bits = 0;      ///< G: fraction bits of a gradient per pixel below one LSB
  int plane_fraction = 0;  ///< F = G + s: fraction bits of a plane at subpixel resolution
  int tile_shift = 0;      ///< log2 of the tile size
  StampGrid stamps;        ///< the stamps of a tile, the samples of a stamp
  BlockGrid blocks;        ///< content of a cache line
  MemoryGrid memory;
  int port_bytes = 0;                    ///< of a beat on the memory port
  int planes = 0;                        ///< planes of all attributes together
  int affine_planes = 0;                 ///< depth and colour, which come first
  int alpha_counters = 0;                ///< 1: the alpha test counts
  int texture_counters = 0;              ///< 1: likewise with a texture unit
  int fog_octaves = 0;                   ///< 1: triangles carry their octave in the table of a fog
  int stencil_flags = 0;                 ///< 1: there is a stencil, and primitives carry flags for it
  int coordinates = 0;                   ///< of a texture: 2 with a texture unit, else 0
  std::size_t q_plane = 0;               ///< with a texture unit: plane of 1/w; u and v follow, and colours over w
  int colors_over_w = 0;                 ///< number of colours over w
  int has_colors_over_w = 0;             ///< 1: there are some
  int normals = 0;                       ///< planes of normals over w; instead of colours
  int color_planes = 0;                  ///< planes of the stored colour: kColorPlane and the next ones
  int samples = 0;                       ///< samples of a stamp
  int tiles_x = 0, tiles_y = 0;          ///< tiles along the sides of the widest and highest target
  int line_x_bits = 0, line_y_bits = 0;  ///< low bits of a tile's or block's x and y that choose its cache line
  int hiz_group_bits = 0;                ///< HiZ bounds of 2^n tiles of a row are cleared at once
  int line_guard_bits = 0;               ///< fraction bits of depth and colour along a line

  // Samples of a pixel.
  int pixel_samples = 1;
  int pixels = 1;           ///< of a stamp
  int has_samples = 0;      ///< 1: several samples per pixel
  int edge_lows = 0;        ///< 3 then: for each edge the bits dropped by edge_function()
  int further_samples = 0;  ///< samples of a stamp, without the first of each pixel
  int memory_colors = 0;    ///< of a stamp in memory: one per sample, or per pixel if the chip stores the mean
  std::array<SampleOffset, kMaxPixelSamples> sample_offset{};  ///< of each, from the pixel's centre, 2^-s pixel

  // Coverage.
  Width coordinate, delta, edge_product, area, edge_value, edge_step, tile_edge, sample_edge;
  // Planes, by attribute.
  AttributeList attributes;
  std::array<AttributeWidths, kMaxAttributes> attribute;
  PerPlane<std::uint8_t> attribute_of{};  ///< index of each plane's attribute
  PerPlane<CodePlace> code_place{};
  PerPlane<std::uint64_t> line_mask{};  ///< all ones in AttributeWidths::line
  Width reciprocal, reciprocal_shift;   ///< the widest; the others are its upper bits
  // Keys and positions.
  Width primitive_id, slot, tile_x, tile_y, tile_pixel, stamp_index, sample_mask, stored_color, stored_depth;
  Width edge_low, pixel_mask, masked_samples, further_depth;  // with several samples per pixel
  Width kind, flag, depth_func, cull_mode, pixel_x, pixel_y, vertex_color, hiz_code, hiz_update, tile_plane,
      depth_source, memory_lane, counter;
  // The memory port.
  Width coordinate_shift, coordinate_reach, coordinate_reference;  // of the texture unit
  Width fog_octave;
  Width color_shift, color_reach;  // likewise, of colours over w
  Width written_color, shaded_color, texture_byte, texture_beats;
  int texture_port_bytes = 0;  ///< of a beat of the texture unit's port
  Width run, address, row_stride, burst_length, port_strobe, port_byte;
  // Lines.
  Width line_numerator, line_position, line_product;   // line_setup
  Width line_error, line_stay, line_move, line_count;  // registers and steps of line_raster, without planes

  /// r of the widest reciprocal.
  [[nodiscard]] int reciprocal_bits() const { return reciprocal.bits - 1; }
  [[nodiscard]] const AttributeWidths& of_plane(std::size_t p) const { return attribute[attribute_of[p]]; }
  [[nodiscard]] const AttributeWidths& depth() const { return of_plane(kDepthPlane); }
  [[nodiscard]] const AttributeWidths& color() const { return of_plane(kColorPlane); }
  /// The first colour over w, or the first normal, and the number of planes before it, over which a token's value is
  /// spread.
  [[nodiscard]] std::size_t color_over_w_plane() const { return static_cast<std::size_t>(token_planes()); }
  [[nodiscard]] std::size_t normal_plane() const { return static_cast<std::size_t>(token_planes()); }
  [[nodiscard]] int token_planes() const { return planes - colors_over_w - normals; }
  /// "depth", "red", ...
  [[nodiscard]] std::string_view plane_name(std::size_t p) const;

  /// All widths, in readable order: coverage, planes, keys, lines. For tables and for raster_pkg.sv.
  [[nodiscard]] std::vector<const Width*> all() const&;
  std::vector<const Width*> all() const&& = delete;  // the pointers would outlive the widths
};

/// A value that a triangle brings a unit in the stream of stamps.
struct UnitValue {
  Width Widths::*width;
  int Widths::*count;  ///< of a triangle: as many as there are units
  int Config::*units;
  const char *name, *bound;
  Interval range;
};
inline constexpr std::array kUnitValues{UnitValue{&Widths::fog_octave,
                                                  &Widths::fog_octaves,
                                                  &Config::fog_units,
                                                  "fog octave",
                                                  "of a table of 16 at most, that of Q = 1; held, for Q < 2^32",
                                                  {-32, 31}}};

/// Whether states bypass the setup of triangles: where a texture unit's planes make setup long, and states frequent.
[[nodiscard]] inline bool has_state_lane(const Widths& widths) { return widths.coordinates != 0; }

/// The widest of the attributes: the width of one datapath for all planes.
[[nodiscard]] const Width& widest(const Widths& widths, Width AttributeWidths::*width);

/// Derives every width. Precondition: every value within the range of its setting; validate() checks whether the widths
/// fit.
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

/// Bound of the distance of a rounded edge from the true one inside the target, in pixels: at most half a subpixel.
[[nodiscard]] double homogeneous_edge_bound(const Config& config);

/// The largest depth error, in LSB, against the exact plane through the snapped vertices. validate() refuses above 1.
[[nodiscard]] double depth_error_bound(const Config& config);

/// The same along a line, against the exact value at the pixel's major coordinate. Without the 1/2 of storage it is
/// below 1/2 in every legal configuration, so no code ever leaves the range of the two ends, and no clamp is needed.
[[nodiscard]] double line_depth_error_bound(const Config& config);

}  // namespace halfplane
