// Large triangles: the 64 tiles of a bin at once, a lane each: outside, hidden, taken whole, or drawn. Bounds of a tile
// have 16 bits: they are conservative. The pixels of a tile, 64 as well, are exact.
#pragma once

#include "bin.inl"
#include "cutouts.inl"
#include "deferred.inl"
#include "fragments.inl"
#include "layers.inl"
#include "operations.inl"
#include "setup.inl"
#include "stencil.inl"
#include "tile_memory.inl"
#include "values.inl"

namespace halfplane::functional::HALFPLANE_ISA_NAME {
namespace {

/// The 64 lanes of a plane: over the pixels of a tile, block by block, or over the tiles of a bin, row by row. The
/// first register is stepped to the others.
enum class Over { pixels, tiles };
template <Over over, class T>
struct Ramp {
  using Lanes = Pack<T, 64>;
  using Register = typename Lanes::Register;
  Register start, by_8, by_16, by_32;  ///< first lane plus offsets within the first register; steps by 8, 16, 32 lanes

  HALFPLANE_INLINE Ramp() = default;
  HALFPLANE_INLINE Ramp(const Bin& bin, T step_x, T step_y) {
    constexpr bool kPixels = over == Over::pixels;
    const S64 &column = kPixels ? bin.position.pixel_x : bin.position.tile_x,
              &row = kPixels ? bin.position.pixel_y : bin.position.tile_y;
    const Register x = Register{} + step_x, y = Register{} + step_y;
    start = (Register)column.part[0] * x + (Register)row.part[0] * y;
    by_8 = kPixels ? y << 1 : y;
    by_16 = kPixels ? x << 2 : y << 1;
    by_32 = y << 2;
  }
  HALFPLANE_INLINE Lanes operator()(T first) const {
    constexpr int kParts = Lanes::kParts;
    Lanes lanes;
    lanes.part[0] = start + first;
    if constexpr (kParts == 8) lanes.part[1] = lanes.part[0] + by_8;
    if constexpr (kParts >= 4) HALFPLANE_EACH_PART(kParts / 4, i, lanes.part[kParts / 4 + i] = lanes.part[i] + by_16)
    HALFPLANE_EACH_PART(kParts / 2, i, lanes.part[kParts / 2 + i] = lanes.part[i] + by_32)
    return lanes;
  }
};

/// The same for wider values, floored to units of 2^fraction; `fraction`: at most 12, so that fifteen fit 16 bits.
template <Over over>
struct LongRamp {
  Ramp<over, std::int16_t> upper;
  Ramp<over, std::uint16_t> lower;
  int fraction;

  HALFPLANE_INLINE LongRamp() = default;
  HALFPLANE_INLINE LongRamp(const Bin& bin, int fraction_, std::int64_t step_x, std::int64_t step_y)
      : fraction(fraction_) {
    upper = Ramp<over, std::int16_t>(bin, upper_of(step_x), upper_of(step_y));
    lower = Ramp<over, std::uint16_t>(bin, lower_of(step_x), lower_of(step_y));
  }
  HALFPLANE_INLINE S64 operator()(std::int64_t first) const {
    return upper(upper_of(first)) + as<S64>(lower(lower_of(first)) >> fraction);
  }
  HALFPLANE_INLINE std::int16_t upper_of(std::int64_t v) const { return static_cast<std::int16_t>(v >> fraction); }
  HALFPLANE_INLINE std::uint16_t lower_of(std::int64_t v) const {
    return static_cast<std::uint16_t>(v & ((1 << fraction) - 1));
  }
};

HALFPLANE_INLINE S64 every_lane(int value) { return S64(static_cast<std::int16_t>(value)); }

/// Codes within 16 bits' reach of `middle`, in [low, high].
struct DepthLanes {
  S64 low, high, middle;  ///< the first two relative to the middle

  HALFPLANE_INLINE DepthLanes(int low_, int high_, int middle_)
      : low(every_lane(low_ - middle_)), high(every_lane(high_ - middle_)), middle(every_lane(middle_)) {}
  /// From distances to the middle.
  HALFPLANE_INLINE U64 clamped(const S64& distance) const { return as<U64>(min(max(distance, low), high) + middle); }
};

/// Words of the three edges; the fourth lane is unused.
using EdgeWords __attribute__((vector_size(16))) = std::int32_t;
HALFPLANE_INLINE EdgeWords load_edges(const std::array<std::int32_t, 4>& from) {
  EdgeWords words;
  std::memcpy(&words, from.data(), sizeof words);
  return words;
}
HALFPLANE_INLINE std::array<std::int32_t, 4> stored(const EdgeWords& words) {
  std::array<std::int32_t, 4> to;
  std::memcpy(to.data(), &words, sizeof words);
  return to;
}
HALFPLANE_INLINE EdgeWords smaller(const EdgeWords& a, const EdgeWords& b) { return a < b ? a : b; }
HALFPLANE_INLINE EdgeWords larger(const EdgeWords& a, const EdgeWords& b) { return a > b ? a : b; }

/// Tiles, a bit each. Either set may be incomplete.
struct TileClasses {
  std::uint64_t outside, full;  ///< no pixel is covered; all are, within the box
};

/// Each edge in units of 2^drop, floored: fifteen steps and a value give an error below 15. `least`, `most`: bounds of
/// the edges' increments from the centre of a pixel to a sample, at most half a step along both axes.
HALFPLANE_INLINE TileClasses classify_tiles(const Bin& bin, const BinTriangle& t, const EdgeWords& least,
                                            const EdgeWords& most) {
  constexpr int kExtent = kTileSize - 1, kStepBits = 7, kFloored = 14, kLimit = 16330,
                kWay = (kBinTiles - 1) * (2 * kTileSize << kStepBits), kReach = (2 * kExtent + 1) << kStepBits;
  static_assert(kLimit > kWay + kReach + kFloored && kLimit + kWay + kReach + kFloored < 1 << 15);
  const EdgeWords zero{}, dx = load_edges(t.dx), dy = load_edges(t.dy);
  const EdgeWords largest = larger(larger(dx, -dx), larger(dy, -dy));
  using Floats __attribute__((vector_size(16))) = float;
  const EdgeWords bits = ((EdgeWords) __builtin_convertvector(largest, Floats) >> 23) - 126;
  const EdgeWords drop = larger(bits - kStepBits, zero);
  const EdgeWords to_largest = (larger(dx, zero) - smaller(dy, zero)) * kExtent + most,
                  to_smallest = (smaller(dx, zero) - larger(dy, zero)) * kExtent + least;
  const EdgeWords limit = zero + kLimit;
  const EdgeWords first = larger(smaller(load_edges(t.edge) >> drop, limit), -limit);
  const EdgeWords outer = ((to_largest + (1 << drop) - 1) >> drop) + ((drop != 0) & kFloored);
  const auto step_x = stored((-kTileSize * dy) >> drop), step_y = stored((kTileSize * dx) >> drop),
             outermost = stored(first + outer), inner = stored((to_smallest >> drop) - outer);
  S64 outside(0), cut(0);  // signs
  for (std::size_t e = 0; e < 3; ++e) {
    const auto narrow = [e](const auto& words) HALFPLANE_LAMBDA { return static_cast<std::int16_t>(words[e]); };
    const S64 value = Ramp<Over::tiles, std::int16_t>(bin, narrow(step_x), narrow(step_y))(narrow(outermost));
    outside |= value;
    cut |= value + narrow(inner);
  }
  return {bits_of(outside), ~bits_of(cut)};
}

/// Ranges of a triangle's depths in its tiles: the plane at their anchors, held in lanes as the distance to the middle
/// of the vertices' depths, plus the offsets to the lowest and the highest.
struct TileDepths {
  bool is_known;  ///< otherwise bounds are the range of the vertices
  std::int32_t first, last, middle, to_low, to_high;
  S64 anchor;

  /// Up to twelve fraction bits are kept, for fifteen floored numbers.
  HALFPLANE_INLINE TileDepths(const Bin& bin, const BinTriangle& t) : is_known(t.is_gentle) {
    const int dropped = bin.range_bits_dropped;
    first = t.z_low >> dropped;
    last = t.z_high >> dropped;
    middle = (first + last) >> 1;
    const int fraction = bin.widths.plane_fraction + dropped, kept = std::min(fraction, 12), down = fraction - kept;
    const std::int64_t zero = std::int64_t{(bin.depth_format.bias >> dropped) + middle} << kept;
    anchor = LongRamp<Over::tiles>(bin, kept, t.z_tile_x >> down, t.z_tile_y >> down)((t.z_anchor >> down) - zero);
    // The anchor's fraction, and its floored part, may carry into the bits that to_high has floored.
    const int tile_fraction = bin.depth_format.down - bin.depth_format.up + dropped;
    to_low = t.to_low;
    to_high = t.to_high + (down > 0 && (15 << tile_fraction) >= 1 << kept ? 2 : 1);
  }
  HALFPLANE_INLINE U64 low() const { return is_known ? at(to_low) : U64(static_cast<std::uint16_t>(first)); }
  HALFPLANE_INLINE U64 high() const { return is_known ? at(to_high) : U64(static_cast<std::uint16_t>(last)); }
  HALFPLANE_INLINE U64 at(std::int32_t offset) const {
    return DepthLanes(first, last, middle).clamped(anchor + every_lane(offset));
  }
};

/// Replaces the lanes that are set in a mask.
template <class Element, class Lanes>
HALFPLANE_INLINE void replace(const S64& where, const Lanes& with, Element* at) {
  select(where, with, Lanes::load(at)).store(at);
}

/// Stores depths of tiles that the triangle takes whole. Returns its number among the pending triangles.
HALFPLANE_INLINE S64 take_depths(Bin& bin, const BinTriangle& t, const S64& is_taken, const TileDepths& depths) {
  if (bin.plane_count == BinMemory::kPlanes) drop_planes(bin);
  const S64 plane(static_cast<std::int16_t>(bin.plane_count));
  bin.memory.planes[bin.plane_count++] = t;
  if (bin.state.depth_write) {
    replace(is_taken, plane, bin.depth_owner.data());
    replace(is_taken, depths.low(), bin.tile_low);
    replace(is_taken, depths.high(), bin.tile_high);
  }
  return plane;
}

/// Takes tiles, with their colours.
HALFPLANE_INLINE void take_tiles(Bin& bin, const BinTriangle& t, std::uint64_t taken, const TileDepths& depths) {
  const S64 is_taken = lanes_of(taken), plane = take_depths(bin, t, is_taken, depths);
  bin.in_memory &= ~taken;
  const auto tiles = static_cast<unsigned>(std::popcount(taken));
  if (bin.state.color_write) {
    const std::uint64_t unused = taken & ~bits_of(S64::load(bin.color_owner.data()));
    bin.job.counters.skipped.attributes += kTilePixels * static_cast<unsigned>(std::popcount(unused));
    if (bin.layer_count != 0) drop_layers(bin, taken & layered_tiles(bin));
    replace(is_taken, plane, bin.color_owner.data());
    bin.split &= ~taken;
  }
  bin.job.counters.skipped.trivially_accepted += tiles;
  const std::uint64_t fragments = 64 * std::uint64_t{tiles} * bin.samples;
  count_fragments(bin, fragments, fragments);
}

/// Constants of a triangle over its tiles. Copies: the compiler must assume that stores change the originals.
struct TileConstants {
  EdgeWords edge, tile_dx, tile_dy, to_smallest, below;  ///< `below`: less than the largest value can become
  bool is_steep, is_whole, is_narrow;
  std::int32_t z_low, z_high, middle;
  std::int32_t z_first;  ///< from a tile's anchor to its first pixel, and from codes to the middle: in a tile's units
  std::array<Ramp<Over::pixels, std::int16_t>, 3> edges;
  std::array<LongRamp<Over::pixels>, 3> steep_edges;
  LongRamp<Over::pixels> depth;

  HALFPLANE_INLINE TileConstants(const Bin& bin, const BinTriangle& t)
      : edge(load_edges(t.edge)),
        is_steep(t.is_steep),
        is_whole(t.is_whole),
        is_narrow(t.is_narrow),
        z_low(t.z_low),
        z_high(t.z_high),
        middle((t.z_low + t.z_high) >> 1) {
    constexpr int kExtent = kTileSize - 1, kSteepFraction = 12;
    const EdgeWords zero{}, dx = load_edges(t.dx), dy = load_edges(t.dy);
    tile_dx = dx * kTileSize;
    tile_dy = dy * kTileSize;
    to_smallest = (smaller(dx, zero) - larger(dy, zero)) * kExtent;
    below = ~((larger(dx, -dx) + larger(dy, -dy)) * kExtent);
    if (is_steep)
      for (std::size_t e = 0; e < 3; ++e) steep_edges[e] = {bin, kSteepFraction, -t.dy[e], t.dx[e]};
    else
      for (std::size_t e = 0; e < 3; ++e)
        edges[e] = {bin, static_cast<std::int16_t>(-t.dy[e]), static_cast<std::int16_t>(t.dx[e])};
    const LaneFormat& format = bin.depth_format;
    const std::int32_t step_x = t.z_step_x >> format.up, step_y = t.z_step_y >> format.up;
    depth = {bin, format.down - format.up, step_x, step_y};
    z_first = -kTileSize / 2 * (step_x + step_y) - ((format.bias + middle) << depth.fraction);
  }
};

/// The pixels of a tile outside an edge, as signs. The distance of an edge's smallest value below its span, or above 0,
/// is common to all pixels: 16 bits hold the rest, for steep edges without the lowest bits. `moved`: the edges'
/// increments from the centre of a pixel to the tested place.
HALFPLANE_INLINE S64 outside_edges(const TileConstants& t, int tile_x, int tile_y, const EdgeWords& moved) {
  const EdgeWords at_tile = t.edge + moved + (tile_y * t.tile_dx - tile_x * t.tile_dy);
  const auto first = stored(smaller(larger(at_tile + t.to_smallest, t.below), EdgeWords{}) - t.to_smallest);
  if (t.is_steep) return t.steep_edges[0](first[0]) | t.steep_edges[1](first[1]) | t.steep_edges[2](first[2]);
  const auto narrow = [&first](std::size_t e) HALFPLANE_LAMBDA { return static_cast<std::int16_t>(first[e]); };
  return t.edges[0](narrow(0)) | t.edges[1](narrow(1)) | t.edges[2](narrow(2));
}

/// The pixels of a tile outside the triangle's box.
HALFPLANE_INLINE S64 outside_box(const Bin& bin, const BinBounds& box, int tile_x, int tile_y) {
  const auto lanes = [](int at, int tile) HALFPLANE_LAMBDA { return every_lane(at - tile * kTileSize); };
  const S64 &x = bin.position.pixel_x, &y = bin.position.pixel_y;
  return (x - lanes(box.left, tile_x)) | (lanes(box.right, tile_x) - x) | (y - lanes(box.top, tile_y)) |
         (lanes(box.bottom, tile_y) - y);
}

/// Depths of a tile after the test, and the pixels that passed.
struct TestedTile {
  U64 now;
  std::uint64_t passed;
};

/// Depth test of 64 pixels or samples with codes of 16 bits.
template <class Fragments>
HALFPLANE_INLINE TestedTile tested(const SliceState& state, const U64& depth, const S64& outside, const U64& stored) {
  if constexpr (Fragments::kIsLess) {
    const U64 now = min(depth | as<U64>(outside), stored);  // `outside` is a mask
    return {now, ~bits_equal(now, stored)};
  } else {
    const S64 passes = ~outside & Fragments::passes(state, depth, stored);
    return {select(passes, depth, stored), bits_of(passes)};
  }
}

/// The same for those whose bits are set.
template <class Fragments>
HALFPLANE_INLINE TestedTile tested_by_bits(const SliceState& state, const U64& depth, std::uint64_t covered,
                                           const U64& stored) {
#if HALFPLANE_ISA == 512
  if constexpr (Fragments::kIsLess) {
    U64 now;
    std::uint64_t passed = 0;
    for (int i = 0; i < 2; ++i) {
      const auto code = (__m512i)depth.part[i], old = (__m512i)stored.part[i];
      const __mmask32 passes = _mm512_mask_cmplt_epu16_mask(static_cast<__mmask32>(covered >> 32 * i), code, old);
      now.part[i] = (U64::Register)_mm512_mask_mov_epi16(old, passes, code);
      passed |= std::uint64_t{passes} << 32 * i;
    }
    return {now, passed};
  }
#endif
  return tested<Fragments>(state, depth, ~lanes_of(covered), stored);
}

/// The same in memory, or in a cleared tile. Returns the pixels that passed.
template <class Fragments>
HALFPLANE_INLINE std::uint64_t test_narrow(Bin& bin, const TileConstants& t, int tile, std::int32_t anchor,
                                           const S64& outside) {
  if (bin.depth_owner[tile] != Bin::kCleared) need_depth(bin, tile);
  std::uint16_t* const at = bin.memory.narrow_depth.data() + first_of(tile);
  const U64 stored = U64::load(bin.depth_owner[tile] == Bin::kCleared ? bin.cleared_depths.data() : at);
  const U64 depth =
      DepthLanes(t.z_low, t.z_high, t.middle).clamped(t.depth((anchor >> bin.depth_format.up) + t.z_first));
  const auto [now, passed] = tested<Fragments>(bin.state, depth, outside, stored);
  if (passed == 0 || !bin.state.depth_write) return passed;
  now.store(at);
  bin.depth_owner[tile] = Bin::kInMemory;
  bin.tile_low[tile] = static_cast<std::uint16_t>(min_lane(now));
  bin.tile_high[tile] = static_cast<std::uint16_t>(max_lane(now));
  return passed;
}

/// The same with depths in lanes of 32 bits, block by block.
template <class Fragments>
HALFPLANE_INLINE std::uint64_t test_wide(Bin& bin, const BinTriangle& t, int tile, std::int32_t anchor,
                                         std::uint64_t covered) {
  const BlockRamp<I16> plane = depth_ramp(bin, t, anchor);
  // Copies: the compiler must assume that stores change the members.
  const LaneFormat format = bin.depth_format;
  const I16 z_low(t.z_low), z_high(t.z_high);
  const bool has_depth = bin.state.depth_write;
  const auto first = static_cast<std::size_t>(first_of(tile));
  std::uint64_t passed = 0;
  I16 lowest(0x7fffffff), highest(0);
  for_each_block([&](auto block) HALFPLANE_LAMBDA {
    const std::size_t at = first + block * kBlockPixels;
    const I16 stored = load_depths(bin, at), depth = decode(plane(block), format, z_low, z_high);
    const I16 is_covered = I16(static_cast<std::int32_t>(block_bits(covered, block))) << bin.position.to_sign;
    const I16 passes = is_covered & Fragments::passes(bin.state, depth, stored);
    const I16 now = select_by_sign(passes, depth, stored);
    passed |= std::uint64_t{bits_of(passes)} << (kBlockPixels * block);
    lowest = min(lowest, now);
    highest = max(highest, now);
    if (has_depth) store_depths(bin, at, now);
  });
  if (has_depth && passed != 0) set_range(bin, tile, min_lane(lowest), max_lane(highest));
  return passed;
}

/// Colours of the pixels that passed, in blocks with such a pixel; without Skip::fragments_early_z in all. `anchor`:
/// the tile's.
HALFPLANE_INLINE void color_tile(Bin& bin, const BinTriangle& t, int tile, const ChannelPairs& anchor,
                                 std::uint64_t passed) {
  const bool is_cleared = bin.color_owner[tile] == Bin::kCleared;
  if (is_cleared)
    bin.color_owner[tile] = Bin::kInMemory;
  else
    need_color(bin, tile);
  const ColorRamp plane = color_ramp(bin, t.color, anchor);
  std::uint32_t* const pixels = bin.memory.color.data() + first_of(tile);
  const ColorSteps steps = t.color;
  const LaneFormat format = bin.color_format;
  const Packing packing = t.packing;
  const bool skips = bin.skip.fragments_early_z;
  for_each_block([&](auto block) HALFPLANE_LAMBDA {
    std::uint32_t* const at = pixels + block * kBlockPixels;
    const I16 stored = I16::load(is_cleared ? bin.cleared_colors.data() : at);
    if (block_bits(passed, block) == 0 && skips) {
      if (is_cleared) stored.store(at);
      return;
    }
    const I16 color = block_colors(steps, plane, block, format, packing);
    select_by_bits(block_bits(passed, block), color, stored, bin.position.to_sign).store(at);
  });
}

/// Pixel counts of a triangle in tiles.
struct PixelCounts {
  std::uint64_t covered = 0, passed = 0;
};

/// Draws the part of a triangle in one tile. `is_in_front`: the triangle covers the tile, all of it passes, and depths
/// are not written.
template <class Fragments>
HALFPLANE_INLINE void draw_tile(Bin& bin, const BinTriangle& t, const TileConstants& constants, int tile, bool is_full,
                                bool is_in_front, PixelCounts& pixels) {
  if (is_in_front) {
    operate_on_tile(bin, t, tile, ~std::uint64_t{0});
    pixels.covered += kTilePixels;
    pixels.passed += kTilePixels;
    return;
  }
  const int tile_x = tile % kBinTiles, tile_y = tile / kBinTiles;
  S64 outside(0);
  if (!is_full) outside = outside_edges(constants, tile_x, tile_y, EdgeWords{});
  if (!constants.is_whole) outside |= outside_box(bin, t.box, tile_x, tile_y);
  const std::uint64_t covered = ~bits_of(outside);
  if (covered == 0) return;
  pixels.covered += static_cast<unsigned>(std::popcount(covered));
  if (bin.tests_stencil) {
    pixels.passed += static_cast<unsigned>(std::popcount(draw_tile_by_stencil(bin, t, tile, covered)));
    return;
  }
  if (!constants.is_narrow) need_depth(bin, tile);
  const std::int32_t anchor = depth_anchor(bin, t, tile_x, tile_y);
  const std::uint64_t passed = constants.is_narrow ? test_narrow<Fragments>(bin, constants, tile, anchor, outside >> 15)
                                                   : test_wide<Fragments>(bin, t, tile, anchor, covered);
  if (bin.has_operations) {
    operate_on_tile(bin, t, tile, passed);
  } else if (t.surface != 0) {
    if (passed != 0) see(bin, t.surface, tile, passed);
  } else if (bin.state.color_write && (passed != 0 || !bin.skip.fragments_early_z)) {
    color_tile(bin, t, tile, color_anchor(bin, t, tile_x, tile_y), passed);
  }
  pixels.passed += static_cast<unsigned>(std::popcount(passed));
}

/// `full`: tiles that need no edge test; `in_front`: no depth test either.
template <class Fragments>
HALFPLANE_NOINLINE void draw_tiles(Bin& bin, const BinTriangle& t, std::uint64_t tiles, std::uint64_t full,
                                   std::uint64_t in_front) {
  const TileConstants constants(bin, t);
  PixelCounts pixels;
  const auto full_tiles = static_cast<unsigned>(std::popcount(tiles & full)),
             cut_tiles = static_cast<unsigned>(std::popcount(tiles & ~full));
  for (; tiles != 0; tiles &= tiles - 1) {
    const int tile = std::countr_zero(tiles);
    draw_tile<Fragments>(bin, t, constants, tile, (full >> tile & 1) != 0, (in_front >> tile & 1) != 0, pixels);
  }
  bin.job.counters.skipped.trivially_accepted += full_tiles;
  bin.job.counters.samples_tested += kTilePixels * cut_tiles;
  count_fragments(bin, pixels.covered, pixels.passed);
}

/// A triangle with one sample per pixel: no increments.
struct OneSample {
  HALFPLANE_INLINE explicit OneSample(const Bin& /*bin*/) {}
  HALFPLANE_INLINE void move_edges(const Bin&, const Corners&, const BinTriangle&) {}
  HALFPLANE_INLINE void move_depths(const Bin&, BinTriangle&) {}
  HALFPLANE_INLINE static EdgeWords least() { return EdgeWords{}; }
  HALFPLANE_INLINE static EdgeWords most() { return EdgeWords{}; }
  HALFPLANE_INLINE static std::size_t surfaces() { return 1; }  ///< at most
  /// Tiles that may be taken whole, and tiles that may be drawn without a look at single samples.
  HALFPLANE_INLINE static std::uint64_t takeable() { return ~std::uint64_t{0}; }
  HALFPLANE_INLINE static std::uint64_t as_one(const Bin&) { return ~std::uint64_t{0}; }
  template <class Fragments>
  HALFPLANE_INLINE static void draw(Bin& bin, const Slice&, const Record&, const BinTriangle& t, const TileDepths&,
                                    std::uint64_t tiles, std::uint64_t full, std::uint64_t in_front) {
    draw_tiles<Fragments>(bin, t, tiles, full, in_front);
  }
};

/// Removes tiles from a set, and counts the reason.
HALFPLANE_INLINE void take_out(std::uint64_t& live, std::uint64_t out, std::uint64_t& counter) {
  counter += static_cast<unsigned>(std::popcount(live & out));
  live &= ~out;
}

/// Draws a triangle or rectangle alone. Among its `live` tiles, tiles outside its edges are rejected first, then hidden
/// ones: depths are set up for the rest, then colours.
template <class Fragments, class Samples>
HALFPLANE_INLINE void draw_large(Bin& bin, const Slice& slice, const Record& record, std::uint64_t live,
                                 BinTriangle& t) {
  const bool is_flat = record.kind() == RecordKind::rectangle;
  auto& skipped = bin.job.counters.skipped;
  Corners corners;
  Samples samples(bin);
  if (is_flat) {
    set_up_flat(bin, slice.vertices[record.v[0]], t);
  } else {
    if (!find_corners(slice, record, corners)) return;
    set_up_edges(bin, *corners.a, *corners.b, *corners.c, t);
    samples.move_edges(bin, corners, t);
  }
  const TileClasses tiles = classify_tiles(bin, t, samples.least(), samples.most());
  if (bin.skip.tiles_outside) take_out(live, tiles.outside, skipped.tiles_outside);
  if (live == 0) return;
  if (!is_flat) {
    set_up_planes(bin, record, corners, t);
    samples.move_depths(bin, t);
  }
  const TileDepths depths(bin, t);
  if (bin.skip.tiles_hiz) take_out(live, Fragments::tiles_behind(bin, depths), skipped.tiles_hiz);
  if (live == 0) return;
  t.surface = 0;
  if (bin.is_killed) {
    // No colour is needed.
  } else if (bin.sees_surfaces() || (bin.has_operations && bin.state.has_surface)) {
    need_surfaces(bin, samples.surfaces());
    t.surface = add_surface(bin, slice, record);
  } else if (!is_flat && (bin.state.color_write || bin.has_operations)) {
    set_up_colors(bin, corners, t);
  }
  std::uint64_t full = 0, taken = 0, in_front = 0;
  if (bin.skip.trivially_accepted) full = live & tiles.full & (t.is_whole ? ~std::uint64_t{0} : tiles_inside(t.box));
  if (full != 0 && bin.skip.attributes && !bin.has_operations && (bin.state.depth_write || bin.state.color_write))
    taken = full & samples.takeable() & Fragments::tiles_in_front(bin, depths);
  if (full != 0 && bin.has_operations && !bin.tests_stencil && (!bin.tests_alpha || bin.is_killed)) {
    in_front = full & samples.as_one(bin) & Fragments::tiles_in_front(bin, depths);
    if (in_front != 0 && bin.lays_over && t.surface == 0 && bin.skip.attributes) {
      add_layer(bin, t, in_front);
      if (bin.state.depth_write) (void)take_depths(bin, t, lanes_of(in_front), depths);
      live &= ~in_front;
    }
    if (bin.state.depth_write) in_front = 0;  // pixel by pixel
  }
  if (taken != 0) take_tiles(bin, t, taken, depths);
  if ((live & ~taken) != 0)
    samples.template draw<Fragments>(bin, slice, record, t, depths, live & ~taken, full, in_front);
  if (bin.state.depth_write) bin.is_range_old = true;
}

}  // namespace
}  // namespace halfplane::functional::HALFPLANE_ISA_NAME
