// Cutouts, where pixels have several samples: the part of a triangle in a tile that its edges cut, kept for later. A
// tile keeps up to eight cutouts, each as the number of its triangle and the samples that have passed, a bit each.
// Later cutouts hide earlier ones sample by sample; a fully hidden cutout is dropped. Colours are computed once for
// each pixel and remaining cutout, mostly at the end of the bin. Depths of a cutout in front of all of the tile's
// depths are deferred as well.
//
// Such a tile has Bin::kCutouts as the owner of its colours, or of colours and depths, and is split. The data below
// keeps its previous owner.
#pragma once

#include "bin.inl"
#include "tile_memory.inl"
#include "values.inl"

namespace halfplane::functional::HALFPLANE_ISA_NAME {
namespace {

/// Samples of a pixel: known at compile time, or 0.
template <unsigned kSamples>
HALFPLANE_INLINE unsigned samples_of(const Bin& bin) {
  return kSamples != 0 ? kSamples : bin.samples;
}

/// Writes colours of a block to the samples that have passed.
template <unsigned kSamples>
HALFPLANE_INLINE void store_samples(const Bin& bin, int tile, const PixelsOfSamples& passed, std::size_t block,
                                    const I16& color) {
  const unsigned samples = samples_of<kSamples>(bin);
  std::uint32_t* const to = bin.sample_memory.color.data() + (first_of(tile) + block * kBlockPixels) * samples;
  for (unsigned k = 0; k < samples; ++k) {
    std::uint32_t* const at_sample = to + k * kBlockPixels;
    select_by_bits(block_bits(passed[k], block), color, I16::load(at_sample), bin.position.to_sign).store(at_sample);
  }
}

/// Sums of colours as they are stored, to make the mean of a block's samples: mean_color(). Two sums a lane: red and
/// blue, green and alpha.
struct ColorSums {
  I16 outer, inner;
  bool is_short;

  HALFPLANE_INLINE explicit ColorSums(const Bin& bin) : is_short(bin.config.color_format == ColorFormat::rgb565) {
    const auto half = static_cast<std::int32_t>(bin.samples / 2);
    outer = I16(half | half << apart());
    inner = I16(half | half << 16);
  }
  HALFPLANE_INLINE int apart() const { return is_short ? 11 : 16; }
  HALFPLANE_INLINE I16 outer_of(const I16& color) const { return color & (is_short ? 0xf81f : 0xff00ff); }
  HALFPLANE_INLINE I16 inner_of(const I16& color) const {
    return shift_right_logical(color, is_short ? 5 : 8) & (is_short ? 0x3f : 0xff00ff);
  }
  HALFPLANE_INLINE void add(const I16& color) {
    outer += outer_of(color);
    inner += inner_of(color);
  }
  HALFPLANE_INLINE void add(const I16& color, const I16& count) {
    outer += outer_of(color) * count;
    inner += inner_of(color) * count;
  }
  HALFPLANE_INLINE I16 mean(const Bin& bin) const {
    const int log = std::countr_zero(bin.samples);
    const std::int32_t code = is_short ? 0x1f : 0xff;
    const auto part = [log](const I16& sum, int from, std::int32_t bits)
                          HALFPLANE_LAMBDA { return shift_right_logical(sum, from + log) & bits; };
    const I16 rest = is_short ? part(inner, 0, 0x3f) << 5 : part(inner, 0, 0xff) << 8 | part(inner, 16, 0xff) << 24;
    return part(outer, 0, code) | part(outer, apart(), code) << apart() | rest;
  }
};

/// Writes colours of a triangle's planes to the samples of a tile.
template <unsigned kSamples>
struct SampledColors {
  Bin& bin;
  const BinTriangle& t;
  std::array<ChannelPairs, kMaxPixelSamples> gain;  ///< from the centre to each sample, if has_gains
  bool has_gains = false;

  HALFPLANE_INLINE SampledColors(Bin& bin_, const BinTriangle& t_) : bin(bin_), t(t_) {}

  HALFPLANE_NOINLINE void find_gains() {
    const ColorGains gains(bin, t);
    for (unsigned k = 0; k < samples_of<kSamples>(bin); ++k) gain[k] = gains(bin, k);
    has_gains = true;
  }
  HALFPLANE_INLINE const ChannelPairs& gain_at(unsigned m) {
    if (!has_gains) find_gains();
    return gain[m];
  }

  /// Colours of a block's pixels `any`: at the centre, or, if that is not covered, at the first covered sample.
  HALFPLANE_INLINE I16 of_block(const ColorRamp& plane, std::uint64_t centre, const PixelsOfSamples& covered,
                                std::size_t block, std::uint32_t any, ColorFormat format) {
    if (!has_gains) find_gains();
    std::array<I16, 2> to_place{I16(0), I16(0)};
    std::uint32_t rest = any & ~block_bits(centre, block);
    for (unsigned m = 0; m < samples_of<kSamples>(bin) && (kSamples != 0 || rest != 0);
         ++m) {  // of 4 without a branch: it is mispredicted
      const std::uint32_t here = rest & block_bits(covered[m], block);
      rest &= ~here;
      for (std::size_t p = 0; p < 2; ++p)
        to_place[p] = select_by_bits(here, I16(gain[m][p]), to_place[p], bin.position.to_sign);
    }
    const auto is_right = static_cast<std::int16_t>(0 - (block & 1)),
               is_below = static_cast<std::int16_t>(0 - (block >> 1));
    const auto pair = [&](std::size_t p) HALFPLANE_LAMBDA {
      const S32 value = plane[p].first + (plane[p].right & is_right) + (plane[p].below & is_below);
      return color_codes(value + as<S32>(to_place[p]), I16(t.color.low[p]), I16(t.color.high[p]), bin.color_format);
    };
    return packed(pair(0), pair(1), format);
  }

  /// Stores colours to the samples that have passed. `any`: pixels with such a sample.
  HALFPLANE_INLINE void store(int tile, std::uint64_t centre, const PixelsOfSamples& covered,
                              const PixelsOfSamples& passed, std::uint64_t any) {
    const ColorRamp plane = color_ramp(bin, t.color, color_anchor(bin, t, tile % kBinTiles, tile / kBinTiles));
    for (std::uint32_t rest = blocks_with(any); rest != 0; rest &= rest - 1) {
      const auto block = static_cast<std::size_t>(std::countr_zero(rest));
      store_samples<kSamples>(bin, tile, passed, block,
                              of_block(plane, centre, covered, block, block_bits(any, block), bin.config.color_format));
    }
  }
};

/// Removes hidden samples from a tile's cutouts, and cutouts without samples. Returns whether a sample below them is
/// visible.
template <unsigned kSamples>
HALFPLANE_NOINLINE bool drop_hidden(Bin& bin, TileCutouts& cutouts) {
  PixelsOfSamples& seen = cutouts.below;
  for (unsigned k = 0; k < samples_of<kSamples>(bin); ++k) seen[k] = ~std::uint64_t{0};
  std::array<std::uint64_t, TileCutouts::kMost> any;
  for (std::size_t i = cutouts.count; i-- != 0;) {
    PixelsOfSamples& passed = cutouts.cutout[i].passed;
    std::uint64_t before = 0;
    any[i] = 0;
    for (unsigned k = 0; k < samples_of<kSamples>(bin); ++k) {
      before |= passed[k];
      passed[k] &= seen[k];
      any[i] |= passed[k];
      seen[k] &= ~passed[k];
    }
    if (any[i] != 0) continue;
    ++bin.cutouts_saved;
    bin.job.counters.skipped.attributes += static_cast<unsigned>(std::popcount(before));
  }
  std::size_t left = 0, first_depth = 0;
  for (std::size_t i = 0; i < cutouts.count; ++i) {
    if (any[i] == 0) continue;
    if (i < cutouts.first_depth) ++first_depth;
    if (left != i) cutouts.cutout[left] = cutouts.cutout[i];
    ++left;
  }
  cutouts.count = left;
  cutouts.first_depth = first_depth;
  std::uint64_t below = 0;
  for (unsigned k = 0; k < samples_of<kSamples>(bin); ++k) below |= seen[k];
  return below != 0;
}

/// Writes depths of a tile's cutouts at the first `samples` to memory. With all samples nothing is pending any more.
template <unsigned kSamples>
HALFPLANE_NOINLINE void store_depths_of_cutouts(Bin& bin, int tile, unsigned samples) {
  TileCutouts& cutouts = bin.sample_memory.cutouts[tile];
  (void)drop_hidden<kSamples>(bin, cutouts);
  bin.depth_owner[tile] = cutouts.depth_below;
  for (unsigned k = 0; k < samples; ++k) {
    std::uint64_t below = ~std::uint64_t{0};
    for (std::size_t i = cutouts.first_depth; i < cutouts.count; ++i) below &= ~cutouts.cutout[i].passed[k];
    if (below != 0 && cutouts.depth_below != Bin::kInMemory) {
      const TileBlocks blocks = sample_depths(bin, tile, k);
      for (std::size_t i = 0; i < 4; ++i)
        store_sample(bin, k, static_cast<std::size_t>(first_of(tile)) + kBlockPixels * i, blocks[i]);
    }
  }
  for (std::size_t i = cutouts.first_depth; i < cutouts.count; ++i) {
    const Cutout& cutout = cutouts.cutout[i];
    const BinTriangle& t = bin.memory.planes[static_cast<std::size_t>(cutout.plane)];
    const std::int32_t anchor = depth_anchor(bin, t, tile % kBinTiles, tile / kBinTiles);
    for (unsigned k = 0; k < samples; ++k) {
      const BlockRamp<I16> plane = depth_ramp(bin, t, wrapped_sum(anchor, depth_at_sample(bin, t, k)));
      for_each_block([&](auto block) HALFPLANE_LAMBDA {
        const std::uint32_t passed = block_bits(cutout.passed[k], block);
        if (passed == 0) return;
        const std::size_t place = static_cast<std::size_t>(first_of(tile)) + block * kBlockPixels;
        store_sample(bin, k, place,
                     select_by_bits(passed, block_depths(bin, t, plane, block), load_sample(bin, k, place),
                                    bin.position.to_sign));
      });
    }
  }
  cutouts.first_depth = cutouts.count;
  bin.depth_owner[tile] = Bin::kInMemory;
  if (samples == bin.samples) find_sample_range(bin, tile);
}
HALFPLANE_INLINE void store_cutout_depths(Bin& bin, int tile, unsigned samples) {
  bin.samples == 4 ? store_depths_of_cutouts<4>(bin, tile, samples) : store_depths_of_cutouts<0>(bin, tile, samples);
}

/// Brings depths of the samples of a tile to memory.
HALFPLANE_NOINLINE void need_sample_depths(Bin& bin, int tile) {
  if (bin.depth_owner[tile] == Bin::kInMemory) return;
  if (bin.depth_owner[tile] == Bin::kCutouts) return store_cutout_depths(bin, tile, bin.samples);
  const bool fills = bin.is_narrow && bin.depth_owner[tile] == Bin::kCleared;
  for (unsigned k = 0; k < bin.samples; ++k) {
    if (fills) {
      U64::load(bin.cleared_depths.data())
          .store(bin.sample_memory.narrow_depth.data() + bin.sample_place(0, first_of(tile)) + k * kTilePixels);
      continue;
    }
    const TileBlocks blocks = sample_depths(bin, tile, k);
    for (std::size_t i = 0; i < 4; ++i)
      store_sample(bin, k, static_cast<std::size_t>(first_of(tile)) + kBlockPixels * i, blocks[i]);
  }
  bin.depth_owner[tile] = Bin::kInMemory;
}

/// Brings colours of a tile, of any owner, to memory, split where they are in the target.
HALFPLANE_NOINLINE void need_sample_colors(Bin& bin, int tile) {
  if (bin.color_owner[tile] != Bin::kInTarget) return need_color(bin, tile);
  for (unsigned k = 0; k < bin.samples; ++k) {
    const TileBlocks blocks = fetched(bin, tile, false, 0, bin.job.target.samples[k].color);
    for (std::size_t i = 0; i < 4; ++i)
      blocks[i].store(bin.sample_memory.color.data() + bin.sample_place(k, first_of(tile) + kBlockPixels * i));
  }
  bin.color_owner[tile] = Bin::kInMemory;
  bin.split |= std::uint64_t{1} << tile;
}

HALFPLANE_NOINLINE void split_tile(Bin& bin, int tile) {
  need_sample_colors(bin, tile);
  if ((bin.split >> tile & 1) != 0) return;
  const std::uint32_t* const from = bin.memory.color.data() + first_of(tile);
  std::uint32_t* const to = bin.sample_memory.color.data() + bin.sample_place(0, first_of(tile));
  for (std::size_t i = 0; i < 4; ++i) {
    const I16 color = I16::load(from + i * kBlockPixels);
    for (std::size_t k = 0; k < bin.samples; ++k) color.store(to + (i * bin.samples + k) * kBlockPixels);
  }
  bin.split |= std::uint64_t{1} << tile;
}

/// Brings colours of a tile's cutouts to memory, split.
template <unsigned kSamples>
HALFPLANE_INLINE void split_cutouts(Bin& bin, int tile) {
  TileCutouts& cutouts = bin.sample_memory.cutouts[tile];
  const std::uint64_t bit = std::uint64_t{1} << tile;
  if (drop_hidden<kSamples>(bin, cutouts)) {
    bin.color_owner[tile] = cutouts.color_below;
    if (!cutouts.is_split_below) bin.split &= ~bit;
    split_tile(bin, tile);
  }
  bin.color_owner[tile] = Bin::kInMemory;
  for (std::size_t i = 0; i < cutouts.count; ++i) {
    const Cutout& cutout = cutouts.cutout[i];
    std::uint64_t any = 0;
    for (unsigned k = 0; k < samples_of<kSamples>(bin); ++k) any |= cutout.passed[k];
    SampledColors<kSamples> colors(bin, bin.memory.planes[static_cast<std::size_t>(cutout.plane)]);
    colors.store(tile, cutout.centre, cutout.covered, cutout.passed, any);
  }
}
HALFPLANE_NOINLINE void color_cutouts(Bin& bin, int tile) {
  bin.cutouts_saved -= static_cast<int>(bin.sample_memory.cutouts[tile].count);
  bin.samples == 4 ? split_cutouts<4>(bin, tile) : split_cutouts<0>(bin, tile);
}

/// Writes colours of a tile's cutouts where only resolved pixels are stored: the mean of each pixel's samples. The tile
/// becomes whole.
template <unsigned kSamples>
HALFPLANE_NOINLINE void resolve_cutouts(Bin& bin, int tile) {
  TileCutouts& cutouts = bin.sample_memory.cutouts[tile];
  const bool has_below = drop_hidden<kSamples>(bin, cutouts);
  if (has_below && (cutouts.is_split_below || cutouts.color_below == Bin::kInTarget)) return color_cutouts(bin, tile);
  std::uint32_t* const to = bin.memory.color.data() + first_of(tile);
  ColorSums sums[4] = {ColorSums(bin), ColorSums(bin), ColorSums(bin), ColorSums(bin)};
  unsigned done = 0;
  const auto add = [&](const PixelsOfSamples& seen, auto&& color_of) HALFPLANE_LAMBDA {
    for_each_block([&](auto block) HALFPLANE_LAMBDA {
      I16 count(0);
      std::uint32_t any = 0, all = 0xffff;
      for (unsigned k = 0; k < samples_of<kSamples>(bin); ++k) {
        const std::uint32_t bits = block_bits(seen[k], block);
        any |= bits;
        all &= bits;
        count = select_by_bits(bits, count + 1, count, bin.position.to_sign);
      }
      if (any == 0) return;
      const I16 color = color_of(block, any);
      if (all == 0xffff) {
        color.store(to + block * kBlockPixels);
        done |= 1U << block;
      } else {
        sums[block].add(color, count);
      }
    });
  };
  bin.split &= ~(std::uint64_t{1} << tile);
  if (has_below) {
    bin.color_owner[tile] = cutouts.color_below;
    need_color(bin, tile);
    add(cutouts.below,
        [&](std::size_t block, std::uint32_t) HALFPLANE_LAMBDA { return I16::load(to + block * kBlockPixels); });
  }
  bin.color_owner[tile] = Bin::kInMemory;
  for (std::size_t i = 0; i < cutouts.count; ++i) {
    const Cutout& cutout = cutouts.cutout[i];
    const BinTriangle& t = bin.memory.planes[static_cast<std::size_t>(cutout.plane)];
    SampledColors<kSamples> colors(bin, t);
    const ColorRamp plane = color_ramp(bin, t.color, color_anchor(bin, t, tile % kBinTiles, tile / kBinTiles));
    add(cutout.passed, [&](std::size_t block, std::uint32_t any) HALFPLANE_LAMBDA {
      return colors.of_block(plane, cutout.centre, cutout.covered, block, any, bin.config.color_format);
    });
  }
  for_each_block([&](auto block) HALFPLANE_LAMBDA {
    if ((done >> block & 1) == 0) sums[block].mean(bin).store(to + block * kBlockPixels);
  });
}

/// Draws all pending cutouts.
HALFPLANE_NOINLINE void finish_cutouts(Bin& bin) {
  for (int tile = 0; tile < Bin::kTiles; ++tile) {
    if (bin.depth_owner[tile] == Bin::kCutouts) store_cutout_depths(bin, tile, bin.samples);
    if (bin.color_owner[tile] == Bin::kCutouts) color_cutouts(bin, tile);
  }
}
/// The same at the end of a bin of which only resolved pixels are stored.
HALFPLANE_NOINLINE void resolve_all_cutouts(Bin& bin) {
  for (int tile = 0; tile < Bin::kTiles; ++tile) {
    if (bin.depth_owner[tile] == Bin::kCutouts) store_cutout_depths(bin, tile, 1);
    if (bin.color_owner[tile] == Bin::kCutouts)
      bin.samples == 4 ? resolve_cutouts<4>(bin, tile) : resolve_cutouts<0>(bin, tile);
  }
}

/// Forgets the triangles that own no tile any more.
HALFPLANE_NOINLINE void drop_planes(Bin& bin) {
  if (bin.samples > 1) finish_cutouts(bin);
  std::array<std::int16_t, BinMemory::kPlanes> moved;
  moved.fill(-1);
  for (const auto* owners : {&bin.depth_owner, &bin.color_owner})
    for (const std::int16_t owner : *owners)
      if (owner >= 0) moved[static_cast<std::size_t>(owner)] = 0;
  bin.plane_count = 0;
  for (std::size_t i = 0; i < BinMemory::kPlanes; ++i) {
    if (moved[i] < 0) continue;
    moved[i] = static_cast<std::int16_t>(bin.plane_count);
    bin.memory.planes[bin.plane_count++] = bin.memory.planes[i];
  }
  for (auto* owners : {&bin.depth_owner, &bin.color_owner})
    for (std::int16_t& owner : *owners)
      if (owner >= 0) owner = moved[static_cast<std::size_t>(owner)];
}

/// Number of a newly pending triangle.
HALFPLANE_INLINE std::int16_t add_plane(Bin& bin, const BinTriangle& t) {
  if (bin.plane_count == BinMemory::kPlanes) drop_planes(bin);
  bin.memory.planes[bin.plane_count] = t;
  return static_cast<std::int16_t>(bin.plane_count++);
}

/// The samples of a tile that a triangle covers, and the samples that have passed the depth test: a bit per pixel.
struct SamplePixels {
  std::uint64_t centre = ~std::uint64_t{0};
  PixelsOfSamples covered, passed;
  std::uint64_t any = 0, all = ~std::uint64_t{0};  ///< of `passed`

  HALFPLANE_INLINE void find_any_and_all(unsigned samples) {
    any = 0;
    all = ~std::uint64_t{0};
    for (unsigned k = 0; k < samples; ++k) {
      any |= passed[k];
      all &= passed[k];
    }
  }
};

/// A range of depths in the precision of tile ranges.
struct CutoutRange {
  std::uint16_t low, high;
};

/// Adds a cutout to a tile. `range`: of its depths, if they are deferred as well.
template <unsigned kSamples>
HALFPLANE_INLINE void add_cutout(Bin& bin, int tile, std::int16_t plane, const SamplePixels& pixels,
                                 const CutoutRange* range) {
  const bool has_depth = range != nullptr;
  TileCutouts& cutouts = bin.sample_memory.cutouts[tile];
  const std::uint64_t bit = std::uint64_t{1} << tile;
  if (bin.color_owner[tile] == Bin::kCutouts && cutouts.count == TileCutouts::kMost) {
    (void)drop_hidden<kSamples>(bin, cutouts);
    if (cutouts.count == TileCutouts::kMost) color_cutouts(bin, tile);
  }
  const bool begins = bin.color_owner[tile] != Bin::kCutouts;
  if (bin.depth_owner[tile] == Bin::kCutouts && (begins || !has_depth)) store_cutout_depths(bin, tile, bin.samples);
  if (begins) {
    if (is_waiting(bin, tile) || bin.color_owner[tile] == Bin::kLayers) need_color(bin, tile);
    cutouts.count = cutouts.first_depth = 0;
    cutouts.color_below = bin.color_owner[tile];
    cutouts.is_split_below = (bin.split & bit) != 0;
    bin.color_owner[tile] = Bin::kCutouts;
    bin.split |= bit;
    bin.in_memory &= ~bit;
  }
  if (has_depth && bin.depth_owner[tile] != Bin::kCutouts) {
    cutouts.depth_below = bin.depth_owner[tile];
    cutouts.first_depth = cutouts.count;
    cutouts.low_below = bin.tile_low[tile];
    cutouts.high_below = bin.tile_high[tile];
    bin.depth_owner[tile] = Bin::kCutouts;
  }
  Cutout& cutout = cutouts.cutout[cutouts.count++];
  cutout.plane = plane;
  cutout.centre = pixels.centre;
  for (unsigned k = 0; k < samples_of<kSamples>(bin); ++k) {
    cutout.covered[k] = pixels.covered[k];
    cutout.passed[k] = pixels.passed[k];
  }
  if (!has_depth) return;
  cutout.low = range->low;
  cutout.high = range->high;
  bin.tile_low[tile] = std::min(bin.tile_low[tile], range->low);
  bin.tile_high[tile] = std::max(bin.tile_high[tile], range->high);
}

/// The samples of a triangle that pass the test `less` in a tile with deferred depths, as far as ranges decide: its
/// range is compared with that of the top cutout at each sample. False where ranges overlap.
template <unsigned kSamples>
HALFPLANE_INLINE bool passes_by_ranges(Bin& bin, int tile, const CutoutRange& range, SamplePixels& pixels) {
  const TileCutouts& cutouts = bin.sample_memory.cutouts[tile];
  const std::uint16_t touch = bin.range_bits_dropped != 0 ? 1 : 0;
  PixelsOfSamples rest, below;
  for (unsigned k = 0; k < samples_of<kSamples>(bin); ++k) {
    rest[k] = pixels.passed[k];
    below[k] = ~std::uint64_t{0};
  }
  std::uint16_t highest = 0;
  const auto decide = [&](std::uint64_t any, std::uint16_t low, std::uint16_t high, auto&& fail) HALFPLANE_LAMBDA {
    if (any == 0 || range.high < low) return true;
    if (range.low < high + touch) return false;
    fail();
    return true;
  };
  for (std::size_t i = cutouts.count; i-- != cutouts.first_depth;) {
    const Cutout& cutout = cutouts.cutout[i];
    PixelsOfSamples here;
    std::uint64_t any = 0;
    for (unsigned k = 0; k < samples_of<kSamples>(bin); ++k) {
      here[k] = rest[k] & cutout.passed[k];
      rest[k] &= ~cutout.passed[k];
      below[k] &= ~cutout.passed[k];
      any |= here[k];
    }
    highest = std::max(highest, cutout.high);
    const bool is_decided = decide(any, cutout.low, cutout.high, [&]() HALFPLANE_LAMBDA {
      for (unsigned k = 0; k < samples_of<kSamples>(bin); ++k) pixels.passed[k] &= ~here[k];
    });
    if (!is_decided) return false;
  }
  std::uint64_t any = 0, any_below = 0;
  for (unsigned k = 0; k < samples_of<kSamples>(bin); ++k) {
    any |= rest[k];
    any_below |= below[k];
  }
  // Everything below is hidden: from now on the tile's range rejects a triangle farther than the farthest cutout.
  if (any_below == 0) bin.tile_high[tile] = std::min(bin.tile_high[tile], highest);
  return decide(any, cutouts.low_below, cutouts.high_below, [&]() HALFPLANE_LAMBDA {
    for (unsigned k = 0; k < samples_of<kSamples>(bin); ++k) pixels.passed[k] &= ~rest[k];
  });
}

/// Ranges of a triangle's depths in a bin's tiles.
struct TileBounds {
  alignas(64) std::array<std::uint16_t, Bin::kTiles> low, high;
};

}  // namespace
}  // namespace halfplane::functional::HALFPLANE_ISA_NAME
