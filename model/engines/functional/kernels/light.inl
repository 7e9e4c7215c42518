// Light of fragments in lanes: the steps of phong.hpp for sixteen pixels.
#pragma once

#include "bin.inl"
#include "perspective.inl"
#include "texture.inl"
#include "values.inl"

namespace halfplane::functional::HALFPLANE_ISA_NAME {
namespace {

/// The planes of a tile's normals.
struct NormalRamps {
  std::array<BlockRamp<I16>, 3> p;

  HALFPLANE_INLINE NormalRamps(const Bin& bin, const LaneLight& of, int tile_x, int tile_y) {
    for (std::size_t c = 0; c < 3; ++c) p[c] = over_w_ramp(bin, of.normal[c], tile_x, tile_y);
  }
};

/// block_normal() of a block, P in the upper bits of its lanes.
struct NormalLanes {
  I16 m[3];

  HALFPLANE_INLINE NormalLanes(const NormalRamps& ramps, const LaneLight& of, std::size_t block) {
    for (std::size_t c = 0; c < 3; ++c) m[c] = ramps.p[c](block);
    const auto magnitude = [this](std::size_t c) HALFPLANE_LAMBDA { return m[c] ^ (m[c] >> 31); };
    const I16 bits = shift_right_logical(magnitude(0) | magnitude(1) | magnitude(2), of.up) | 1;
    const I16 drop =
        (float_bits(bits) >> kFloatFraction) + (of.up - kFloatBias - kBlockBits);  // except for a rounding bit
    const I16 left = max(-drop, I16(0)), right = max(drop, I16(0));
    for (I16& c : m) c = min((((c << left) >> right) + 1) >> 1, I16((1 << kBlockBits) - 1));
  }
};

/// inverse_length(): the upper bits of a binary32 mantissa give the line, the lower bits the place on it.
struct InverseLengthLanes {
  I16 down, root;  ///< exponent - 1

  HALFPLANE_INLINE InverseLengthLanes(const NormalLanes& n, const LaneLight& of) {
    const I16 square = n.m[0] * n.m[0] + n.m[1] * n.m[1] + n.m[2] * n.m[2];  // 32 bits, unsigned
    const I16 bits = float_bits(shift_right_logical(square, 1));
    constexpr int kBelowLine = kFloatFraction - kRootLines, kBelowPlace = kBelowLine - kRootPlaceBits;
    const I16 line = ((bits >> kBelowLine) & ((2 << kRootLines) - 1)) << 1;
    const I16 place = (bits >> kBelowPlace) & ((1 << kRootPlaceBits) - 1);
    const auto* const numbers = &of.roots->start;
    const I16 fall = gather(numbers, line + 1) * place + (1 << (kRootPlaceBits - 1));
    root = gather(numbers, line) - (fall >> kRootPlaceBits);
    // The exponent of the square is that of its half plus 1; a zero normal has none, and no cosine.
    down = max((bits >> (kFloatFraction + 1)) - (kFloatBias - 1) / 2 - 1, I16(kBlockBits - 2));
  }
};

/// cosine(). A product of 36 bits is the sum of two, floored one after the other.
HALFPLANE_INLINE I16 cosine(const NormalLanes& n, const InverseLengthLanes& length, const Normal& direction) {
  const I16 dot = n.m[0] * direction[0] + n.m[1] * direction[1] + n.m[2] * direction[2];
  const I16 part = ((max(dot, I16(0)) >> length.down) << 1) | 1;
  constexpr int kSplit = kRootFraction / 2;
  const I16 lower = (part * (length.root & ((1 << kSplit) - 1)) + (1 << (kRootFraction - 1))) >> kSplit;
  const I16 rounded = (part * (length.root >> kSplit) + lower) >> (kRootFraction - kSplit);
  return rounded & (dot > 0);
}

/// PhongLight::factors().
struct LightLanes {
  I16 diffuse, specular;

  HALFPLANE_INLINE LightLanes(const NormalRamps& ramps, const LaneLight& of, std::size_t block) {
    const NormalLanes n(ramps, of, block);
    const InverseLengthLanes length(n, of);
    const I16 facing = cosine(n, length, of.direction);
    constexpr int kDrop = kCosineFraction - kLightFraction;
    diffuse = (facing + (1 << (kDrop - 1))) >> kDrop;
    const I16 away = max((1 << kCosineFraction) - cosine(n, length, of.half), I16(0));
    const I16 line = away >> of.place_bits, place = away & ((1 << of.place_bits) - 1);
    constexpr std::int32_t kLast = (1 << kPowerLines) - 1;
    const I16 at = min(line, I16(kLast)) << 1;
    const auto* const numbers = &of.power->start;
    const I16 sum = (gather(numbers, at) << of.place_bits) - gather(numbers, at + 1) * place + (1 << (of.drop - 1));
    const I16 held = min(max(sum >> of.drop, I16(0)), I16(1 << kLightFraction));
    specular = held & (line <= kLast) & (facing > 0);
  }

  /// PhongLight::lit().
  HALFPLANE_INLINE ColorPairs lit(const ColorPairs& color, const LaneLight& of) const {
    constexpr std::int32_t kHalf = 1 << (kLightFraction - 1);
    const auto channel = [&](const I16& own, std::size_t c) HALFPLANE_LAMBDA {
      const I16 much = ((diffuse * of.diffuse[c] + kHalf) >> kLightFraction) + of.ambient[c];
      return min((own * much + specular * of.specular[c] + kHalf) >> kLightFraction, I16(255));
    };
    return ColorPairs(
        channel(color.red_blue & 0xffff, 0) | (channel(color.red_blue >> 16, 2) << 16),
        channel(color.green_alpha & 0xffff, 1) | (color.green_alpha & static_cast<std::int32_t>(0xffff0000U)));
  }
};

}  // namespace
}  // namespace halfplane::functional::HALFPLANE_ISA_NAME
