// Large triangles with several samples per pixel: depths are kept per sample, colours per pixel while all its samples
// have the same one. A tile in which they differ is split, into an image for each sample; a tile that a triangle fully
// covers is whole again. So a tile far from edges costs as much as with one sample: the depths of a triangle that owns
// it are computed when needed, at the sample in question. In a tile cut by its edges a triangle is kept as a cutout:
// cutouts.inl.
//
// An edge at a sample is the edge at the centre plus a constant, and so is a depth (multisample.hpp).
#pragma once

#include "bin.inl"
#include "cutouts.inl"
#include "deferred.inl"
#include "fragments.inl"
#include "operations.inl"
#include "setup.inl"
#include "surface.inl"
#include "texture.inl"
#include "tile_memory.inl"
#include "tiles.inl"
#include "values.inl"

namespace halfplane::functional::HALFPLANE_ISA_NAME {
namespace {

/// From the centre of a pixel to each sample: the increments of a triangle's edges (in the order of BinTriangle) and
/// depths.
struct SeveralSamples {
  std::array<EdgeWords, kMaxPixelSamples> edge;
  std::array<std::int32_t, kMaxPixelSamples> depth;  ///< in a lane
  EdgeWords edge_least, edge_most;                   ///< bounds of the edges, including 0 at the centre
  std::uint32_t drawn;                               ///< samples that the draw's sample mask lets pass, a bit each
  bool draws_all;

  HALFPLANE_INLINE explicit SeveralSamples(const Bin& bin) : drawn(bin.drawn_samples) {
    const EdgeWords zero{};
    for (EdgeWords& one : edge) one = zero;
    depth.fill(0);
    edge_least = edge_most = zero;
    draws_all = drawn == (1U << bin.samples) - 1;
  }

  /// sample_edge_offset() of the three edges. Their dropped bits are the same at every pixel's centre.
  HALFPLANE_INLINE void move_edges(const Bin& bin, const Corners& corners, const BinTriangle& t) {
    using Unsigned __attribute__((vector_size(16))) = std::uint32_t;
    const int s = bin.widths.grid_bits;
    const auto half = static_cast<std::uint32_t>(1 << (s - 1));
    const EdgeWords x{corners.a->x, corners.b->x, corners.c->x, 0}, y{corners.a->y, corners.b->y, corners.c->y, 0};
    const EdgeWords dx = load_edges(t.dx), dy = load_edges(t.dy);
    const Unsigned exact =
        cross((Unsigned)dx, (Unsigned)dy, half - (Unsigned)x, half - (Unsigned)y) + (Unsigned)~is_top_left(dx, dy);
    const auto low = (EdgeWords)(exact & ((1U << s) - 1));
    for (std::size_t k = 0; k < bin.samples; ++k) {
      const SampleOffset& o = bin.widths.sample_offset[k];
      edge[k] = (low - dy * o.x + dx * o.y) >> s;
      edge_least = smaller(edge_least, edge[k]);
      edge_most = larger(edge_most, edge[k]);
    }
  }

  HALFPLANE_INLINE void move_depths(const Bin& bin, BinTriangle& t) {
    std::int64_t least = 0, most = 0;
    for (unsigned k = 0; k < bin.samples; ++k) {
      const std::int64_t gain = depth_to_sample(bin, t, k);
      depth[k] = static_cast<std::int32_t>(static_cast<std::uint32_t>(gain) << bin.depth_format.up);
      least = std::min(least, gain);
      most = std::max(most, gain);
    }
    const int s = bin.widths.grid_bits, drop = bin.depth_format.step_drop;
    find_reach(bin, round_shift(t.z_tile_x >> (kTileShift + s), drop),
               round_shift(t.z_tile_y >> (kTileShift + s), drop), t, least, most);
  }

  HALFPLANE_INLINE const EdgeWords& least() const { return edge_least; }
  HALFPLANE_INLINE const EdgeWords& most() const { return edge_most; }
  HALFPLANE_INLINE static std::size_t surfaces() { return 1 + kMaxPixelSamples; }
  HALFPLANE_INLINE std::uint64_t takeable() const { return draws_all ? ~std::uint64_t{0} : 0; }
  HALFPLANE_INLINE std::uint64_t as_one(const Bin& bin) const {
    if (!draws_all) return 0;
    const std::uint64_t is_far = bits_of(S64::load(bin.color_owner.data()) == Bin::kInTarget);
    return ~(bin.split | is_far);
  }
  template <class Fragments>
  HALFPLANE_INLINE void draw(Bin& bin, const Slice& slice, const Record& record, const BinTriangle& t,
                             const TileDepths& depths, std::uint64_t tiles, std::uint64_t full,
                             std::uint64_t in_front) const;
};

/// The colours of a tile's pixels, packed or, with 8 bits a channel, before packing.
struct PixelColors {
  alignas(64) std::array<std::uint32_t, kTilePixels> code{};

  HALFPLANE_INLINE ColorPairs operator[](std::size_t block) const {
    return ColorPairs(I16::load(code.data() + block * kBlockPixels));
  }
};

/// Depths of a block's pixels at four samples: a LongRamp over block and samples.
struct FourSamples {
  S64 upper;
  U64 lower;

  HALFPLANE_INLINE FourSamples() = default;
  /// Steps and increments to the samples in units of the ramp.
  HALFPLANE_INLINE void set(const Bin& bin, const LongRamp<Over::pixels>& ramp, std::int32_t step_x,
                            std::int32_t step_y, const std::array<std::int32_t, 4>& gain) {
    std::array<std::int16_t, 4> gain_upper, gain_lower;
    for (std::size_t k = 0; k < 4; ++k) {
      gain_upper[k] = ramp.upper_of(gain[k]);
      gain_lower[k] = static_cast<std::int16_t>(ramp.lower_of(gain[k]));
    }
    const S64 &x = bin.position.samples_x, &y = bin.position.samples_y;
    upper = x * ramp.upper_of(step_x) + y * ramp.upper_of(step_y) + four_blocks(gain_upper);
    lower = as<U64>(x) * ramp.lower_of(step_x) + as<U64>(y) * ramp.lower_of(step_y) + as<U64>(four_blocks(gain_lower));
  }
  HALFPLANE_INLINE S64 operator()(const LongRamp<Over::pixels>& ramp, std::int32_t first) const {
    return upper + ramp.upper_of(first) + as<S64>((lower + ramp.lower_of(first)) >> ramp.fraction);
  }
};

/// One triangle in its tiles. `kSamples`: how many a pixel has, or 0, if Bin::samples gives the number.
template <unsigned kSamples>
struct SampledTriangle {
  Bin& bin;
  const Slice& slice;
  const Record& record;
  const BinTriangle& t;
  const SeveralSamples& at;
  const TileConstants constants;
  SampledColors<kSamples> planes;
  std::array<std::int32_t, kMaxPixelSamples> surface{};  ///< surface number by shading sample; 0: none yet
  FourSamples
      depth_of_four[(kSamples != 0 ? kSamples : kMaxPixelSamples) / 4];  ///< if is_narrow; as TileCutouts::cutout
  bool can_wait;                                                         ///< its colours may be deferred
  std::int16_t plane_number = -1;                                        ///< into BinMemory::planes, once pending

  HALFPLANE_INLINE SampledTriangle(Bin& bin_, const Slice& slice_, const Record& record_, const BinTriangle& t_,
                                   const SeveralSamples& at_)
      : bin(bin_), slice(slice_), record(record_), t(t_), at(at_), constants(bin_, t_), planes(bin_, t_) {
    const int up = bin.depth_format.up;
    if (constants.is_narrow)
      for (unsigned k = 0; k + 4 <= count(); k += 4) {
        const auto gain = [&](unsigned i) HALFPLANE_LAMBDA { return at.depth[k + i] >> up; };
        depth_of_four[k / 4].set(bin, constants.depth, t.z_step_x >> up, t.z_step_y >> up,
                                 {gain(0), gain(1), gain(2), gain(3)});
      }
    can_wait = bin.state.color_write && bin.skip.attributes && !bin.has_operations && t.surface == 0;
  }

  HALFPLANE_INLINE unsigned count() const { return samples_of<kSamples>(bin); }

  /// Edge values at the first pixel of a tile, at the centre and then at each sample; less than the limit is outside.
  /// The same test as in outside_edges().
  using FirstValues = std::array<std::array<std::int32_t, 4>, 1 + kMaxPixelSamples>;
  HALFPLANE_INLINE FirstValues first_values(const EdgeWords& smallest) const {
    FirstValues first;
    const auto at_place = [&](const EdgeWords& value) HALFPLANE_LAMBDA {
      return stored(smaller(larger(value, constants.below), EdgeWords{}) - constants.to_smallest);
    };
    first[0] = at_place(smallest);
    for (unsigned k = 0; k < count(); ++k) first[1 + k] = at_place(smallest + at.edge[k]);
    return first;
  }

  /// Removes the pixels outside an edge from the coverage.
  HALFPLANE_INLINE void leave_out(std::size_t e, const FirstValues& first, SamplePixels& pixels) const {
    const auto each = [&](auto&& outside) HALFPLANE_LAMBDA {
      pixels.centre &= ~outside(first[0][e]);
      for (unsigned k = 0; k < count(); ++k) pixels.covered[k] &= ~outside(first[1 + k][e]);
    };
    if (constants.is_steep)
      return each([&](std::int32_t from) HALFPLANE_LAMBDA { return bits_of(constants.steep_edges[e](from)); });
    const S64 ramp = constants.edges[e](0);
    each([&](std::int32_t from) HALFPLANE_LAMBDA { return bits_at_most(ramp, static_cast<std::int16_t>(~from)); });
  }

  /// False if nothing is covered. Mostly one edge cuts a tile: the others are not evaluated.
  HALFPLANE_INLINE bool cover(int tile, bool is_full, SamplePixels& pixels) const {
    std::uint64_t in_box = ~std::uint64_t{0};
    const int x = tile % kBinTiles, y = tile / kBinTiles;
    if (!is_full && !constants.is_whole) in_box = ~bits_of(outside_box(bin, t.box, x, y));
    pixels.centre = in_box;
    for (unsigned k = 0; k < count(); ++k) pixels.covered[k] = in_box;
    if (is_full) return true;
    const EdgeWords smallest = constants.edge + constants.to_smallest + (y * constants.tile_dx - x * constants.tile_dy);
    const FirstValues first = first_values(smallest);
    const auto at_least = stored(smallest + at.edge_least);
    std::uint32_t cut = 0;  // a bit an edge: a loop over them has fewer mispredicted branches than three tests
    for (std::size_t e = 0; e < 3; ++e) cut |= at_least[e] < 0 ? 1U << e : 0;
    for (; cut != 0; cut &= cut - 1) leave_out(static_cast<std::size_t>(std::countr_zero(cut)), first, pixels);
    std::uint64_t any = 0;
    for (unsigned k = 0; k < count(); ++k) any |= pixels.covered[k];
    return any != 0;
  }

  /// Tests four samples of a block at a time. `anchor`: the depth of the tile's first pixel.
  template <class Fragments>
  HALFPLANE_INLINE void test_by_fours(int tile, std::int32_t anchor, SamplePixels& pixels) const {
    const DepthLanes limits(constants.z_low, constants.z_high, constants.middle);
    const bool writes = bin.state.depth_write;
    const std::int32_t to_right = kBlockSize * (t.z_step_x >> bin.depth_format.up),
                       to_below = kBlockSize * (t.z_step_y >> bin.depth_format.up);
    for (unsigned first = 0; first < count(); first += 4) {
      std::uint64_t any = 0;
      BlocksOfSamples covered, passed{};  // number k, of sample k
      for (unsigned k = 0; k < 4; ++k) {
        covered[k] = (at.drawn >> (first + k) & 1) != 0 ? pixels.covered[first + k] : 0;
        any |= covered[k];
      }
      const BlocksOfSamples of_block = transposed(covered);
      for (std::uint32_t rest = blocks_with(any); rest != 0; rest &= rest - 1) {
        const auto block = static_cast<std::size_t>(std::countr_zero(rest));
        const auto right = static_cast<std::int32_t>(block & 1), below = static_cast<std::int32_t>(block >> 1);
        std::uint16_t* const to =
            bin.sample_memory.narrow_depth.data() + bin.sample_place(first, first_of(tile) + block * kBlockPixels);
        const S64 depth = depth_of_four[first / 4](constants.depth, anchor + right * to_right + below * to_below);
        const TestedTile result =
            tested_by_bits<Fragments>(bin.state, limits.clamped(depth), of_block[block], U64::load(to));
        for (std::size_t k = 0; k < 4; ++k)
          passed[k] |= (result.passed >> (kBlockPixels * k) & 0xffff) << (kBlockPixels * block);
        if (writes) result.now.store(to);
      }
      for (unsigned k = 0; k < 4; ++k) pixels.passed[first + k] = passed[k];
    }
  }

  template <class Fragments>
  HALFPLANE_INLINE void test(int tile, SamplePixels& pixels) const {
    for (unsigned k = 0; k < count(); ++k) pixels.passed[k] = 0;
    if (bin.depth_owner[tile] != Bin::kInMemory) need_sample_depths(bin, tile);
    const std::int32_t anchor = depth_anchor(bin, t, tile % kBinTiles, tile / kBinTiles);
    const bool writes = bin.state.depth_write;
    if (constants.is_narrow && count() % 4 == 0) {
      test_by_fours<Fragments>(tile, (anchor >> bin.depth_format.up) + constants.z_first, pixels);
      pixels.find_any_and_all(count());
      if (writes && pixels.any != 0) find_sample_range(bin, tile);
      return;
    }
    const auto first = static_cast<std::size_t>(first_of(tile));
    for (unsigned k = 0; k < count(); ++k) {
      if ((at.drawn >> k & 1) == 0) continue;
      const BlockRamp<I16> plane = depth_ramp(bin, t, wrapped_sum(anchor, at.depth[k]));
      for_each_block([&](auto block) HALFPLANE_LAMBDA {
        const std::uint32_t covered = block_bits(pixels.covered[k], block);
        if (covered == 0) return;
        const std::size_t place = first + block * kBlockPixels;
        const I16 stored = load_sample(bin, k, place), depths = block_depths(bin, t, plane, block);
        const std::uint32_t passed = covered & bits_of(Fragments::passes(bin.state, depths, stored));
        pixels.passed[k] |= std::uint64_t{passed} << (kBlockPixels * block);
        if (writes) store_sample(bin, k, place, select_by_bits(passed, depths, stored, bin.position.to_sign));
      });
    }
    pixels.find_any_and_all(count());
    if (writes && pixels.any != 0) find_sample_range(bin, tile);
  }

  /// The pixels shaded at sample m, the first that is covered where the centre is not.
  template <class Visit>
  HALFPLANE_INLINE void for_each_place(const SamplePixels& pixels, Visit&& visit) const {
    std::uint64_t rest = pixels.any & ~pixels.centre;
    for (unsigned m = 0; rest != 0 && m < count(); ++m) {
      const std::uint64_t here = rest & pixels.covered[m];
      rest &= ~here;
      if (here != 0) visit(m, here);
    }
  }

  HALFPLANE_INLINE std::int32_t surface_at(unsigned m) {
    if (surface[m] == 0) surface[m] = add_surface(bin, slice, record, static_cast<int>(m));
    return surface[m];
  }
  HALFPLANE_INLINE ChannelPairs anchor_of(int tile) const {
    return color_anchor(bin, t, tile % kBinTiles, tile / kBinTiles);
  }
  HALFPLANE_INLINE ChannelPairs anchor_at(unsigned m, int tile) {
    const ChannelPairs centre = anchor_of(tile), gain = planes.gain_at(m);
    return {sum_of_pairs(centre[0], gain[0]), sum_of_pairs(centre[1], gain[1])};
  }

  /// Finds colours of all pixels with a passed sample, from a surface or from planes.
  HALFPLANE_NOINLINE void find_colors(int tile, const SamplePixels& pixels, ColorFormat format, PixelColors& colors) {
    if (t.surface != 0) {
      const auto set = [&](std::int32_t number, std::uint64_t here) {
        shade(bin, drawn_surface(bin, static_cast<std::size_t>(number)), tile, here, colors.code.data(),
              Packing{format, false});
      };
      if ((pixels.any & pixels.centre) != 0) set(t.surface, pixels.any & pixels.centre);
      return for_each_place(pixels, [&](unsigned m, std::uint64_t here) { set(surface_at(m), here); });
    }
    const ColorRamp plane = color_ramp(bin, t.color, anchor_of(tile));
    for_each_block([&](auto block) HALFPLANE_LAMBDA {
      const std::uint32_t any = block_bits(pixels.any, block);
      if (any != 0)
        planes.of_block(plane, pixels.centre, pixels.covered, block, any, format)
            .store(colors.code.data() + block * kBlockPixels);
    });
  }

  /// Whether the pixels of a tile have one colour each, before and after; a fully covered tile does in any case.
  HALFPLANE_INLINE bool stays_whole(int tile, const SamplePixels& pixels) const {
    const std::uint64_t bit = std::uint64_t{1} << tile;
    if (bin.color_owner[tile] == Bin::kInTarget) need_sample_colors(bin, tile);
    if (pixels.all == ~std::uint64_t{0} && !bin.has_operations) {
      bin.split &= ~bit;
      if (bin.color_owner[tile] == Bin::kCutouts) bin.color_owner[tile] = Bin::kInMemory;  // all of it is written next
    }
    return pixels.any == pixels.all && (bin.split & bit) == 0;
  }

  HALFPLANE_NOINLINE void color(int tile, const SamplePixels& pixels) {
    if (stays_whole(tile, pixels)) {
      const std::uint64_t centre = pixels.any & pixels.centre;
      if (t.surface != 0) {
        if (centre != 0) see(bin, t.surface, tile, centre);
        for_each_place(pixels, [&](unsigned m, std::uint64_t here) { see(bin, surface_at(m), tile, here); });
        return;
      }
      if (centre != 0) color_tile(bin, t, tile, anchor_of(tile), centre);
      for_each_place(pixels,
                     [&](unsigned m, std::uint64_t here) { color_tile(bin, t, tile, anchor_at(m, tile), here); });
      return;
    }
    if (bin.color_owner[tile] != Bin::kInMemory || (bin.split >> tile & 1) == 0) split_tile(bin, tile);
    if (t.surface != 0) {
      PixelColors colors;
      find_colors(tile, pixels, bin.config.color_format, colors);
      for_each_block([&](auto block) HALFPLANE_LAMBDA {
        if (block_bits(pixels.any, block) != 0)
          store_samples<kSamples>(bin, tile, pixels.passed, block,
                                  I16::load(colors.code.data() + block * kBlockPixels));
      });
      return;
    }
    planes.store(tile, pixels.centre, pixels.covered, pixels.passed, pixels.any);
  }

  /// Writes depths of the samples that have passed every test.
  HALFPLANE_INLINE void write_depths(int tile, const SamplePixels& pixels) const {
    if (pixels.any == 0) return;
    const std::int32_t anchor = depth_anchor(bin, t, tile % kBinTiles, tile / kBinTiles);
    for (unsigned k = 0; k < count(); ++k) {
      const BlockRamp<I16> plane = depth_ramp(bin, t, wrapped_sum(anchor, at.depth[k]));
      for_each_block([&](auto block) HALFPLANE_LAMBDA {
        const std::size_t place = static_cast<std::size_t>(first_of(tile)) + block * kBlockPixels;
        store_sample(bin, k, place,
                     select_by_bits(block_bits(pixels.passed[k], block), block_depths(bin, t, plane, block),
                                    load_sample(bin, k, place), bin.position.to_sign));
      });
    }
    find_sample_range(bin, tile);
  }

  /// operate_on_tile() for samples.
  HALFPLANE_NOINLINE void operate(int tile, SamplePixels& pixels) {
    const FragmentOps& ops = *bin.ops;
    const auto passed_samples = [&] {
      unsigned sum = 0;
      for (unsigned k = 0; k < count(); ++k) sum += static_cast<unsigned>(std::popcount(pixels.passed[k]));
      return sum;
    };
    if (bin.is_killed) return count_killed(bin, passed_samples());
    if (!bin.tests_alpha && !ops.state.color_write) return;
    if (!bin.tests_alpha && stays_whole(tile, pixels) && (pixels.any & ~pixels.centre) == 0)
      return operate_on_tile(bin, t, tile, pixels.any);
    PixelColors colors;
    find_colors(tile, pixels, ColorFormat::rgba8888, colors);
    if (bin.tests_alpha) {
      const std::uint64_t kept = test_alpha(bin, pixels.any, colors);
      const unsigned before = passed_samples();
      for (unsigned k = 0; k < count(); ++k) pixels.passed[k] &= kept;
      pixels.find_any_and_all(count());
      count_killed(bin, before - passed_samples());
      if (ops.state.depth_write) write_depths(tile, pixels);
    }
    if (!ops.state.color_write || pixels.any == 0) return;
    if (stays_whole(tile, pixels)) {
      need_color(bin, tile);
      return store_colors(bin, bin.memory.color.data() + first_of(tile), pixels.any, colors);
    }
    split_tile(bin, tile);
    for (unsigned k = 0; k < count(); ++k)
      if (pixels.passed[k] != 0)
        store_colors(bin, bin.sample_memory.color.data() + bin.sample_place(k, first_of(tile)), pixels.passed[k],
                     colors, bin.samples * kBlockPixels);
  }

  /// Its number among the pending triangles.
  HALFPLANE_INLINE std::int16_t plane() {
    if (plane_number < 0) plane_number = add_plane(bin, t);
    return plane_number;
  }

  /// Whether the colours of the passed samples are deferred.
  HALFPLANE_INLINE bool waits(int tile, const SamplePixels& pixels) const {
    if (!can_wait || !may_wait(tile) || pixels.all == ~std::uint64_t{0}) return false;
    return pixels.any != pixels.all || (bin.split >> tile & 1) != 0;
  }

  /// Whether a cutout is deferred in a tile: not where samples have been stored one by one, as others will be, nor
  /// where cutouts are usually needed before others hide them.
  HALFPLANE_INLINE bool may_wait(int tile) const {
    return bin.color_owner[tile] == Bin::kCutouts || (bin.cutouts_saved > 0 && (bin.split >> tile & 1) == 0);
  }

  /// Samples that pass, where ranges of depths decide: no depth is computed, and the cutout's depths are deferred too.
  template <class Fragments>
  HALFPLANE_INLINE bool passes_by_ranges_alone(int tile, bool is_ahead, const CutoutRange& range,
                                               SamplePixels& pixels) const {
    const bool asks_cutouts = Fragments::kIsLess && can_wait && bin.depth_owner[tile] == Bin::kCutouts;
    if (!asks_cutouts && (!is_ahead || !may_wait(tile))) return false;
    for (unsigned k = 0; k < count(); ++k) pixels.passed[k] = (at.drawn >> k & 1) != 0 ? pixels.covered[k] : 0;
    return is_ahead || passes_by_ranges<kSamples>(bin, tile, range, pixels);
  }

  /// Adds the passed samples as a cutout with deferred depths.
  HALFPLANE_INLINE void wait_with_depths(int tile, const SamplePixels& pixels, const CutoutRange& range) {
    if (!bin.state.depth_write) return add_cutout<kSamples>(bin, tile, plane(), pixels, nullptr);
    if ((pixels.all & pixels.centre) != ~std::uint64_t{0})
      return add_cutout<kSamples>(bin, tile, plane(), pixels, &range);
    const std::uint64_t bit = std::uint64_t{1} << tile;
    bin.depth_owner[tile] = bin.color_owner[tile] = plane();
    bin.split &= ~bit;
    bin.in_memory &= ~bit;
    bin.tile_low[tile] = range.low;
    bin.tile_high[tile] = range.high;
  }

  template <class Fragments>
  HALFPLANE_INLINE void draw(int tile, bool is_full, bool is_ahead, const TileBounds& bounds, PixelCounts& counts) {
    SamplePixels pixels;
    if (!cover(tile, is_full, pixels)) return;
    const auto at_tile = static_cast<std::size_t>(tile);
    const CutoutRange range{bounds.low[at_tile], bounds.high[at_tile]};
    const bool by_ranges = passes_by_ranges_alone<Fragments>(tile, is_ahead, range, pixels);
    by_ranges ? pixels.find_any_and_all(count()) : test<Fragments>(tile, pixels);
    for (unsigned k = 0; k < count(); ++k) {
      if ((at.drawn >> k & 1) == 0) continue;
      counts.covered += static_cast<unsigned>(std::popcount(pixels.covered[k]));
      counts.passed += static_cast<unsigned>(std::popcount(pixels.passed[k]));
    }
    if (pixels.any == 0) return;
    if (by_ranges)
      wait_with_depths(tile, pixels, range);
    else if (bin.has_operations)
      operate(tile, pixels);
    else if (waits(tile, pixels))
      add_cutout<kSamples>(bin, tile, plane(), pixels, nullptr);
    else if (bin.state.color_write)
      color(tile, pixels);
  }
};

template <class Fragments, unsigned kSamples>
HALFPLANE_NOINLINE void draw_sampled_tiles(Bin& bin, const Slice& slice, const Record& record, const BinTriangle& t,
                                           const SeveralSamples& at, const TileDepths& depths, std::uint64_t tiles,
                                           std::uint64_t full, std::uint64_t in_front) {
  SampledTriangle<kSamples> drawn(bin, slice, record, t, at);
  PixelCounts pixels;
  bin.job.counters.skipped.trivially_accepted += static_cast<unsigned>(std::popcount(tiles & full));
  bin.job.counters.samples_tested += kTilePixels * bin.samples * static_cast<unsigned>(std::popcount(tiles & ~full));
  std::uint64_t ahead = 0;
  TileBounds bounds;
  if (drawn.can_wait) {
    ahead = tiles & Fragments::tiles_in_front(bin, depths);
    depths.low().store(bounds.low.data());
    depths.high().store(bounds.high.data());
  }
  for (; tiles != 0; tiles &= tiles - 1) {
    const int tile = std::countr_zero(tiles);
    if ((in_front >> tile & 1) != 0) {
      operate_on_tile(bin, t, tile, ~std::uint64_t{0});
      if (bin.is_killed) count_killed(bin, kTilePixels * (bin.samples - 1));
      pixels.covered += kTilePixels * bin.samples;
      pixels.passed += kTilePixels * bin.samples;
      continue;
    }
    drawn.template draw<Fragments>(tile, (full >> tile & 1) != 0, (ahead >> tile & 1) != 0, bounds, pixels);
  }
  count_fragments(bin, pixels.covered, pixels.passed);
}

template <class Fragments>
HALFPLANE_INLINE void SeveralSamples::draw(Bin& bin, const Slice& slice, const Record& record, const BinTriangle& t,
                                           const TileDepths& depths, std::uint64_t tiles, std::uint64_t full,
                                           std::uint64_t in_front) const {
  bin.samples == 4 ? draw_sampled_tiles<Fragments, 4>(bin, slice, record, t, *this, depths, tiles, full, in_front)
                   : draw_sampled_tiles<Fragments, 0>(bin, slice, record, t, *this, depths, tiles, full, in_front);
}

}  // namespace
}  // namespace halfplane::functional::HALFPLANE_ISA_NAME
