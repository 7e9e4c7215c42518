// Depths and colours of a tile, block by block: from the plane's value at the tile's anchor.
#pragma once

#include "bin.inl"

namespace halfplane::functional::HALFPLANE_ISA_NAME {
namespace {

/// The depth at a tile's anchor, in a lane.
HALFPLANE_INLINE std::int32_t depth_anchor(const Bin& bin, const BinTriangle& t, int tile_x, int tile_y) {
  const auto value = static_cast<std::uint64_t>(t.z_anchor) + product(t.z_tile_x, tile_x) + product(t.z_tile_y, tile_y);
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(static_cast<std::int64_t>(value) >> bin.depth_format.drop)
                                   << bin.depth_format.up);
}
HALFPLANE_INLINE ChannelPairs color_anchor(const Bin& bin, const BinTriangle& t, int tile_x, int tile_y) {
  using Unsigned __attribute__((vector_size(32))) = std::uint64_t;
  const Channels value = load(t.c_anchor) + load(t.c_tile_x) * tile_x + load(t.c_tile_y) * tile_y;
  return channel_pairs((Channels)((Unsigned)value >> bin.color_format.drop << bin.color_format.up));
}

/// Sum that wraps.
HALFPLANE_INLINE std::int32_t wrapped_sum(std::int32_t a, std::int32_t b) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) + static_cast<std::uint32_t>(b));
}

/// Increment of depth from the centre of a pixel to its sample k, in a tile's units: sample_plane_offset().
HALFPLANE_INLINE std::int64_t depth_to_sample(const Bin& bin, const BinTriangle& t, unsigned k) {
  const int s = bin.widths.grid_bits;
  const auto step = [&](std::int64_t of_tile) HALFPLANE_LAMBDA {
    return round_shift(of_tile >> (kTileShift + s), bin.depth_format.step_drop);
  };
  const SampleOffset& o = bin.widths.sample_offset[k];
  return round_shift(step(t.z_tile_x) * o.x + step(t.z_tile_y) * o.y, s);
}
/// The same in a lane.
HALFPLANE_INLINE std::int32_t depth_at_sample(const Bin& bin, const BinTriangle& t, unsigned k) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(depth_to_sample(bin, t, k)) << bin.depth_format.up);
}

/// Steps of colours per pixel, channel by channel, in a tile's units.
HALFPLANE_INLINE Channels color_step(const Bin& bin, const std::array<std::int64_t, 4>& of_tile) {
  return round_shift_channels(load(of_tile) >> (kTileShift + bin.widths.grid_bits), bin.color_format.step_drop);
}
/// Increments of colours to sample k.
HALFPLANE_INLINE Channels color_to_sample(const Bin& bin, const BinTriangle& t, std::size_t k) {
  const SampleOffset& o = bin.widths.sample_offset[k];
  return round_shift_channels(color_step(bin, t.c_tile_x) * o.x + color_step(bin, t.c_tile_y) * o.y,
                              bin.widths.grid_bits);
}
/// The same in lanes: their 16 bits depend on no more than 32 of a step.
struct ColorGains {
  Codes step_x, step_y;

  HALFPLANE_INLINE ColorGains(const Bin& bin, const BinTriangle& t)
      : step_x(__builtin_convertvector(color_step(bin, t.c_tile_x), Codes)),
        step_y(__builtin_convertvector(color_step(bin, t.c_tile_y), Codes)) {}
  HALFPLANE_INLINE ChannelPairs operator()(const Bin& bin, std::size_t k) const {
    const int s = bin.widths.grid_bits;
    const SampleOffset& o = bin.widths.sample_offset[k];
    return channel_pairs((step_x * o.x + step_y * o.y + (1 << s >> 1)) >> s << bin.color_format.up);
  }
};

/// Moves the colours' planes to a sample.
inline void move_colors(const Bin& bin, std::size_t sample, BinTriangle& t) {
  store(t.c_anchor, load(t.c_anchor) + (color_to_sample(bin, t, sample) << bin.color_format.drop));
}

/// A plane over a tile: its first block, and the steps from there to the blocks on the right and below.
template <class Lanes>
struct BlockRamp {
  Lanes first, right, below;

  HALFPLANE_INLINE BlockRamp(const Lanes& first_, const Lanes& right_, const Lanes& below_)
      : first(first_), right(right_), below(below_) {}
  HALFPLANE_INLINE BlockRamp() = default;
  HALFPLANE_INLINE BlockRamp(const BlockRamp& from) : BlockRamp(from.first, from.right, from.below) {}
  HALFPLANE_INLINE BlockRamp& operator=(const BlockRamp& from) {
    first = from.first;
    right = from.right;
    below = from.below;
    return *this;
  }

  HALFPLANE_INLINE Lanes operator()(std::size_t block) const {
    const Lanes upper = (block & 1) != 0 ? first + right : first;
    return (block >> 1) != 0 ? upper + below : upper;
  }
};
using ColorRamp = std::array<BlockRamp<S32>, 2>;

HALFPLANE_INLINE BlockRamp<I16> depth_ramp(const Bin& bin, const BinTriangle& t, std::int32_t anchor) {
  return {bin.position.column[0] * t.z_step_x + bin.position.row[0] * t.z_step_y + anchor, I16(kBlockSize * t.z_step_x),
          I16(kBlockSize * t.z_step_y)};
}
HALFPLANE_INLINE ColorRamp color_ramp(const Bin& bin, const ColorSteps& t, const ChannelPairs& anchor) {
  ColorRamp ramp;
  for (std::size_t p = 0; p < 2; ++p) {
    const auto step_x = as<S32>(I16(t.step_x[p])), step_y = as<S32>(I16(t.step_y[p]));
    ramp[p].first = as<S32>(bin.position.column_pair[0]) * step_x + as<S32>(bin.position.row_pair[0]) * step_y +
                    as<S32>(I16(anchor[p]));
    ramp[p].right = step_x << kBlockShift;
    ramp[p].below = step_y << kBlockShift;
  }
  return ramp;
}

/// The blocks of a tile, one after the other.
template <class Visit>
HALFPLANE_INLINE void for_each_block(Visit&& visit) {
  visit(std::integral_constant<std::size_t, 0>{});
  visit(std::integral_constant<std::size_t, 1>{});
  visit(std::integral_constant<std::size_t, 2>{});
  visit(std::integral_constant<std::size_t, 3>{});
}

/// Mask of a block's pixels, from the mask of its tile.
HALFPLANE_INLINE std::uint32_t block_bits(std::uint64_t pixels, std::size_t block) {
  return static_cast<std::uint32_t>(pixels >> (kBlockPixels * block) & 0xffff);
}

/// The blocks of a tile with such pixels, a bit each: a loop over them has fewer mispredicted branches than a test of
/// each.
HALFPLANE_INLINE std::uint32_t blocks_with(std::uint64_t pixels) {
  std::uint32_t blocks = 0;
  for_each_block([&](auto block) HALFPLANE_LAMBDA { blocks |= block_bits(pixels, block) != 0 ? 1U << block : 0; });
  return blocks;
}

/// Replaces `pixels` of a tile's 64 by `code_of(block, stored)`. `stride`: from block to block. `skips`: skips blocks
/// without such pixels.
template <class CodeOf>
HALFPLANE_INLINE void store_pixels(const Bin& bin, std::uint32_t* tile, std::uint64_t pixels, bool skips,
                                   CodeOf&& code_of, std::size_t stride = kBlockPixels) {
  for_each_block([&](auto block) HALFPLANE_LAMBDA {
    const std::uint32_t bits = block_bits(pixels, block);
    if (bits == 0 && skips) return;
    std::uint32_t* const at = tile + block * stride;
    const I16 stored = I16::load(at), code = code_of(block, stored);
    (bits == 0xffff ? code : select_by_bits(bits, code, stored, bin.position.to_sign)).store(at);
  });
}

/// Depths in block 0...3 of a tile.
HALFPLANE_INLINE I16 block_depths(const Bin& bin, const BinTriangle& t, const BlockRamp<I16>& ramp, std::size_t block) {
  return decode(ramp(block), bin.depth_format, t.z_low, t.z_high);
}
/// Packed colours.
HALFPLANE_INLINE I16 block_colors(const ColorSteps& t, const ColorRamp& ramp, std::size_t block,
                                  const LaneFormat& format, const Packing& pixels) {
  const auto pair = [&](std::size_t p)
                        HALFPLANE_LAMBDA { return color_codes(ramp[p](block), I16(t.low[p]), I16(t.high[p]), format); };
  return packed(pair(0), pair(1), pixels);
}

}  // namespace
}  // namespace halfplane::functional::HALFPLANE_ISA_NAME
