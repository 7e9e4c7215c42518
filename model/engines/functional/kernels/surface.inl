// Surfaces in lanes: the colours of a tile's pixels that show a triangle with a texture or colours over w.
#pragma once

#include "bin.inl"
#include "level_of_detail.inl"
#include "light.inl"
#include "perspective.inl"
#include "texture.inl"
#include "tile_memory.inl"
#include "upright.inl"
#include "values.inl"

namespace halfplane::functional::HALFPLANE_ISA_NAME {
namespace {

/// divide_by_255() of channels in the halves of lanes: (t + (t >> 8)) >> 8 is 257 t >> 16.
HALFPLANE_INLINE S32 divide_by_255(const S32& value) { return multiply_upper(value + 128, 257); }

/// combined().
HALFPLANE_INLINE ColorPairs combined(const ColorPairs& color, const ColorPairs& texel, const LaneTexture& texture) {
  const auto with_alpha = [](const ColorPairs& rgb, const I16& green_alpha) HALFPLANE_LAMBDA {
    return ColorPairs(rgb.red_blue, joined_halves(rgb.green_alpha, green_alpha));
  };
  const auto by_channel = [&](auto&& of) HALFPLANE_LAMBDA {
    return ColorPairs(as<I16>(of(as<S32>(color.red_blue), as<S32>(texel.red_blue))),
                      as<I16>(of(as<S32>(color.green_alpha), as<S32>(texel.green_alpha))));
  };
  const auto product = [](const S32& a, const S32& b) HALFPLANE_LAMBDA { return divide_by_255(a * b); };
  switch (texture.combine) {
    case TextureCombine::modulate: return by_channel(product);
    case TextureCombine::replace: return texture.has_alpha ? texel : with_alpha(texel, color.green_alpha);
    case TextureCombine::decal: {
      const auto part = as<S32>(upper_pairs(texel.green_alpha, texel.green_alpha));
      const auto mixed = by_channel([&](const S32& a, const S32& b)
                                        HALFPLANE_LAMBDA { return divide_by_255(a * (255 - part) + b * part); });
      return with_alpha(mixed, color.green_alpha);
    }
    case TextureCombine::blend: {
      const auto blended = [&](std::size_t pair, const S32& a, const S32& part) HALFPLANE_LAMBDA {
        return as<I16>(divide_by_255(a * (255 - part) + as<S32>(I16(texture.constant[pair])) * part));
      };
      return with_alpha(ColorPairs(blended(0, as<S32>(color.red_blue), as<S32>(texel.red_blue)),
                                   blended(1, as<S32>(color.green_alpha), as<S32>(texel.green_alpha))),
                        by_channel(product).green_alpha);
    }
    default: {
      const auto sum = by_channel([](const S32& a, const S32& b) HALFPLANE_LAMBDA { return min(a + b, S32(255)); });
      return with_alpha(sum, by_channel(product).green_alpha);
    }
  }
}

HALFPLANE_INLINE Sampling sampling_of(const SurfaceConstants& of) {
  return of.has_texture ? sampling_of(of.texture) : Sampling::none;
}

/// The surface of a tile.
template <Sampling kSampling>
struct SurfaceRamps {
  QuotientRamps<2> coordinate;
  ReciprocalsOfQ constant_q;  ///< of all pixels, if SurfaceConstants::has_constant_w; likewise lambda
  I16 constant_lod;
  QuotientRamps<4> color_over_w;
  ColorRamp color;
  LodRamps lod;

  /// `has_color`: whether own() will be called.
  HALFPLANE_INLINE SurfaceRamps(const Bin& bin, const DrawnSurface& surface, int tile_x, int tile_y, bool has_color) {
    const SurfaceConstants& of = surface.constants;
    if constexpr (kSampling != Sampling::none) {
      coordinate.set(bin, of.coordinate, tile_x, tile_y);
      if constexpr (kSampling == Sampling::any) lod.set(bin, of.texture.lod, tile_x, tile_y);
      if (of.has_constant_w) {
        constant_q.set(coordinate.q.first, of.division);
        if constexpr (kSampling == Sampling::any) constant_lod = lod(of.texture.lod, 0, constant_q.bits);
      }
    }
    if (!has_color || of.has_constant_color) return;
    if (of.is_color_over_w) {
      color_over_w.set(bin, of.color, tile_x, tile_y);
      return;
    }
    const ColorRamp ramp = color_ramp(bin, surface.colors.color, color_anchor(bin, surface.colors, tile_x, tile_y));
    for (std::size_t p = 0; p < ramp.size(); ++p) color[p] = ramp[p];
  }

  /// The primitive's own colours in a block.
  HALFPLANE_INLINE ColorPairs own(const Bin& bin, const DrawnSurface& surface, std::size_t block) const {
    const SurfaceConstants& of = surface.constants;
    if (of.has_constant_color) {
      const auto constant = [&](std::size_t c) HALFPLANE_LAMBDA {
        return I16(static_cast<int>(of.color_low[c] | of.color_low[c + 2] << 16));
      };
      return {constant(0), constant(1)};
    }
    if (!of.is_color_over_w) {
      const ColorSteps& steps = surface.colors.color;
      const auto pair = [&](std::size_t p) HALFPLANE_LAMBDA {
        return color_codes(color[p](block), I16(steps.low[p]), I16(steps.high[p]), bin.color_format);
      };
      return {pair(0), pair(1)};
    }
    const ReciprocalsOfQ q(color_over_w.q(block), of.division);
    const auto channel = [&](std::size_t c) HALFPLANE_LAMBDA {
      const auto low = static_cast<std::int32_t>(of.color_low[c]), high = static_cast<std::int32_t>(of.color_high[c]);
      if (low == high) return I16(low);
      const I16 code = over_q(color_over_w.p[c](block), q, of.color.attribute[c], of.of_color);
      return min(max(code, I16(low)), I16(high));
    };
    return {channel(0) | (channel(2) << 16), channel(1) | (channel(3) << 16)};
  }

  /// Coordinates of a block's pixels on the texture. Returns lambda, if needed.
  HALFPLANE_INLINE I16 find_coordinates(const SurfaceConstants& of, std::size_t block, CoordinateLanes& at) const {
    const LaneTexture& texture = of.texture;
    ReciprocalsOfQ varying;
    if (!of.has_constant_w) varying.set(coordinate.q(block), of.division);
    const ReciprocalsOfQ& q = of.has_constant_w ? constant_q : varying;
    const auto along = [&](std::size_t axis) HALFPLANE_LAMBDA {
      const I16 u = over_q(coordinate.p[axis](block), q, of.coordinate.attribute[axis], of.of_coordinate);
      return on_axis(texture, axis, u, texture.reference[axis]);
    };
    at.u = along(0);
    at.v = along(1);
    if constexpr (kSampling == Sampling::any) return of.has_constant_w ? constant_lod : lod(texture.lod, block, q.bits);
    return I16(0);
  }
};

/// The usual samples of a tile by footprints, in two steps: linear ones of level 0, and those between two levels.
template <bool kHasLevels>
struct TileSamples {
  FootprintPlaces lower[4], upper[4];
  I16 part[4];
  int levels = 0;  ///< 0 for other samples: sample() has them

  /// `lod`: without bias and bounds; `to_sign`: 31 - lane.
  HALFPLANE_INLINE TileSamples(const LaneTexture& texture, std::uint64_t pixels, const CoordinateLanes (&at)[4],
                               const I16 (&lod)[4], [[maybe_unused]] const I16& to_sign) {
    if (texture.has_border || texture.quads == nullptr) return;
    const auto each = [&](auto&& visit) HALFPLANE_LAMBDA {
      for_each_block([&](auto block) HALFPLANE_LAMBDA {
        if (block_bits(pixels, block) != 0) visit(block);
      });
    };
    const auto on_level = [&](FootprintPlaces& places, std::size_t block, const auto& level)
                              HALFPLANE_LAMBDA { places.set(texture, from_middle_of(at[block], level), level); };
    if constexpr (!kHasLevels) {
      const BaseLevel level(texture);
      each([&](auto block) HALFPLANE_LAMBDA { on_level(lower[block], block, level); });
      levels = 1;
    } else {
      I16 least(std::numeric_limits<std::int32_t>::max()), most(std::numeric_limits<std::int32_t>::min());
      each([&](auto block) HALFPLANE_LAMBDA {
        part[block] = bounded_lod(texture, lod[block]);
        const auto bits = block_bits(pixels, block);  // other lanes are undefined
        least = min(least, select_by_bits(bits, part[block], least, to_sign));
        most = max(most, select_by_bits(bits, part[block], most, to_sign));
      });
      const Lod low = min_lane(least), high = max_lane(most);
      const bool is_magnified = high <= texture.magnified;
      if (is_magnified ? texture.mag != TextureMag::linear
                       : low <= texture.magnified || texture.min != TextureMin::linear_mipmap_linear)
        return;
      levels = is_magnified ? 1 : 2;
      const auto level_of = [&texture](Lod lambda)
                                HALFPLANE_LAMBDA { return std::min(lambda >> kLodFraction, texture.last_level); };
      if (is_magnified || level_of(low) == level_of(high)) {
        const int first = is_magnified ? 0 : level_of(low);
        const OneLevel level(texture, first), next(texture, std::min(first + 1, texture.last_level));
        each([&](auto block) HALFPLANE_LAMBDA {
          on_level(lower[block], block, level);
          if (levels == 2) on_level(upper[block], block, next);
        });
      } else {
        each([&](auto block) HALFPLANE_LAMBDA {
          const LevelPairLanes around(part[block], texture.last_level);
          on_level(lower[block], block, LaneLevel(texture, around.lower));
          on_level(upper[block], block, LaneLevel(texture, around.upper));
        });
      }
    }
  }
  HALFPLANE_INLINE ColorPairs texels(const LaneTexture& texture, std::size_t block) const {
    const auto sums = [&texture](const FootprintPlaces& places, SumTo to)
                          HALFPLANE_LAMBDA { return linear_sums(places.fetched(texture), to); };
    if (!kHasLevels || levels == 1) return integers_of(sums(lower[block], SumTo::integer));
    return blend_levels(sums(lower[block], SumTo::level), sums(upper[block], SumTo::level), part[block] & 255);
  }
};

template <Sampling kSampling>
HALFPLANE_INLINE ColorPairs texels_at(const LaneTexture& texture, const CoordinateLanes& at, const I16& lod) {
  if constexpr (kSampling == Sampling::linear) return filter_linear(texture, at, BaseLevel(texture));
  return sample(texture, at, lod);
}

/// The filtered texels of a tile's blocks.
template <Sampling kSampling>
HALFPLANE_INLINE void find_texels(const Bin& bin, const LaneTexture& texture, std::uint64_t pixels,
                                  const CoordinateLanes (&at)[4], const I16 (&lod)[4], I16 (&red_blue)[4],
                                  I16 (&green_alpha)[4]) {
  const TileSamples<kSampling == Sampling::any> usual(texture, pixels, at, lod, bin.position.to_sign);
  for_each_block([&](auto block) HALFPLANE_LAMBDA {
    if (block_bits(pixels, block) == 0) return;
    const ColorPairs texels =
        usual.levels != 0 ? usual.texels(texture, block) : texels_at<kSampling>(texture, at[block], lod[block]);
    red_blue[block] = texels.red_blue;
    green_alpha[block] = texels.green_alpha;
  });
}

/// Colours of a tile's `pixels`. Each step runs for all four blocks before the next: the steps of one block depend on
/// each other, and would hide the loads of the next block from the scheduler.
template <Sampling kSampling>
HALFPLANE_NOINLINE void shade(Bin& bin, const DrawnSurface& surface, int tile, std::uint64_t pixels,
                              std::uint32_t* const colors, const Packing& packing) {
  constexpr bool kHasTexture = kSampling != Sampling::none;
  const SurfaceConstants& of = surface.constants;
  const SurfaceRamps<kSampling> ramps(bin, surface, tile % kBinTiles, tile / kBinTiles, of.has_color);
  CoordinateLanes at[4];
  I16 lod[4], red_blue[4], green_alpha[4];
  alignas(64) std::array<std::uint32_t, kTilePixels> nearest;
  if constexpr (kSampling == Sampling::nearest) {
    for_each_block([&](auto block) HALFPLANE_LAMBDA {
      if (block_bits(pixels, block) == 0) return;
      (void)ramps.find_coordinates(of, block, at[block]);
      const Places places(nearest_places(of.texture, at[block], BaseLevel(of.texture)));
      fetch_texels(of.texture.texels, places.place.data(), nearest.data() + block * kBlockPixels);
    });
  } else if constexpr (kHasTexture) {
    for_each_block([&](auto block) HALFPLANE_LAMBDA {
      if (block_bits(pixels, block) != 0) lod[block] = ramps.find_coordinates(of, block, at[block]);
    });
    find_texels<kSampling>(bin, of.texture, pixels, at, lod, red_blue, green_alpha);
  }
  store_pixels(bin, colors, pixels, true, [&](auto block, const I16&) HALFPLANE_LAMBDA {
    const auto pairs = [&]() HALFPLANE_LAMBDA {
      if constexpr (!kHasTexture) return ramps.own(bin, surface, block);
      const ColorPairs texels = [&]() HALFPLANE_LAMBDA {
        if constexpr (kSampling == Sampling::nearest)
          return ColorPairs(I16::load(nearest.data() + block * kBlockPixels));
        return ColorPairs(red_blue[block], green_alpha[block]);
      }();
      return of.has_color ? combined(ramps.own(bin, surface, block), texels, of.texture) : texels;
    }();
    return packed(pairs.red_blue, pairs.green_alpha, packing);
  });
}

/// shade() with the tile's texels known, R lowest: combines them with the primitive's own colours.
HALFPLANE_NOINLINE void combine_texels(Bin& bin, const DrawnSurface& surface, int tile, std::uint64_t pixels,
                                       const std::uint32_t* texels, std::uint32_t* const colors,
                                       const Packing& packing) {
  const SurfaceConstants& of = surface.constants;
  const SurfaceRamps<Sampling::none> ramps(bin, surface, tile % kBinTiles, tile / kBinTiles, of.has_color);
  store_pixels(bin, colors, pixels, true, [&](auto block, const I16&) HALFPLANE_LAMBDA {
    const ColorPairs texel(I16::load(texels + block * kBlockPixels));
    const ColorPairs mixed = of.has_color ? combined(ramps.own(bin, surface, block), texel, of.texture) : texel;
    return packed(mixed.red_blue, mixed.green_alpha, packing);
  });
}

/// The same pixel by pixel, by the stages.
HALFPLANE_NOINLINE void shade_by_stages(Bin& bin, const Surface& surface, int tile, std::uint64_t pixels,
                                        std::uint32_t* const colors, const Packing& packing) {
  const int left = bin.first_x + tile % kBinTiles * kTileSize, top = bin.first_y + tile / kBinTiles * kTileSize;
  for (; pixels != 0; pixels &= pixels - 1) {
    const auto at = static_cast<std::size_t>(std::countr_zero(pixels));
    const int block = static_cast<int>(at) / kBlockPixels, pixel = static_cast<int>(at) % kBlockPixels;
    const int x = block % 2 * kBlockSize + pixel % kBlockSize, y = block / 2 * kBlockSize + pixel / kBlockSize;
    const std::array<std::uint8_t, 4> c = surface.color(left + x, top + y);
    colors[at] = packing.dithers ? pack_rgb565_dithered<std::uint32_t>(c[0], c[1], c[2], dither_threshold(x, y))
                                 : pack_color(packing.format, c);
  }
}

/// The textures alone, or colours without light.
HALFPLANE_INLINE void shade_unlit(Bin& bin, const DrawnSurface& surface, int tile, std::uint64_t pixels,
                                  std::uint32_t* const colors, const Packing& packing) {
  if (surface.constants.is_upright) {
    alignas(64) std::array<std::uint32_t, kTilePixels> texels;
    if (find_upright_texels(bin, surface, tile, texels.data()))
      return combine_texels(bin, surface, tile, pixels, texels.data(), colors, packing);
  }
  switch (sampling_of(surface.constants)) {
    case Sampling::none: return shade<Sampling::none>(bin, surface, tile, pixels, colors, packing);
    case Sampling::nearest: return shade<Sampling::nearest>(bin, surface, tile, pixels, colors, packing);
    case Sampling::linear: return shade<Sampling::linear>(bin, surface, tile, pixels, colors, packing);
    case Sampling::any: return shade<Sampling::any>(bin, surface, tile, pixels, colors, packing);
  }
}

/// Lit colours: texels first, if there are some, in 8 bits a channel.
HALFPLANE_NOINLINE void shade_lit(Bin& bin, const DrawnSurface& surface, int tile, std::uint64_t pixels,
                                  std::uint32_t* const colors, const Packing& packing) {
  const SurfaceConstants& of = surface.constants;
  alignas(64) std::array<std::uint32_t, kTilePixels> texels{};
  if (of.has_texture) shade_unlit(bin, surface, tile, pixels, texels.data(), kUnpacked);
  const SurfaceRamps<Sampling::none> ramps(bin, surface, tile % kBinTiles, tile / kBinTiles, true);
  const NormalRamps normals(bin, *of.light, tile % kBinTiles, tile / kBinTiles);
  store_pixels(bin, colors, pixels, true, [&](auto block, const I16&) HALFPLANE_LAMBDA {
    const ColorPairs lit = LightLanes(normals, *of.light, block).lit(ramps.own(bin, surface, block), *of.light);
    const ColorPairs pairs =
        of.has_texture ? combined(lit, ColorPairs(I16::load(texels.data() + block * kBlockPixels)), of.texture) : lit;
    return packed(pairs.red_blue, pairs.green_alpha, packing);
  });
}

/// All that lanes do, except fog.
HALFPLANE_INLINE void shade_in_lanes(Bin& bin, const DrawnSurface& surface, int tile, std::uint64_t pixels,
                                     std::uint32_t* const colors, const Packing& packing) {
  if (surface.constants.light) return shade_lit(bin, surface, tile, pixels, colors, packing);
  shade_unlit(bin, surface, tile, pixels, colors, packing);
}

/// f of pixels, 2^-12: FogTable::factor().
HALFPLANE_INLINE I16 fog_factors(const I16& q, const LaneFog& fog, int up) {
  const I16 bits = float_bits(shift_right_logical(q, up));
  const I16 position = min(max((bits >> (kFloatFraction - kFogPlaceBits)) - fog.first, I16(0)), I16(fog.last));
  const I16 line = (position >> fog.place_bits) << 1, place = position & ((1 << fog.place_bits) - 1);
  const auto* const numbers = &fog.lines->start;
  const I16 sum = (gather(numbers, line) << fog.place_bits) + gather(numbers, line + 1) * place + (1 << (fog.drop - 1));
  return min(max(sum >> fog.drop, I16(0)), I16(kFogClear));
}

/// fogged().
HALFPLANE_INLINE ColorPairs in_fog(const ColorPairs& color, const I16& factor, const LaneFog& fog) {
  const auto mixed = [&](const I16& channel, std::size_t c) HALFPLANE_LAMBDA {
    const std::int32_t at_none = (fog.color[c] << kFogFactorBits) + (1 << (kFogFactorBits - 1));
    return ((channel - fog.color[c]) * factor + at_none) >> kFogFactorBits;
  };
  return ColorPairs(
      mixed(color.red_blue & 0xffff, 0) | (mixed(color.red_blue >> 16, 2) << 16),
      mixed(color.green_alpha & 0xffff, 1) | (color.green_alpha & static_cast<std::int32_t>(0xffff0000U)));
}

/// The same with fog, a pass of its own over colours of 8 bits: no cost without fog.
HALFPLANE_NOINLINE void shade_in_fog(Bin& bin, const DrawnSurface& surface, int tile, std::uint64_t pixels,
                                     std::uint32_t* const colors, const Packing& packing) {
  alignas(64) std::array<std::uint32_t, kTilePixels> clear{};
  shade_in_lanes(bin, surface, tile, pixels, clear.data(), kUnpacked);
  const LaneFog& fog = surface.constants.fog;
  const BlockRamp<I16> q = over_w_ramp(bin, fog.q, tile % kBinTiles, tile / kBinTiles);
  store_pixels(bin, colors, pixels, true, [&](auto block, const I16&) HALFPLANE_LAMBDA {
    const I16 factors = fog_factors(q(block), fog, surface.constants.division.up);
    const ColorPairs pairs = in_fog(ColorPairs(I16::load(clear.data() + block * kBlockPixels)), factors, fog);
    return packed(pairs.red_blue, pairs.green_alpha, packing);
  });
}

/// Writes colours of a tile's `pixels`, in a format, to their places among the tile's 64.
HALFPLANE_INLINE void shade(Bin& bin, const DrawnSurface& surface, int tile, std::uint64_t pixels,
                            std::uint32_t* const colors, const Packing& packing) {
  if (surface.stage) return shade_by_stages(bin, surface.stage->surface, tile, pixels, colors, packing);
  if (surface.constants.has_fog) return shade_in_fog(bin, surface, tile, pixels, colors, packing);
  shade_in_lanes(bin, surface, tile, pixels, colors, packing);
}
/// Writes them to memory, in the stored format.
HALFPLANE_INLINE void shade(Bin& bin, const DrawnSurface& surface, int tile, std::uint64_t pixels) {
  shade(bin, surface, tile, pixels, bin.memory.color.data() + first_of(tile), surface.packing);
}

}  // namespace
}  // namespace halfplane::functional::HALFPLANE_ISA_NAME
