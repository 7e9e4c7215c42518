// Codes over w of sixteen triangles, a triangle a lane: Q and P of their corners, and the corner at which their planes start.
#pragma once

#include "small_batch.inl"

namespace halfplane::functional::HALFPLANE_ISA_NAME {
namespace {

HALFPLANE_INLINE D16 magnitude(const D16& v) { return as<D16>(as<L16>(v) & std::int64_t{0x7fffffffffffffff}); }
/// The exponent field of non-negative numbers in binary64.
HALFPLANE_INLINE I16 exponent_field(const D16& v) { return upper_halves(as<L16>(v)) >> 20; }
/// The inverse: 2^(field - 1023).
HALFPLANE_INLINE D16 power_of_field(const I16& field) { return as<D16>(convert<std::int64_t>(field) << 52); }
constexpr std::int32_t kDoubleBias = 1023;

/// snap(): floor(v + 1/2) is half of floor(2 v) + 1, rounded down, where v + 1/2 itself would be rounded. `twice`: 2 v.
HALFPLANE_INLINE I16 snapped_codes(const D16& twice) {
#if HALFPLANE_ISA == 512
  const auto half = [&twice](int i) HALFPLANE_LAMBDA {
    return _mm512_cvt_roundpd_epi32((__m512d)twice.part[i], _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC);
  };
  I16 whole;
  whole.part[0] = (I16::Register)_mm512_inserti64x4(_mm512_castsi256_si512(half(0)), half(1), 1);
#else
  const auto whole = convert<std::int32_t>(floor(twice));
#endif
  return (whole + 1) >> 1;
}

/// The values of an attribute at the three corners.
template <class Lanes>
struct OfCorners {
  Lanes a, b, c;
};

/// For finite numbers.
HALFPLANE_INLINE D16 least_of(const OfCorners<D16>& of) { return min(min(of.a, of.b), of.c); }
HALFPLANE_INLINE D16 largest_magnitude(const OfCorners<D16>& of) {
#if HALFPLANE_ISA == 512
  D16 r;
  constexpr int kLargestMagnitude = 0b1011;
  for (int i = 0; i < D16::kParts; ++i)
    r.part[i] =
        (D16::Register)_mm512_range_pd(_mm512_range_pd((__m512d)of.a.part[i], (__m512d)of.b.part[i], kLargestMagnitude),
                                       (__m512d)of.c.part[i], kLargestMagnitude);
  return r;
#else
  return max(max(magnitude(of.a), magnitude(of.b)), magnitude(of.c));
#endif
}

/// quantize_q().
struct QLanes {
  OfCorners<D16> number;
  OfCorners<I16> code;

  /// `inverse`: 1 / w.
  HALFPLANE_INLINE QLanes(const OfCorners<D16>& w, const OfCorners<D16>& inverse, int bits) {
    // The quotient of a mantissa is that of w, scaled.
    const D16 scale = power_of_field(exponent_field(least_of(w)) + bits);
    const D16 a = inverse.a * scale, b = inverse.b * scale, c = inverse.c * scale;
    // Rounding may carry to one more bit.
    const D16 whole(static_cast<double>(std::int64_t{1} << bits) - 0.5);
    const D16 twice = select(max(max(a, b), c) >= whole, D16(1.0), D16(2.0));
    code.a = max(snapped_codes(a * twice), I16(1));
    code.b = max(snapped_codes(b * twice), I16(1));
    code.c = max(snapped_codes(c * twice), I16(1));
    number.a = convert<double>(code.a);
    number.b = convert<double>(code.b);
    number.c = convert<double>(code.c);
  }
};

/// quantize_over_w().
struct OverWLanes {
  OfCorners<I16> p;
  I16 reach, exponent;
  D16 reference;

  HALFPLANE_INLINE OverWLanes(const OfCorners<D16>& value, const QLanes& q, const OverWFormat& format) {
    const D16 low = least_of(value), high = max(max(value.a, value.b), value.c);
    reference = format.is_centred ? floor(low * 0.5 + high * 0.5) : D16(0.0);
    D16 ua = value.a - reference, ub = value.b - reference, uc = value.c - reference;
    const auto bits_above_point = [](const D16& number)
                                      HALFPLANE_LAMBDA { return exponent_field(number) - (kDoubleBias - 1); };
    const auto find_reach = [&](const D16& farthest)
                                HALFPLANE_LAMBDA { reach = max(bits_above_point(farthest * (1 + 0x1p-10)), I16(0)); };
    const D16 farthest = max(high - reference, reference - low);
    find_reach(farthest);
    if (is_any(reach >= kMaxReach)) [[unlikely]] {
      constexpr double limit = kFarthestCoordinate;
      for (D16* const u : {&ua, &ub, &uc}) *u = min(max(*u, D16(-limit)), D16(limit));
      find_reach(min(farthest, D16(limit)));
    }
    const D16 a = ua * q.number.a, b = ub * q.number.b, c = uc * q.number.c;
    exponent = max(bits_above_point(largest_magnitude({a, b, c})), reach - 1) - format.bits;
    const auto find_codes = [&]() HALFPLANE_LAMBDA {
      const D16 scale = power_of_field(kDoubleBias + 1 - exponent);  // twice
      p.a = snapped_codes(a * scale);
      p.b = snapped_codes(b * scale);
      p.c = snapped_codes(c * scale);
    };
    find_codes();
    const I16 is_too_large = max(max(magnitude(p.a), magnitude(p.b)), magnitude(p.c)) >= 1 << format.bits;
    if (!is_any(is_too_large)) return;
    exponent = exponent - is_too_large;
    find_codes();
  }
};

/// The corner at which planes over w start: base_vertex(), of equal ones the first in canonical order; and the corners
/// after it.
struct PieceOrder {
  I16 is_b, is_c;  ///< masks; neither: a

  HALFPLANE_INLINE PieceOrder(const I16& first_is_b, const I16& first_is_c, const I16& is_turned,
                              const OfCorners<I16>& q) {
    // Number of corners after the first, in canonical order.
    const auto ranked = [&](const I16& code, std::int32_t if_a, std::int32_t if_b, std::int32_t if_c) HALFPLANE_LAMBDA {
      const I16 after = select(first_is_c, I16(if_c), select(first_is_b, I16(if_b), I16(if_a)));
      return (code << 2) | (after ^ (is_turned & (after != 0) & 3));
    };
    const I16 a = ranked(q.a, 0, 2, 1), b = ranked(q.b, 1, 0, 2), c = ranked(q.c, 2, 1, 0);
    is_c = c < min(a, b);
    is_b = ~is_c & (b < a);
  }

  /// The base, the next corner, the last.
  HALFPLANE_INLINE OfCorners<I16> turned_to_base(const I16& a, const I16& b, const I16& c) const {
    return {select(is_c, c, select(is_b, b, a)), select(is_c, a, select(is_b, c, b)),
            select(is_c, b, select(is_b, a, c))};
  }
};

/// The first corner in the order of (Y, X): masks; neither: a.
struct FirstCorner {
  I16 is_b, is_c;

  HALFPLANE_INLINE explicit FirstCorner(const SmallCorners& t) {
    const I16 b_key = (t.ay << 16) + t.ax, c_key = (t.by << 16) + t.bx;  // from a, as one number
    is_c = c_key < min(b_key, I16(0));
    is_b = ~is_c & (b_key < 0);
  }
};

}  // namespace
}  // namespace halfplane::functional::HALFPLANE_ISA_NAME
