// Lanes to bits and to one number, and moves between lanes.
#pragma once

#include "lanes.inl"

namespace halfplane::functional::HALFPLANE_ISA_NAME {
namespace {

/// One bit for each lane whose sign bit is set.
HALFPLANE_LEAF std::uint32_t bits_of(const I16& mask) {
#if HALFPLANE_ISA == 512
  return _mm512_movepi32_mask((__m512i)mask.part[0]);
#elif HALFPLANE_ISA == 256
  return static_cast<std::uint32_t>(_mm256_movemask_ps((__m256)mask.part[0]) | _mm256_movemask_ps((__m256)mask.part[1])
                                                                                   << 8);
#elif defined(__x86_64__)
  std::uint32_t bits = 0;
  for (int i = 0; i < 4; ++i) bits |= static_cast<std::uint32_t>(_mm_movemask_ps((__m128)mask.part[i])) << 4 * i;
  return bits;
#else
  std::uint32_t bits = 0;
  for (int i = 0; i < 16; ++i) bits |= (static_cast<std::uint32_t>(mask.part[i / 4][i % 4]) >> 31) << i;
  return bits;
#endif
}

/// ORs the bits of the lanes in `lanes`, each shifted up by `by`.
HALFPLANE_LEAF std::uint64_t or_of_bits(const I16& bits, const I16& by, std::uint32_t lanes) {
#if HALFPLANE_ISA == 512
  const auto half = [](std::uint32_t mask, const __m256i& b, const __m256i& places) HALFPLANE_LAMBDA {
    return _mm512_maskz_sllv_epi64(static_cast<__mmask8>(mask), _mm512_cvtepi32_epi64(b),
                                   _mm512_cvtepi32_epi64(places));
  };
  const auto b = (__m512i)bits.part[0], places = (__m512i)by.part[0];
  const __m512i low = half(lanes, _mm512_castsi512_si256(b), _mm512_castsi512_si256(places)),
                high = half(lanes >> 8, _mm512_extracti64x4_epi64(b, 1), _mm512_extracti64x4_epi64(places, 1));
  return static_cast<std::uint64_t>(_mm512_reduce_or_epi64(_mm512_or_si512(low, high)));
#elif HALFPLANE_ISA == 256
  const L16 is_in =
      (L16::of([](int i) HALFPLANE_LAMBDA { return std::int64_t{1} << i; }) & static_cast<std::int64_t>(lanes)) != 0;
  const L16 moved = (convert<std::int64_t>(bits) << convert<std::int64_t>(by)) & is_in;
  const L16::Register all = (moved.part[0] | moved.part[1]) | (moved.part[2] | moved.part[3]);
  return static_cast<std::uint64_t>(all[0] | all[1] | all[2] | all[3]);
#else
  std::uint64_t all = 0;
  for (int i = 0; i < 16; ++i) {
    const auto lane = [i](const I16& v) {
      return static_cast<std::uint32_t>(v.part[i / I16::kLanes][i % I16::kLanes]);
    };
    all |= (lanes >> i & 1) * std::uint64_t{lane(bits)} << (lane(by) & 63);
  }
  return all;
#endif
}

#if HALFPLANE_ISA == 512
/// `bits` where a < b. Goes straight to a mask register: with bits_of() GCC makes lanes first.
HALFPLANE_LEAF std::uint32_t bits_below(std::uint32_t bits, const I16& a, const I16& b) {
  return _mm512_mask_cmplt_epi32_mask(static_cast<__mmask16>(bits), (__m512i)a.part[0], (__m512i)b.part[0]);
}
#endif

/// Sixteen numbers of four bits, packed; lane 0 lowest.
HALFPLANE_LEAF std::uint64_t nibbles_of(const I16& values) {
  const I16 placed = values << I16::of([](int i) { return 4 * (i % 8); });
#if HALFPLANE_ISA == 512
  const auto all = (__m512i)placed.part[0];
  const auto low = static_cast<std::uint32_t>(_mm512_mask_reduce_or_epi32(0x00ff, all)),
             high = static_cast<std::uint32_t>(_mm512_mask_reduce_or_epi32(0xff00, all));
#else
  using Four __attribute__((vector_size(16))) = std::int32_t;
#if HALFPLANE_ISA == 256
  const auto half = [&placed](int i) HALFPLANE_LAMBDA {
    constexpr auto kFour = std::make_index_sequence<4>{};
    const auto& eight = placed.part[i];
    return lanes_from<Four, 0>(eight, eight, kFour) | lanes_from<Four, 4>(eight, eight, kFour);
  };
#else
  const auto half = [&placed](std::size_t i) HALFPLANE_LAMBDA { return placed.part[2 * i] | placed.part[2 * i + 1]; };
#endif
  const auto or_of = [](const Four& four) HALFPLANE_LAMBDA {
    const Four two = four | __builtin_shufflevector(four, four, 2, 3, 0, 1);
    return static_cast<std::uint32_t>(two[0] | two[1]);
  };
  const std::uint32_t low = or_of(half(0)), high = or_of(half(1));
#endif
  return low | std::uint64_t{high} << 32;
}

/// Each lane's predecessor: the lanes of `v` one up, and below them the last lane of `before`.
HALFPLANE_LEAF I16 moved_up(const I16& before, const I16& v) {
  constexpr auto kAll = std::make_index_sequence<I16::kLanes>{};
  I16 r;
  r.part[0] = lanes_from<I16::Register, I16::kLanes - 1>(before.part[I16::kParts - 1], v.part[0], kAll);
  HALFPLANE_EACH_PART(I16::kParts - 1, i,
                      r.part[i + 1] = lanes_from<I16::Register, I16::kLanes - 1>(v.part[i], v.part[i + 1], kAll))
  return r;
}

HALFPLANE_LEAF bool is_any(const I16& mask) { return bits_of(mask) != 0; }

/// One bit for each of 32 lanes whose sign bit is set.
#if HALFPLANE_ISA == 512
HALFPLANE_LEAF std::uint32_t bits_of(const S32& mask) { return _mm512_movepi16_mask((__m512i)mask.part[0]); }
#else
HALFPLANE_LEAF std::uint32_t bits_of(const S16& low, const S16& high) {
#if HALFPLANE_ISA == 256
  const __m256i bytes = _mm256_packs_epi16((__m256i)low.part[0], (__m256i)high.part[0]);  // back in order:
  return static_cast<std::uint32_t>(_mm256_movemask_epi8(_mm256_permute4x64_epi64(bytes, 0xd8)));
#elif defined(__x86_64__)
  const auto half = [](const S16& mask) HALFPLANE_LAMBDA {
    return static_cast<std::uint32_t>(_mm_movemask_epi8(_mm_packs_epi16((__m128i)mask.part[0], (__m128i)mask.part[1])));
  };
  return half(low) | half(high) << 16;
#else
  std::uint32_t bits = 0;
  for (int i = 0; i < 16; ++i) {
    bits |= std::uint32_t{low.part[i / 8][i % 8] < 0} << i;
    bits |= std::uint32_t{high.part[i / 8][i % 8] < 0} << (16 + i);
  }
  return bits;
#endif
}
#endif

/// One bit for each of 64 lanes whose sign bit is set.
HALFPLANE_LEAF std::uint64_t bits_of(const S64& mask) {
#if HALFPLANE_ISA == 512
  return _mm512_movepi16_mask((__m512i)mask.part[0]) | std::uint64_t{_mm512_movepi16_mask((__m512i)mask.part[1])} << 32;
#elif HALFPLANE_ISA == 256
  const auto half = [&mask](int i) HALFPLANE_LAMBDA {  // a byte a lane, back in order
    const __m256i bytes = _mm256_packs_epi16((__m256i)mask.part[i], (__m256i)mask.part[i + 1]);
    return static_cast<std::uint32_t>(_mm256_movemask_epi8(_mm256_permute4x64_epi64(bytes, 0xd8)));
  };
  return half(0) | std::uint64_t{half(2)} << 32;
#elif defined(__x86_64__)
  std::uint64_t bits = 0;
  for (int i = 0; i < 8; i += 2)
    bits |=
        static_cast<std::uint64_t>(_mm_movemask_epi8(_mm_packs_epi16((__m128i)mask.part[i], (__m128i)mask.part[i + 1])))
        << 8 * i;
  return bits;
#else
  std::uint64_t bits = 0;
  for (int i = 0; i < 64; ++i) bits |= std::uint64_t{mask.part[i / 8][i % 8] < 0} << i;
  return bits;
#endif
}

/// One bit for each lane with a <= b.
HALFPLANE_LEAF std::uint64_t bits_at_most(const S64& a, std::int16_t b) {
#if HALFPLANE_ISA == 512
  const __m512i most = _mm512_set1_epi16(b);
  return _mm512_cmple_epi16_mask((__m512i)a.part[0], most) |
         std::uint64_t{_mm512_cmple_epi16_mask((__m512i)a.part[1], most)} << 32;
#else
  return ~bits_of(a > b);
#endif
}

/// The inverse: a mask.
HALFPLANE_LEAF S64 lanes_of(std::uint64_t bits) {
  S64 r;
#if HALFPLANE_ISA == 512
  for (int i = 0; i < 2; ++i) r.part[i] = (S64::Register)_mm512_movm_epi16(static_cast<__mmask32>(bits >> 32 * i));
#else
  constexpr int kLanes = S64::kLanes;
  S64::Register bit;
  for (int i = 0; i < kLanes; ++i) bit[i] = static_cast<std::int16_t>(1U << i);
  for (int i = 0; i < S64::kParts; ++i) {
    const auto part = static_cast<std::int16_t>(bits >> kLanes * i);
    r.part[i] = ((S64::Register{} + part) & bit) == bit;
  }
#endif
  return r;
}

#if HALFPLANE_ISA <= 256
/// The inverse, for sixteen lanes.
HALFPLANE_LEAF S16 block_lanes_of(std::uint32_t bits) {
  const S16 bit = S16::of([](int i) { return static_cast<std::int16_t>(1U << i); });
  return (S16(static_cast<std::int16_t>(bits)) & bit) == bit;
}

/// A mask for lanes of 32 bits.
HALFPLANE_LEAF I16 widened(const S16& mask) {
#if HALFPLANE_ISA == 256
  I16 r;
  r.part[0] = (I16::Register)_mm256_cvtepi16_epi32(_mm256_castsi256_si128((__m256i)mask.part[0]));
  r.part[1] = (I16::Register)_mm256_cvtepi16_epi32(_mm256_extracti128_si256((__m256i)mask.part[0], 1));
  return r;
#else
  return convert<std::int32_t>(mask);
#endif
}

/// Number of set lanes in a mask, times kCountOfLane.
constexpr unsigned kCountOfLane = HALFPLANE_ISA == 256 ? 2 : 1;
HALFPLANE_LEAF unsigned count_of(const S16& mask) {
#if HALFPLANE_ISA == 256
  return static_cast<unsigned>(std::popcount(static_cast<unsigned>(_mm256_movemask_epi8((__m256i)mask.part[0]))));
#elif defined(__x86_64__)
  return static_cast<unsigned>(std::popcount(
      static_cast<unsigned>(_mm_movemask_epi8(_mm_packs_epi16((__m128i)mask.part[0], (__m128i)mask.part[1])))));
#else
  unsigned lanes = 0;
  for (int i = 0; i < 16; ++i) lanes += mask.part[i / 8][i % 8] != 0 ? 1 : 0;
  return lanes;
#endif
}

/// To 16 bits, saturating.
HALFPLANE_LEAF S16 saturated(const I16& v) {
  S16 r;
#if HALFPLANE_ISA == 256
  const __m256i both = _mm256_packs_epi32((__m256i)v.part[0], (__m256i)v.part[1]);
  r.part[0] = (S16::Register)_mm256_permute4x64_epi64(both, 0xd8);
#elif defined(__x86_64__)
  for (std::size_t i = 0; i < 2; ++i)
    r.part[i] = (S16::Register)_mm_packs_epi32((__m128i)v.part[2 * i], (__m128i)v.part[2 * i + 1]);
#else
  for (int i = 0; i < 16; ++i)
    r.part[i / 8][i % 8] = static_cast<std::int16_t>(std::clamp(v.part[i / 4][i % 4], -0x8000, 0x7fff));
#endif
  return r;
}
#endif

/// Masks of four blocks of a tile, a word of each: of sample k in number k, or of block k. The same words the other way.
using BlocksOfSamples = std::array<std::uint64_t, 4>;
HALFPLANE_LEAF BlocksOfSamples transposed(const BlocksOfSamples& words) {
  BlocksOfSamples r;
#if HALFPLANE_ISA >= 256
  // Out of registers: a load of 32 bytes would wait for four stores of eight.
  const auto word = [&words](std::size_t i) HALFPLANE_LAMBDA { return static_cast<std::int64_t>(words[i]); };
  const __m256i all = _mm256_set_epi64x(word(3), word(2), word(1), word(0)),
                order =
                    _mm256_broadcastsi128_si256(_mm_setr_epi8(0, 1, 8, 9, 2, 3, 10, 11, 4, 5, 12, 13, 6, 7, 14, 15));
  const __m256i pairs = _mm256_shuffle_epi8(all, order);
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(r.data()),
                      _mm256_permutevar8x32_epi32(pairs, _mm256_setr_epi32(0, 4, 1, 5, 2, 6, 3, 7)));
#else
  for (std::size_t i = 0; i < 4; ++i) {
    r[i] = 0;
    for (std::size_t k = 0; k < 4; ++k) r[i] |= (words[k] >> 16 * i & 0xffff) << 16 * k;
  }
#endif
  return r;
}

/// Four numbers, each in sixteen lanes.
HALFPLANE_LEAF S64 four_blocks(const std::array<std::int16_t, 4>& of) {
  S64 r;
#if HALFPLANE_ISA == 512
  for (std::size_t i = 0; i < 2; ++i)
    r.part[i] = (S64::Register)_mm512_inserti64x4(_mm512_set1_epi16(of[2 * i]), _mm256_set1_epi16(of[2 * i + 1]), 1);
#else
  for (int i = 0; i < S64::kParts; ++i) r.part[i] = S64::Register{} + of[static_cast<std::size_t>(4 * i / S64::kParts)];
#endif
  return r;
}
/// Four times sixteen lanes, to 16 bits, saturating.
HALFPLANE_LEAF S64 four_blocks(const std::array<I16, 4>& of) {
  S64 r;
#if HALFPLANE_ISA == 512
  const __m512i order = _mm512_setr_epi64(0, 2, 4, 6, 1, 3, 5, 7);
  for (std::size_t i = 0; i < 2; ++i) {
    const __m512i both = _mm512_packs_epi32((__m512i)of[2 * i].part[0], (__m512i)of[2 * i + 1].part[0]);
    r.part[i] = (S64::Register)_mm512_permutexvar_epi64(order, both);
  }
#else
  for (int i = 0; i < S64::kParts; ++i)
    r.part[i] = saturated(of[static_cast<std::size_t>(4 * i / S64::kParts)]).part[i % S16::kParts];
#endif
  return r;
}

/// Eight lanes of `left` and eight of `right` alternating, to signed bytes, saturating.
HALFPLANE_LEAF B64 saturated(const S32& left, const S32& right) {
  B64 r;
#if HALFPLANE_ISA == 512
  r.part[0] = (B64::Register)_mm512_packs_epi16((__m512i)left.part[0], (__m512i)right.part[0]);
#elif HALFPLANE_ISA == 256
  for (int i = 0; i < 2; ++i)
    r.part[i] = (B64::Register)_mm256_packs_epi16((__m256i)left.part[i], (__m256i)right.part[i]);
#elif defined(__x86_64__)
  for (int i = 0; i < 4; ++i) r.part[i] = (B64::Register)_mm_packs_epi16((__m128i)left.part[i], (__m128i)right.part[i]);
#else
  for (int i = 0; i < 32; ++i) {
    const auto byte = [i](const S32& v) {
      return static_cast<std::uint8_t>(std::clamp<int>(v.part[i / 8][i % 8], -0x80, 0x7f));
    };
    r.part[i / 8][i % 8] = byte(left);
    r.part[i / 8][8 + i % 8] = byte(right);
  }
#endif
  return r;
}

/// Two numbers of 16 bits, alternating.
template <class Lanes>
HALFPLANE_LEAF Lanes repeated(std::int32_t two) {
  using Wide __attribute__((vector_size(sizeof(typename Lanes::Register)))) = std::int32_t;
  Lanes r;
  HALFPLANE_EACH_PART(Lanes::kParts, i, r.part[i] = (typename Lanes::Register)(Wide{} + two))
  return r;
}
/// Four, repeated.
HALFPLANE_LEAF S32 repeated(std::uint64_t four) {
  using Wide __attribute__((vector_size(HALFPLANE_ISA / 8))) = std::uint64_t;
  S32 r;
  HALFPLANE_EACH_PART(S32::kParts, i, r.part[i] = (S32::Register)(Wide{} + four))
  return r;
}

/// Bytes 0 and 1 of each lane, or 2 and 3, as pairs.
HALFPLANE_LEAF I16 channel_pair(const I16& rgba, std::size_t pair) {
#if HALFPLANE_ISA >= 256
  using Bytes __attribute__((vector_size(HALFPLANE_ISA / 8))) = std::int8_t;
  Bytes from;
  for (int i = 0; i < HALFPLANE_ISA / 8; ++i)
    from[i] = static_cast<std::int8_t>(i % 2 != 0 ? -1 : i % 16 / 4 * 4 + 2 * static_cast<int>(pair) + i % 4 / 2);
  I16 r;
#if HALFPLANE_ISA == 512
  r.part[0] = (I16::Register)_mm512_shuffle_epi8((__m512i)rgba.part[0], (__m512i)from);
#else
  for (int i = 0; i < 2; ++i) r.part[i] = (I16::Register)_mm256_shuffle_epi8((__m256i)rgba.part[i], (__m256i)from);
#endif
  return r;
#else
  const I16 both = shift_right_logical(rgba, static_cast<int>(16 * pair));
  return (both & 0xff) | ((both << 8) & 0xff0000);
#endif
}

/// The highest bytes of four lanes, the first one lowest.
HALFPLANE_LEAF I16 highest_bytes(const I16& first, const I16& second, const I16& third, const I16& fourth) {
#if HALFPLANE_ISA >= 256
  const auto moved = [](const I16& v, int to) HALFPLANE_LAMBDA {
    using Bytes __attribute__((vector_size(HALFPLANE_ISA / 8))) = std::int8_t;
    Bytes from;
    for (int i = 0; i < HALFPLANE_ISA / 8; ++i)
      from[i] = static_cast<std::int8_t>(i % 4 == to ? i % 16 / 4 * 4 + 3 : -1);
    I16 r;
#if HALFPLANE_ISA == 512
    r.part[0] = (I16::Register)_mm512_shuffle_epi8((__m512i)v.part[0], (__m512i)from);
#else
    for (int i = 0; i < 2; ++i) r.part[i] = (I16::Register)_mm256_shuffle_epi8((__m256i)v.part[i], (__m256i)from);
#endif
    return r;
  };
  return (moved(first, 0) | moved(second, 1)) | (moved(third, 2) | moved(fourth, 3));
#else
  const auto moved = [](const I16& v, int down) HALFPLANE_LAMBDA {
    return shift_right_logical(v, down) & static_cast<std::int32_t>(0xff000000U >> down);
  };
  return (moved(first, 24) | moved(second, 16)) | (moved(third, 8) | moved(fourth, 0));
#endif
}

/// The lower half of each lane, copied to both halves.
HALFPLANE_LEAF I16 doubled(const I16& v) {
  I16 r;
#if HALFPLANE_ISA == 512
  const __m512i order = _mm512_broadcast_i32x4(_mm_setr_epi8(0, 1, 0, 1, 4, 5, 4, 5, 8, 9, 8, 9, 12, 13, 12, 13));
  r.part[0] = (I16::Register)_mm512_shuffle_epi8((__m512i)v.part[0], order);
#elif HALFPLANE_ISA == 256
  const __m256i order = _mm256_broadcastsi128_si256(_mm_setr_epi8(0, 1, 0, 1, 4, 5, 4, 5, 8, 9, 8, 9, 12, 13, 12, 13));
  for (int i = 0; i < 2; ++i) r.part[i] = (I16::Register)_mm256_shuffle_epi8((__m256i)v.part[i], order);
#else
  r = (v & 0xffff) | (v << 16);
#endif
  return r;
}

/// In each group of eight 16-bit numbers, the first four interleaved with the last four.
HALFPLANE_LEAF B64 turns_of_halves(const B64& v) {
  B64 r;
#if HALFPLANE_ISA == 512
  const __m512i order = _mm512_broadcast_i32x4(_mm_setr_epi8(0, 1, 8, 9, 2, 3, 10, 11, 4, 5, 12, 13, 6, 7, 14, 15));
  r.part[0] = (B64::Register)_mm512_shuffle_epi8((__m512i)v.part[0], order);
#elif HALFPLANE_ISA == 256
  const __m256i order =
      _mm256_broadcastsi128_si256(_mm_setr_epi8(0, 1, 8, 9, 2, 3, 10, 11, 4, 5, 12, 13, 6, 7, 14, 15));
  for (int i = 0; i < 2; ++i) r.part[i] = (B64::Register)_mm256_shuffle_epi8((__m256i)v.part[i], order);
#else
  using Words __attribute__((vector_size(16))) = std::int16_t;
  for (int i = 0; i < 4; ++i)
    r.part[i] = (B64::Register)__builtin_shufflevector((Words)v.part[i], (Words)v.part[i], 0, 4, 1, 5, 2, 6, 3, 7);
#endif
  return r;
}

/// Stores the 64 bits of each lane, `low` first, to memory.
template <class Element>
HALFPLANE_LEAF void store_interleaved(const I16& low, const I16& high, Element* to) {
  static_assert(sizeof(Element) == 8);
#if HALFPLANE_ISA == 512
  const auto &a = low.part[0], &b = high.part[0];
  using Row = I16::InMemory;
  reinterpret_cast<Row*>(to)[0] = __builtin_shufflevector(a, b, 0, 16, 1, 17, 2, 18, 3, 19, 4, 20, 5, 21, 6, 22, 7, 23);
  reinterpret_cast<Row*>(to)[1] =
      __builtin_shufflevector(a, b, 8, 24, 9, 25, 10, 26, 11, 27, 12, 28, 13, 29, 14, 30, 15, 31);
#elif HALFPLANE_ISA == 256
  for (int i = 0; i < 2; ++i) {
    const auto a = (__m256i)low.part[i], b = (__m256i)high.part[i];
    const __m256i first = _mm256_unpacklo_epi32(a, b), second = _mm256_unpackhi_epi32(a, b);
    __m256i* const row = reinterpret_cast<__m256i*>(to) + 2 * i;
    _mm256_storeu_si256(row, _mm256_permute2x128_si256(first, second, 0x20));
    _mm256_storeu_si256(row + 1, _mm256_permute2x128_si256(first, second, 0x31));
  }
#else
  for (std::size_t i = 0; i < 4; ++i) {
    I16::InMemory* const row = reinterpret_cast<I16::InMemory*>(to) + 2 * i;
    row[0] = __builtin_shufflevector(low.part[i], high.part[i], 0, 4, 1, 5);
    row[1] = __builtin_shufflevector(low.part[i], high.part[i], 2, 6, 3, 7);
  }
#endif
}

/// One bit for each lane with a >= b.
HALFPLANE_LEAF std::uint64_t bits_at_least(const U64& a, const U64& b) {
#if HALFPLANE_ISA == 512
  return _mm512_cmpge_epu16_mask((__m512i)a.part[0], (__m512i)b.part[0]) |
         std::uint64_t{_mm512_cmpge_epu16_mask((__m512i)a.part[1], (__m512i)b.part[1])} << 32;
#else
  return bits_of(max(a, b) == a);
#endif
}

/// One bit for each lane with a == b.
HALFPLANE_LEAF std::uint64_t bits_equal(const U64& a, const U64& b) {
#if HALFPLANE_ISA == 512
  return _mm512_cmpeq_epu16_mask((__m512i)a.part[0], (__m512i)b.part[0]) |
         std::uint64_t{_mm512_cmpeq_epu16_mask((__m512i)a.part[1], (__m512i)b.part[1])} << 32;
#else
  return bits_of(a == b);
#endif
}

/// a in the lanes whose bit is set, b elsewhere. `to_sign`: 31 - lane.
HALFPLANE_LEAF I16 select_by_bits(std::uint32_t bits, const I16& a, const I16& b, [[maybe_unused]] const I16& to_sign) {
#if HALFPLANE_ISA == 512
  I16 r;
  r.part[0] =
      (I16::Register)_mm512_mask_mov_epi32((__m512i)b.part[0], static_cast<__mmask16>(bits), (__m512i)a.part[0]);
  return r;
#else
  return select_by_sign(I16(static_cast<std::int32_t>(bits)) << to_sign, a, b);
#endif
}

/// Mean of each byte, a half rounded up.
HALFPLANE_LEAF I16 mean_of_bytes(const I16& a, const I16& b) {
#if HALFPLANE_ISA == 512
  I16 r;
  r.part[0] = (I16::Register)_mm512_avg_epu8((__m512i)a.part[0], (__m512i)b.part[0]);
  return r;
#elif HALFPLANE_ISA == 256
  I16 r;
  for (int i = 0; i < 2; ++i) r.part[i] = (I16::Register)_mm256_avg_epu8((__m256i)a.part[i], (__m256i)b.part[i]);
  return r;
#else
  return (a | b) - (shift_right_logical(a ^ b, 1) & 0x7f7f7f7f);
#endif
}
/// The same of four: where the means of two add up to an odd number and one of them is rounded, theirs is 1 too large.
HALFPLANE_LEAF I16 mean_of_bytes(const I16& a, const I16& b, const I16& c, const I16& d) {
  const I16 first = mean_of_bytes(a, b), second = mean_of_bytes(c, d);
  return mean_of_bytes(first, second) - (((a ^ b) | (c ^ d)) & (first ^ second) & 0x01010101);
}

/// select_by_bits() for four numbers of 16 bits a pixel, of which a block's left half has eight and its right half eight.
HALFPLANE_LEAF void replace_by_bits(std::uint32_t bits, const S32& with, S32& left, S32& right,
                                    [[maybe_unused]] const I16& to_sign) {
#if HALFPLANE_ISA == 512
  const __m512i all = _mm512_set1_epi64(static_cast<std::int64_t>(bits)),
                of_left = _mm512_setr_epi64(1, 2, 1 << 4, 2 << 4, 1 << 8, 2 << 8, 1 << 12, 2 << 12);
  const auto replace = [&](S32& half, const __m512i& place) HALFPLANE_LAMBDA {
    half.part[0] = (S32::Register)_mm512_mask_mov_epi64((__m512i)half.part[0], _mm512_test_epi64_mask(all, place),
                                                        (__m512i)with.part[0]);
  };
  replace(left, of_left);
  replace(right, _mm512_slli_epi64(of_left, 2));
#else
  const I16 signs = I16(static_cast<std::int32_t>(bits)) << to_sign;
  for (int i = 0; i < S32::kParts; ++i) {
#if HALFPLANE_ISA == 256
    const auto mask = (__m256i)signs.part[i];
    const auto replaced = [&](const S32& half, const __m256i& of) HALFPLANE_LAMBDA {
      return (S32::Register)_mm256_blendv_ps((__m256)half.part[i], (__m256)with.part[i], (__m256)of);
    };
    left.part[i] = replaced(left, _mm256_unpacklo_epi32(mask, mask));
    right.part[i] = replaced(right, _mm256_unpackhi_epi32(mask, mask));
#else
    const I16::Register mask = signs.part[i] < 0;
    const auto replaced = [&](const S32& half, const I16::Register& of) HALFPLANE_LAMBDA {
      return (half.part[i] & ~(S32::Register)of) | (with.part[i] & (S32::Register)of);
    };
    left.part[i] = replaced(left, __builtin_shufflevector(mask, mask, 0, 0, 1, 1));
    right.part[i] = replaced(right, __builtin_shufflevector(mask, mask, 2, 2, 3, 3));
#endif
  }
#endif
}

/// 32 bits from base + 4 * index, lane by lane.
HALFPLANE_LEAF I16 gather(const void* base, const I16& index) {
  I16 r;
#if HALFPLANE_ISA == 512
  r.part[0] = (I16::Register)_mm512_i32gather_epi32((__m512i)index.part[0], base, 4);
#elif HALFPLANE_ISA == 256
  for (int i = 0; i < 2; ++i)
    r.part[i] = (I16::Register)_mm256_i32gather_epi32(static_cast<const int*>(base), (__m256i)index.part[i], 4);
#else
  for (std::size_t i = 0; i < 16; ++i)
    std::memcpy(reinterpret_cast<char*>(&r) + 4 * i,
                static_cast<const char*>(base) + std::ptrdiff_t{index.part[i / 4][i % 4]} * 4, 4);
#endif
  return r;
}

/// Numbers of a table of 64.
HALFPLANE_LEAF I16 looked_up(const std::uint16_t* numbers, const I16& index) {
#if HALFPLANE_ISA == 512
  const U64 table = U64::load(numbers);
  const __m512i at = _mm512_castsi256_si512(_mm512_cvtepi32_epi16((__m512i)index.part[0])),
                found = _mm512_permutex2var_epi16((__m512i)table.part[0], at, (__m512i)table.part[1]);
  I16 r;
  r.part[0] = (I16::Register)_mm512_cvtepu16_epi32(_mm512_castsi512_si256(found));
  return r;
#else
  alignas(64) std::array<std::int32_t, 16> at, found;
  index.store(at.data());
  for (std::size_t i = 0; i < 16; ++i) found[i] = numbers[at[i]];
  return I16::load(found.data());
#endif
}

/// One number in the lower eight lanes, another in the upper.
HALFPLANE_LEAF I16 halves(std::int32_t low, std::int32_t high) {
  I16 r;
#if HALFPLANE_ISA == 512
  r.part[0] = (I16::Register)_mm512_inserti64x4(_mm512_set1_epi32(low), _mm256_set1_epi32(high), 1);
#else
  for (int i = 0; i < I16::kParts; ++i) r.part[i] = I16::Register{} + (2 * i < I16::kParts ? low : high);
#endif
  return r;
}

/// The smallest lane.
HALFPLANE_LEAF std::int32_t min_lane(const I16& v) {
#if HALFPLANE_ISA == 512
  return _mm512_reduce_min_epi32((__m512i)v.part[0]);
#else
  // Half against half, down to one lane.
  using Four __attribute__((vector_size(16))) = std::int32_t;
  const auto smaller = [](const Four& a, const Four& b) HALFPLANE_LAMBDA { return a < b ? a : b; };
#if HALFPLANE_ISA == 256
  constexpr auto kFour = std::make_index_sequence<4>{};
  const I16::Register eight = v.part[0] < v.part[1] ? v.part[0] : v.part[1];
  const Four four = smaller(lanes_from<Four, 0>(eight, eight, kFour), lanes_from<Four, 4>(eight, eight, kFour));
#else
  const Four four = smaller(smaller(v.part[0], v.part[1]), smaller(v.part[2], v.part[3]));
#endif
  const Four two = smaller(four, __builtin_shufflevector(four, four, 2, 3, 0, 1));
  return std::min(two[0], two[1]);
#endif
}
HALFPLANE_LEAF std::int32_t max_lane(const I16& v) { return ~min_lane(~v); }

HALFPLANE_LEAF std::int32_t or_of_lanes(const I16& v) {
#if HALFPLANE_ISA == 512
  return _mm512_reduce_or_epi32((__m512i)v.part[0]);
#else
  using Two __attribute__((vector_size(16))) = std::int64_t;
#if HALFPLANE_ISA == 256
  using Four __attribute__((vector_size(32))) = std::int64_t;
  const Four four = (Four)(v.part[0] | v.part[1]);
  const Two two = __builtin_shufflevector(four, four, 0, 1) | __builtin_shufflevector(four, four, 2, 3);
#else
  const Two two = (Two)((v.part[0] | v.part[1]) | (v.part[2] | v.part[3]));
#endif
  const std::int64_t all = two[0] | two[1];
  return static_cast<std::int32_t>(all | all >> 32);
#endif
}

HALFPLANE_LEAF std::uint32_t min_lane(const U64& v) {
#if HALFPLANE_ISA == 128
  U64::Register all = v.part[0];
  for (int i = 1; i < 8; ++i) all = all < v.part[i] ? all : v.part[i];
  std::uint32_t least = all[0];
  for (int i = 1; i < 8; ++i) least = std::min<std::uint32_t>(least, all[i]);
  return least;
#else
#if HALFPLANE_ISA == 512
  const auto both = (__m512i)(v.part[0] < v.part[1] ? v.part[0] : v.part[1]);
  const __m256i half = _mm256_min_epu16(_mm512_castsi512_si256(both), _mm512_extracti64x4_epi64(both, 1));
#else
  const auto smaller = [](const U64::Register& a, const U64::Register& b) HALFPLANE_LAMBDA { return a < b ? a : b; };
  const auto half = (__m256i)smaller(smaller(v.part[0], v.part[1]), smaller(v.part[2], v.part[3]));
#endif
  const __m128i eight = _mm_min_epu16(_mm256_castsi256_si128(half), _mm256_extracti128_si256(half, 1));
  return static_cast<std::uint32_t>(_mm_cvtsi128_si32(_mm_minpos_epu16(eight))) & 0xffff;
#endif
}
HALFPLANE_LEAF std::uint32_t max_lane(const U64& v) { return 0xffff - min_lane(~v); }

}  // namespace
}  // namespace halfplane::functional::HALFPLANE_ISA_NAME
