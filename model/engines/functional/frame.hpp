// Data passed between the parts of the functional engine: slices of a draw, records of their remaining primitives, and
// for each bin of the target the list of its records.
//
//   slice   a few thousand primitives of one draw. Has its own vertices, records and bin lists: made by one thread.
//   bin     64 x 64 pixels. Drawn by one thread, slice after slice: in program order, whichever thread made the slices.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "../../host/primitives.hpp"
#include "../../stages/fragment_ops.hpp"
#include "../render.hpp"
#include "prepared_scene.hpp"

namespace halfplane::functional {

inline constexpr int kBinShift = 6, kBinSize = 1 << kBinShift;     ///< pixels along the side of a bin
inline constexpr int kTileShift = 3, kTileSize = 1 << kTileShift;  ///< the only tile size of this engine
inline constexpr int kBinTiles = kBinSize / kTileSize;             ///< tiles along the side of a bin

/// A block is sixteen lanes, one cache line; a tile is four of them.
inline constexpr int kBlockShift = 2, kBlockSize = 1 << kBlockShift, kBlockPixels = 16;
inline constexpr std::size_t kTilePixels = std::size_t{kTileSize} * kTileSize,
                             kBinPixels = std::size_t{kBinSize} * kBinSize;

/// Small triangles, which are set up sixteen at a time, lie within this many by this many tiles; medium ones may be set
/// up so.
inline constexpr int kSmallTiles = 2, kMediumTiles = 3;

/// Bits of the extent of small or medium triangles: below 2^pixel_bits pixels; 32 bits hold products of two extents.
[[nodiscard]] inline int extent_bits(int pixel_bits, const Widths& widths) {
  return std::min(pixel_bits + widths.grid_bits, 14);
}
inline constexpr int kSmallPixelBits = 4, kMediumPixelBits = 5;

/// Operations of a draw's fragments, and their shading. In draws with an alpha test, color_write says that colours are
/// read.
struct SliceState : FragmentState {
  bool is_flat = false;      ///< the colour of the first vertex is used
  bool is_opaque = true;     ///< a passing fragment replaces the stored values, a failing one has no effect
  bool has_surface = false;  ///< colours are computed by surface.hpp
  bool is_masked = false;    ///< no colour channel is written or read
};

/// A draw's colour operations but for dithering: where pixels have one sample, that is only a way to store colours.
[[nodiscard]] constexpr ColorOps undithered(ColorOps ops, int pixel_samples) {
  ops.dithers = ops.dithers && pixel_samples > 1;
  return ops;
}

/// A vertex in the engine's own layout, independent of SnappedVertex: the values that every draw needs are a row of
/// four words, of which lanes take sixteen at a time, a column each. A further attribute becomes an array of its own in
/// Slice.
struct VertexRow {
  std::int32_t x = 0, y = 0;  ///< subpixels, y down
  std::uint32_t z = 0;        ///< depth code
  std::uint32_t rgba = 0;     ///< colour codes, 8 bits a channel, R lowest
};
static_assert(sizeof(VertexRow) == 16 && offsetof(VertexRow, y) == 4 && offsetof(VertexRow, z) == 8 &&
              offsetof(VertexRow, rgba) == 12);

/// The only place where a snapped vertex of the host side becomes a row.
[[nodiscard]] inline VertexRow row_of(const SnappedVertex& v) { return {v.x, v.y, v.depth(), packed_channels(v.code)}; }

/// Square points of at most this many pixels along a side are drawn as a dot for each pixel.
inline constexpr int kLargestDots = 4;

/// Whether a state's points are drawn so.
[[nodiscard]] inline bool are_dots(const State& state, const Widths& widths) {
  return widths.has_samples == 0 && !state.smooth && state.point_shape == PointShape::square &&
         state.point_size <= kLargestDots;
}

// Lanes take sixteen dots at a time.
static_assert(sizeof(Dot) == 16 && offsetof(Dot, z) == 8 && offsetof(Dot, rgba) == 12);

/// Whether LineBatch sets up lines: it has 64 bits for a gradient times an offset inside the first pixel.
[[nodiscard]] inline bool lanes_hold_lines(const Config& config, const Widths& widths) {
  return config.depth_bits + 2 * widths.grid_bits + widths.line_guard_bits + 2 <= 62;
}

enum class RecordKind : std::uint8_t { triangle, whole_line, cut_line, rectangle };

/// A primitive with at least one pixel in its box. Eight words: kernels make and take sixteen at a time, a column each.
struct Record {
  std::array<std::uint32_t, 3> v{};    ///< into vertices, provoking one first, of whole lines last; cut: [0] into lines
  std::int32_t z_low = 0, z_high = 0;  ///< range of its depth codes
  std::int32_t left_top = 0, right_bottom = 0;  ///< its box within the scissor, pixels, inclusive: column low, row high
  std::int32_t traits = 0;                      ///< kind in the lowest byte, and these bits

  static constexpr std::int32_t kWhole = 1
                                         << 8,  ///< a triangle covered by its edges alone: the scissor cuts nothing off
      kSmall = 1 << 9,                          ///< whole, within kSmallTiles by kSmallTiles, not too steep
      kMedium = 1 << 10,                        ///< whole, within kMediumTiles by kMediumTiles, small or not
      kDrawsNothing = 1 << 11;  ///< culled, but Skip forbids to drop it: goes through the raster and draws nothing
  static constexpr int kSamplesShift = 16;  ///< a small triangle within two by two pixels: the covered ones; else 0

  [[nodiscard]] int left() const { return static_cast<std::int16_t>(left_top); }
  [[nodiscard]] int top() const { return left_top >> 16; }
  [[nodiscard]] int right() const { return static_cast<std::int16_t>(right_bottom); }
  [[nodiscard]] int bottom() const { return right_bottom >> 16; }
  [[nodiscard]] RecordKind kind() const { return static_cast<RecordKind>(traits & 255); }
  [[nodiscard]] bool has(std::int32_t trait) const { return (traits & trait) != 0; }
  [[nodiscard]] int samples() const { return traits >> kSamplesShift; }
};
static_assert(sizeof(Record) == 32 && offsetof(Record, z_low) == 12 && offsetof(Record, z_high) == 16 &&
              offsetof(Record, left_top) == 20 && offsetof(Record, right_bottom) == 24 &&
              offsetof(Record, traits) == 28);

/// One slice. The data that lanes read and write is in plain arrays, padded to whole registers.
struct Slice {
  /// Primitives of one draw that follow each other.
  struct Part {
    std::size_t first = 0, count = 0;  ///< triangles of the prepared scene
    std::uint32_t command = 0;         ///< index of the draw in Scene::commands
    std::uint32_t primitive = 0;       ///< number of the first, over the whole scene
  };
  const DrawContext* context = nullptr;  ///< of its first part; all parts have the same state
  SliceState state;
  std::vector<Part> parts;
  std::size_t triangles = 0;  ///< triangles of all parts
  bool is_lines = false;      ///< the triangles are lines
  bool has_dots = false;      ///< it draws `dots`: the triangles are points, or all outlines are dots
  std::vector<AssembledPrimitive>
      outlines;  ///< or primitives not for lanes: large points, polygon modes; then of one part

  /// Range of the triangles' vertices: each is projected once. If the range is too wide, every corner is a vertex of
  /// its own: three in a row for each triangle.
  std::uint32_t low_index = 0, high_index = 0;
  bool is_wide = false;
  bool is_in_view = false;  ///< the vertices of all parts lie inside the view volume, each with its w above 0
  std::vector<VertexRow> vertices;
  /// Attributes of each vertex, where the state has surfaces; normals where fragments are lit. They are the prepared
  /// scene's, if the slice has exactly these vertices.
  const SurfaceRow* surface = nullptr;
  const Normal* normals = nullptr;
  std::vector<SurfaceRow> own_surface;  ///< otherwise rows point to these copies
  std::vector<Normal> own_normals;
  std::vector<std::uint32_t> codes;  ///< kVolume and kSlow bits of each vertex
  std::uint32_t any_code = 0;        ///< their union
  std::vector<Record> records;
  std::size_t record_count = 0;
  std::vector<LineSetup> lines;
  std::vector<Dot> dots;                   ///< instead of records, if all primitives are such points: bin by bin
  std::vector<std::uint32_t> bin_first;    ///< into bin_records or dots, one more than there are bins
  std::vector<std::uint32_t> bin_records;  ///< into records, by bin
  Signature state_signature;               ///< where bins are compared; likewise of each record
  std::vector<Signature> signatures;
  Counters counters;

  static constexpr std::uint32_t kVolume = 0x3f;  ///< outside that plane of DrawContext::frustum, of points view_volume
  static constexpr std::uint32_t kSlow = 0x40;    ///< outside the guard band, or not a vertex that may be drawn
};

struct FrameContext {
  const PreparedScene& prepared;
  const Config& config;
  const Widths& widths;
  Skip skip;
  int bins_x = 0;
  bool takes_one_by_one = false;  ///< draws all fragments one by one: RenderOptions::general_fragments
};

/// Draws triangle number `triangle` of a part that lanes cannot take: the host side's own function.
using SlowPath = void (*)(const FrameContext& frame, Slice& slice, const Slice::Part& part, std::size_t triangle);

/// State of the target's tiles that is known without reading pixels, bin after bin, row by row inside a bin. Ranges of
/// depths are kept in 16 bits, the upper ones of a code: lanes then take a bin's 64 tiles at once.
struct TileStates {
  static constexpr std::uint8_t kDepthCleared = 1, kColorCleared = 2;  ///< a pending clear
  std::vector<std::uint16_t> z_low, z_high;                            ///< bounds of the stored depths
  std::vector<std::uint8_t> pending;
  std::vector<std::uint8_t>
      held;  ///< the same bits: the target's memory holds that clear, from this frame or an earlier one
};

/// Bits of a code below the bits that a range keeps.
[[nodiscard]] inline int range_drop(const Config& config) { return std::max(config.depth_bits - 16, 0); }

/// The bin being drawn.
struct BinJob {
  const FrameContext& frame;
  std::span<const Slice* const> slices;
  int bin = 0;
  Framebuffer& target;
  TileStates& tiles;
  std::uint32_t clear_depth = 0, clear_color = 0;  ///< of tiles with pending clears
  Counters& counters;
  bool keeps_samples = false;  ///< the samples' images are written, not only the pixels'
};

/// The loops that run in lanes, compiled for one instruction set.
struct Kernels {
  const char* name;
  void (*project)(const FrameContext&, Slice&);         ///< vertices and codes
  void (*cull)(const FrameContext&, Slice&, SlowPath);  ///< records
  void (*cull_lines)(const FrameContext&, Slice&, SlowPath);
  void (*raster)(BinJob&);      ///< a bin's records, drawn
  SmoothLanes smooth_coverage;  ///< of the pixels of smooth lines
};

}  // namespace halfplane::functional
