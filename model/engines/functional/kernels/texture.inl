// Texels in lanes: texture_filter.hpp and texture_sample.hpp for textures whose sides are powers of two.
#pragma once

#include "lane_memory.inl"
#include "lane_moves.inl"

namespace halfplane::functional::HALFPLANE_ISA_NAME {
namespace {

/// 2^-8 texels of level 0.
struct CoordinateLanes {
  I16 u, v;
};

/// The coordinate along an axis from a quotient of over_q(). Far beyond the image all texels are equal, and so 32 bits
/// hold twice that.
template <class Reference>
HALFPLANE_LEAF I16 on_axis(const LaneTexture& texture, std::size_t axis, const I16& u, const Reference& reference) {
  const I16 sum = (texture.up == 0 ? u : u << texture.up) + reference;
  constexpr std::int32_t kFar = 1 << 22;
  return texture.wrap[axis] == TextureWrap::clamp ? min(max(sum, I16(-kFar)), I16(kFar)) : sum;
}

/// Level 0 in all lanes.
struct BaseLevel {
  const LaneTexture& texture;

  HALFPLANE_INLINE explicit BaseLevel(const LaneTexture& texture_) : texture(texture_) {}
  template <std::size_t kAxis>
  HALFPLANE_INLINE static const I16& cut(const I16& coordinate) {
    return coordinate;
  }
  template <std::size_t kAxis>
  HALFPLANE_INLINE static const I16& rounded(const I16& coordinate) {
    return coordinate;
  }
  template <std::size_t kAxis>
  HALFPLANE_INLINE I16 last() const {
    return I16(texture.last[kAxis]);
  }
  /// Shift from the block bits of a row's number to a place.
  HALFPLANE_INLINE int pitch() const { return texture.pitch; }
  HALFPLANE_INLINE static I16 first() { return I16(0); }
};

struct LaneLevel {
  I16 down[2], last_texel[2], to_row, first_texel;

  HALFPLANE_INLINE LaneLevel(const LaneTexture& texture, const I16& level) {
    for (std::size_t axis = 0; axis < 2; ++axis) {
      down[axis] = min(level, I16(texture.bits[axis]));
      last_texel[axis] = I16(texture.last[axis]) >> down[axis];
    }
    to_row = max(texture.bits[0] - level, I16(2));
    first_texel = looked_up(texture.first, level);
  }
  template <std::size_t kAxis>
  HALFPLANE_INLINE I16 cut(const I16& coordinate) const {
    return coordinate >> down[kAxis];
  }
  template <std::size_t kAxis>
  HALFPLANE_INLINE I16 rounded(const I16& coordinate) const {
    return (((coordinate << 1) >> down[kAxis]) + 1) >> 1;
  }
  template <std::size_t kAxis>
  HALFPLANE_INLINE const I16& last() const {
    return last_texel[kAxis];
  }
  HALFPLANE_INLINE const I16& pitch() const { return to_row; }
  HALFPLANE_INLINE const I16& first() const { return first_texel; }
};

/// wrapped_texel(). `last`: the last texel of the level, a power of two less 1.
HALFPLANE_INLINE I16 wrapped_texel(const I16& i, TextureWrap wrap, const I16& last) {
  if (wrap == TextureWrap::repeat) return i & last;
  if (wrap == TextureWrap::clamp) return min(max(i, I16(0)), last);
  const I16 period = (last << 1) | 1, rest = i & period;
  return rest ^ (period & (rest > last));
}

/// The parts of a texel's place in TexelBlocks from its column and its row.
HALFPLANE_INLINE I16 column_place(const I16& x) { return (x & 3) + ((x & ~3) << 2); }
template <class Pitch>
HALFPLANE_INLINE I16 row_place(const I16& y, const Pitch& pitch) {
  return ((y & 3) << 2) + ((y & ~3) << pitch);
}

/// Colours, 8 bits a channel in the halves of lanes.
struct ColorPairs {
  I16 red_blue, green_alpha;

  HALFPLANE_INLINE ColorPairs(const I16& red_blue_, const I16& green_alpha_)
      : red_blue(red_blue_), green_alpha(green_alpha_) {}
  /// R lowest.
  HALFPLANE_INLINE explicit ColorPairs(const I16& rgba)
      : ColorPairs(rgba & 0xff00ff, as<I16>(shift_right_logical(as<S32>(rgba), 8))) {}
  HALFPLANE_INLINE ColorPairs(const ColorPairs& from) : ColorPairs(from.red_blue, from.green_alpha) {}
  ColorPairs& operator=(const ColorPairs&) = delete;
};

/// Places of the nearest texels.
template <class Level>
HALFPLANE_INLINE I16 nearest_places(const LaneTexture& texture, const CoordinateLanes& at, const Level& level) {
  const I16 x = wrapped_texel(level.template cut<0>(at.u) >> kTexelFraction, texture.wrap[0], level.template last<0>()),
            y = wrapped_texel(level.template cut<1>(at.v) >> kTexelFraction, texture.wrap[1], level.template last<1>());
  return level.first() + column_place(x) + row_place(y, level.pitch());
}

/// is_on_border() of texels along one axis.
HALFPLANE_INLINE I16 is_on_border(const I16& texel, const I16& last) { return (texel < I16(0)) | (texel > last); }

/// R lowest.
template <class Level>
HALFPLANE_INLINE I16 filter_nearest(const LaneTexture& texture, const CoordinateLanes& at, const Level& level) {
  I16 texel = gather(texture.texels, nearest_places(texture, at, level));
  if (texture.beyond[0] == TextureWrap::border)
    texel = select(is_on_border(level.template cut<0>(at.u) >> kTexelFraction, level.template last<0>()),
                   I16(texture.border), texel);
  if (texture.beyond[1] == TextureWrap::border)
    texel = select(is_on_border(level.template cut<1>(at.v) >> kTexelFraction, level.template last<1>()),
                   I16(texture.border), texel);
  return texel;
}

/// Numbers stored by lanes, to be used as addresses. They are read from memory: GCC would extract them from the lanes
/// one by one instead, by shuffles and moves that the lanes need themselves.
HALFPLANE_INLINE std::size_t word_at(const std::uint32_t* words, int i) {
  return static_cast<const volatile std::uint32_t&>(words[i]);
}
struct Places {
  alignas(64) std::array<std::uint32_t, 16> place;

  HALFPLANE_INLINE explicit Places(const I16& lanes) { lanes.store(place.data()); }
  HALFPLANE_INLINE std::size_t operator[](int i) const { return word_at(place.data(), i); }
};

/// Texels by loads and stores of one word each, in parallel to lane arithmetic: half the time of a gather. A vector load of
/// the result stalls until the stores have completed, so do other work first. `places` may be `to`.
HALFPLANE_INLINE void fetch_texels(const void* texels, const std::uint32_t* places, std::uint32_t* to) {
  for (int i = 0; i < kBlockPixels; ++i) to[i] = static_cast<const std::uint32_t*>(texels)[word_at(places, i)];
}

/// Input of a linear filter: left and right texels of two rows, R lowest, and the weights of the second column and row,
/// in 256ths.
struct Footprints {
  I16 upper_left, upper_right, lower_left, lower_right, across, down;
};

/// Texel by texel.
template <class Level>
HALFPLANE_INLINE Footprints gathered_footprints(const LaneTexture& texture, const CoordinateLanes& from_middle,
                                                const Level& level) {
  const I16 x = from_middle.u >> kTexelFraction, y = from_middle.v >> kTexelFraction;
  const auto column = [&](const I16& i) HALFPLANE_LAMBDA {
    return level.first() + column_place(wrapped_texel(i, texture.wrap[0], level.template last<0>()));
  };
  const auto row = [&](const I16& i) HALFPLANE_LAMBDA {
    return row_place(wrapped_texel(i, texture.wrap[1], level.template last<1>()), level.pitch());
  };
  const auto fetch = [&texture](const I16& place) HALFPLANE_LAMBDA { return gather(texture.texels, place); };
  const I16 left = column(x), right = column(x + 1), upper = row(y), lower = row(y + 1);
  return {fetch(left + upper),  fetch(right + upper), fetch(left + lower),
          fetch(right + lower), from_middle.u & 255,  from_middle.v & 255};
}

/// A clamped image has no texels before the first: their weight is that of the first alone.
HALFPLANE_INLINE I16 part_of(const I16& coordinate, TextureWrap wrap) {
  const I16 bits = coordinate & 255;
  return wrap == TextureWrap::clamp ? bits & ~(coordinate >> 31) : bits;
}

/// Places of the footprints of a linear filter, `from_middle`: less half a texel.
template <class Level>
HALFPLANE_INLINE I16 footprint_places(const LaneTexture& texture, const CoordinateLanes& from_middle,
                                      const Level& level) {
  const I16 x = wrapped_texel(from_middle.u >> kTexelFraction, texture.wrap[0], level.template last<0>()),
            y = wrapped_texel(from_middle.v >> kTexelFraction, texture.wrap[1], level.template last<1>());
  return level.first() + column_place(x) + row_place(y, level.pitch());
}

/// A linear filter before its loads: places of footprints in bytes, and weights. Computed for several blocks before the
/// loads of the first, which then need not wait for them.
struct FootprintPlaces {
  alignas(64) std::array<std::uint32_t, 16> place;
  I16 across, down;

  HALFPLANE_INLINE FootprintPlaces() = default;
  /// `from_middle`: less half a texel.
  template <class Level>
  HALFPLANE_INLINE void set(const LaneTexture& texture, const CoordinateLanes& from_middle, const Level& level) {
    constexpr int kQuadShift = 4;  // bytes
    (footprint_places(texture, from_middle, level) << kQuadShift).store(place.data());
    across = part_of(from_middle.u, texture.wrap[0]);
    down = part_of(from_middle.v, texture.wrap[1]);
  }
  /// All four texels at once.
  HALFPLANE_INLINE Footprints fetched(const LaneTexture& texture) const {
    const auto* const quads = reinterpret_cast<const char*>(texture.quads);
    const Columns texels = turned_rows([&](int i) HALFPLANE_LAMBDA { return quads + word_at(place.data(), i); });
    return {texels.first, texels.second, texels.third, texels.fourth, across, down};
  }
};

template <class Level>
HALFPLANE_INLINE Footprints footprints_of_quads(const LaneTexture& texture, const CoordinateLanes& from_middle,
                                                const Level& level) {
  FootprintPlaces places;
  places.set(texture, from_middle, level);
  return places.fetched(texture);
}

/// The coordinate of half_border, from the middle of a texel.
HALFPLANE_INLINE I16 held_in_image(const I16& from_middle, TextureWrap beyond, const I16& last) {
  constexpr std::int32_t kHalf = 1 << (kTexelFraction - 1);
  if (beyond != TextureWrap::half_border) return from_middle;
  return min(max(from_middle, I16(-kHalf)), (last << kTexelFraction) + kHalf);
}

/// Footprints of a texture with a border along u, v or both.
template <class Level>
HALFPLANE_NOINLINE Footprints bordered_footprints(const LaneTexture& texture, const CoordinateLanes& from_middle,
                                                  const Level& level) {
  const CoordinateLanes at{held_in_image(from_middle.u, texture.beyond[0], level.template last<0>()),
                           held_in_image(from_middle.v, texture.beyond[1], level.template last<1>())};
  Footprints texels =
      texture.quads != nullptr ? footprints_of_quads(texture, at, level) : gathered_footprints(texture, at, level);
  // Before the first texel a quad begins with that one; so the texel to the right of -1 is its left one.
  I16 is_left_border(0), is_right_border(0), is_upper_border(0), is_lower_border(0);
  if (has_border(texture.beyond[0])) {
    const I16 x = at.u >> kTexelFraction, last = level.template last<0>(), is_before = x < I16(0);
    texels.upper_right = select(is_before, texels.upper_left, texels.upper_right);
    texels.lower_right = select(is_before, texels.lower_left, texels.lower_right);
    texels.across = at.u & 255;
    is_left_border = is_on_border(x, last);
    is_right_border = is_on_border(x + 1, last);
  }
  if (has_border(texture.beyond[1])) {
    const I16 y = at.v >> kTexelFraction, last = level.template last<1>(), is_before = y < I16(0);
    texels.lower_left = select(is_before, texels.upper_left, texels.lower_left);
    texels.lower_right = select(is_before, texels.upper_right, texels.lower_right);
    texels.down = at.v & 255;
    is_upper_border = is_on_border(y, last);
    is_lower_border = is_on_border(y + 1, last);
  }
  const I16 border(texture.border);
  texels.upper_left = select(is_left_border | is_upper_border, border, texels.upper_left);
  texels.upper_right = select(is_right_border | is_upper_border, border, texels.upper_right);
  texels.lower_left = select(is_left_border | is_lower_border, border, texels.lower_left);
  texels.lower_right = select(is_right_border | is_lower_border, border, texels.lower_right);
  return texels;
}

/// Sums of R, G, B and A.
struct ChannelSums {
  I16 of[4];
};

/// weighted() of numbers less 2^15.
HALFPLANE_INLINE I16 weighted_centred(const I16& lanes, const I16& weights, int drop) {
  return multiply_add_pairs(lanes, weights) + ((1 << 23) + (1 << (drop - 1)));
}
/// low * (256 - part) + high * part + 2^(drop - 1) for 16-bit numbers, lane by lane. `lanes`: low and high; `weights`:
/// of both; `drop`: bits to be rounded.
HALFPLANE_INLINE I16 weighted(const I16& lanes, const I16& weights, int drop) {
  constexpr auto kCentre = static_cast<std::int32_t>(0x80008000U);  // for a signed multiply
  return weighted_centred(lanes ^ kCentre, weights, drop);
}
HALFPLANE_INLINE I16 weights_of(const I16& part) { return (256 - part) | (part << 16); }

/// A block's coordinates on a level, less half a texel.
template <class Level>
HALFPLANE_INLINE CoordinateLanes from_middle_of(const CoordinateLanes& at, const Level& level) {
  return {level.template rounded<0>(at.u) - 128, level.template rounded<1>(at.v) - 128};
}

/// linear_sums(), to be rounded by `drop` bits.
HALFPLANE_INLINE ChannelSums linear_sums(const Footprints& texels, int drop) {
  const auto across = as<S32>(doubled(texels.across));
  // Two channels of a row: at most 255 * 256.
  const auto mixed = [&across](const S32& left, const S32& right)
                         HALFPLANE_LAMBDA { return as<I16>((left << 8) + (right - left) * across); };
  const auto row = [&](const I16& left, const I16& right) HALFPLANE_LAMBDA {
    const ColorPairs first(left), second(right);
    return ColorPairs(mixed(as<S32>(first.red_blue), as<S32>(second.red_blue)),
                      mixed(as<S32>(first.green_alpha), as<S32>(second.green_alpha)));
  };
  const I16 down = weights_of(texels.down);
  const ColorPairs above = row(texels.upper_left, texels.upper_right),
                   below = row(texels.lower_left, texels.lower_right);
  const auto first = [&](const I16& upper, const I16& lower)
                         HALFPLANE_LAMBDA { return weighted(pairs(upper, lower), down, drop); };
  const auto second = [&](const I16& upper, const I16& lower)
                          HALFPLANE_LAMBDA { return weighted(upper_pairs(upper, lower), down, drop); };
  return {{first(above.red_blue, below.red_blue), first(above.green_alpha, below.green_alpha),
           second(above.red_blue, below.red_blue), second(above.green_alpha, below.green_alpha)}};
}

template <class Level>
HALFPLANE_INLINE ChannelSums linear_sums(const LaneTexture& texture, const CoordinateLanes& at, const Level& level,
                                         int drop) {
  const CoordinateLanes from_middle = from_middle_of(at, level);
  return linear_sums(texture.has_border         ? bordered_footprints(texture, from_middle, level)
                     : texture.quads != nullptr ? footprints_of_quads(texture, from_middle, level)
                                                : gathered_footprints(texture, from_middle, level),
                     drop);
}

/// linear_sums() of alpha alone, as an integer. `quads`: of the lanes' footprints; `from_middle`: their coordinates.
HALFPLANE_INLINE I16 linear_alpha(const LaneTexture& texture, const CoordinateLanes& from_middle, const I16& quads) {
  const auto left = as<S32>(quads & 0xff00ff), right = as<S32>(shift_right_logical(quads, 8) & 0xff00ff);
  const auto across = as<S32>(doubled(part_of(from_middle.u, texture.wrap[0])));
  const auto rows = as<I16>((left << 8) + (right - left) * across);
  return weighted(rows, weights_of(part_of(from_middle.v, texture.wrap[1])), 16) >> 16;
}

/// Integer parts of sums with 16 fraction bits.
HALFPLANE_INLINE ColorPairs integers_of(const ChannelSums& sum) {
  return {upper_pairs(sum.of[0], sum.of[2]), upper_pairs(sum.of[1], sum.of[3])};
}

template <class Level>
HALFPLANE_INLINE ColorPairs filter_linear(const LaneTexture& texture, const CoordinateLanes& at, const Level& level) {
  return integers_of(linear_sums(texture, at, level, 16));
}

/// blend_levels() for channels with 8 fraction bits.
HALFPLANE_INLINE ColorPairs blend_levels(const ChannelSums& lower, const ChannelSums& upper, const I16& part) {
  const I16 weights = weights_of(part);
  ChannelSums sum;
  for (std::size_t c = 0; c < 4; ++c) sum.of[c] = weighted(lower.of[c] | (upper.of[c] << 16), weights, 16);
  return integers_of(sum);
}

/// levels_around().
struct LevelPairLanes {
  I16 lower, upper, part;
  HALFPLANE_INLINE LevelPairLanes(const I16& lod, int last) {
    const I16 level = lod >> kLodFraction;
    lower = min(max(level, I16(0)), I16(last));
    upper = min(max(level + 1, I16(0)), I16(last));
    part = lod & 255;
  }
};

/// Sums with 8 fraction bits.
HALFPLANE_INLINE ColorPairs blend_sums(ChannelSums& lower, ChannelSums& upper, const I16& part) {
  for (I16& channel : lower.of) channel = channel >> 8;
  for (I16& channel : upper.of) channel = channel >> 8;
  return blend_levels(lower, upper, part);
}

HALFPLANE_INLINE ColorPairs filter_trilinear(const LaneTexture& texture, const CoordinateLanes& at,
                                             const LevelPairLanes& levels) {
  ChannelSums lower = linear_sums(texture, at, LaneLevel(texture, levels.lower), 8),
              upper = linear_sums(texture, at, LaneLevel(texture, levels.upper), 8);
  return blend_sums(lower, upper, levels.part);
}

HALFPLANE_INLINE ColorPairs filter_between_nearest(const LaneTexture& texture, const CoordinateLanes& at,
                                                   const LevelPairLanes& levels) {
  const auto channels = [&](const I16& level) HALFPLANE_LAMBDA {
    const I16 texel = filter_nearest(texture, at, LaneLevel(texture, level));
    return ChannelSums{{(texel & 255) << 8, texel & 0xff00, shift_right_logical(texel, 8) & 0xff00,
                        shift_right_logical(texel, 16) & 0xff00}};
  };
  return blend_levels(channels(levels.lower), channels(levels.upper), levels.part);
}

HALFPLANE_INLINE ColorPairs filtered_base(const LaneTexture& texture, const CoordinateLanes& at, bool is_linear) {
  const BaseLevel level(texture);
  return is_linear ? filter_linear(texture, at, level) : ColorPairs(filter_nearest(texture, at, level));
}

/// Filters as texture_min says.
HALFPLANE_INLINE ColorPairs minified(const LaneTexture& texture, const CoordinateLanes& at, const I16& lod) {
  const auto nearest_level = [&]() HALFPLANE_LAMBDA {
    const I16 level = min(max((lod + 127) >> kLodFraction, I16(0)), I16(texture.last_level));
    return LaneLevel(texture, level);
  };
  switch (texture.min) {
    case TextureMin::nearest_mipmap_nearest: return ColorPairs(filter_nearest(texture, at, nearest_level()));
    case TextureMin::linear_mipmap_nearest: return filter_linear(texture, at, nearest_level());
    case TextureMin::nearest_mipmap_linear:
      return filter_between_nearest(texture, at, LevelPairLanes(lod, texture.last_level));
    case TextureMin::linear_mipmap_linear:
      return filter_trilinear(texture, at, LevelPairLanes(lod, texture.last_level));
    default: return filtered_base(texture, at, texture.min == TextureMin::linear);
  }
}

/// lambda with bias and bounds.
HALFPLANE_INLINE I16 bounded_lod(const LaneTexture& texture, const I16& lod) {
  return min(max(lod + texture.bias, I16(texture.least)), I16(texture.largest));
}

/// sample(). `lod`: without bias and bounds.
HALFPLANE_NOINLINE ColorPairs sample(const LaneTexture& texture, const CoordinateLanes& at, const I16& lod) {
  const I16 level = bounded_lod(texture, lod);
  const I16 is_magnified = level <= texture.magnified;
  const std::uint32_t magnified = bits_of(is_magnified);
  if (magnified == 0) return minified(texture, at, level);
  const ColorPairs base = filtered_base(texture, at, texture.mag == TextureMag::linear);
  if (magnified == 0xffff) return base;
  const ColorPairs small = minified(texture, at, level);
  return {select(is_magnified, base.red_blue, small.red_blue),
          select(is_magnified, base.green_alpha, small.green_alpha)};
}

/// The usual samples of a block by footprints, in two steps: linear ones of level 0, and those between two levels.
template <bool kBetween>
struct BlockSample {
  FootprintPlaces lower, upper;
  I16 part;

  HALFPLANE_INLINE BlockSample() = default;
  /// False for other samples: sample() has them.
  HALFPLANE_INLINE bool set(const LaneTexture& texture, const CoordinateLanes& at, const I16& lod) {
    if (texture.has_border || texture.quads == nullptr) return false;
    const auto on_level = [&](FootprintPlaces& places, const auto& level)
                              HALFPLANE_LAMBDA { places.set(texture, from_middle_of(at, level), level); };
    if constexpr (!kBetween) {
      on_level(lower, BaseLevel(texture));
    } else {
      const I16 level = bounded_lod(texture, lod);
      if (texture.min != TextureMin::linear_mipmap_linear || bits_of(level <= texture.magnified) != 0) return false;
      const LevelPairLanes levels(level, texture.last_level);
      on_level(lower, LaneLevel(texture, levels.lower));
      on_level(upper, LaneLevel(texture, levels.upper));
      part = levels.part;
    }
    return true;
  }
  HALFPLANE_INLINE ColorPairs texels(const LaneTexture& texture) const {
    if constexpr (!kBetween) return integers_of(linear_sums(lower.fetched(texture), 16));
    ChannelSums first = linear_sums(lower.fetched(texture), 8), second = linear_sums(upper.fetched(texture), 8);
    return blend_sums(first, second, part);
  }
};

}  // namespace
}  // namespace halfplane::functional::HALFPLANE_ISA_NAME
