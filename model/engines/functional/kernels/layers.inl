// Layers: triangles that are blended over the stored colours by their alpha, with no other operation. A triangle that
// covers a whole tile, in front of all its depths, is kept as a layer; up to sixteen layers of a tile are then blended
// in one pass over its pixels, in order, with one read and one write. Layers hidden by an opaque triangle are dropped
// first.
//
// Such a tile has Bin::kLayers as the owner of its colours; the colours below are in memory. fetch_color() blends the
// layers when the colours are needed.
#pragma once

#include "bin.inl"
#include "fragments.inl"
#include "surface.inl"
#include "texture.inl"
#include "tile_memory.inl"

namespace halfplane::functional::HALFPLANE_ISA_NAME {
namespace {

/// src_alpha and `dst`, added, for all channels. Alpha, where stored, uses the same factors, or one as the first.
[[nodiscard]] inline bool has_factors(const ColorOps& ops, BlendFactor dst, ColorFormat format) {
  const BlendFactors& f = ops.factors;
  if (f.src != BlendFactor::src_alpha || f.dst != dst || ops.equation[0] != BlendEquation::add) return false;
  return format != ColorFormat::rgba8888 ||
         ((f.src_alpha == BlendFactor::src_alpha || f.src_alpha == BlendFactor::one) && f.dst_alpha == dst &&
          ops.equation[1] == BlendEquation::add);
}
/// The most common blending: the two factors sum to 255.
[[nodiscard]] inline bool has_over_factors(const ColorOps& ops, ColorFormat format) {
  return has_factors(ops, BlendFactor::one_minus_src_alpha, format);
}

/// Whether all channels are written. Comparing the arrays is a call for each tile.
[[nodiscard]] inline bool writes_all_channels(const ColorOps& ops) {
  return ops.writes[0] && ops.writes[1] && ops.writes[2] && ops.writes[3];
}

/// has_over_factors(), without other operations.
[[nodiscard]] inline bool is_over(const ColorOps& ops, ColorFormat format) {
  return has_over_factors(ops, format) && !ops.dithers && ops.logic == LogicOp::copy && writes_all_channels(ops);
}

/// The bits that replace alpha as its own first factor, where that is one.
HALFPLANE_INLINE std::int32_t own_factor_bits(const ColorOps& ops) {
  return ops.factors.src_alpha == BlendFactor::one ? 255 << 16 : 0;
}

/// Alpha in both halves.
HALFPLANE_INLINE S32 alpha_pairs(const I16& green_alpha) { return as<S32>(upper_pairs(green_alpha, green_alpha)); }

/// The stored colour as codes of 8 bits: widen_color(). Five bits r become 33 r >> 2, six g 65 g >> 4: here as the
/// upper halves of products, r 2^11 times 264 and g 2^10 times 260.
HALFPLANE_INLINE ColorPairs widened(const I16& stored, ColorFormat format) {
  if (format == ColorFormat::rgba8888) return ColorPairs(stored);
  const I16 red_blue = (stored & 0xf800) | (stored << 27), green = (stored << 5) & 0xfc00;
  return ColorPairs(as<I16>(multiply_upper(as<S32>(red_blue), 264)),
                    as<I16>(multiply_upper(as<S32>(green), 260)) | (255 << 16));
}

/// The colour of such a draw: blended(). The sum of the two products is at most 255^2. `own_factor`: own_factor_bits().
HALFPLANE_INLINE ColorPairs laid_over(const ColorPairs& source, const ColorPairs& stored, std::int32_t own_factor) {
  const S32 alpha = alpha_pairs(source.green_alpha), rest = 255 - alpha;
  const S32 of_alpha = as<S32>(as<I16>(alpha) | own_factor);
  return ColorPairs(
      as<I16>(divide_by_255(as<S32>(source.red_blue) * alpha + as<S32>(stored.red_blue) * rest)),
      as<I16>(divide_by_255(as<S32>(source.green_alpha) * of_alpha + as<S32>(stored.green_alpha) * rest)));
}

/// A pending layer, in one bin. Values are codes without a bias, in the upper bits of 16: from 256 on they wrap.
struct Layer {
  alignas(
      64) std::array<std::array<std::int32_t, Bin::kTiles>, 2> anchor;  ///< at each tile's anchor, two channels each
  alignas(
      64) std::array<std::array<std::array<std::int32_t, kBlockPixels>, 4>, 2> from_anchor;  ///< of a block's pixels
  ChannelPairs low, high;                                                                    ///< codes of the vertices
  std::uint64_t is_clamped;  ///< tiles whose values may leave this range
  std::int32_t own_factor;
  bool dithers;
};

/// The layers of a thread's bin; Bin::layer_count of them.
struct LayerMemory {
  static constexpr std::size_t kLayers = 16;
  std::array<Layer, kLayers> layer;
  std::array<std::uint16_t, Bin::kTiles> of_tile;  ///< a bit each; valid where color_owner is kLayers

  static LayerMemory& of_thread() {
    static thread_local LayerMemory memory;
    return memory;
  }
};

/// Whether 32 bits hold the local part of a colour's plane at a tile's anchor.
[[nodiscard]] inline bool are_short_anchors(const LaneFormat& format) { return format.drop + 16 - format.up <= 32; }

/// Two channels at the anchors of all tiles, and the tiles in which they may leave the range of the vertices' codes. A
/// tile is fully covered, so that no value wraps there.
HALFPLANE_INLINE std::uint64_t set_layer_anchors(const Bin& bin, const BinTriangle& t, Layer& layer, std::size_t p) {
  const LaneFormat& format = bin.centred_color;
  const auto low_word = [](std::int64_t v) HALFPLANE_LAMBDA {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(static_cast<std::uint64_t>(v)));
  };
  struct Channel {
    I16 value, below;  ///< the next two rows of tiles
  };
  const auto channel = [&](std::size_t c) HALFPLANE_LAMBDA {
    const I16 &x = bin.position.pair_x, y = bin.position.lane >> 3;
    const auto centred = static_cast<std::int64_t>(static_cast<std::uint64_t>(t.c_anchor[c]) + format.to_centred);
    return Channel{x * low_word(t.c_tile_x[c]) + y * low_word(t.c_tile_y[c]) + low_word(centred),
                   I16(2 * low_word(t.c_tile_y[c]))};
  };
  Channel first = channel(p), second = channel(p + 2);
  const auto at_place = [&](const I16& value)
                            HALFPLANE_LAMBDA { return shift_right_logical(value, format.drop) << format.up; };
  // From a tile's anchor to its lowest and highest value.
  const auto step_x = as<S32>(I16(t.color.step_x[p])), step_y = as<S32>(I16(t.color.step_y[p]));
  const auto reach = [](const S32& step, auto&& pick) HALFPLANE_LAMBDA {
    constexpr std::int16_t kBefore = kTileSize / 2, kBehind = kTileSize / 2 - 1;
    return pick(step * kBehind, -(step * kBefore));
  };
  const auto least = [](const S32& a, const S32& b) HALFPLANE_LAMBDA { return min(a, b); };
  const auto most = [](const S32& a, const S32& b) HALFPLANE_LAMBDA { return max(a, b); };
  const S32 to_low = reach(step_x, least) + reach(step_y, least), to_high = reach(step_x, most) + reach(step_y, most);
  const auto bias = static_cast<std::int16_t>(format.bias);
  const S32 low = (as<S32>(I16(layer.low[p])) - bias) << format.down,
            high = ((as<S32>(I16(layer.high[p])) - bias) << format.down) |
                   static_cast<std::int16_t>((1 << format.down) - 1);
  std::uint64_t leaves = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    const I16 values = pairs(at_place(first.value), at_place(second.value));
    as<I16>(as<S32>(values) + static_cast<std::int16_t>(format.bias << format.down))
        .store(layer.anchor[p].data() + 16 * k);
    const I16 out = as<I16>((as<S32>(values) + to_low < low) | (as<S32>(values) + to_high > high));
    leaves |= std::uint64_t{bits_of(out != 0)} << 16 * k;
    first.value += first.below;
    second.value += second.below;
  }
  const I16 column = bin.position.column_pair[0], row = bin.position.row_pair[0];
  const S32 at_first = as<S32>(column) * step_x + as<S32>(row) * step_y;
  for (std::size_t block = 0; block < 4; ++block) {
    S32 at = at_first;
    if ((block & 1) != 0) at += step_x << kBlockShift;
    if ((block & 2) != 0) at += step_y << kBlockShift;
    at.store(layer.from_anchor[p][block].data());
  }
  return leaves;
}

/// A tile's pixels of two channels each, while layers are blended over them.
struct LaidPairs {
  S32 red_blue, green_alpha;

  HALFPLANE_INLINE LaidPairs() = default;
  HALFPLANE_INLINE void load(const std::uint32_t* from, ColorFormat format) {
    const ColorPairs codes = widened(I16::load(from), format);
    red_blue = as<S32>(codes.red_blue);
    green_alpha = as<S32>(codes.green_alpha);
  }
  HALFPLANE_INLINE void store(std::uint32_t* to, ColorFormat format) const {
    packed(as<I16>(red_blue), as<I16>(green_alpha), format).store(to);
  }
};

/// Blends one layer over a block.
template <bool kClamps, ColorFormat kFormat>
HALFPLANE_INLINE void lay(const Layer& layer, int tile, std::size_t block, int down, std::int16_t bias,
                          LaidPairs& over) {
  const auto codes = [&](std::size_t p) HALFPLANE_LAMBDA {
    const S32 value =
        as<S32>(I16(layer.anchor[p][static_cast<std::size_t>(tile)])) + S32::load(layer.from_anchor[p][block].data());
    if constexpr (!kClamps) return as<I16>(shift_right_logical(value, down));
    const S32 code = ((value - static_cast<std::int16_t>(bias << down)) >> down) + bias;
    return as<I16>(min(max(code, as<S32>(I16(layer.low[p]))), as<S32>(I16(layer.high[p]))));
  };
  const ColorPairs mixed = laid_over(ColorPairs(codes(0), codes(1)),
                                     ColorPairs(as<I16>(over.red_blue), as<I16>(over.green_alpha)), layer.own_factor);
  if constexpr (kFormat == ColorFormat::rgba8888) {
    over.red_blue = as<S32>(mixed.red_blue);
    over.green_alpha = as<S32>(mixed.green_alpha);
  } else {  // each layer is stored
    const I16 code = packed(mixed.red_blue, mixed.green_alpha, Packing{kFormat, layer.dithers});
    const ColorPairs stored = widened(code, kFormat);
    over.red_blue = as<S32>(stored.red_blue);
    over.green_alpha = as<S32>(stored.green_alpha);
  }
}

/// Blends the layers of a tile, a bit each, over its pixels: as many blocks at once as there are registers for.
template <ColorFormat kFormat>
HALFPLANE_NOINLINE void lay_over_tile(const Bin& bin, const LayerMemory& memory, int tile, std::uint32_t layers,
                                      std::uint32_t* to) {
  const int down = bin.centred_color.down;
  const auto bias = static_cast<std::int16_t>(bin.centred_color.bias);
  const auto each_layer = [&](auto&& blocks) HALFPLANE_LAMBDA {
    for (std::uint32_t rest = layers; rest != 0; rest &= rest - 1) {
      const Layer& layer = memory.layer[static_cast<std::size_t>(std::countr_zero(rest))];
      (layer.is_clamped >> tile & 1) != 0 ? blocks(layer, std::true_type{}) : blocks(layer, std::false_type{});
    }
  };
#if HALFPLANE_ISA == 512
  LaidPairs a, b, c, d;
  a.load(to, kFormat);
  b.load(to + kBlockPixels, kFormat);
  c.load(to + 2 * kBlockPixels, kFormat);
  d.load(to + 3 * kBlockPixels, kFormat);
  each_layer([&](const Layer& layer, auto clamps) HALFPLANE_LAMBDA {
    constexpr bool kClamps = decltype(clamps)::value;
    lay<kClamps, kFormat>(layer, tile, 0, down, bias, a);
    lay<kClamps, kFormat>(layer, tile, 1, down, bias, b);
    lay<kClamps, kFormat>(layer, tile, 2, down, bias, c);
    lay<kClamps, kFormat>(layer, tile, 3, down, bias, d);
  });
  a.store(to, kFormat);
  b.store(to + kBlockPixels, kFormat);
  c.store(to + 2 * kBlockPixels, kFormat);
  d.store(to + 3 * kBlockPixels, kFormat);
#else
  for (std::size_t block = 0; block < 4; ++block) {
    LaidPairs over;
    over.load(to + block * kBlockPixels, kFormat);
    each_layer([&](const Layer& layer, auto clamps)
                   HALFPLANE_LAMBDA { lay<decltype(clamps)::value, kFormat>(layer, tile, block, down, bias, over); });
    over.store(to + block * kBlockPixels, kFormat);
  }
#endif
}

/// Brings colours of a tile with pending layers to memory.
HALFPLANE_NOINLINE void lay_tile(Bin& bin, int tile) {
  const LayerMemory& memory = LayerMemory::of_thread();
  bin.color_owner[tile] = Bin::kInMemory;
  const std::uint32_t layers = memory.of_tile[static_cast<std::size_t>(tile)];
  std::uint32_t* const to = bin.memory.color.data() + first_of(tile);
  bin.config.color_format == ColorFormat::rgba8888 ? lay_over_tile<ColorFormat::rgba8888>(bin, memory, tile, layers, to)
                                                   : lay_over_tile<ColorFormat::rgb565>(bin, memory, tile, layers, to);
}

/// The tiles with pending layers.
HALFPLANE_INLINE std::uint64_t layered_tiles(const Bin& bin) {
  return bits_of(S64::load(bin.color_owner.data()) == Bin::kLayers);
}

/// Blends all pending layers: numbers start again.
HALFPLANE_NOINLINE void lay_all(Bin& bin) {
  for (std::uint64_t rest = layered_tiles(bin); rest != 0; rest &= rest - 1) lay_tile(bin, std::countr_zero(rest));
  bin.layer_count = 0;
}

HALFPLANE_NOINLINE void add_layer(Bin& bin, const BinTriangle& t, std::uint64_t tiles) {
  if (bin.layer_count == LayerMemory::kLayers) lay_all(bin);
  LayerMemory& memory = LayerMemory::of_thread();
  Layer& layer = memory.layer[bin.layer_count];
  layer.low = t.color.low;
  layer.high = t.color.high;
  layer.own_factor = own_factor_bits(bin.ops->color);
  layer.dithers = bin.packing.dithers;
  layer.is_clamped = 0;
  for (std::size_t p = 0; p < 2; ++p) layer.is_clamped |= set_layer_anchors(bin, t, layer, p);
  for (std::uint64_t rest = tiles & ~layered_tiles(bin); rest != 0; rest &= rest - 1) {
    const int tile = std::countr_zero(rest);
    need_color(bin, tile);
    bin.color_owner[tile] = Bin::kLayers;
    memory.of_tile[static_cast<std::size_t>(tile)] = 0;
  }
  const auto bit = static_cast<std::uint16_t>(1U << bin.layer_count++);
  std::uint16_t* const of_tile = memory.of_tile.data();
  const U64 with = U64::load(of_tile);
  select(lanes_of(tiles), with | bit, with).store(of_tile);
  bin.in_memory &= ~tiles;
  bin.job.counters.skipped.trivially_accepted += static_cast<unsigned>(std::popcount(tiles));
  const std::uint64_t pixels = kTilePixels * static_cast<unsigned>(std::popcount(tiles));
  count_fragments(bin, pixels * bin.samples, pixels * bin.samples);
}

/// Counts the fragments of layers on `tiles`, which an opaque triangle is about to hide.
HALFPLANE_NOINLINE void drop_layers(Bin& bin, std::uint64_t tiles) {
  const LayerMemory& memory = LayerMemory::of_thread();
  std::uint64_t layers = 0;
  for (; tiles != 0; tiles &= tiles - 1)
    layers += static_cast<unsigned>(
        std::popcount(unsigned{memory.of_tile[static_cast<std::size_t>(std::countr_zero(tiles))]}));
  bin.job.counters.skipped.attributes += kTilePixels * layers;
}

}  // namespace
}  // namespace halfplane::functional::HALFPLANE_ISA_NAME
