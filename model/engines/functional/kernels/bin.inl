// The state of a bin while its records are drawn: its pixels, the content of its tiles, pending work. All later files
// are functions on it.
#pragma once

#include "leaf.inl"
#include "line_setup.inl"
#include "small_batch.inl"
#include "small_setup.inl"

namespace halfplane::functional::HALFPLANE_ISA_NAME {
namespace {

/// Pixel and tile positions of lanes.
struct LanePositions {
  I16 pair_x;   ///< for rows of eight
  I16 lane;     ///< its number
  I16 to_sign;  ///< 31 - lane: moves bit number `lane` to the sign
  I16 block_x, block_y;
  S64 tile_x, tile_y;        ///< of the tiles of a bin, row by row
  S64 pixel_x, pixel_y;      ///< of the pixels of a tile, block by block
  S64 samples_x, samples_y;  ///< of four samples of a block
  /// Columns (rows) of the left and right (upper and lower) blocks of a tile, from its anchor; also in both halves.
  std::array<I16, 2> column, row, column_pair, row_pair;
  struct Block {
    I16 column, row;
    S32 channel_column, channel_row;  ///< of the tile's left half, four channels a pixel
  };
  std::array<Block, 4> block;                ///< blocks of a tile, likewise
  std::array<Quad::Part, 2> quad_x, quad_y;  ///< x, y of the first part of a quad; of the next part

  LanePositions() {
    pair_x = I16::of([](int i) { return i % 8; });
    tile_x = S64::of([](int i) { return static_cast<std::int16_t>(i % kBinTiles); });
    tile_y = S64::of([](int i) { return static_cast<std::int16_t>(i / kBinTiles); });
    pixel_x = S64::of([](int i) { return static_cast<std::int16_t>(i / 16 % 2 * kBlockSize + i % 4); });
    pixel_y = S64::of([](int i) { return static_cast<std::int16_t>(i / 32 * kBlockSize + i / 4 % 4); });
    samples_x = S64::of([](int i) { return static_cast<std::int16_t>(i % 4); });
    samples_y = S64::of([](int i) { return static_cast<std::int16_t>(i / 4 % 4); });
    lane = I16::of([](int i) { return i; });
    to_sign = I16::of([](int i) { return 31 - i; });
    block_x = I16::of([](int i) { return i % 4; });
    block_y = I16::of([](int i) { return i / 4; });
    for (int side = 0; side < 2; ++side) {
      const auto at = static_cast<std::size_t>(side);
      column[at] = block_x + (kBlockSize * side - kTileSize / 2);
      row[at] = block_y + (kBlockSize * side - kTileSize / 2);
      column_pair[at] = pairs(column[at], column[at]);
      row_pair[at] = pairs(row[at], row[at]);
      const int quad = 2 * kBlockSize * side;
      quad_x[at] = Quad::Part::of(
          [quad](int i) { return static_cast<std::int16_t>(quad + i / kBlockPixels * kBlockSize + i % kBlockSize); });
      quad_y[at] =
          Quad::Part::of([quad](int i) { return static_cast<std::int16_t>(quad + i / kBlockSize % kBlockSize); });
    }
    for (std::size_t at = 0; at < 4; ++at) {
      const std::size_t right = at & 1, below = at >> 1;
      const auto first = [](std::size_t side) { return kBlockSize * static_cast<int>(side) - kTileSize / 2; };
      block[at].column = column[right];
      block[at].row = row[below];
      block[at].channel_column = S32::of([&](int i) { return static_cast<std::int16_t>(first(right) + i / 4 % 2); });
      block[at].channel_row = S32::of([&](int i) { return static_cast<std::int16_t>(first(below) + i / 8); });
    }
  }
};

/// Made when a kernel first runs, not when the program starts: the machine may not have these instructions.
static const LanePositions& lane_positions() {
  static const LanePositions positions;
  return positions;
}

static const LinePositions& line_places() {
  static const LinePositions positions;
  return positions;
}

/// Constants of a triangle's colours, in lanes.
struct ColorSteps {
  ChannelPairs step_x, step_y, low, high;  ///< steps per pixel; range of the vertices' codes
};

/// Inclusive.
struct BinBounds {
  std::int32_t left, top, right, bottom;
};

/// One triangle, as one bin sees it, in pixels and tiles of the bin.
struct BinTriangle {
  /// At the bin's first pixel, clamped to +-2^30; steps as in Edge. The fourth is unused.
  std::array<std::int32_t, 4> edge, dx, dy;
  BinBounds box;
  std::int32_t z_low, z_high;                 ///< codes of the vertices
  std::int64_t z_anchor, z_tile_x, z_tile_y;  ///< plane at the first tile's anchor; steps from tile to tile
  std::int32_t z_step_x, z_step_y;            ///< per pixel, in a lane
  std::int32_t to_low, to_high;               ///< in units of a range: from a tile's anchor to its lowest and highest
  bool is_gentle;                             ///< to_low, to_high are valid: no value wraps
  bool is_narrow;                             ///< its depths are tested in lanes of 16 bits
  bool is_steep;                              ///< an edge needs more than 16 bits in a tile
  bool is_whole;                              ///< its edges alone decide its coverage
  std::array<std::int64_t, 4> c_anchor, c_tile_x, c_tile_y;  ///< the same for colours, channel by channel
  ColorSteps color;
  std::int32_t surface;  ///< index into BinMemory::seen, where its colours are; 0: none
  Packing packing;       ///< of its colours
};

/// A surface whose colours are being computed.
struct DrawnSurface {
  DrawnSurface(const StageSurface& from, const FrameContext& frame, const TexelBlocks* texels, const Packing& packing_)
      : constants(from, frame, texels), packing(packing_) {}

  SurfaceConstants constants;
  BinTriangle colors;                   ///< affine ones, if needed
  std::unique_ptr<StageSurface> stage;  ///< where lanes lack a feature of the surface
  Packing packing;
  std::uint32_t number = 0;  ///< of all that were ever set up on a thread
};

/// Coordinates of an upright image at the columns and rows of a bin's tiles: upright.inl.
struct UprightMemory {
  std::uint32_t image = 0;  ///< DrawnSurface::number
  std::uint32_t known = 0;  ///< a bit for each column of tiles, then for each row
  alignas(64) std::array<std::array<std::int32_t, kBlockPixels>, 2 * kBinTiles> at;

  static std::size_t column_of(int tile) { return static_cast<std::size_t>(tile % kBinTiles); }
  static std::size_t row_of(int tile) { return static_cast<std::size_t>(kBinTiles + tile / kBinTiles); }
};

/// A visible textured primitive, set up when its first pixel is shaded.
struct SeenSurface {
  const Slice* slice;
  const Record* record;
  int place;           ///< kAtCentre, or the sample that shades
  std::int32_t drawn;  ///< into BinMemory::drawn, once it is set up; else -1
};

/// Sixteen small or medium triangles of a batch, each clipped to its window of two by two tiles, with deferred colours.
/// Each is a piece; pieces beyond the batch are never seen.
struct PieceGroup {
  const Slice* slice;
  std::size_t style;                      ///< in BinMemory::styles
  std::array<const Record*, 16> records;  ///< the members up to `surface`: as in SmallBatch
  alignas(64) SmallBatch::LaneArray<3> corner;
  alignas(64) SmallBatch::Lane left, top;
  std::uint32_t live;
  bool is_set_up;
  std::uint32_t alone;                    ///< a bit each: triangles that lanes cannot set up, shaded like large ones
  std::array<std::uint16_t, 16> surface;  ///< their indices into BinMemory::seen
};

/// Four numbers of each piece of a group: by column where a register of sixteen numbers can be indexed, else by piece.
struct alignas(64) PieceRow {
  std::array<std::int32_t, std::size_t{4} * 16> number{};
};

/// Constants of the visible pieces of a group.
struct PieceConstants {
  /// In a tile. A window has one tile with even column and even row, and so on.
  struct Tile {
    PieceRow coordinates;  ///< anchors of Q and of P of u and v, in lanes; u_ref of v
    PieceRow colors;       ///< anchors of red and green, blue and alpha; codes of the vertices, lowest, highest
  };
  PieceRow step_x;           ///< steps of Q and P; and, a byte each, LaneAttribute::narrow and drop
  PieceRow step_y;           ///< steps of Q and P; u_ref of u
  PieceRow color;            ///< steps in x, red and green first, and in y
  std::array<Tile, 4> tile;  ///< by the lowest bit of its column, and that of its row
};

/// The same for colours over w, red, green, blue and alpha: steps of P, and its anchors in tiles.
struct PieceColors {
  PieceRow step_x, step_y;
  PieceRow scale;  ///< LaneAttribute::narrow and drop, codes of the vertices, lowest, highest: a byte a channel
  std::array<PieceRow, 4> tile;
};

/// The same for the level of detail: lines of u and v along y, and along x.
struct PieceLevels {
  PieceRow at_zero, step;
  PieceRow offset;  ///< the first column
};

/// The pixels of a bin: tile after tile, block after block, row after row. And the triangles that own tiles.
struct BinMemory {
  static constexpr std::size_t kPlanes = 256;              ///< limit of pending triangles: more than two for each tile
  alignas(64) std::array<std::int32_t, kBinPixels> depth;  ///< unused where 16 bits suffice
  alignas(64) std::array<std::uint16_t, kBinPixels> narrow_depth;
  alignas(64) std::array<std::uint32_t, kBinPixels> color;
  alignas(64) std::array<BinTriangle, kPlanes> planes;
  alignas(64) std::array<std::uint32_t, kBinPixels> source;  ///< colours of waiting pixels: waiting.inl
  static constexpr std::size_t kSurfaces = 8192;  ///< limit of pending surfaces: twice the pixels that can show one
  alignas(64) std::array<std::uint16_t, kBinPixels> surface;  ///< into `seen`, 0: the colour is in memory
  std::array<SeenSurface, kSurfaces> seen;                    ///< from 1 on
  std::vector<DrawnSurface> drawn;
  std::uint32_t drawn_before = 0;  ///< the last DrawnSurface::number
  UprightMemory upright;
  // Pending pieces, by group, from 1 on; the pixel of a piece stores kFirstPiece, plus 16 times the group's number, plus
  // the piece's number in its group.
  static constexpr std::size_t kFirstPiece = kSurfaces, kGroups = kSurfaces / 16;
  std::vector<PieceGroup> groups;         ///< kGroups, if there are any
  std::vector<PieceConstants> constants;  ///< likewise; group 0 is unused
  std::vector<PieceLevels> levels;        ///< likewise, if a style needs them
  std::vector<PieceColors> colors;        ///< likewise
  std::vector<SurfaceStyle> styles;

  /// On the heap, as below: a thread's own memory is cleared whenever one starts, whatever it is to do.
  static BinMemory& of_thread() {
    static thread_local const auto memory = std::make_unique<BinMemory>();
    return *memory;
  }
};

/// Pixels of a tile at each sample, a bit each.
using PixelsOfSamples = std::array<std::uint64_t, kMaxPixelSamples>;

/// A triangle's pending part in a tile: cutouts.inl.
struct Cutout {
  std::int16_t plane;       ///< into BinMemory::planes
  std::uint16_t low, high;  ///< range of its depths, if they are pending
  std::uint64_t centre;     ///< pixels covered at their centres
  PixelsOfSamples covered, passed;
};
/// The cutouts of a tile, the last one on top.
struct TileCutouts {
  static constexpr std::size_t kMost = 8;
  std::size_t count, first_depth;         ///< from here on depths are pending as well, if Bin::depth_owner says so
  std::int16_t color_below, depth_below;  ///< owners of the layers below
  bool is_split_below;
  std::uint16_t low_below, high_below;  ///< range of the depths below
  PixelsOfSamples below;                ///< samples that no cutout hides: set by drop_hidden()
  Cutout cutout[kMost];                 // GCC 12 takes an access to a std::array of these for one of another array
};

/// Data of a bin by sample of multisampled pixels: block after block as in BinMemory, each block sample after sample:
/// Bin::sample_place(). Colours are of split tiles.
struct SampleMemory {
  static constexpr std::size_t kSamples = std::size_t{kMaxPixelSamples} * kBinPixels;
  alignas(64) std::array<std::int32_t, kSamples> depth;
  alignas(64) std::array<std::uint16_t, kSamples> narrow_depth;
  alignas(64) std::array<std::uint32_t, kSamples> color;
  TileCutouts cutouts[kBinTiles * kBinTiles];

  static SampleMemory& of_thread() {
    static thread_local const auto memory = std::make_unique<SampleMemory>();
    return *memory;
  }
};

struct Bin {
  static constexpr int kTiles = kBinTiles * kBinTiles;
  // Owner of a tile's depths or colours; 0 and more: a triangle of BinMemory::planes.
  static constexpr std::int16_t kInMemory = -1, kCleared = -2, kInTarget = -3;
  static constexpr std::int16_t kSurfaces = -4;  ///< pixel by pixel: BinMemory::surface
  static constexpr std::int16_t kLayers = -5;    ///< in memory, except for pending layers: layers.inl
  static constexpr std::int16_t kCutouts = -6;   ///< SampleMemory::cutouts

  using Compute = void (*)(Bin& bin, int tile);

  Bin(BinJob& job_, Compute compute_deferred_)
      : job(job_),
        compute_deferred(compute_deferred_),
        config(job.frame.config),
        widths(job.frame.widths),
        skip(job.frame.skip),
        depth_format(widths.depth(), 32, widths),
        color_format(widths.color(), 16, widths),
        centred_depth(depth_format.centred()),
        centred_color(color_format.centred()),
        is_short(is_short_enough(widths, depth_format, color_format)),
        has_short_edges(are_short_edges(widths)),
        first_x(job.bin % job.frame.bins_x * kBinSize),
        first_y(job.bin / job.frame.bins_x * kBinSize),
        pixel(1.0 / static_cast<double>(std::int64_t{1} << widths.grid_bits)),
        are_lines(job.target.has_whole_lines()),
        samples(static_cast<unsigned>(widths.pixel_samples)),
        is_narrow(config.depth_bits <= 16),
        tests_narrow(is_narrow && config.depth_bits >= 15 && depth_format.down - depth_format.up <= 12),
        range_bits_dropped(range_drop(config)),
        tile_low(job.tiles.z_low.data() + std::ptrdiff_t{job.bin} * kTiles),
        tile_high(job.tiles.z_high.data() + std::ptrdiff_t{job.bin} * kTiles),
        memory(BinMemory::of_thread()),
        sample_memory(SampleMemory::of_thread()) {
    const std::uint8_t* pending = job.tiles.pending.data() + std::ptrdiff_t{job.bin} * kTiles;
    for (int t = 0; t < kTiles; ++t) {
      depth_owner[t] = (pending[t] & TileStates::kDepthCleared) != 0 ? kCleared : kInTarget;
      color_owner[t] = (pending[t] & TileStates::kColorCleared) != 0 ? kCleared : kInTarget;
    }
    cleared_depths.fill(static_cast<std::uint16_t>(job.clear_depth));
    cleared_colors.fill(job.clear_color);
  }

  BinJob& job;
  Compute compute_deferred;  ///< to memory: colours of a tile of kSurfaces, kLayers, kCutouts or a textured primitive
  const Config& config;
  const Widths& widths;
  Skip skip;  ///< as it applies to the current draw
  LaneFormat depth_format, color_format;
  LaneFormat centred_depth, centred_color;  ///< formats of small triangles
  bool is_short;                            ///< small triangles use the short arithmetic
  bool has_short_edges;                     ///< 16 bits hold their edges
  int first_x, first_y;                     ///< pixels
  double pixel;                             ///< a subpixel, in pixels
  bool are_lines;                           ///< sixteen pixels of a row of the target are a cache line
  unsigned samples;                         ///< samples of a pixel; several: multisample.inl
  bool is_narrow;                           ///< depths are in BinMemory::narrow_depth
  bool tests_narrow;  ///< 16 bits hold the codes of a tile modulo their wrap window, and fifteen of its fractions
  int range_bits_dropped;
  std::uint16_t *tile_low, *tile_high;
  BinMemory& memory;
  SampleMemory& sample_memory;  ///< not of_thread() in a loop: that is an opaque call for the compiler
  SliceState state;
  const FragmentOps* ops = nullptr;  ///< of the slice
  Packing packing{};                 ///< of its colours
  /// Whether passing pixels of a batch wait to be operated upon.
  [[nodiscard]] HALFPLANE_INLINE bool is_operated() const { return has_operations && !lays_over; }
  /// How colours of a draw are stored.
  [[nodiscard]] HALFPLANE_INLINE Packing packing_of(const FragmentOps& of) const {
    return {config.color_format, of.color.dithers};
  }
  // State of the current primitive after its alpha test:
  bool has_operations = false;      ///< operations that are more than plain: operations.inl
  bool lays_over = false;           ///< the only operation is blending by alpha
  bool tests_alpha = false;         ///< colours are not known to pass
  bool is_killed = false;           ///< all colours are known to fail
  bool tests_stencil = false;       ///< its tiles are drawn by stencil.inl
  std::uint32_t drawn_samples = 1;  ///< of pixels, by the draw's sample mask, a bit each
  bool is_back = false;             ///< the current triangle shows its back; set for draws with a stencil
  /// Where SampleMemory has sample k of the block that begins with pixel `at`.
  [[nodiscard]] HALFPLANE_INLINE std::size_t sample_place(unsigned k, std::size_t at) const {
    return at * samples + k * kBlockPixels;
  }
  [[nodiscard]] HALFPLANE_INLINE bool sees_surfaces() const { return state.has_surface && state.color_write; }
  std::int32_t low = 0, high = 0;  ///< range of the bin's depths, or wider
  std::int32_t lowest_high = 0;    ///< lowest of its tiles' upper bounds, now or earlier
  static constexpr std::int32_t kOpen = 1 << 16;
  std::int32_t closed_from = kOpen;  ///< with the test less, all tiles hide depths from here on
  const LanePositions& position = lane_positions();
  SmallBatch small;
  std::int32_t batch_surface = 0;  ///< surface number of its first triangle
  int small_run = 0;               ///< records in a row that were small or medium
  const LinePositions& line_positions = line_places();
  LineBatch lines;
  std::uint64_t line_tiles = 0;  ///< touched by lines of line_state since triangles were last drawn
  SliceState line_state;
  bool falls = false, rises = false;  ///< direction in which a passing depth may change the stored one
  std::size_t plane_count = 0;
  std::size_t surface_count = 0;  ///< of BinMemory::seen
  std::size_t group_count = 0;    ///< of BinMemory::groups
  std::size_t layer_count = 0;    ///< of LayerMemory
  bool is_range_old = true;       ///< low, high and lowest_high must be found again before use
  /// Cutouts hidden by later ones, minus cutouts coloured before the end of the bin: at 0 or less no new cutout is
  /// kept.
  int cutouts_saved = 1;
  std::uint64_t split = 0;      ///< tiles whose pixels may have samples of different colours
  std::uint64_t in_memory = 0;  ///< tiles with depths and colours in memory, as far as small triangles know
  std::array<std::uint64_t, kTiles> waiting{};  ///< pixels of each tile, a bit each: waiting.inl
  std::array<std::uint8_t, kTiles> touches{};   ///< by tile: touches by batches since its range was found
  alignas(64) std::array<std::int16_t, kTiles> depth_owner, color_owner;
  // Clear values, readable as if they were in memory: a tile if 16 bits suffice, a block.
  alignas(64) std::array<std::uint16_t, kTilePixels> cleared_depths;
  alignas(64) std::array<std::uint32_t, kBlockPixels> cleared_colors;
};

/// A range of depths in the precision of tile ranges.
struct DepthRange {
  std::int32_t low, high;
};
HALFPLANE_INLINE DepthRange range_of(const Bin& bin, const Record& record) {
  return {record.z_low >> bin.range_bits_dropped, record.z_high >> bin.range_bits_dropped};
}

/// The tiles of a box, a bit each.
HALFPLANE_INLINE std::uint64_t tiles_of(const BinBounds& box) {
  constexpr std::uint64_t kColumn = 0x0101010101010101;
  const std::uint64_t row = (2U << (box.right >> kTileShift)) - (1U << (box.left >> kTileShift));
  const int above = box.top >> kTileShift << kTileShift, last = box.bottom >> kTileShift << kTileShift;
  return row * ((kColumn >> (56 - last)) & (~std::uint64_t{0} << above));
}

/// The tiles that lie completely in a box.
inline std::uint64_t tiles_inside(const BinBounds& box) {
  const auto round_up = [](int at) { return (at + kTileSize - 1) & -kTileSize; };
  const BinBounds inner{round_up(box.left), round_up(box.top), ((box.right + 1) & -kTileSize) - 1,
                        ((box.bottom + 1) & -kTileSize) - 1};
  return inner.left > inner.right || inner.top > inner.bottom ? 0 : tiles_of(inner);
}

/// The part of a record's box that lies in the bin.
HALFPLANE_INLINE BinBounds box_of(const Bin& bin, const Record& record) {
  return {std::max(record.left() - bin.first_x, 0), std::max(record.top() - bin.first_y, 0),
          std::min(record.right() - bin.first_x, kBinSize - 1), std::min(record.bottom() - bin.first_y, kBinSize - 1)};
}

}  // namespace
}  // namespace halfplane::functional::HALFPLANE_ISA_NAME
