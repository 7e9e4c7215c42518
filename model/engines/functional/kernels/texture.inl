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
  /// Shift from the block bits of a column's number to a place.
  HALFPLANE_INLINE int pitch() const { return texture.pitch; }
  HALFPLANE_INLINE static I16 first() { return I16(0); }
};

struct LaneLevel {
  I16 down[2], last_texel[2], to_column, first_texel;

  HALFPLANE_INLINE LaneLevel(const LaneTexture& texture, const I16& level) {
    for (std::size_t axis = 0; axis < 2; ++axis) {
      down[axis] = min(level, I16(texture.bits[axis]));
      last_texel[axis] = I16(texture.last[axis]) >> down[axis];
    }
    to_column = max(texture.bits[1] - level, I16(TexelBlocks::kShift));
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
  HALFPLANE_INLINE const I16& pitch() const { return to_column; }
  HALFPLANE_INLINE const I16& first() const { return first_texel; }
};

/// One level in all lanes.
struct OneLevel {
  int down[2];
  std::int32_t half[2], last_texel[2];
  int to_column;
  std::int32_t first_texel;

  HALFPLANE_INLINE OneLevel(const LaneTexture& texture, int level)
      : to_column(std::max(texture.bits[1] - level, TexelBlocks::kShift)),
        first_texel(texture.first[static_cast<std::size_t>(level)]) {
    for (std::size_t axis = 0; axis < 2; ++axis) {
      down[axis] = std::min(level, texture.bits[axis]);
      half[axis] = (1 << down[axis]) >> 1;
      last_texel[axis] = texture.last[axis] >> down[axis];
    }
  }
  template <std::size_t kAxis>
  HALFPLANE_INLINE I16 rounded(const I16& coordinate) const {
    return (coordinate + half[kAxis]) >> down[kAxis];
  }
  template <std::size_t kAxis>
  HALFPLANE_INLINE I16 last() const {
    return I16(last_texel[kAxis]);
  }
  HALFPLANE_INLINE int pitch() const { return to_column; }
  HALFPLANE_INLINE I16 first() const { return I16(first_texel); }
};

/// wrapped_texel(). `last`: the last texel of the level, a power of two less 1.
HALFPLANE_INLINE I16 wrapped_texel(const I16& i, TextureWrap wrap, const I16& last) {
  if (wrap == TextureWrap::repeat) return i & last;
  if (wrap == TextureWrap::clamp) return min(max(i, I16(0)), last);
  const I16 period = (last << 1) | 1, rest = i & period;
  return rest ^ (period & (rest > last));
}

/// The parts of a texel's place in TexelBlocks from its column and its row.
template <class Pitch>
HALFPLANE_INLINE I16 column_place(const I16& x, const Pitch& pitch) {
  return (x & 3) + ((x & ~3) << pitch);
}
HALFPLANE_INLINE I16 row_place(const I16& y) { return y << TexelBlocks::kShift; }

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
  return level.first() + column_place(x, level.pitch()) + row_place(y);
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

/// Input of a linear filter: TexelBlocks::Quad by channel, and the weights of the second column and row, in 256ths.
struct Footprints {
  I16 channel[4], across, down;
};

/// Texel by texel.
template <class Level>
HALFPLANE_INLINE Footprints gathered_footprints(const LaneTexture& texture, const CoordinateLanes& from_middle,
                                                const Level& level) {
  const I16 x = from_middle.u >> kTexelFraction, y = from_middle.v >> kTexelFraction;
  const auto column = [&](const I16& i) HALFPLANE_LAMBDA {
    return level.first() + column_place(wrapped_texel(i, texture.wrap[0], level.template last<0>()), level.pitch());
  };
  const auto row = [&](const I16& i) HALFPLANE_LAMBDA {
    return row_place(wrapped_texel(i, texture.wrap[1], level.template last<1>()));
  };
  const auto fetch = [&texture](const I16& place) HALFPLANE_LAMBDA { return gather(texture.texels, place); };
  const I16 left = column(x), right = column(x + 1), upper = row(y), lower = row(y + 1);
  // TexelBlocks::Quad.
  const auto even = [](const I16& first, const I16& second)
                        HALFPLANE_LAMBDA { return (first & 0xff00ff) | ((second & 0xff00ff) << 8); };
  const auto odd = [](const I16& first, const I16& second) HALFPLANE_LAMBDA {
    constexpr auto kOdd = static_cast<std::int32_t>(0xff00ff00U);
    return (shift_right_logical(first, 8) & 0xff00ff) | (second & kOdd);
  };
  const I16 texels[4] = {fetch(left + upper), fetch(right + upper), fetch(left + lower), fetch(right + lower)};
  const I16 above[2] = {even(texels[0], texels[1]), odd(texels[0], texels[1])},
            below[2] = {even(texels[2], texels[3]), odd(texels[2], texels[3])};
  const I16 centre(static_cast<std::int32_t>(TexelBlocks::kCentre));
  return {{pairs(above[0], below[0]) ^ centre, pairs(above[1], below[1]) ^ centre,
           upper_pairs(above[0], below[0]) ^ centre, upper_pairs(above[1], below[1]) ^ centre},
          from_middle.u & 255,
          from_middle.v & 255};
}

/// Coordinates, less half a texel, that footprints are fetched by. A clamped image has no texels before the first: their
/// weight is that of the first alone.
HALFPLANE_INLINE CoordinateLanes held_for_quads(const LaneTexture& texture, const CoordinateLanes& from_middle) {
  const auto held = [&](const I16& along, std::size_t axis) HALFPLANE_LAMBDA {
    return texture.wrap[axis] == TextureWrap::clamp ? max(along, I16(0)) : along;
  };
  return {held(from_middle.u, 0), held(from_middle.v, 1)};
}

/// Places of the footprints of a linear filter. `at`: held_for_quads().
template <class Level>
HALFPLANE_INLINE I16 footprint_places(const LaneTexture& texture, const CoordinateLanes& at, const Level& level) {
  const auto texel = [&](const I16& along, std::size_t axis, const I16& last) HALFPLANE_LAMBDA {
    const I16 i = along >> kTexelFraction;
    return texture.wrap[axis] == TextureWrap::clamp ? min(i, last) : i & last;
  };
  return level.first() + column_place(texel(at.u, 0, level.template last<0>()), level.pitch()) +
         row_place(texel(at.v, 1, level.template last<1>()));
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
    const CoordinateLanes at = held_for_quads(texture, from_middle);
    (footprint_places(texture, at, level) << kQuadShift).store(place.data());
    across = at.u & 255;
    down = at.v & 255;
  }
  /// All four texels at once.
  HALFPLANE_INLINE Footprints fetched(const LaneTexture& texture) const {
    const auto* const quads = reinterpret_cast<const char*>(texture.quads);
    const Columns texels = turned_rows([&](int i) HALFPLANE_LAMBDA { return quads + word_at(place.data(), i); });
    return {{texels.first, texels.second, texels.third, texels.fourth}, across, down};
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
  constexpr std::int32_t kLeft = 0xff00ff, kUpper = 0xffff;  // of a channel
  I16 is_border(0), is_before[2] = {I16(0), I16(0)};
  if (has_border(texture.beyond[0])) {
    const I16 x = at.u >> kTexelFraction, last = level.template last<0>();
    is_border = (is_on_border(x, last) & kLeft) | (is_on_border(x + 1, last) & ~kLeft);
    is_before[0] = x < I16(0);
  }
  if (has_border(texture.beyond[1])) {
    const I16 y = at.v >> kTexelFraction, last = level.template last<1>();
    is_border |= (is_on_border(y, last) & kUpper) | (is_on_border(y + 1, last) & ~kUpper);
    is_before[1] = y < I16(0);
  }
  if (or_of_lanes(is_border) == 0) return texels;
  // Before the first texel a quad begins with that one; so the texel to the right of -1 is its left one.
  if (has_border(texture.beyond[0])) texels.across = at.u & 255;
  if (has_border(texture.beyond[1])) texels.down = at.v & 255;
  const auto border = static_cast<std::uint32_t>(texture.border);
  for (int c = 0; c < 4; ++c) {
    I16& channel = texels.channel[c];
    channel = select(is_before[0], (channel & kLeft) | ((channel & kLeft) << 8), channel);
    channel = select(is_before[1], (channel & kUpper) | (channel << 16), channel);
    const std::uint32_t four = ((border >> 8 * c & 255) * 0x01010101U) ^ TexelBlocks::kCentre;
    channel = (channel & ~is_border) | (is_border & static_cast<std::int32_t>(four));
  }
  return texels;
}

/// Sums of R, G, B and A.
struct ChannelSums {
  I16 of[4];
};

/// How the sum of a linear filter, less 2^23 in 16 fraction bits, is rounded: to an integer in the upper half, or to 8
/// fraction bits, less 2^15, for blend_levels().
enum class SumTo : std::int32_t { integer = (1 << 23) + (1 << 15), level = 1 << 7 };

/// low * (256 - part) + high * part for 16-bit numbers less 2^15, lane by lane. `lanes`: low and high; `weights`: of both.
HALFPLANE_INLINE I16 weighted(const I16& lanes, const I16& weights, SumTo to) {
  return multiply_add_pairs(lanes, weights) + static_cast<std::int32_t>(to);
}
HALFPLANE_INLINE I16 weights_of(const I16& part) { return (256 - part) | (part << 16); }

/// A block's coordinates on a level, less half a texel.
template <class Level>
HALFPLANE_INLINE CoordinateLanes from_middle_of(const CoordinateLanes& at, const Level& level) {
  return {level.template rounded<0>(at.u) - 128, level.template rounded<1>(at.v) - 128};
}

/// Weights of the columns of a row, in bytes, as footprint_sum() takes them.
HALFPLANE_INLINE S32 columns_of(const I16& part) { return as<S32>(doubled(part | (part << 8)) ^ 0x00ff00ff); }

/// linear_sums() of one channel of Footprints. A row's sum, less 2^15: 256 left + (right - left) * part.
HALFPLANE_INLINE I16 footprint_sum(const I16& channel, const S32& columns, const I16& down, SumTo to) {
  const auto bytes = as<S32>(channel);
  return weighted(as<I16>(multiply_add_bytes(columns, bytes) + multiply_add_bytes(S32(1), bytes)), down, to);
}

/// linear_sums().
HALFPLANE_INLINE ChannelSums linear_sums(const Footprints& texels, SumTo to) {
  const S32 columns = columns_of(texels.across);
  const I16 down = weights_of(texels.down);
  const auto sum = [&](std::size_t c) HALFPLANE_LAMBDA { return footprint_sum(texels.channel[c], columns, down, to); };
  return {{sum(0), sum(1), sum(2), sum(3)}};
}

template <class Level>
HALFPLANE_INLINE ChannelSums linear_sums(const LaneTexture& texture, const CoordinateLanes& at, const Level& level,
                                         SumTo to) {
  const CoordinateLanes from_middle = from_middle_of(at, level);
  return linear_sums(texture.has_border         ? bordered_footprints(texture, from_middle, level)
                     : texture.quads != nullptr ? footprints_of_quads(texture, from_middle, level)
                                                : gathered_footprints(texture, from_middle, level),
                     to);
}

/// linear_sums() of alpha alone, as an integer. `alphas`: of the lanes' footprints, `at` held_for_quads().
HALFPLANE_INLINE I16 linear_alpha(const CoordinateLanes& at, const I16& alphas) {
  return footprint_sum(alphas, columns_of(at.u & 255), weights_of(at.v & 255), SumTo::integer) >> 16;
}

/// Integer parts of sums with 16 fraction bits.
HALFPLANE_INLINE ColorPairs integers_of(const ChannelSums& sum) {
  return {upper_pairs(sum.of[0], sum.of[2]), upper_pairs(sum.of[1], sum.of[3])};
}

template <class Level>
HALFPLANE_INLINE ColorPairs filter_linear(const LaneTexture& texture, const CoordinateLanes& at, const Level& level) {
  return integers_of(linear_sums(texture, at, level, SumTo::integer));
}

/// blend_levels() of a channel of two levels: SumTo::level.
HALFPLANE_INLINE I16 blended_levels(const I16& lower, const I16& upper, const I16& weights) {
  return weighted(joined_halves(lower >> 8, upper << 8), weights, SumTo::integer);
}
HALFPLANE_INLINE ColorPairs blend_levels(const ChannelSums& lower, const ChannelSums& upper, const I16& part) {
  const I16 weights = weights_of(part);
  const auto sum = [&](std::size_t c) HALFPLANE_LAMBDA { return blended_levels(lower.of[c], upper.of[c], weights); };
  return integers_of({{sum(0), sum(1), sum(2), sum(3)}});
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

HALFPLANE_INLINE ColorPairs filter_trilinear(const LaneTexture& texture, const CoordinateLanes& at,
                                             const LevelPairLanes& levels) {
  return blend_levels(linear_sums(texture, at, LaneLevel(texture, levels.lower), SumTo::level),
                      linear_sums(texture, at, LaneLevel(texture, levels.upper), SumTo::level), levels.part);
}

HALFPLANE_INLINE ColorPairs filter_between_nearest(const LaneTexture& texture, const CoordinateLanes& at,
                                                   const LevelPairLanes& levels) {
  const auto channels = [&](const I16& level) HALFPLANE_LAMBDA {
    const I16 texel = filter_nearest(texture, at, LaneLevel(texture, level));
    const auto channel = [&texel](int c)
                             HALFPLANE_LAMBDA { return ((shift_right_logical(texel, 8 * c) & 255) - 128) << 16; };
    return ChannelSums{{channel(0), channel(1), channel(2), channel(3)}};
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

}  // namespace
}  // namespace halfplane::functional::HALFPLANE_ISA_NAME
