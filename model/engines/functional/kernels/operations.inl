// Operations in lanes: alpha test, blending, dithering, logic operations and masks of a triangle's pixels in a tile, from color_ops.hpp.
// Colours have the layout of surfaces: red with blue and green with alpha in the halves of lanes.
//
// Such a triangle reads stored values, so it owns no tile and defers no colour; hidden tiles are still skipped.
#pragma once

#include "bin.inl"
#include "deferred.inl"
#include "fragments.inl"
#include "layers.inl"
#include "perspective.inl"
#include "surface.inl"
#include "texture.inl"
#include "tile_memory.inl"
#include "values.inl"

namespace halfplane::functional::HALFPLANE_ISA_NAME {
namespace {

using H32 = Pack<std::uint16_t, 32>;  ///< unsigned

/// min(a + b, 255^2) for products of codes.
HALFPLANE_INLINE S32 limited_sum(const S32& a, const S32& b) {
  constexpr std::uint16_t kMost = 255 * 255;
  const auto first = as<H32>(a);
  return as<S32>(first + min(as<H32>(b), kMost - first));
}
HALFPLANE_INLINE S32 limited_difference(const S32& a, const S32& b) {
  const auto first = as<H32>(a);
  return as<S32>(first - min(first, as<H32>(b)));
}

/// blended() by src_alpha and one: a stored code of 8 bits adds the same before and after the division.
HALFPLANE_INLINE ColorPairs added_light(const ColorPairs& source, const ColorPairs& stored, std::int32_t own_factor) {
  const S32 alpha = alpha_pairs(source.green_alpha), of_alpha = as<S32>(as<I16>(alpha) | own_factor);
  const auto sum = [](const I16& codes, const S32& factor, const I16& before) HALFPLANE_LAMBDA {
    return as<I16>(min(divide_by_255(as<S32>(codes) * factor) + as<S32>(before), S32(255)));
  };
  return ColorPairs(sum(source.red_blue, alpha, stored.red_blue),
                    sum(source.green_alpha, of_alpha, stored.green_alpha));
}

/// A block's colours before they are stored.
struct BlendLanes {
  const ColorOps& ops;
  ColorPairs source, stored;
  S32 source_alpha, stored_alpha;

  HALFPLANE_INLINE BlendLanes(const ColorOps& ops_, const ColorPairs& source_, const ColorPairs& stored_)
      : ops(ops_),
        source(source_),
        stored(stored_),
        source_alpha(alpha_pairs(source.green_alpha)),
        stored_alpha(alpha_pairs(stored.green_alpha)) {}

  /// blend_factor() of red with blue, or green with alpha; `is_alpha`: for the latter, alpha's factor.
  HALFPLANE_INLINE S32 factor(BlendFactor of, const S32& src, const S32& dst, std::size_t first, std::size_t second,
                              bool is_alpha) const {
    const auto constant = [&](std::size_t a, std::size_t b)
                              HALFPLANE_LAMBDA { return as<S32>(I16(ops.constant[a] | ops.constant[b] << 16)); };
    switch (of) {
      case BlendFactor::zero: return S32(0);
      case BlendFactor::one: return S32(255);
      case BlendFactor::src_color: return src;
      case BlendFactor::one_minus_src_color: return 255 - src;
      case BlendFactor::dst_color: return dst;
      case BlendFactor::one_minus_dst_color: return 255 - dst;
      case BlendFactor::src_alpha: return source_alpha;
      case BlendFactor::one_minus_src_alpha: return 255 - source_alpha;
      case BlendFactor::dst_alpha: return stored_alpha;
      case BlendFactor::one_minus_dst_alpha: return 255 - stored_alpha;
      case BlendFactor::constant_color: return constant(first, second);
      case BlendFactor::one_minus_constant_color: return 255 - constant(first, second);
      case BlendFactor::constant_alpha: return constant(3, 3);
      case BlendFactor::one_minus_constant_alpha: return 255 - constant(3, 3);
      case BlendFactor::src_alpha_saturate: return is_alpha ? S32(255) : min(source_alpha, 255 - stored_alpha);
    }
    return S32(0);
  }

  /// blend_channel() of pairs.
  HALFPLANE_INLINE static S32 put_together(BlendEquation equation, const S32& s, const S32& fs, const S32& d,
                                           const S32& fd) {
    switch (equation) {
      case BlendEquation::add: return divide_by_255(limited_sum(s * fs, d * fd));
      case BlendEquation::subtract: return divide_by_255(limited_difference(s * fs, d * fd));
      case BlendEquation::reverse_subtract: return divide_by_255(limited_difference(d * fd, s * fs));
      case BlendEquation::min: return min(s, d);
      default: return max(s, d);
    }
  }

  /// blended().
  HALFPLANE_INLINE ColorPairs operator()(bool has_alpha) const {
    const BlendFactors& f = ops.factors;
    const auto pair = [&](const I16& src, const I16& dst, std::size_t first, std::size_t second,
                          bool is_alpha) HALFPLANE_LAMBDA {
      const auto s = as<S32>(src), d = as<S32>(dst);
      return as<I16>(put_together(ops.equation[is_alpha ? 1 : 0], s,
                                  factor(is_alpha ? f.src_alpha : f.src, s, d, first, second, is_alpha), d,
                                  factor(is_alpha ? f.dst_alpha : f.dst, s, d, first, second, is_alpha)));
    };
    const I16 red_blue = pair(source.red_blue, stored.red_blue, 0, 2, false),
              green = pair(source.green_alpha, stored.green_alpha, 1, 3, false);
    if (!has_alpha) return ColorPairs(red_blue, green);
    const I16 alpha = pair(source.green_alpha, stored.green_alpha, 1, 3, true);
    return ColorPairs(red_blue, joined_halves(green, alpha));
  }
};

/// The colours of a tile's pixels before they are stored: computed on demand, or a surface's.
struct TileColors {
  ColorRamp plane;
  const ColorSteps& steps;
  const LaneFormat& format;
  bool is_surface;
  alignas(64) std::array<std::uint32_t, kTilePixels> rgba;  ///< colours of a surface

  HALFPLANE_INLINE TileColors(Bin& bin, const BinTriangle& t, int tile, std::uint64_t pixels)
      : steps(t.color), format(bin.color_format), is_surface(t.surface != 0) {
    if (is_surface) {
      rgba.fill(0);
      shade(bin, drawn_surface(bin, static_cast<std::size_t>(t.surface)), tile, pixels, rgba.data(), kUnpacked);
    } else {
      const ColorRamp ramp = color_ramp(bin, t.color, color_anchor(bin, t, tile % kBinTiles, tile / kBinTiles));
      for (std::size_t p = 0; p < ramp.size(); ++p) plane[p] = ramp[p];
    }
  }
  HALFPLANE_INLINE ColorPairs operator[](std::size_t block) const {
    if (is_surface) return ColorPairs(I16::load(rgba.data() + block * kBlockPixels));
    return ColorPairs(color_codes(plane[0](block), I16(steps.low[0]), I16(steps.high[0]), format),
                      color_codes(plane[1](block), I16(steps.low[1]), I16(steps.high[1]), format));
  }
};

/// The `pixels` that pass the alpha test. `alpha_of`: alpha of a block.
template <class AlphaOf>
HALFPLANE_INLINE std::uint64_t test_alphas(const Bin& bin, std::uint64_t pixels, AlphaOf&& alpha_of) {
  const DepthFunc func = bin.ops->alpha.func;
  const I16 reference(bin.ops->alpha.reference);
  std::uint64_t passed = 0;
  for_each_block([&](auto block) HALFPLANE_LAMBDA {
    const I16 alpha = alpha_of(block);
    const I16 less = alpha < reference, equal = alpha == reference;
    I16 passes(0);
    if (depth_passes(func, 0, 1)) passes |= less;
    if (depth_passes(func, 0, 0)) passes |= equal;
    if (depth_passes(func, 1, 0)) passes |= ~(less | equal);
    passed |= std::uint64_t{bits_of(passes)} << (kBlockPixels * block);
  });
  return passed & pixels;
}
/// `colors`: of a block, as in TileColors.
template <class Colors>
HALFPLANE_INLINE std::uint64_t test_alpha(const Bin& bin, std::uint64_t pixels, const Colors& colors) {
  return test_alphas(bin, pixels, [&colors](auto block) HALFPLANE_LAMBDA {
    return shift_right_logical(colors[block].green_alpha, 16);
  });
}

/// Whether the alpha of a surface's linear filter can be computed without its colours.
HALFPLANE_INLINE bool has_alpha_alone(const DrawnSurface& surface) {
  const SurfaceConstants& of = surface.constants;
  return of.are_in_lanes && of.has_texture && !of.light && of.texture.alpha_quads != nullptr &&
         sampling_of(of.texture) == Sampling::linear &&
         (!of.has_color || of.texture.combine == TextureCombine::modulate);
}

/// test_alpha() for such a surface in a tile.
HALFPLANE_NOINLINE std::uint64_t test_linear_alpha(const Bin& bin, const DrawnSurface& surface, int tile,
                                                   std::uint64_t pixels) {
  const SurfaceConstants& of = surface.constants;
  const LaneTexture& texture = of.texture;
  const SurfaceRamps<Sampling::linear> ramps(bin, surface, tile % kBinTiles, tile / kBinTiles, of.has_color);
  alignas(64) std::array<std::uint32_t, kTilePixels> quads;
  CoordinateLanes at[4];
  for_each_block([&](auto block) HALFPLANE_LAMBDA {
    (void)ramps.find_coordinates(of, block, at[block]);
    const CoordinateLanes held = held_for_quads(texture, from_middle_of(at[block], BaseLevel(texture)));
    at[block].u = held.u;
    at[block].v = held.v;
    const Places places(footprint_places(texture, held, BaseLevel(texture)));
    fetch_texels(texture.alpha_quads, places.place.data(), quads.data() + block * kBlockPixels);
  });
  return test_alphas(bin, pixels, [&](auto block) HALFPLANE_LAMBDA {
    const I16 texel = linear_alpha(at[block], I16::load(quads.data() + block * kBlockPixels));
    if (!of.has_color) return texel;
    const I16 own = shift_right_logical(ramps.own(bin, surface, block).green_alpha, 16);
    return as<I16>(divide_by_255(as<S32>(own) * as<S32>(texel)));
  });
}

/// A draw's logic operation in lanes: operated() of color_ops.hpp.
struct LogicLanes {
  std::int32_t none, source, stored, both;

  HALFPLANE_INLINE explicit LogicLanes(LogicOp op) {
    const LogicTerms terms(op);
    none = static_cast<std::int32_t>(terms.none);
    source = static_cast<std::int32_t>(terms.source);
    stored = static_cast<std::int32_t>(terms.stored);
    both = static_cast<std::int32_t>(terms.both);
  }
  HALFPLANE_INLINE I16 operator()(const I16& code, const I16& before) const {
    return (code & source) ^ (before & stored) ^ (code & before & both) ^ none;
  }
};

/// Writes depths of `pixels`, which have passed every test.
HALFPLANE_INLINE void write_depths(Bin& bin, const BinTriangle& t, int tile, std::uint64_t pixels) {
  if (pixels == 0) return;
  need_depth(bin, tile);
  const BlockRamp<I16> plane = depth_ramp(bin, t, depth_anchor(bin, t, tile % kBinTiles, tile / kBinTiles));
  const auto first = static_cast<std::size_t>(first_of(tile));
  for_each_block([&](auto block) HALFPLANE_LAMBDA {
    const std::size_t at = first + block * kBlockPixels;
    store_depths(bin, at,
                 select_by_bits(block_bits(pixels, block), block_depths(bin, t, plane, block), load_depths(bin, at),
                                bin.position.to_sign));
  });
  find_range(bin, tile);
}

/// Operates colours of `pixels` upon the stored ones, of a tile's 64, block after block at `stride`: store_color().
template <class Colors>
HALFPLANE_INLINE void store_colors(Bin& bin, std::uint32_t* to, std::uint64_t pixels, const Colors& colors,
                                   std::size_t stride = kBlockPixels) {
  const ColorOps& ops = bin.ops->color;
  const ColorFormat format = bin.config.color_format;
  const bool has_alpha = format == ColorFormat::rgba8888, blends = ops.blends(),
             is_over = has_over_factors(ops, format), is_light = has_factors(ops, BlendFactor::one, format);
  const std::int32_t own_factor = own_factor_bits(ops);
  const bool writes_some = bin.ops->state.color_write,  // false only without Skip::masked_draws
      has_logic = ops.logic != LogicOp::copy, writes_all = writes_some && !has_logic && writes_all_channels(ops);
  const auto written = writes_some ? static_cast<std::int32_t>(written_bits(ops, format)) : 0;
  const Packing packing = bin.packing;
  const LogicLanes logic(ops.logic);
  const auto code_of = [&](auto block, const I16& stored) HALFPLANE_LAMBDA {
    const auto mixed = [&]() HALFPLANE_LAMBDA {
      if (!blends) return colors[block];
      if (is_over) return laid_over(colors[block], widened(stored, format), own_factor);
      if (is_light) return added_light(colors[block], widened(stored, format), own_factor);
      return BlendLanes(ops, colors[block], widened(stored, format))(has_alpha);
    }();
    I16 code = packed(mixed.red_blue, mixed.green_alpha, packing);
    if (has_logic) code = logic(code, stored);
    return writes_all ? code : (code & written) | (stored & ~written);
  };
  store_pixels(bin, to, pixels, bin.skip.operations_early_z, code_of, stride);
}

/// Alphas from `low` to `high`.
struct Alphas {
  std::uint32_t low = 0, high = 255;
};

/// The alphas that pixels of a tile whose corners a textured triangle covers may have, by all reachable texels: level 0
/// only.
HALFPLANE_NOINLINE Alphas texture_alphas(Bin& bin, const BinTriangle& t, int tile, std::uint64_t pixels) {
  constexpr std::uint64_t kCorners =
      1 | std::uint64_t{1} << (kBlockPixels + 3) | std::uint64_t{1} << (2 * kBlockPixels + 12) | std::uint64_t{1} << 63;
  if ((pixels & kCorners) != kCorners || bin.samples != 1) return {};
  const DrawnSurface& surface = drawn_surface(bin, static_cast<std::size_t>(t.surface));
  const SurfaceConstants& of = surface.constants;
  const LaneTexture& texture = of.texture;
  if (!of.are_in_lanes || !of.has_texture || of.light || texture.alpha_ranges == nullptr) return {};
  const Sampling sampling = sampling_of(texture);
  if (sampling == Sampling::any) return {};
  std::array<std::int32_t, 2> low, high;
  const auto reach = [&](std::size_t axis, std::int32_t least, std::int32_t most) HALFPLANE_LAMBDA {
    const std::int32_t half = sampling == Sampling::linear ? 1 << (kTexelFraction - 1) : 0;  // to the texels around
    low[axis] = (least - texture.margin[axis] - half) >> kTexelFraction;
    high[axis] = (most + texture.margin[axis] + half) >> kTexelFraction;
  };
  if (of.is_upright) {
    const UprightMemory& places = upright_places(bin, surface, tile);
    const auto along = [&](std::size_t axis, std::size_t place) HALFPLANE_LAMBDA {
      const std::int32_t first = places.at[place][0], last = places.at[place][kTileSize - 1];
      reach(axis, std::min(first, last), std::max(first, last));
    };
    along(0, UprightMemory::column_of(tile));
    along(1, UprightMemory::row_of(tile));
  } else {
    const int tile_x = (bin.first_x >> kTileShift) + tile % kBinTiles,
              tile_y = (bin.first_y >> kTileShift) + tile / kBinTiles;
    // The corners, repeated.
    const I16 column = I16::of([](int i) { return (i & 1) != 0 ? kTileSize / 2 - 1 : -kTileSize / 2; }),
              row = I16::of([](int i) { return (i & 2) != 0 ? kTileSize / 2 - 1 : -kTileSize / 2; });
    const auto at_corners = [&](const LanePlane& plane) HALFPLANE_LAMBDA {
      return column * plane.step_x + row * plane.step_y + plane.anchor(tile_x, tile_y);
    };
    const ReciprocalsOfQ q(at_corners(of.coordinate.q), of.division);
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const LaneAttribute& attribute = of.coordinate.attribute[axis];
      const I16 u = over_q(at_corners(attribute.p), q, attribute, of.of_coordinate);
      alignas(64) std::array<std::int32_t, kBlockPixels> corner;
      on_axis(texture, axis, u, texture.reference[axis]).store(corner.data());
      const auto [least, most] = std::minmax({corner[0], corner[1], corner[2], corner[3]});
      reach(axis, least, most);
    }
  }
  const TexelBlocks::AlphaRanges::Range texel = texture.alpha_ranges->range(low, high, texture.wrap);
  const auto result = [&](std::uint32_t own, std::uint32_t of_texel) HALFPLANE_LAMBDA -> std::uint32_t {
    if (!of.has_color) return of_texel;
    switch (texture.combine) {
      case TextureCombine::replace: return texture.has_alpha ? of_texel : own;
      case TextureCombine::decal: return own;
      default: return halfplane::divide_by_255(own * of_texel);
    }
  };
  return {result(of.color_low[3], texel.low), result(of.color_high[3], texel.high)};
}

/// The outcome of the alpha test for all pixels of a tile, as far as the alpha of a triangle's plane decides it: as
/// lanes compute it from the tile's anchor, if no value wraps.
HALFPLANE_INLINE Outcome alpha_outcome(Bin& bin, const BinTriangle& t, int tile, std::uint64_t pixels) {
  if (!bin.tests_alpha) return Outcome::all_pass;
  if (bin.is_killed) return Outcome::none_passes;
  if (!bin.skip.alpha_tiles) return Outcome::some_pass;
  if (t.surface != 0) {
    const Alphas alphas = texture_alphas(bin, t, tile, pixels);
    return test_outcome(bin.ops->alpha.func, bin.ops->alpha.reference, alphas.low, alphas.high);
  }
  const LaneFormat& format = bin.color_format;
  const auto upper = [](std::int32_t pair) HALFPLANE_LAMBDA { return pair >> 16; };
  const int step_x = upper(t.color.step_x[1]), step_y = upper(t.color.step_y[1]);
  const int anchor = upper(color_anchor(bin, t, tile % kBinTiles, tile / kBinTiles)[1]) & 0xffff;
  constexpr int kBefore = kTileSize / 2, kBehind = kTileSize / 2 - 1;
  const int least =
                anchor + std::min(-kBefore * step_x, kBehind * step_x) + std::min(-kBefore * step_y, kBehind * step_y),
            most =
                anchor + std::max(-kBefore * step_x, kBehind * step_x) + std::max(-kBefore * step_y, kBehind * step_y);
  int low = upper(t.color.low[1]), high = upper(t.color.high[1]);
  if (least >= 0 && most < 1 << 16) {
    const auto code = [&, low, high](int value)
                          HALFPLANE_LAMBDA { return std::clamp((value >> format.down) - format.bias, low, high); };
    low = code(least);
    high = code(most);
  }
  return test_outcome(bin.ops->alpha.func, bin.ops->alpha.reference, static_cast<std::uint32_t>(low),
                      static_cast<std::uint32_t>(high));
}

/// Whether a source of alpha 0 leaves the stored colour as it is, for all values of both.
inline bool keeps_where_transparent(const ColorOps& ops) {
  const auto is_zero = [](BlendFactor f) { return f == BlendFactor::zero || f == BlendFactor::src_alpha; };
  const auto is_one = [](BlendFactor f) { return f == BlendFactor::one || f == BlendFactor::one_minus_src_alpha; };
  const auto adds = [](BlendEquation e) { return e == BlendEquation::add; };
  const BlendFactors& f = ops.factors;
  return is_zero(f.src) && is_one(f.dst) && is_one(f.dst_alpha) && adds(ops.equation[0]) && adds(ops.equation[1]) &&
         !ops.dithers && ops.logic == LogicOp::copy;
}

/// Operates on a tile's pixels that have passed the depth test; the alpha test may still drop them.
HALFPLANE_NOINLINE void operate_on_tile(Bin& bin, const BinTriangle& t, int tile, std::uint64_t passed) {
  const FragmentOps& ops = *bin.ops;
  if (passed == 0 && bin.skip.operations_early_z) {
    ++bin.job.counters.skipped.operations_early_z;
    return;
  }
  if (!bin.tests_alpha && !ops.state.color_write && bin.skip.masked_draws) return;
  const Outcome alpha = alpha_outcome(bin, t, tile, passed);
  if (alpha == Outcome::none_passes) {
    count_killed(bin, static_cast<unsigned>(std::popcount(passed)));
    ++bin.job.counters.skipped.alpha_tiles;
    return;
  }
  const bool may_be_transparent = t.surface != 0 && !bin.tests_alpha && bin.skip.alpha_tiles;
  if (may_be_transparent && keeps_where_transparent(ops.color) && texture_alphas(bin, t, tile, passed).high == 0) {
    ++bin.job.counters.skipped.alpha_tiles;
    return;
  }
  std::uint64_t kept = passed;
  const auto keep = [&](std::uint64_t those) HALFPLANE_LAMBDA {
    kept = those;
    count_killed(bin, static_cast<unsigned>(std::popcount(passed & ~kept)));
    if (bin.tests_alpha && ops.state.depth_write) write_depths(bin, t, tile, kept);
  };
  // A passing pixel replaces the stored values: its colour is deferred like any other surface's, and computed if
  // visible. bin.state.color_write also says that alpha is read.
  if (t.surface != 0 && bin.samples == 1 && bin.skip.attributes && ops.state.color_write && !ops.color.blends() &&
      undithered(ops.color, 1).is_plain()) {
    if (alpha == Outcome::some_pass) {
      const DrawnSurface& surface = drawn_surface(bin, static_cast<std::size_t>(t.surface));
      keep(has_alpha_alone(surface) ? test_linear_alpha(bin, surface, tile, passed)
                                    : test_alpha(bin, passed, TileColors(bin, t, tile, passed)));
    } else {
      keep(passed);
    }
    if (kept != 0) see(bin, t.surface, tile, kept);
    return;
  }
  const TileColors colors(bin, t, tile, passed);
  keep(alpha == Outcome::some_pass ? test_alpha(bin, passed, colors) : passed);
  if ((!ops.state.color_write && bin.skip.masked_draws) || (kept == 0 && bin.skip.operations_early_z)) return;
  need_color(bin, tile);
  store_colors(bin, bin.memory.color.data() + first_of(tile), kept, colors);
}

}  // namespace
}  // namespace halfplane::functional::HALFPLANE_ISA_NAME
