// Small and medium triangles with several samples per pixel: the blocks of 4 x 4 pixels with covered samples. A block's
// coverage, depths and colours are processed sample by sample as with one sample; its tile is split, because few small
// triangles leave a pixel whole.
#pragma once

#include "bin.inl"
#include "cutouts.inl"
#include "fragments.inl"
#include "multisample_setup.inl"
#include "small.inl"
#include "small_batch.inl"
#include "small_setup.inl"
#include "tile_memory.inl"
#include "tiles.inl"

namespace halfplane::functional::HALFPLANE_ISA_NAME {
namespace {

/// touch_tiles() for several samples per pixel: depths by sample, colours split.
template <class Fragments>
HALFPLANE_INLINE bool touch_sampled_tiles(Bin& bin, std::uint64_t tiles) {
  const bool is_color = bin.state.color_write;
  bin.cutouts_saved = std::min(bin.cutouts_saved, 0);  // small triangles will need memory instead
  for (std::uint64_t rest = tiles & ~(bin.in_memory & bin.split); rest != 0; rest &= rest - 1) {
    const int at = std::countr_zero(rest);
    need_sample_depths(bin, at);
    if (is_color) split_tile(bin, at);
  }
  if (is_color) bin.in_memory |= tiles;
  return widen_ranges<Fragments>(bin, tiles, [&bin](int tile) HALFPLANE_LAMBDA { find_sample_range(bin, tile); });
}

/// The edges of lane i over quad q of its window, their part that varies from pixel to pixel; then from the values at
/// its first pixel, at the centre or at a sample, a bit for each pixel outside.
template <bool kShort>
struct QuadEdges;

template <>
struct QuadEdges<true> {
  std::array<Quad, 3> plane;

  HALFPLANE_INLINE QuadEdges(const Bin& bin, std::size_t i, std::size_t q) {
    using Part = Quad::Part;
    const Part &column = bin.position.quad_x[q % 2], &row = bin.position.quad_y[q / 2];
    for (std::size_t e = 0; e < 3; ++e) {
      const auto both = [i](const SmallBatch::Lane& of) HALFPLANE_LAMBDA { return repeated<Part>(of[i]); };
      constexpr std::size_t kLower = Quad::kParts / 2;
      auto& part = plane[e].part;
      const Part below = both(bin.small.edge_below[e]);
      part[0] = column * both(bin.small.edge_x[e]) + row * both(bin.small.edge_y[e]);
      part[kLower] = part[0] + below;
      if constexpr (Quad::kPartBlocks == 1) {
        part[1] = part[0] + both(bin.small.edge_aside[e]);
        part[kLower + 1] = part[1] + below;
      }
    }
  }
  HALFPLANE_INLINE std::uint64_t outside(const SmallBatch::LaneArray<3>& first, std::size_t i) const {
    const auto a = repeated<Quad::Part>(first[0][i]), b = repeated<Quad::Part>(first[1][i]),
               c = repeated<Quad::Part>(first[2][i]);
    Quad signs;
    HALFPLANE_EACH_PART(Quad::kParts, k,
                        signs.part[k] = (plane[0].part[k] + a) | (plane[1].part[k] + b) | (plane[2].part[k] + c))
    return signs.bits();
  }
};

template <>
struct QuadEdges<false> {
  std::array<std::array<I16, Quad::kBlocks>, 3> plane;

  HALFPLANE_INLINE QuadEdges(const Bin& bin, std::size_t i, std::size_t q) {
    constexpr int kSize = 2 * kBlockSize;
    const I16 column = bin.position.block_x + static_cast<std::int32_t>(q % 2) * kSize,
              row = bin.position.block_y + static_cast<std::int32_t>(q / 2) * kSize;
    for (std::size_t e = 0; e < 3; ++e) {
      const I16 aside = I16(bin.small.edge_aside[e][i]), below = I16(bin.small.edge_below[e][i]);
      auto& block = plane[e];
      block[0] = column * bin.small.edge_x[e][i] + row * bin.small.edge_y[e][i];
      block[1] = block[0] + aside;
      block[2] = block[0] + below;
      block[3] = block[1] + below;
    }
  }
  HALFPLANE_INLINE std::uint64_t outside(const SmallBatch::LaneArray<3>& first, std::size_t i) const {
    std::uint64_t bits = 0;
    for (std::size_t k = 0; k < Quad::kBlocks; ++k)
      bits |= std::uint64_t{bits_of((plane[0][k] + first[0][i]) | (plane[1][k] + first[1][i]) |
                                    (plane[2][k] + first[2][i]))}
              << 16 * k;
    return bits;
  }
};

/// Coverage of a batch's quads by pixel: at the centres, at each sample, and at any of these.
struct SampledCoverage {
  Coverage any;
  alignas(64) Coverage::Blocks centre;
  alignas(64) std::array<std::uint16_t, Coverage::kMost * Quad::kBlocks * kMaxPixelSamples> sample;  ///< block by block
  std::uint64_t samples = 0;  ///< covered and drawn samples

  HALFPLANE_INLINE SampledCoverage() = default;
};

template <unsigned kSamples, bool kShort>
HALFPLANE_INLINE void find_sampled(const Bin& bin, const SmallSamples& samples, std::uint64_t quads,
                                   SampledCoverage& covered) {
  const std::size_t count = samples_of<kSamples>(bin);
  std::size_t at = 0;
  std::uint64_t sum = 0;
  for (; quads != 0; quads &= quads - 1) {
    const auto number = static_cast<std::size_t>(std::countr_zero(quads)), i = number / 4, q = number % 4;
    const std::uint64_t in_box = kWindowQuads.in_box[static_cast<std::size_t>(bin.small.columns_rows[i])][q];
    const QuadEdges<kShort> edges(bin, i, q);
    std::uint64_t any = 0;
    std::array<std::uint64_t, kMaxPixelSamples> pixels;
    for (std::size_t k = 0; k < count; ++k) {
      const std::uint64_t bits = in_box & ~edges.outside(samples.edge[k], i);
      pixels[k] = bits;
      any |= bits;
      if ((bin.drawn_samples >> k & 1) != 0) sum += static_cast<unsigned>(std::popcount(bits));
    }
    if constexpr (kSamples == 4) {
      const BlocksOfSamples blocks = transposed({pixels[0], pixels[1], pixels[2], pixels[3]});
      for (std::size_t k = 0; k < Quad::kBlocks; ++k) Coverage::set_blocks(covered.sample, 4 * at + k, blocks[k]);
    } else {
      std::uint16_t* const to = covered.sample.data() + at * Quad::kBlocks * count;
      for (std::size_t k = 0; k < Quad::kBlocks * count; ++k)
        to[k] = static_cast<std::uint16_t>(block_bits(pixels[k % count], k / count));
    }
    Coverage::set_blocks(covered.centre, at, in_box & ~edges.outside(bin.small.edge, i));
    covered.any.set(at, i, bin.small.first_block[i] + kWindowQuads.first[q], any);
    at += any != 0 ? 1 : 0;
  }
  covered.any.quads = at;
  covered.samples = sum;
}
template <unsigned kSamples>
HALFPLANE_INLINE void find_sampled(Bin& bin, const SmallSamples& samples, SampledCoverage& covered) {
  const std::uint64_t quads = live_quads(bin);
  bin.has_short_edges ? find_sampled<kSamples, true>(bin, samples, quads, covered)
                      : find_sampled<kSamples, false>(bin, samples, quads, covered);
  bin.job.counters.samples_tested += Quad::kPixels * bin.samples * static_cast<unsigned>(std::popcount(quads));
}

/// Words of four samples of a block, the first lowest.
HALFPLANE_INLINE std::uint64_t four_words(const std::uint16_t* from) {
  if constexpr (std::endian::native == std::endian::little) {
    std::uint64_t words;
    std::memcpy(&words, from, sizeof words);
    return words;
  }
  return from[0] | std::uint64_t{from[1]} << 16 | std::uint64_t{from[2]} << 32 | std::uint64_t{from[3]} << 48;
}

/// Colours of a block of lane i: at the centre, or, if that is not covered, at the first covered sample.
template <unsigned kSamples>
HALFPLANE_INLINE I16 sampled_colors(const Bin& bin, const SmallSamples& samples, const SampledCoverage& covered,
                                    std::size_t number, std::size_t i, const SmallBatch::Tile& tile,
                                    const LanePositions::Block& block, int down) {
  const SmallBatch& batch = bin.small;
  const S32 step_x = repeated(batch.c_step_x[i]), step_y = repeated(batch.c_step_y[i]);
  S32 left = block_plane(block.channel_column, block.channel_row, step_x, step_y, step_y * block_rows<S32>,
                         repeated(tile.color[i])),
      right = left + (step_x << 1);
  std::uint32_t rest = covered.any.block[number] & ~std::uint32_t{covered.centre[number]};
  S32 gain_left(0), gain_right(0);
  for (std::size_t k = 0; k < samples_of<kSamples>(bin) && (kSamples != 0 || rest != 0);
       ++k) {  // of 4 without a branch: it is mispredicted
    const std::uint32_t here = rest & covered.sample[number * samples_of<kSamples>(bin) + k];
    rest &= ~here;
    replace_by_bits(here, repeated(samples.color[k][i]), gain_left, gain_right, bin.position.to_sign);
  }
  left += gain_left;
  right += gain_right;
  const I16 low(batch.c_low[i]), high(batch.c_high[i]),
      rgba = ColorRange::clamped(saturated(left >> down, right >> down), low, high);
  return bin.config.color_format == ColorFormat::rgba8888 ? rgba : packed(rgba, bin.config.color_format);
}

/// Depth, test and colour of the blocks with covered samples. `kByFours`: four samples in 16 bits, at once.
template <class Fragments, class Test, unsigned kSamples, bool kByFours>
HALFPLANE_NOINLINE void draw_sampled_blocks(Bin& bin, const SmallSamples& samples, const SampledCoverage& covered) {
  const SmallBatch& batch = bin.small;
  const SliceState state = bin.state;
  const LanePositions& position = bin.position;
  SampleMemory& memory = bin.sample_memory;
  const Test test(bin, memory);
  std::uint32_t* const colors = memory.color.data();
  const int depth_down = bin.centred_depth.down, color_down = bin.centred_color.down;
  const std::size_t count = samples_of<kSamples>(bin);
  const std::uint32_t drawn = bin.drawn_samples;
  const bool has_depth = state.depth_write, has_color = state.color_write;
  std::uint64_t drawn_bits = 0;  // of four samples, sixteen each
  for (std::size_t k = 0; k < 4; ++k) drawn_bits |= std::uint64_t{0xffff * (drawn >> k & 1U)} << 16 * k;
  const S64 bias(static_cast<std::int16_t>(bin.depth_format.bias));
  unsigned passed_pixels = 0;
  for (std::size_t first = 0; first < covered.any.quads; first += 16)
    for (std::uint64_t rest = covered.any.blocks(first); rest != 0; rest &= rest - 1) {
      const std::size_t number = Quad::kBlocks * first + static_cast<std::size_t>(std::countr_zero(rest));
      const std::size_t quad = number / Quad::kBlocks, i = covered.any.lane[quad];
      const WindowBlock& in_window = kWindowBlocks[covered.any.first[quad]][number % Quad::kBlocks];
      const SmallBatch::Tile& tile = batch.tile[in_window.tile];
      const LanePositions::Block& block = position.block[in_window.block];
      const auto at = static_cast<std::size_t>(batch.place[i]) + in_window.place;
      const I16 value = block_plane(block.column, block.row, I16(batch.z_step_x[i]), I16(batch.z_step_y[i]),
                                    I16(batch.z_step_below[i]), I16(tile.depth[i]));
      const std::size_t place = at * count;
      const std::uint16_t* const of_samples = covered.sample.data() + number * count;
      if constexpr (kByFours) {
        std::array<I16, 4> codes;
        for (std::size_t k = 0; k < 4; ++k) codes[k] = (value + samples.depth[k][i]) >> depth_down;
        const S64 low(static_cast<std::int16_t>(batch.z_low[i])), high(static_cast<std::int16_t>(batch.z_high[i]));
        const U64 depth = as<U64>(min(max(four_blocks(codes), low), high) + bias);
        std::uint16_t* const to = memory.narrow_depth.data() + place;
        const TestedTile result =
            tested_by_bits<Fragments>(state, depth, four_words(of_samples) & drawn_bits, U64::load(to));
        if (result.passed == 0) continue;
        if (has_depth) result.now.store(to);
        passed_pixels += Test::kCount * static_cast<unsigned>(std::popcount(result.passed));
        if (!has_color) continue;
        const I16 color = sampled_colors<kSamples>(bin, samples, covered, number, i, tile, block, color_down);
        for (std::size_t k = 0; k < 4; ++k) {
          std::uint32_t* const pixels = colors + place + k * kBlockPixels;
          select_by_bits(block_bits(result.passed, k), color, I16::load(pixels), position.to_sign).store(pixels);
        }
      } else {
        typename Test::Passed passed[kMaxPixelSamples];
        unsigned some = 0;
        for (std::size_t k = 0; k < count; ++k) {
          const std::uint32_t bits = of_samples[k] & (0U - (drawn >> k & 1U));
          const std::size_t to = place + k * kBlockPixels;
          const auto stored = test.load(to),
                     depth = test.codes((value + samples.depth[k][i]) >> depth_down, batch.z_low[i], batch.z_high[i]);
          passed[k] = test.template passed<Fragments>(state, bits, depth, stored);
          some += test.count(passed[k]);
          if (has_depth) test.store(to, test.choose(passed[k], depth, stored));
        }
        passed_pixels += some;
        if (some == 0 || !has_color) continue;
        const I16 color = sampled_colors<kSamples>(bin, samples, covered, number, i, tile, block, color_down);
        for (std::size_t k = 0; k < count; ++k) {
          std::uint32_t* const to = colors + place + k * kBlockPixels;
          test.choose_color(passed[k], color, I16::load(to)).store(to);
        }
      }
    }
  count_fragments(bin, covered.samples, passed_pixels / Test::kCount);
}

/// Draws a batch that is set up, in tiles that are ready for it.
template <class Fragments, unsigned kSamples>
HALFPLANE_NOINLINE void draw_sampled(Bin& bin, const SmallSamples& samples) {
  SampledCoverage covered;
  find_sampled<kSamples>(bin, samples, covered);
  bin.is_narrow ? draw_sampled_blocks<Fragments, NarrowTest, kSamples, kSamples == 4>(bin, samples, covered)
                : draw_sampled_blocks<Fragments, WideTest, kSamples, false>(bin, samples, covered);
}

/// Draws a loaded batch, without operations and surfaces.
template <class Fragments>
HALFPLANE_NOINLINE void draw_sampled_batch(Bin& bin, const Slice& slice) {
  const std::uint64_t tiles = batch_tiles(bin);
  SmallSamples samples(bin.widths);
  set_up_batch(bin, slice, samples);
  const bool is_changed = touch_sampled_tiles<Fragments>(bin, tiles);
  bin.samples == 4 ? draw_sampled<Fragments, 4>(bin, samples) : draw_sampled<Fragments, 0>(bin, samples);
  bin.small.count = 0;
  if (is_changed || (!Fragments::kIsLess && bin.state.depth_write)) find_bin_range(bin);
}

}  // namespace
}  // namespace halfplane::functional::HALFPLANE_ISA_NAME
