// Attributes over w in lanes: perspective.hpp without products of more than 32 bits.
#pragma once

#include "bin.inl"
#include "values.inl"

namespace halfplane::functional::HALFPLANE_ISA_NAME {
namespace {

/// Bits of numbers from 0 on as binary32: the 21 highest are unchanged, because the bit below them is cleared and so no
/// rounding carries past it.
HALFPLANE_INLINE I16 float_bits(const I16& value) {
#if HALFPLANE_ISA == 512
  I16 bits;
  bits.part[0] =
      (I16::Register)_mm512_cvt_roundepi32_ps((__m512i)value.part[0], _MM_FROUND_TO_ZERO | _MM_FROUND_NO_EXC);
  return bits;
#else
  return as<I16>(convert<float>(value & ~(value >> 21)));
#endif
}

/// 1 / Q of pixels: PixelReciprocal.
struct ReciprocalsOfQ {
  I16 bits;        ///< float_bits() of Q
  I16 exponent;    ///< e + kFloatBias
  I16 reciprocal;  ///< r

  HALFPLANE_INLINE ReciprocalsOfQ() = default;
  HALFPLANE_INLINE ReciprocalsOfQ(const I16& value, const LaneDivision& by) { set(value, by); }
  /// `value`: of Q's plane. For an uncovered pixel the result is undefined.
  HALFPLANE_INLINE void set(const I16& value, const LaneDivision& by) {
    bits = float_bits(shift_right_logical(value, by.up));
    exponent = bits >> kFloatFraction;
    const I16 divisor = (bits & by.mantissa_mask) | by.middle;  // d 2^-k, in [1, 2)
    reciprocal = quotient_of(divisor, by);
  }

 private:
  /// floor(2^2k / d).
  HALFPLANE_INLINE static I16 quotient_of(const I16& divisor, const LaneDivision& by) {
    const F16 power(by.power);
#if HALFPLANE_ISA == 512
    F16 quotient;  // rounded down
    quotient.part[0] = (F16::Register)_mm512_div_round_ps((__m512)power.part[0], (__m512)divisor.part[0],
                                                          _MM_FROUND_TO_ZERO | _MM_FROUND_NO_EXC);
    return convert<std::int32_t>(quotient);
#else
    const I16 guess = convert<std::int32_t>(power / as<F16>(divisor));
    const I16 d = (divisor - ((kFloatBias - 1) << kFloatFraction)) >> by.to_divisor;
    return guess + (guess * d - by.whole > 0);  // a mask: corrected_reciprocal()
#endif
  }
};

/// P with `bits` more bits, clamped where it exceeds the range of narrow_p() in any case. `bits`: at most 21.
HALFPLANE_INLINE I16 with_more_bits(const I16& p, const I16& bits) {
  const I16 limit = I16(1 << 30) >> bits;
  return min(max(p, -limit), limit) << bits;
}

/// narrow_p(), `value`: of P's plane. A shift by 0 bits, or to the left, becomes a left shift followed by a right shift
/// of one bit.
HALFPLANE_INLINE I16 narrow_p(const I16& value, const ReciprocalsOfQ& q, const LaneAttribute& attribute,
                              const LaneOverW& format) {
  const I16 down = q.exponent + attribute.narrow;  // shift from a lane
  if (attribute.is_tame) return ((value >> down) + 1) >> 1;
  I16 dropped;
  if (attribute.may_gain) {
    const I16 drop = down - format.up;
    dropped = with_more_bits(value >> format.up, max(-drop, I16(0))) >> min(max(drop, I16(0)), I16(31));
  } else {
    dropped = value >> as<I16>(min(as<W16>(down), W16(31)));
  }
  return min(max((dropped + 1) >> 1, I16(format.lowest)), I16(format.highest));
}

/// over_q(). A product of more than 31 bits is the sum of two, floored in turn.
HALFPLANE_INLINE I16 over_q(const I16& value, const ReciprocalsOfQ& q, const LaneAttribute& attribute,
                            const LaneOverW& format) {
  const I16 narrow = narrow_p(value, q, attribute, format);
  const I16 lower = q.reciprocal & format.lower_bits;
  const I16 product = narrow * (q.reciprocal >> format.split) + ((narrow * lower) >> format.split);
  return (product + attribute.half) >> attribute.drop;
}

/// A plane over w in a tile of the bin.
HALFPLANE_INLINE BlockRamp<I16> over_w_ramp(const Bin& bin, const LanePlane& plane, int tile_x, int tile_y) {
  const std::int32_t anchor = plane.anchor((bin.first_x >> kTileShift) + tile_x, (bin.first_y >> kTileShift) + tile_y);
  return {bin.position.column[0] * plane.step_x + bin.position.row[0] * plane.step_y + anchor,
          I16(kBlockSize * plane.step_x), I16(kBlockSize * plane.step_y)};
}

/// Attributes over one Q in a tile.
template <std::size_t N>
struct QuotientRamps {
  BlockRamp<I16> q;
  std::array<BlockRamp<I16>, N> p;

  HALFPLANE_INLINE QuotientRamps() = default;
  HALFPLANE_INLINE void set(const Bin& bin, const LaneQuotients<N>& of, int tile_x, int tile_y) {
    q = over_w_ramp(bin, of.q, tile_x, tile_y);
    for (std::size_t i = 0; i < N; ++i) p[i] = over_w_ramp(bin, of.attribute[i].p, tile_x, tile_y);
  }
};

}  // namespace
}  // namespace halfplane::functional::HALFPLANE_ISA_NAME
