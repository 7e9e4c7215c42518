// What the parts of the functional engine hand on to each other: slices of a draw, records of what is left of their
// primitives, and for each bin of the target the list of its records.
//
//   slice   some thousand primitives of one draw. Its own vertices, records and bin lists: made by one thread.
//   bin     64 x 64 pixels. Drawn by one thread, slice after slice: in program order, whoever made the slices.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "../../pipeline.hpp"
#include "prepared_scene.hpp"

namespace halfplane::functional {

inline constexpr int kBinShift = 6, kBinSize = 1 << kBinShift;     ///< pixels along the side of a bin
inline constexpr int kTileShift = 3, kTileSize = 1 << kTileShift;  ///< the only tile size that this engine has
inline constexpr int kBinTiles = kBinSize / kTileSize;             ///< tiles along the side of a bin

/// Extent of triangles that are set up sixteen at a time: 16 pixels, and products of two that 32 bits hold.
[[nodiscard]] inline int small_extent_bits(const Widths& widths) { return std::min(4 + widths.grid_bits, 14); }

/// What a draw's state asks of its fragments.
struct FragmentState {
  DepthFunc depth_test = DepthFunc::less;
  bool depth_write = true, color_write = true;
  bool is_flat = false;  ///< the colour is that of the first vertex
};

enum class RecordKind : std::uint8_t { triangle, whole_line, cut_line, rectangle };

/// A primitive with at least one pixel in its box.
struct Record {
  std::array<std::uint32_t, 3> v{};    ///< into Slice::vertices, of a triangle the provoking one first, of a whole line
                                       ///< last, behind its ends; cut line: [0] into Slice::lines
  std::int32_t z_low = 0, z_high = 0;  ///< range of its depth codes
  std::int16_t left = 0, top = 0, right = 0, bottom = 0;  ///< its box inside the scissor, pixels, inclusive
  RecordKind kind = RecordKind::triangle;
  std::uint8_t samples = 0;        ///< a small triangle within two by two pixels: bits, which of them it covers; else 0
  bool is_whole : 1 = false;       ///< a triangle whose edges alone say what it covers: the scissor cuts nothing off
  bool is_small : 1 = false;       ///< whole, within two by two tiles, and of small_extent_bits()
  bool draws_nothing : 1 = false;  ///< culled, but nobody may skip: goes through the raster and draws nothing
};

/// One slice. What the lanes read and write is in plain arrays, as long as they need.
struct Slice {
  /// Primitives of one draw that follow each other.
  struct Part {
    std::size_t first = 0, count = 0;  ///< triangles of the prepared scene
    std::uint32_t command = 0;         ///< index of the draw in Scene::commands
    std::uint32_t primitive = 0;       ///< number of the first, over the whole scene
  };
  const DrawContext* context = nullptr;  ///< of its first part; the others have the same state
  FragmentState state;
  std::vector<Part> parts;
  std::size_t triangles = 0;                 ///< of all parts
  bool is_lines = false;                     ///< the triangles are lines
  std::vector<AssembledPrimitive> outlines;  ///< or what the lanes do not take: points, polygon modes; then of one part

  /// Range of the triangles' vertices: those are projected, once each. If it is too wide for that, every corner is a
  /// vertex of its own: three in a row for each triangle.
  std::uint32_t low_index = 0, high_index = 0;
  bool is_wide = false;
  std::vector<SnappedVertex> vertices;
  std::vector<std::uint32_t> codes;  ///< kVolume and kSlow bits of each vertex
  std::uint32_t any_code = 0;        ///< their union
  std::vector<Record> records;
  std::size_t record_count = 0;
  std::vector<LineSetup> lines;
  std::vector<std::uint32_t> bin_first;    ///< into bin_records, one more than there are bins
  std::vector<std::uint32_t> bin_records;  ///< into records
  Counters counters;

  static constexpr std::uint32_t kVolume = 0x3f;  ///< outside that plane of the view volume
  static constexpr std::uint32_t kSlow = 0x40;    ///< outside the guard band, or not a vertex that may be drawn
};

/// What stays the same over the frame.
struct FrameContext {
  const PreparedScene& prepared;
  const Config& config;
  const Widths& widths;
  Skip skip;
  int bins_x = 0, bins_y = 0;
};

/// What happens to triangle number `triangle` of a part that the lanes cannot take: the host side's own function.
using SlowPath = void (*)(const FrameContext& frame, Slice& slice, const Slice::Part& part, std::size_t triangle);

/// What is known of the tiles of the target without looking at their pixels, bin after bin, row by row inside a bin.
struct TileStates {
  static constexpr std::uint8_t kDepthCleared = 1, kColorCleared = 2;  ///< a clear that has not been written yet
  std::vector<std::int32_t> z_low, z_high;                             ///< no stored depth lies outside
  std::vector<std::uint8_t> pending;
  std::vector<std::uint8_t>
      held;  ///< the same bits: the target's memory is that clear, from this frame or an earlier one
};

/// One bin at work.
struct BinJob {
  const FrameContext& frame;
  std::span<const Slice* const> slices;
  int bin = 0;
  Framebuffer& target;
  TileStates& tiles;
  std::uint32_t clear_depth = 0, clear_color = 0;  ///< of pending tiles
  Counters& counters;
};

/// The loops that are worth lanes, compiled for one instruction set.
struct Kernels {
  const char* name;
  void (*project)(const FrameContext&, Slice&);         ///< vertices and codes
  void (*cull)(const FrameContext&, Slice&, SlowPath);  ///< records
  void (*cull_lines)(const FrameContext&, Slice&, SlowPath);
  void (*raster)(BinJob&);  ///< a bin's records, drawn
};

}  // namespace halfplane::functional
