// Setup, coarse raster, fine raster, interpolation, depth test and ROP of one bin, fused. The bits are those of the
// stages; the order of the work differs:
//
//   triangle within two by two pixels  sixteen at a time through setup, then their samples
//   within two by two tiles            sixteen at a time through setup, then their covered blocks
//   within three by three, in a row    the same
//   larger                             all tiles of the bin at once: outside, hidden, taken whole, or drawn
//
// A block is 4 x 4 pixels: sixteen lanes, one cache line of colours. A tile is four of them.
//
// A tile that a triangle covers wholly, in front of all its depths, is taken without access to pixels: the tile stores
// the triangle's number, and depths and colours are computed when they are needed, mostly at the end of the bin.
//
// docs/functional.md draws the path of a block through these files.
#pragma once

#include "batches.inl"
#include "bin.inl"
#include "cutouts.inl"
#include "deferred.inl"
#include "dots.inl"
#include "finish.inl"
#include "fragments.inl"
#include "general.inl"
#include "layers.inl"
#include "lines.inl"
#include "multisample.inl"
#include "small_batch.inl"
#include "stencil.inl"
#include "tile_memory.inl"
#include "tiles.inl"

namespace halfplane::functional::HALFPLANE_ISA_NAME {
namespace {

/// One range of depths for all tiles.
struct SameDepths {
  DepthRange range;

  HALFPLANE_INLINE U64 low() const { return U64(static_cast<std::uint16_t>(range.low)); }
  HALFPLANE_INLINE U64 high() const { return U64(static_cast<std::uint16_t>(range.high)); }
};

/// Whether no part of a record can be visible; for lines and records among many small triangles: the range of the whole
/// bin is tested first.
template <class Fragments>
HALFPLANE_INLINE bool is_behind(Bin& bin, const Record& record, bool is_line) {
  if (!bin.skip.tiles_hiz) return false;
  if (bin.is_range_old) find_bin_range(bin);
  const DepthRange range = range_of(bin, record);
  if (!(Fragments::kIsLess ? range.low >= bin.closed_from : Fragments::is_behind(bin, range))) {
    // Nearer than the bound of every tile: its own tiles need no test.
    if (is_line || (Fragments::kIsLess && range.low < bin.lowest_high)) return false;
    if ((tiles_of(box_of(bin, record)) & ~Fragments::tiles_behind(bin, SameDepths{range})) != 0) return false;
  }
  const auto tiles = static_cast<unsigned>(std::popcount(tiles_of(box_of(bin, record))));
  bin.job.counters.tiles_visited += tiles;
  bin.job.counters.skipped.tiles_hiz += tiles;
  return true;
}

/// First tile of the part of a record's box that lies in the bin.
HALFPLANE_INLINE int first_tile(const Bin& bin, const Record& record) {
  const int x = std::max(record.left() - bin.first_x, 0), y = std::max(record.top() - bin.first_y, 0);
  return (y >> kTileShift) * kBinTiles + (x >> kTileShift);
}

/// Records that are prefetched before they are read: two batches.
constexpr std::ptrdiff_t kAhead = 32;

/// Prefetches data for the next records: of lines, also the vertices of the next batch.
HALFPLANE_INLINE void fetch_records(const Slice& slice, const std::uint32_t* first, const std::uint32_t* last) {
  if (last - first > kAhead) __builtin_prefetch(&slice.records[first[kAhead]]);
  if (!slice.is_lines || last - first <= kAhead / 2) return;
  if (const Record& near = slice.records[first[kAhead / 2]]; near.kind() == RecordKind::whole_line)
    for (std::size_t k = 0; k < 2; ++k) __builtin_prefetch(&slice.vertices[near.v[k]]);
}

/// For any other record: its tiles that may show it. All tiles of the bin are tested at once, and where all of them
/// hide it that result is kept for the next records.
template <class Fragments>
HALFPLANE_INLINE std::uint64_t seen_tiles(Bin& bin, const Record& record, const BinBounds& box) {
  const std::uint64_t tiles = tiles_of(box);
  bin.job.counters.tiles_visited += static_cast<unsigned>(std::popcount(tiles));
  if (!bin.skip.tiles_hiz) return tiles;
  const DepthRange range = range_of(bin, record);
  std::uint64_t behind = ~std::uint64_t{0};
  if (!Fragments::kIsLess || range.low < bin.closed_from) behind = Fragments::tiles_behind(bin, SameDepths{range});
  if (Fragments::kIsLess && ~behind == 0) bin.closed_from = std::min(bin.closed_from, range.low);
  bin.job.counters.skipped.tiles_hiz += static_cast<unsigned>(std::popcount(tiles & behind));
  return tiles & ~behind;
}

/// Draws a triangle or rectangle alone, in its `live` tiles.
template <class Fragments>
HALFPLANE_INLINE void draw_alone(Bin& bin, const Slice& slice, const Record& record, const BinBounds& box,
                                 std::uint64_t live) {
  // Earlier records must be drawn first.
  if (bin.small.count != 0) draw_batch<Fragments>(bin, slice);
  if (bin.lines.count != 0) draw_lines<Fragments>(bin, slice);
  bin.line_tiles = 0;
  if (record.has(Record::kDrawsNothing)) return;
  BinTriangle triangle;
  triangle.box = box;
  triangle.is_whole = record.has(Record::kWhole);
  triangle.packing = bin.packing;
  if (bin.samples > 1)
    draw_large<Fragments, SeveralSamples>(bin, slice, record, live, triangle);
  else
    draw_large<Fragments, OneSample>(bin, slice, record, live, triangle);
}

/// Sixteen records at once, if all are small and each is nearer than the bound of its first tile: a batch without tests
/// of single records. Nothing may be pending.
template <class Fragments>
HALFPLANE_INLINE bool draw_sixteen(Bin& bin, const Slice& slice, const std::uint32_t* first,
                                   const std::uint32_t* last) {
  SmallBatch& batch = bin.small;
  const Record* const records = slice.records.data();
  constexpr int kLine = 2;    // records in a cache line
  if (last - first > kAhead)  // mostly records that follow each other
    for (int i = 0; i < 16; i += kLine) __builtin_prefetch(records + first[kAhead] + i);
  if (first[15] - first[0] != 15 || bin.sees_surfaces())
    for (std::size_t i = 0; i < 16; ++i) batch.records[i] = records + first[i];
  const auto words = [&](int from) HALFPLANE_LAMBDA {
    return first[15] - first[0] == 15 ? words_of(records + first[0], from) : words_of(batch, from);  // they ascend
  };
  const Columns upper = words(4);
  if (is_any((upper.fourth & Record::kSmall) == 0)) return false;
  const Columns lower = words(0);
  if (bin.skip.tiles_hiz) {
    const auto tile_of = [](const I16& pixel, int bin_first)
                             HALFPLANE_LAMBDA { return max(pixel - bin_first, I16(0)) >> kTileShift; };
    const I16& left_top = upper.second;
    const I16 tile = tile_of(left_top >> 16, bin.first_y) * kBinTiles + tile_of(left_top << 16 >> 16, bin.first_x),
              low = lower.fourth >> bin.range_bits_dropped;
    if (!Fragments::kIsLess || is_any(looked_up(bin.tile_high, tile) <= low)) return false;
  }
  batch.window.fill(0);
  batch.count = 16;
  bin.small_run += 16;
  place_records(batch, lower, upper, bin.first_x, bin.first_y);
  draw_loaded<Fragments>(bin, slice);
  return true;
}

/// The records of one slice.
template <class Fragments>
void draw_records(Bin& bin, const Slice& slice, const std::uint32_t* first, const std::uint32_t* last) {
  if (const SliceState& touched = bin.line_state; touched.depth_test != bin.state.depth_test ||
                                                  touched.depth_write != bin.state.depth_write ||
                                                  touched.color_write != bin.state.color_write) {
    bin.line_tiles = 0;
    bin.line_state = bin.state;
  }
  if (slice.is_lines)  // of a bin they are scattered
    for (std::ptrdiff_t i = 0; i < std::min(last - first, kAhead); ++i) __builtin_prefetch(&slice.records[first[i]]);
  const std::uint32_t* next_sixteen = first;  // the next record at which it is worth a try
  while (first != last) {
    const Record& record = slice.records[*first];
    if (bin.small.count == 0 && record.has(Record::kSmall) && first >= next_sixteen && last - first >= 16) {
      next_sixteen = first + 16;
      if (draw_sixteen<Fragments>(bin, slice, first, last)) {
        first = next_sixteen;
        continue;
      }
    }
    fetch_records(slice, first++, last);
    if (record.has(Record::kSmall)) {
      // Nearer than the bound of one of its tiles: no test of the others, nor of the bin.
      const bool is_near = Fragments::kIsLess && range_of(bin, record).low < bin.tile_high[first_tile(bin, record)];
      if (!is_near && is_behind<Fragments>(bin, record, false)) continue;
      ++bin.small_run;
      add_small<Fragments>(bin, slice, record);
      continue;
    }
    const RecordKind kind = record.kind();
    if (kind == RecordKind::whole_line || kind == RecordKind::cut_line) {
      if (is_behind<Fragments>(bin, record, true)) continue;
      bin.small_run = 0;
      if (!slice.is_lines) draw_batch<Fragments>(bin, slice);  // outlines: triangles may be before and after it
      if (bin.lines.add(record) || !slice.is_lines) draw_lines<Fragments>(bin, slice);
      continue;
    }
    const BinBounds box = box_of(bin, record);
    const std::uint64_t live = seen_tiles<Fragments>(bin, record, box);
    if (live == 0) continue;
    // A batch pays off for medium triangles from the third in a row on; with several samples, where tiles cost more,
    // always.
    const int most_alone = bin.samples > 1 ? 0 : 2;
    const bool is_medium = record.has(Record::kMedium);
    bin.small_run = is_medium ? bin.small_run + 1 : 0;
    if (!is_medium || bin.small_run <= most_alone)
      draw_alone<Fragments>(bin, slice, record, box, live);
    else
      add_medium<Fragments>(bin, slice, record, box);
  }
  draw_batch<Fragments>(bin, slice);
  draw_lines<Fragments>(bin, slice);
}

/// Records that batches do not take, one after the other: under a stencil, where an alpha test decides about a depth, and with
/// several samples those with operations or deferred colours.
template <class Fragments>
HALFPLANE_NOINLINE void draw_records_in_order(Bin& bin, const Slice& slice, const std::uint32_t* first,
                                              const std::uint32_t* last) {
  while (first != last) {
    const Record& record = slice.records[*first];
    fetch_records(slice, first++, last);
    const BinBounds box = box_of(bin, record);
    const std::uint64_t live = seen_tiles<Fragments>(bin, record, box);
    bin.is_back = shows_back(bin, slice, record);
    if (live != 0) draw_alone<Fragments>(bin, slice, record, box, live);
    bin.is_range_old = true;
  }
  bin.is_back = false;
  bin.closed_from = Bin::kOpen;
}

/// Draws records of one slice that are drawn the same way.
HALFPLANE_INLINE void draw_records(Bin& bin, const Slice& slice, const std::uint32_t* first,
                                   const std::uint32_t* last) {
  // Blocks of small triangles with several samples per pixel support no blending and no deferred colours.
  if (bin.samples > 1 && (bin.has_operations || bin.sees_surfaces())) {
    if (bin.state.depth_test == DepthFunc::less)
      return draw_records_in_order<OpaqueFragments<true>>(bin, slice, first, last);
    return draw_records_in_order<OpaqueFragments<false>>(bin, slice, first, last);
  }
  // Two instances: for the most common test, and for any.
  if (bin.state.depth_test == DepthFunc::less)
    draw_records<OpaqueFragments<true>>(bin, slice, first, last);
  else
    draw_records<OpaqueFragments<false>>(bin, slice, first, last);
  // Other tests may let farther depths pass.
  if (bin.state.depth_test != DepthFunc::less) bin.closed_from = Bin::kOpen;
}

/// The result of a draw's operations for one of its primitives, as far as the alpha of its vertices decides it.
enum class RecordWay {
  plain,      ///< a passing fragment replaces the stored values
  laid_over,  ///< only blended by alpha
  killed,     ///< fails the alpha test
  operated,   ///< full operations.inl
  general     ///< lines, one fragment after the other
};

struct RecordWays {
  const Slice& slice;
  const FragmentOps& ops;
  bool tests_alpha, knows_alpha, lays_over, replaces, is_plain;
  bool is_opaque_texel;  ///< alpha is that of a texel, which is opaque

  RecordWays(const Bin& bin, const Slice& of) : slice(of), ops(of.context->fragment_ops) {
    const ColorFormat format = bin.config.color_format;
    tests_alpha = ops.alpha.func != DepthFunc::always;
    // The alpha of a texture is unknown, unless all of its texels are opaque.
    const State& state = of.context->state;
    const bool has_texel_alpha = state.texture && state.texture_combine != TextureCombine::decal &&
                                 has_alpha(of.context->scene.textures[*state.texture].format);
    const bool are_texels_opaque = has_texel_alpha && bin.job.frame.prepared.textures[*state.texture].is_opaque &&
                                   !has_border(state.texture_wrap[0]) && !has_border(state.texture_wrap[1]);
    knows_alpha = !has_texel_alpha || are_texels_opaque;
    is_opaque_texel = are_texels_opaque && state.texture_combine == TextureCombine::replace;
    const ColorOps color = undithered(ops.color, bin.widths.pixel_samples);
    is_plain = !ops.state.color_write || color.is_plain();
    replaces = ops.state.color_write && bin.skip.opaque_blends && replaces_where_opaque(color, format);
    lays_over =
        ops.state.color_write && !of.state.has_surface && are_short_anchors(bin.color_format) && is_over(color, format);
  }

  HALFPLANE_INLINE RecordWay operator()(const Bin& bin, const Record& record) const {
    const RecordKind kind = record.kind();
    const bool is_line = kind == RecordKind::whole_line || kind == RecordKind::cut_line;
    const RecordWay otherwise = is_line ? RecordWay::general : RecordWay::operated;
    if (ops.stencil) return otherwise;
    if (!knows_alpha || kind == RecordKind::cut_line || (is_line && is_opaque_texel))
      return lays_over && !tests_alpha && !is_line ? RecordWay::laid_over : otherwise;
    std::uint32_t low = 255, high = 255;
    if (!is_opaque_texel) {
      high = 0;
      for (const std::uint32_t at : record.v) {
        const std::uint32_t alpha = slice.vertices[slice.state.is_flat ? record.v[flat_corner(kind)] : at].rgba >> 24;
        low = std::min(low, alpha);
        high = std::max(high, alpha);
      }
    }
    const Outcome outcome = !tests_alpha           ? Outcome::all_pass
                            : bin.skip.alpha_tiles ? test_outcome(ops.alpha.func, ops.alpha.reference, low, high)
                                                   : Outcome::some_pass;
    if (outcome == Outcome::none_passes && !is_line) return RecordWay::killed;
    if (outcome != Outcome::all_pass) return otherwise;
    if ((is_plain && tests_alpha) || (replaces && low == 255)) return RecordWay::plain;
    return lays_over && !is_line ? RecordWay::laid_over : otherwise;
  }

 private:
  /// The corner that gives a flat primitive its colour.
  HALFPLANE_INLINE static std::size_t flat_corner(RecordKind kind) { return kind == RecordKind::whole_line ? 2 : 0; }
};

/// Draws records of one slice with operations, as long as their way is the same.
HALFPLANE_NOINLINE void draw_run(Bin& bin, const Slice& slice, RecordWay way, const std::uint32_t* first,
                                 const std::uint32_t* last) {
  const FragmentOps& ops = *bin.ops;
  bin.state = slice.state;
  bin.is_range_old = true;
  if (way == RecordWay::general) return draw_records_general(bin, slice, first, last);
  if (way == RecordWay::plain) {
    bin.state.color_write = ops.state.color_write;
    const std::uint64_t passed = bin.job.counters.depth_passed;
    bin.skip = bin.job.frame.skip;
    draw_records(bin, slice, first, last);
    if (ops.color.blends()) bin.job.counters.skipped.opaque_blends += bin.job.counters.depth_passed - passed;
    return;
  }
  auto& skipped = bin.job.counters.skipped;
  const std::uint64_t behind = skipped.tiles_hiz;
  bin.has_operations = true;
  bin.lays_over = way == RecordWay::laid_over;
  bin.is_killed = way == RecordWay::killed;
  bin.tests_alpha = way == RecordWay::killed || (way == RecordWay::operated && ops.alpha.func != DepthFunc::always);
  bin.tests_stencil = ops.stencil.has_value();
  bin.skip.tiles_hiz =
      bin.job.frame.skip.tiles_hiz && bin.skip.operations_early_z && (!ops.stencil || keeps_where_hidden(*ops.stencil));
  if (bin.tests_alpha) bin.state.depth_write = false;  // depths are written after the alpha test
  const bool reads_alpha_first = bin.tests_alpha && ops.state.depth_write;
  const bool takes_batches =
      bin.lays_over || (way == RecordWay::operated && !bin.tests_stencil && !reads_alpha_first &&
                        ops.state.color_write && bin.skip.attributes && bin.skip.operations_early_z);
  takes_batches ? draw_records(bin, slice, first, last)
                : draw_records_in_order<OpaqueFragments<false>>(bin, slice, first, last);
  skipped.operations_early_z += skipped.tiles_hiz - behind;  // 0 without Skip::operations_early_z
  bin.has_operations = bin.lays_over = bin.is_killed = bin.tests_alpha = bin.tests_stencil = false;
  bin.skip = bin.job.frame.skip;
}

/// The records of a slice with operations.
HALFPLANE_NOINLINE void draw_records_by_way(Bin& bin, const Slice& slice, const std::uint32_t* first,
                                            const std::uint32_t* last) {
  const RecordWays ways(bin, slice);
  while (first != last) {
    const RecordWay way = ways(bin, slice.records[*first]);
    const std::uint32_t* next = first + 1;
    while (next != last && ways(bin, slice.records[*next]) == way) ++next;
    draw_run(bin, slice, way, first, next);
    first = next;
  }
}

/// Dots of one slice.
HALFPLANE_INLINE void draw_dots(Bin& bin, const Slice& slice, std::uint32_t begin, std::uint32_t end) {
  const Dot *const first = slice.dots.data() + begin, *const last = slice.dots.data() + end;
  bin.line_tiles = 0;
  bin.closed_from = Bin::kOpen;
  if (!bin.state.is_opaque) return draw_dots<GeneralFragments>(bin, first, last);
  draw_dots<OpaqueFragments<false>>(bin, first, last);
}

/// Bin::compute_deferred.
HALFPLANE_NOINLINE void compute_deferred_colors(Bin& bin, int tile) {
  const std::int32_t owner = bin.color_owner[tile];
  if (owner == Bin::kLayers) return lay_tile(bin, tile);
  if (owner == Bin::kCutouts) return color_cutouts(bin, tile);
  shade_tile(bin, tile);
}

/// The kernel: a bin, slice after slice.
static void raster(BinJob& job) {
  Bin bin(job, compute_deferred_colors);
  if (!bin.are_lines) fetch_target(bin);
  const auto number = static_cast<std::size_t>(job.bin);
  for (const Slice* const at : job.slices) {
    const Slice& slice = *at;
    const std::uint32_t begin = slice.bin_first[number], end = slice.bin_first[number + 1];
    if (begin == end) continue;
    bin.state = slice.state;
    bin.ops = &slice.context->fragment_ops;
    bin.packing = bin.packing_of(*bin.ops);
    bin.drawn_samples = drawn_samples(slice.context->state) & ((1U << bin.samples) - 1);
    bin.is_range_old = true;
    bin.falls = bin.state.depth_test == DepthFunc::less || bin.state.depth_test == DepthFunc::lequal;
    bin.rises = bin.state.depth_test == DepthFunc::greater || bin.state.depth_test == DepthFunc::gequal;
    if (slice.has_dots) {
      draw_dots(bin, slice, begin, end);
      continue;
    }
    const std::uint32_t *const first = slice.bin_records.data() + begin, *const last = slice.bin_records.data() + end;
    if (bin.state.is_opaque)
      draw_records(bin, slice, first, last);
    else if (job.frame.takes_one_by_one)
      draw_records_general(bin, slice, first, last);
    else
      draw_records_by_way(bin, slice, first, last);
    if (!bin.state.is_opaque) bin.closed_from = Bin::kOpen;
  }
  finish(bin);
}

}  // namespace
}  // namespace halfplane::functional::HALFPLANE_ISA_NAME
