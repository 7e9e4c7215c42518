// Vectors with a fixed number of lanes, whatever the register size of the machine: a pack uses as many registers as it
// needs.
//
// Packs go to memory and back register by register. GCC 12 copies more than 16 bytes, by std::memcpy or as structs in
// memory, in pieces of 16, and a register loaded from several pieces that were just stored waits for all of them: half
// of the time of a block. Nor does it compile implicit copies, of a struct or an array of packs, for the instruction
// set of this file: a struct that is copied defines its copy, and std::array and std::pair are not copied.
#pragma once

#include "../kernel_headers.hpp"

namespace halfplane::functional::HALFPLANE_ISA_NAME {
namespace {

/// Unrolled over the registers of a pack: GCC takes packs apart before it unrolls loops, and otherwise keeps the registers of
/// four registers and more in memory.
#define HALFPLANE_PART(parts, i, at, ...) \
  if constexpr ((parts) > at) {           \
    constexpr int i = at;                 \
    __VA_ARGS__;                          \
  }
#define HALFPLANE_EACH_PART(parts, i, ...)   \
  {                                          \
    HALFPLANE_PART(parts, i, 0, __VA_ARGS__) \
    HALFPLANE_PART(parts, i, 1, __VA_ARGS__) \
    HALFPLANE_PART(parts, i, 2, __VA_ARGS__) \
    HALFPLANE_PART(parts, i, 3, __VA_ARGS__) \
    HALFPLANE_PART(parts, i, 4, __VA_ARGS__) \
    HALFPLANE_PART(parts, i, 5, __VA_ARGS__) \
    HALFPLANE_PART(parts, i, 6, __VA_ARGS__) \
    HALFPLANE_PART(parts, i, 7, __VA_ARGS__) \
  }

/// N lanes of a T.
template <class T, int N>
struct Pack {
  static constexpr int kLanes = HALFPLANE_ISA / 8 / static_cast<int>(sizeof(T));  ///< in a register
  static constexpr int kParts = N / kLanes;
  static_assert(N % kLanes == 0);
  using Register __attribute__((vector_size(HALFPLANE_ISA / 8))) = T;
  using InMemory __attribute__((vector_size(HALFPLANE_ISA / 8), aligned(1), may_alias)) = T;

  Register part[kParts];

  HALFPLANE_LEAF Pack() = default;
  HALFPLANE_LEAF Pack(const Pack& from) {
    for (int i = 0; i < kParts; ++i) part[i] = from.part[i];
  }
  HALFPLANE_LEAF Pack& operator=(Pack from) {
    for (int i = 0; i < kParts; ++i) part[i] = from.part[i];
    return *this;
  }
  HALFPLANE_LEAF Pack(T value) {  // NOLINT: a number is the same in all lanes
    HALFPLANE_EACH_PART(kParts, i, part[i] = Register{} + value)
  }
  template <class Lane>
  HALFPLANE_LEAF static Pack of(Lane&& lane) {
    Pack pack;
    for (int i = 0; i < N; ++i) pack.part[i / kLanes][i % kLanes] = lane(i);
    return pack;
  }
  template <class Element>
  HALFPLANE_LEAF static Pack load(const Element* from) {
    Pack pack;
    HALFPLANE_EACH_PART(kParts, i, pack.part[i] = reinterpret_cast<const InMemory*>(from)[i])
    return pack;
  }
  template <class Element>
  HALFPLANE_LEAF void store(Element* to) const {
    HALFPLANE_EACH_PART(kParts, i, reinterpret_cast<InMemory*>(to)[i] = part[i])
  }
};

#define HALFPLANE_PACK_OPERATOR(op)                                                       \
  template <class T, int N>                                                               \
  HALFPLANE_LEAF Pack<T, N> operator op(const Pack<T, N>& a, const Pack<T, N>& b) {       \
    Pack<T, N> r;                                                                         \
    HALFPLANE_EACH_PART((Pack<T, N>::kParts), i, r.part[i] = a.part[i] op b.part[i])      \
    return r;                                                                             \
  }                                                                                       \
  template <class T, int N>                                                               \
  HALFPLANE_LEAF Pack<T, N> operator op(const Pack<T, N>& a, std::type_identity_t<T> b) { \
    return a op Pack<T, N>(b);                                                            \
  }                                                                                       \
  template <class T, int N>                                                               \
  HALFPLANE_LEAF Pack<T, N> operator op(std::type_identity_t<T> a, const Pack<T, N>& b) { \
    return Pack<T, N>(a) op b;                                                            \
  }
HALFPLANE_PACK_OPERATOR(+)
HALFPLANE_PACK_OPERATOR(-)
HALFPLANE_PACK_OPERATOR(*)
HALFPLANE_PACK_OPERATOR(/)
HALFPLANE_PACK_OPERATOR(&)
HALFPLANE_PACK_OPERATOR(|)
HALFPLANE_PACK_OPERATOR(^)
#undef HALFPLANE_PACK_OPERATOR

template <class T, int N>
HALFPLANE_LEAF Pack<T, N> operator~(const Pack<T, N>& a) {
  Pack<T, N> r;
  HALFPLANE_EACH_PART((Pack<T, N>::kParts), i, r.part[i] = ~a.part[i])
  return r;
}
template <class T, int N>
HALFPLANE_LEAF Pack<T, N> operator-(const Pack<T, N>& a) {
  Pack<T, N> r;
  HALFPLANE_EACH_PART((Pack<T, N>::kParts), i, r.part[i] = -a.part[i])
  return r;
}
template <class T, int N>
HALFPLANE_LEAF Pack<T, N> operator<<(const Pack<T, N>& a, int bits) {
  Pack<T, N> r;
  HALFPLANE_EACH_PART((Pack<T, N>::kParts), i, r.part[i] = a.part[i] << bits)
  return r;
}
template <class T, int N>
HALFPLANE_LEAF Pack<T, N> operator>>(const Pack<T, N>& a, int bits) {
  Pack<T, N> r;
  HALFPLANE_EACH_PART((Pack<T, N>::kParts), i, r.part[i] = a.part[i] >> bits)
  return r;
}
/// Lane by lane.
template <class T, int N>
HALFPLANE_LEAF Pack<T, N> operator<<(const Pack<T, N>& a, const Pack<T, N>& bits) {
  Pack<T, N> r;
  HALFPLANE_EACH_PART((Pack<T, N>::kParts), i, r.part[i] = a.part[i] << bits.part[i])
  return r;
}
template <class T, int N>
HALFPLANE_LEAF Pack<T, N> operator>>(const Pack<T, N>& a, const Pack<T, N>& bits) {
  Pack<T, N> r;
  HALFPLANE_EACH_PART((Pack<T, N>::kParts), i, r.part[i] = a.part[i] >> bits.part[i])
  return r;
}
template <class T, int N>
HALFPLANE_LEAF Pack<T, N>& operator+=(Pack<T, N>& a, const Pack<T, N>& b) {
  return a = a + b;
}
template <class T, int N>
HALFPLANE_LEAF Pack<T, N>& operator|=(Pack<T, N>& a, const Pack<T, N>& b) {
  return a = a | b;
}
template <class T, int N>
HALFPLANE_LEAF Pack<T, N>& operator&=(Pack<T, N>& a, const Pack<T, N>& b) {
  return a = a & b;
}

/// Unsigned shift.
template <int N>
HALFPLANE_LEAF Pack<std::int32_t, N> shift_right_logical(const Pack<std::int32_t, N>& a, int bits) {
  using P = Pack<std::int32_t, N>;
  using Unsigned = typename Pack<std::uint32_t, N>::Register;
  P r;
  for (int i = 0; i < P::kParts; ++i) r.part[i] = (typename P::Register)((Unsigned)a.part[i] >> bits);
  return r;
}

/// The integer as wide as T: lanes of a comparison, all bits or none.
template <class T>
using MaskOf =
    std::conditional_t<sizeof(T) == 8, std::int64_t, std::conditional_t<sizeof(T) == 4, std::int32_t, std::int16_t>>;

#define HALFPLANE_PACK_COMPARISON(op)                                                                \
  template <class T, int N>                                                                          \
  HALFPLANE_LEAF Pack<MaskOf<T>, N> operator op(const Pack<T, N>& a, const Pack<T, N>& b) {          \
    Pack<MaskOf<T>, N> r;                                                                            \
    HALFPLANE_EACH_PART((Pack<T, N>::kParts), i,                                                     \
                        r.part[i] = (typename Pack<MaskOf<T>, N>::Register)(a.part[i] op b.part[i])) \
    return r;                                                                                        \
  }                                                                                                  \
  template <class T, int N>                                                                          \
  HALFPLANE_LEAF Pack<MaskOf<T>, N> operator op(const Pack<T, N>& a, std::type_identity_t<T> b) {    \
    return a op Pack<T, N>(b);                                                                       \
  }
HALFPLANE_PACK_COMPARISON(<)
HALFPLANE_PACK_COMPARISON(<=)
HALFPLANE_PACK_COMPARISON(>)
HALFPLANE_PACK_COMPARISON(>=)
HALFPLANE_PACK_COMPARISON(==)
HALFPLANE_PACK_COMPARISON(!=)
#undef HALFPLANE_PACK_COMPARISON

/// a where the mask is set, b elsewhere.
template <class T, int N>
HALFPLANE_LEAF Pack<T, N> select(const Pack<MaskOf<T>, N>& mask, const Pack<T, N>& a, const Pack<T, N>& b) {
  Pack<T, N> r;
#if HALFPLANE_ISA == 256  // GCC would otherwise first test where the mask is 0
  using Register = typename Pack<T, N>::Register;
  HALFPLANE_EACH_PART(
      (Pack<T, N>::kParts), i,
      r.part[i] = (Register)_mm256_blendv_epi8((__m256i)b.part[i], (__m256i)a.part[i], (__m256i)mask.part[i]))
#else
  HALFPLANE_EACH_PART((Pack<T, N>::kParts), i, r.part[i] = mask.part[i] ? a.part[i] : b.part[i])
#endif
  return r;
}
/// a where the sign of the mask is set, b elsewhere.
template <int N>
HALFPLANE_LEAF Pack<std::int32_t, N> select_by_sign(const Pack<std::int32_t, N>& mask, const Pack<std::int32_t, N>& a,
                                                    const Pack<std::int32_t, N>& b) {
#if HALFPLANE_ISA == 256
  using P = Pack<std::int32_t, N>;
  P r;
  for (int i = 0; i < P::kParts; ++i)
    r.part[i] = (typename P::Register)_mm256_blendv_ps((__m256)b.part[i], (__m256)a.part[i], (__m256)mask.part[i]);
  return r;
#else
  return select(mask < 0, a, b);
#endif
}
template <class T, int N>
HALFPLANE_LEAF Pack<T, N> min(const Pack<T, N>& a, const Pack<T, N>& b) {
  Pack<T, N> r;
  HALFPLANE_EACH_PART((Pack<T, N>::kParts), i, r.part[i] = a.part[i] < b.part[i] ? a.part[i] : b.part[i])
  return r;
}
template <class T, int N>
HALFPLANE_LEAF Pack<T, N> max(const Pack<T, N>& a, const Pack<T, N>& b) {
  Pack<T, N> r;
  HALFPLANE_EACH_PART((Pack<T, N>::kParts), i, r.part[i] = a.part[i] > b.part[i] ? a.part[i] : b.part[i])
  return r;
}

/// Lanes of `low` followed by `high`, from lane `First` on.
template <class Result, int First, class Vector, std::size_t... I>
HALFPLANE_LEAF Result lanes_from(const Vector& low, const Vector& high, std::index_sequence<I...>) {
  return __builtin_shufflevector(low, high, (First + static_cast<int>(I))...);
}

/// Every second lane of `low` and `high`, from lane `First` on.
template <class Result, int First = 0, class Vector, std::size_t... I>
HALFPLANE_LEAF Result even_lanes(const Vector& low, const Vector& high, std::index_sequence<I...>) {
  return __builtin_shufflevector(low, high, (2 * static_cast<int>(I) + First)...);
}

/// Converts lane by lane as static_cast does; where one type is twice as wide, half a register at a time.
template <class To, class From, int N>
HALFPLANE_LEAF Pack<To, N> convert(const Pack<From, N>& from) {
  constexpr int kLanes = std::min(Pack<To, N>::kLanes, Pack<From, N>::kLanes);
  static_assert(std::max(Pack<To, N>::kLanes, Pack<From, N>::kLanes) <= 2 * kLanes);
  using FromLanes __attribute__((vector_size(kLanes * sizeof(From)))) = From;
  using ToLanes __attribute__((vector_size(kLanes * sizeof(To)))) = To;
  Pack<To, N> to;
  if constexpr (sizeof(To) == sizeof(From)) {
    for (int i = 0; i < Pack<To, N>::kParts; ++i) to.part[i] = __builtin_convertvector(from.part[i], ToLanes);
  } else if constexpr (sizeof(To) > sizeof(From)) {
    constexpr auto kHalf = std::make_index_sequence<kLanes>{};
    for (int i = 0; i < Pack<From, N>::kParts; ++i) {
      const auto& both = from.part[i];
      to.part[2 * i] = __builtin_convertvector((lanes_from<FromLanes, 0>(both, both, kHalf)), ToLanes);
      to.part[2 * i + 1] = __builtin_convertvector((lanes_from<FromLanes, kLanes>(both, both, kHalf)), ToLanes);
    }
  } else if constexpr (std::is_integral_v<From> && std::endian::native == std::endian::little) {
    constexpr auto kBoth = std::make_index_sequence<std::size_t{2} * kLanes>{};
    using Wide = typename Pack<To, N>::Register;  // the lower halves: even lanes, low first
    for (int i = 0; i < Pack<To, N>::kParts; ++i)
      to.part[i] = even_lanes<Wide>((Wide)from.part[2 * i], (Wide)from.part[2 * i + 1], kBoth);
  } else {
    constexpr auto kBoth = std::make_index_sequence<std::size_t{2} * kLanes>{};
    for (int i = 0; i < Pack<To, N>::kParts; ++i)
      to.part[i] =
          lanes_from<typename Pack<To, N>::Register, 0>(__builtin_convertvector(from.part[2 * i], ToLanes),
                                                        __builtin_convertvector(from.part[2 * i + 1], ToLanes), kBoth);
  }
  return to;
}

/// The same bits as lanes of another type.
template <class To, class From>
HALFPLANE_LEAF To as(const From& from) {
  static_assert(sizeof(To) == sizeof(From) && To::kParts == From::kParts);
  To to;
  HALFPLANE_EACH_PART(To::kParts, i, to.part[i] = (typename To::Register)from.part[i])
  return to;
}

using I16 = Pack<std::int32_t, 16>;
using S32 = Pack<std::int16_t, 32>;  ///< two in each lane of an I16
#if HALFPLANE_ISA <= 256
using S16 = Pack<std::int16_t, 16>;  ///< the pixels of a block; wider registers take them in 32 bits
#endif
using S64 = Pack<std::int16_t, 64>;  ///< the pixels of a tile, or the tiles of a bin
using U64 = Pack<std::uint16_t, 64>;
using B64 = Pack<std::uint8_t, 64>;  ///< the channels of a block
using W16 = Pack<std::uint32_t, 16>;
using F16 = Pack<float, 16>;
using L16 = Pack<std::int64_t, 16>;
using D16 = Pack<double, 16>;

HALFPLANE_LEAF S32 shift_right_logical(const S32& a, int bits) {
  using Unsigned __attribute__((vector_size(HALFPLANE_ISA / 8))) = std::uint16_t;
  S32 r;
  for (int i = 0; i < S32::kParts; ++i) r.part[i] = (S32::Register)((Unsigned)a.part[i] >> bits);
  return r;
}

HALFPLANE_LEAF L16 shift_right_logical(const L16& a, int bits) {
  using Unsigned __attribute__((vector_size(HALFPLANE_ISA / 8))) = std::uint64_t;
  L16 r;
  for (int i = 0; i < L16::kParts; ++i) r.part[i] = (L16::Register)((Unsigned)a.part[i] >> bits);
  return r;
}

HALFPLANE_LEAF L16 shift_right_logical(const L16& a, const L16& bits) {
  using Unsigned __attribute__((vector_size(HALFPLANE_ISA / 8))) = std::uint64_t;
  L16 r;
  for (int i = 0; i < L16::kParts; ++i) r.part[i] = (L16::Register)((Unsigned)a.part[i] >> (Unsigned)bits.part[i]);
  return r;
}

/// Products of numbers of 32 bits in lanes of 64.
HALFPLANE_LEAF L16 multiply_narrow(const L16& a, const L16& b) {
#if HALFPLANE_ISA == 128
  return a * b;
#else
  L16 r;
  for (int i = 0; i < L16::kParts; ++i)
#if HALFPLANE_ISA == 512
    r.part[i] = (L16::Register)_mm512_mul_epi32((__m512i)a.part[i], (__m512i)b.part[i]);
#else
    r.part[i] = (L16::Register)_mm256_mul_epi32((__m256i)a.part[i], (__m256i)b.part[i]);
#endif
  return r;
#endif
}

HALFPLANE_LEAF D16 floor(const D16& v) {
  D16 r;
#if HALFPLANE_ISA == 512
  for (int i = 0; i < D16::kParts; ++i) r.part[i] = (D16::Register)_mm512_floor_pd((__m512d)v.part[i]);
#elif HALFPLANE_ISA == 256
  for (int i = 0; i < D16::kParts; ++i) r.part[i] = (D16::Register)_mm256_floor_pd((__m256d)v.part[i]);
#else
  for (int i = 0; i < 16; ++i)
    r.part[i / D16::kLanes][i % D16::kLanes] = std::floor(v.part[i / D16::kLanes][i % D16::kLanes]);
#endif
  return r;
}

/// The upper 32 bits of each lane.
HALFPLANE_LEAF I16 upper_halves(const L16& v) {
#if HALFPLANE_ISA == 512
  I16 r;
  const I16 odd = I16::of([](int i) { return 2 * i + 1; });
  r.part[0] = (I16::Register)_mm512_permutex2var_epi32((__m512i)v.part[0], (__m512i)odd.part[0], (__m512i)v.part[1]);
  return r;
#elif HALFPLANE_ISA == 256
  I16 r;
  for (int i = 0; i < I16::kParts; ++i)
    r.part[i] = even_lanes<I16::Register, 1>((I16::Register)v.part[2 * i], (I16::Register)v.part[2 * i + 1],
                                             std::make_index_sequence<I16::kLanes>{});
  return r;
#else
  return convert<std::int32_t>(shift_right_logical(v, 32));
#endif
}

/// The lower half of each lane from `low`, the upper one from `high`.
HALFPLANE_LEAF I16 joined_halves(const I16& low, const I16& high) {
#if HALFPLANE_ISA == 256
  I16 r;
  for (int i = 0; i < 2; ++i)
    r.part[i] = (I16::Register)_mm256_blend_epi16((__m256i)low.part[i], (__m256i)high.part[i], 0xaa);
  return r;
#elif HALFPLANE_ISA == 512
  I16 r;
  r.part[0] = (I16::Register)_mm512_mask_blend_epi16(0xaaaaaaaaU, (__m512i)low.part[0], (__m512i)high.part[0]);
  return r;
#else
  return (low & 0xffff) | (high & static_cast<std::int32_t>(0xffff0000U));
#endif
}
/// Two values of 16 bits in the halves of each lane: the lower halves of both, or the upper ones.
HALFPLANE_LEAF I16 pairs(const I16& low, const I16& high) { return joined_halves(low, high << 16); }
HALFPLANE_LEAF I16 upper_pairs(const I16& low, const I16& high) {
  return joined_halves(shift_right_logical(low, 16), high);
}

/// The upper halves of unsigned products.
HALFPLANE_LEAF S32 multiply_upper(const S32& a, std::uint16_t b) {
  S32 r;
  const S32 factor(static_cast<std::int16_t>(b));
#if HALFPLANE_ISA == 512
  r.part[0] = (S32::Register)_mm512_mulhi_epu16((__m512i)a.part[0], (__m512i)factor.part[0]);
#elif HALFPLANE_ISA == 256
  for (int i = 0; i < 2; ++i)
    r.part[i] = (S32::Register)_mm256_mulhi_epu16((__m256i)a.part[i], (__m256i)factor.part[i]);
#elif defined(__x86_64__)
  for (int i = 0; i < 4; ++i) r.part[i] = (S32::Register)_mm_mulhi_epu16((__m128i)a.part[i], (__m128i)factor.part[i]);
#else
  for (int i = 0; i < 32; ++i) {
    const auto value = static_cast<std::uint16_t>(a.part[i / S32::kLanes][i % S32::kLanes]);
    r.part[i / S32::kLanes][i % S32::kLanes] = static_cast<std::int16_t>((std::uint32_t{value} * b) >> 16);
  }
#endif
  return r;
}

/// a.low b.low + a.high b.high, lane by lane, for 16-bit pairs.
HALFPLANE_LEAF I16 multiply_add_pairs(const I16& a, const I16& b) {
  I16 r;
#if HALFPLANE_ISA == 512
  r.part[0] = (I16::Register)_mm512_madd_epi16((__m512i)a.part[0], (__m512i)b.part[0]);
#elif HALFPLANE_ISA == 256
  for (int i = 0; i < 2; ++i) r.part[i] = (I16::Register)_mm256_madd_epi16((__m256i)a.part[i], (__m256i)b.part[i]);
#elif defined(__x86_64__)
  for (int i = 0; i < 4; ++i) r.part[i] = (I16::Register)_mm_madd_epi16((__m128i)a.part[i], (__m128i)b.part[i]);
#else
  r = (a << 16 >> 16) * (b << 16 >> 16) + (a >> 16) * (b >> 16);
#endif
  return r;
}

/// a.low b.low + a.high b.high of pairs of bytes, without sign in `a`, with it in `b`; the sum has 16 bits.
HALFPLANE_LEAF S32 multiply_add_bytes(const S32& a, const S32& b) {
#if HALFPLANE_ISA == 512
  S32 r;
  r.part[0] = (S32::Register)_mm512_maddubs_epi16((__m512i)a.part[0], (__m512i)b.part[0]);
  return r;
#elif HALFPLANE_ISA == 256
  S32 r;
  for (int i = 0; i < 2; ++i) r.part[i] = (S32::Register)_mm256_maddubs_epi16((__m256i)a.part[i], (__m256i)b.part[i]);
  return r;
#else
  return (a & 255) * (b << 8 >> 8) + shift_right_logical(a, 8) * (b >> 8);
#endif
}

}  // namespace
}  // namespace halfplane::functional::HALFPLANE_ISA_NAME
