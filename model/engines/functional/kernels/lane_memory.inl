// Lanes from and to memory: narrow numbers, rows of four, blocks of an image, whole cache lines.
#pragma once

#include "lanes.inl"

namespace halfplane::functional::HALFPLANE_ISA_NAME {
namespace {

/// Sixteen numbers below 2^16, from and to memory.
HALFPLANE_LEAF I16 load_narrow(const std::uint16_t* from) {
  I16 r;
#if HALFPLANE_ISA == 512
  r.part[0] = (I16::Register)_mm512_cvtepu16_epi32(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(from)));
#elif HALFPLANE_ISA == 256
  for (int i = 0; i < 2; ++i)
    r.part[i] = (I16::Register)_mm256_cvtepu16_epi32(_mm_loadu_si128(reinterpret_cast<const __m128i*>(from) + i));
#else
  for (int i = 0; i < 16; ++i) r.part[i / 4][i % 4] = from[i];
#endif
  return r;
}
HALFPLANE_LEAF void store_narrow(const I16& value, std::uint16_t* to) {
#if HALFPLANE_ISA == 512
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), _mm512_cvtepi32_epi16((__m512i)value.part[0]));
#elif HALFPLANE_ISA == 256
  const __m256i both = _mm256_packus_epi32((__m256i)value.part[0], (__m256i)value.part[1]);
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), _mm256_permute4x64_epi64(both, 0xd8));
#else
  for (int i = 0; i < 16; ++i) to[i] = static_cast<std::uint16_t>(value.part[i / 4][i % 4]);
#endif
}

/// Numbers of a table of sixteen, without a gather.
HALFPLANE_LEAF I16 looked_up(const std::array<std::int32_t, 16>& table, const I16& index) {
  I16 r;
#if HALFPLANE_ISA == 512
  r.part[0] = (I16::Register)_mm512_permutexvar_epi32((__m512i)index.part[0], _mm512_loadu_si512(table.data()));
#elif HALFPLANE_ISA == 256
  const auto* const half = reinterpret_cast<const __m256i*>(table.data());
  const __m256i low = _mm256_loadu_si256(half), high = _mm256_loadu_si256(half + 1);
  for (int i = 0; i < 2; ++i) {
    const auto at = (__m256i)index.part[i];
    r.part[i] = (I16::Register)_mm256_blendv_ps((__m256)_mm256_permutevar8x32_epi32(low, at),
                                                (__m256)_mm256_permutevar8x32_epi32(high, at),
                                                (__m256)_mm256_slli_epi32(at, 28));  // bit 3 as the sign
  }
#else
  for (int i = 0; i < 16; ++i) r.part[i / 4][i % 4] = table[static_cast<std::size_t>(index.part[i / 4][i % 4]) & 15];
#endif
  return r;
}

/// Four columns of sixteen rows of four numbers.
struct Columns {
  I16 first, second, third, fourth;
};

#if defined(__x86_64__)
/// Four registers, whose quarters each hold a row of four numbers: columns to rows and rows to columns.
HALFPLANE_LEAF void turn_quarters(I16::Register& a, I16::Register& b, I16::Register& c, I16::Register& d) {
#if HALFPLANE_ISA == 512
#define HALFPLANE_UNPACK(half, a, b, bits) _mm512_unpack##half##_epi##bits((__m512i)(a), (__m512i)(b))
#elif HALFPLANE_ISA == 256
#define HALFPLANE_UNPACK(half, a, b, bits) _mm256_unpack##half##_epi##bits((__m256i)(a), (__m256i)(b))
#else
#define HALFPLANE_UNPACK(half, a, b, bits) _mm_unpack##half##_epi##bits((__m128i)(a), (__m128i)(b))
#endif
  const auto ab_low = HALFPLANE_UNPACK(lo, a, b, 32), ab_high = HALFPLANE_UNPACK(hi, a, b, 32),
             cd_low = HALFPLANE_UNPACK(lo, c, d, 32), cd_high = HALFPLANE_UNPACK(hi, c, d, 32);
  a = (I16::Register)HALFPLANE_UNPACK(lo, ab_low, cd_low, 64);
  b = (I16::Register)HALFPLANE_UNPACK(hi, ab_low, cd_low, 64);
  c = (I16::Register)HALFPLANE_UNPACK(lo, ab_high, cd_high, 64);
  d = (I16::Register)HALFPLANE_UNPACK(hi, ab_high, cd_high, 64);
#undef HALFPLANE_UNPACK
}
#endif

/// Lane i: the row at row_at(i). Cheaper than a gather for each column.
template <class RowAt>
HALFPLANE_LEAF Columns turned_rows(RowAt&& row_at) {
  Columns to;
#if defined(__x86_64__)
  for (int part = 0; part < I16::kParts; ++part) {
    const auto quarter = [&](int i) HALFPLANE_LAMBDA {
      return _mm_loadu_si128(reinterpret_cast<const __m128i*>(row_at(part * I16::kLanes + i)));
    };
    const auto quarters = [&](int i) HALFPLANE_LAMBDA {  // i, i + 4, ...
#if HALFPLANE_ISA == 512
      const __m512i two = _mm512_inserti32x4(_mm512_castsi128_si512(quarter(i)), quarter(i + 4), 1);
      return (I16::Register)_mm512_inserti32x4(_mm512_inserti32x4(two, quarter(i + 8), 2), quarter(i + 12), 3);
#elif HALFPLANE_ISA == 256
      return (I16::Register)_mm256_inserti128_si256(_mm256_castsi128_si256(quarter(i)), quarter(i + 4), 1);
#else
      return (I16::Register)quarter(i);
#endif
    };
    I16::Register a = quarters(0), b = quarters(1), c = quarters(2), d = quarters(3);
    turn_quarters(a, b, c, d);
    to.first.part[part] = a;
    to.second.part[part] = b;
    to.third.part[part] = c;
    to.fourth.part[part] = d;
  }
#else
  const auto column = [&](int at) HALFPLANE_LAMBDA {
    return I16::of([&](int i) HALFPLANE_LAMBDA {
      std::int32_t value;
      std::memcpy(&value, reinterpret_cast<const char*>(row_at(i)) + 4 * at, sizeof value);
      return value;
    });
  };
  to = {column(0), column(1), column(2), column(3)};
#endif
  return to;
}

/// The same for N rows.
template <std::size_t N>
struct ColumnsOfRows {
  Columns row[N];
};

/// The inverse: lane i to the row at row_at(i).
template <class RowAt>
HALFPLANE_LEAF void store_rows(const Columns& from, RowAt&& row_at) {
#if defined(__x86_64__)
  for (int part = 0; part < I16::kParts; ++part) {
    const auto put = [&](int i, const I16::Register& quarters) HALFPLANE_LAMBDA {  // i, i + 4, ...
      const auto store = [&](int at, const __m128i& row) HALFPLANE_LAMBDA {
        _mm_storeu_si128(reinterpret_cast<__m128i*>(row_at(part * I16::kLanes + at)), row);
      };
#if HALFPLANE_ISA == 512
      store(i, _mm512_castsi512_si128((__m512i)quarters));
      store(i + 4, _mm512_extracti32x4_epi32((__m512i)quarters, 1));
      store(i + 8, _mm512_extracti32x4_epi32((__m512i)quarters, 2));
      store(i + 12, _mm512_extracti32x4_epi32((__m512i)quarters, 3));
#elif HALFPLANE_ISA == 256
      store(i, _mm256_castsi256_si128((__m256i)quarters));
      store(i + 4, _mm256_extracti128_si256((__m256i)quarters, 1));
#else
      store(i, (__m128i)quarters);
#endif
    };
    I16::Register a = from.first.part[part], b = from.second.part[part], c = from.third.part[part],
                  d = from.fourth.part[part];
    turn_quarters(a, b, c, d);
    put(0, a);
    put(1, b);
    put(2, c);
    put(3, d);
  }
#else
  for (int i = 0; i < 16; ++i) {
    const auto lane = [i](const I16& of) { return of.part[i / I16::kLanes][i % I16::kLanes]; };
    const std::array<std::int32_t, 4> row{lane(from.first), lane(from.second), lane(from.third), lane(from.fourth)};
    std::memcpy(row_at(i), row.data(), sizeof row);
  }
#endif
}
/// Stores row i at `to` + i * `stride` bytes.
HALFPLANE_LEAF void store_rows(const Columns& from, void* to, std::size_t stride) {
  store_rows(from,
             [=](int i) HALFPLANE_LAMBDA { return static_cast<char*>(to) + static_cast<std::size_t>(i) * stride; });
}

#if HALFPLANE_ISA == 512
/// The lanes whose bits are set, one after the other; any lanes after them.
HALFPLANE_LEAF Columns packed_columns(const Columns& from, std::uint32_t bits) {
  const auto packed = [bits](const I16& v) HALFPLANE_LAMBDA {
    I16 r;
    r.part[0] = (I16::Register)_mm512_maskz_compress_epi32(static_cast<__mmask16>(bits), (__m512i)v.part[0]);
    return r;
  };
  return {packed(from.first), packed(from.second), packed(from.third), packed(from.fourth)};
}
#endif

/// Four columns of sixteen rows of four numbers.
struct DoubleColumns {
  D16 first, second, third, fourth;
};

/// Lane i: the row at row_at(i).
template <class RowAt>
HALFPLANE_LEAF DoubleColumns turned_doubles(RowAt&& row_at) {
  DoubleColumns to;
#if defined(__x86_64__)
  for (int part = 0; part < D16::kParts; ++part) {
    const auto row = [&](int i) HALFPLANE_LAMBDA { return static_cast<const double*>(row_at(part * D16::kLanes + i)); };
#if HALFPLANE_ISA == 512
    const auto rows = [&](int i) HALFPLANE_LAMBDA {  // i and i + 2
      return _mm512_insertf64x4(_mm512_castpd256_pd512(_mm256_loadu_pd(row(i))), _mm256_loadu_pd(row(i + 2)), 1);
    };
    const __m512d a = rows(0), b = rows(1), c = rows(4), d = rows(5);
    const __m512d ab_low = _mm512_unpacklo_pd(a, b), ab_high = _mm512_unpackhi_pd(a, b),
                  cd_low = _mm512_unpacklo_pd(c, d), cd_high = _mm512_unpackhi_pd(c, d);
    to.first.part[part] = (D16::Register)_mm512_shuffle_f64x2(ab_low, cd_low, 0x88);
    to.second.part[part] = (D16::Register)_mm512_shuffle_f64x2(ab_high, cd_high, 0x88);
    to.third.part[part] = (D16::Register)_mm512_shuffle_f64x2(ab_low, cd_low, 0xdd);
    to.fourth.part[part] = (D16::Register)_mm512_shuffle_f64x2(ab_high, cd_high, 0xdd);
#elif HALFPLANE_ISA == 256
    const __m256d a = _mm256_loadu_pd(row(0)), b = _mm256_loadu_pd(row(1)), c = _mm256_loadu_pd(row(2)),
                  d = _mm256_loadu_pd(row(3));
    const __m256d ab_low = _mm256_unpacklo_pd(a, b), ab_high = _mm256_unpackhi_pd(a, b),
                  cd_low = _mm256_unpacklo_pd(c, d), cd_high = _mm256_unpackhi_pd(c, d);
    to.first.part[part] = (D16::Register)_mm256_permute2f128_pd(ab_low, cd_low, 0x20);
    to.second.part[part] = (D16::Register)_mm256_permute2f128_pd(ab_high, cd_high, 0x20);
    to.third.part[part] = (D16::Register)_mm256_permute2f128_pd(ab_low, cd_low, 0x31);
    to.fourth.part[part] = (D16::Register)_mm256_permute2f128_pd(ab_high, cd_high, 0x31);
#else
    const __m128d a = _mm_loadu_pd(row(0)), b = _mm_loadu_pd(row(1)), c = _mm_loadu_pd(row(0) + 2),
                  d = _mm_loadu_pd(row(1) + 2);
    to.first.part[part] = (D16::Register)_mm_unpacklo_pd(a, b);
    to.second.part[part] = (D16::Register)_mm_unpackhi_pd(a, b);
    to.third.part[part] = (D16::Register)_mm_unpacklo_pd(c, d);
    to.fourth.part[part] = (D16::Register)_mm_unpackhi_pd(c, d);
#endif
  }
#else
  const auto column = [&](int at) HALFPLANE_LAMBDA {
    return D16::of([&](int i) HALFPLANE_LAMBDA { return static_cast<const double*>(row_at(i))[at]; });
  };
  to.first = column(0);
  to.second = column(1);
  to.third = column(2);
  to.fourth = column(3);
#endif
  return to;
}

/// Four rows of four pixels of an image.
template <class Element>
HALFPLANE_LEAF I16 load_block(const Element* from, int stride) {
  using Row __attribute__((vector_size(16), aligned(1), may_alias)) = std::int32_t;
  using Four __attribute__((vector_size(16))) = std::int32_t;
  std::array<Four, 4> row;
  for (std::size_t j = 0; j < 4; ++j) row[j] = *reinterpret_cast<const Row*>(from + static_cast<int>(j) * stride);
  I16 r;
#if HALFPLANE_ISA == 128
  for (std::size_t j = 0; j < 4; ++j) r.part[j] = row[j];
#else
  using Eight __attribute__((vector_size(32))) = std::int32_t;
  constexpr auto kEight = std::make_index_sequence<8>{};
  const Eight upper = lanes_from<Eight, 0>(row[0], row[1], kEight),
              lower = lanes_from<Eight, 0>(row[2], row[3], kEight);
#if HALFPLANE_ISA == 512
  r.part[0] = lanes_from<I16::Register, 0>(upper, lower, std::make_index_sequence<16>{});
#else
  r.part[0] = upper;
  r.part[1] = lower;
#endif
#endif
  return r;
}
/// Two blocks, side by side, as four rows of eight pixels.
template <class Element>
HALFPLANE_LEAF void store_blocks(Element* to, int stride, const I16& left, const I16& right) {
#if HALFPLANE_ISA == 512
  using Row __attribute__((vector_size(32), aligned(4), may_alias)) = std::int32_t;
  const auto &a = left.part[0], &b = right.part[0];
  const auto put = [&](int j, const Row& row) HALFPLANE_LAMBDA { *reinterpret_cast<Row*>(to + j * stride) = row; };
  const auto upper = __builtin_shufflevector(a, b, 0, 1, 2, 3, 16, 17, 18, 19, 4, 5, 6, 7, 20, 21, 22, 23);
  const auto lower = __builtin_shufflevector(a, b, 8, 9, 10, 11, 24, 25, 26, 27, 12, 13, 14, 15, 28, 29, 30, 31);
  put(0, __builtin_shufflevector(upper, upper, 0, 1, 2, 3, 4, 5, 6, 7));
  put(1, __builtin_shufflevector(upper, upper, 8, 9, 10, 11, 12, 13, 14, 15));
  put(2, __builtin_shufflevector(lower, lower, 0, 1, 2, 3, 4, 5, 6, 7));
  put(3, __builtin_shufflevector(lower, lower, 8, 9, 10, 11, 12, 13, 14, 15));
#elif HALFPLANE_ISA == 256
  using Row __attribute__((vector_size(32), aligned(4), may_alias)) = std::int32_t;
  const auto put = [&](int j, const Row& row) HALFPLANE_LAMBDA { *reinterpret_cast<Row*>(to + j * stride) = row; };
  for (int part = 0; part < 2; ++part) {
    const auto &a = left.part[part], &b = right.part[part];
    put(2 * part, __builtin_shufflevector(a, b, 0, 1, 2, 3, 8, 9, 10, 11));
    put(2 * part + 1, __builtin_shufflevector(a, b, 4, 5, 6, 7, 12, 13, 14, 15));
  }
#else
  for (std::ptrdiff_t j = 0; j < 4; ++j) {
    std::memcpy(to + j * stride, reinterpret_cast<const char*>(&left) + 16 * j, 16);
    std::memcpy(to + j * stride + 4, reinterpret_cast<const char*>(&right) + 16 * j, 16);
  }
#endif
}

/// The channels of eight texels, 16 bits each: of the lower lanes, or of the upper ones.
template <bool kUpper>
HALFPLANE_LEAF S32 channels_of_eight(const I16& texels) {
  S32 r;
#if HALFPLANE_ISA == 512
  r.part[0] = (S32::Register)_mm512_cvtepu8_epi16(_mm512_extracti64x4_epi64((__m512i)texels.part[0], kUpper ? 1 : 0));
#elif HALFPLANE_ISA == 256
  const auto eight = (__m256i)texels.part[kUpper ? 1 : 0];
  r.part[0] = (S32::Register)_mm256_cvtepu8_epi16(_mm256_castsi256_si128(eight));
  r.part[1] = (S32::Register)_mm256_cvtepu8_epi16(_mm256_extracti128_si256(eight, 1));
#else
  for (int i = 0; i < 32; ++i) {
    const auto texel = static_cast<std::uint32_t>(texels.part[(kUpper ? 2 : 0) + i / 16][i / 4 % 4]);
    r.part[i / 8][i % 8] = static_cast<std::int16_t>(texel >> 8 * (i % 4) & 255);
  }
#endif
  return r;
}

/// The inverse, for channels below 256: four rows of eight texels to two blocks, one after the other.
HALFPLANE_LEAF void store_rows_as_blocks(const S32& a, const S32& b, const S32& c, const S32& d, std::uint32_t* to) {
#if HALFPLANE_ISA == 512
  const auto two = [](const S32& p, const S32& q)  // by two texels: p 0, q 0, p 1, q 1, ...
      HALFPLANE_LAMBDA { return _mm512_packus_epi16((__m512i)p.part[0], (__m512i)q.part[0]); };
  const __m512i upper = two(a, b), lower = two(c, d);
  _mm512_storeu_si512(to, _mm512_permutex2var_epi64(upper, _mm512_setr_epi64(0, 2, 1, 3, 8, 10, 9, 11), lower));
  _mm512_storeu_si512(to + kBlockPixels,
                      _mm512_permutex2var_epi64(upper, _mm512_setr_epi64(4, 6, 5, 7, 12, 14, 13, 15), lower));
#elif HALFPLANE_ISA == 256
  for (int side = 0; side < 2; ++side) {
    const auto two = [&](const S32& p, const S32& q) HALFPLANE_LAMBDA {
      return _mm256_permute4x64_epi64(_mm256_packus_epi16((__m256i)p.part[side], (__m256i)q.part[side]), 0xd8);
    };
    auto* const block = reinterpret_cast<__m256i*>(to + side * kBlockPixels);
    _mm256_storeu_si256(block, two(a, b));
    _mm256_storeu_si256(block + 1, two(c, d));
  }
#else
  const auto store = [](const S32& row, std::uint32_t* at) {
    for (int i = 0; i < 8; ++i) {
      std::uint32_t texel = 0;
      for (int k = 3; k >= 0; --k) texel = texel << 8 | static_cast<std::uint16_t>(row.part[i / 2][i % 2 * 4 + k]);
      at[i / 4 * kBlockPixels + i % 4] = texel;
    }
  };
  store(a, to);
  store(b, to + 4);
  store(c, to + 8);
  store(d, to + 12);
#endif
}

/// Sixteen pixels past the caches to the beginning of a cache line: a line that is written whole need not be read
/// first. Call finish_lines() after the last.
template <class Element>
HALFPLANE_LEAF void stream_line(Element* to, const I16& row) {
#if HALFPLANE_ISA == 512
  _mm512_stream_si512(reinterpret_cast<__m512i*>(to), (__m512i)row.part[0]);
#elif HALFPLANE_ISA == 256
  _mm256_stream_si256(reinterpret_cast<__m256i*>(to), (__m256i)row.part[0]);
  _mm256_stream_si256(reinterpret_cast<__m256i*>(to) + 1, (__m256i)row.part[1]);
#elif defined(__x86_64__)
  for (int i = 0; i < 4; ++i) _mm_stream_si128(reinterpret_cast<__m128i*>(to) + i, (__m128i)row.part[i]);
#else
  row.store(to);
#endif
}

HALFPLANE_LEAF void finish_lines() {
#if defined(__x86_64__)
  _mm_sfence();
#endif
}

}  // namespace
}  // namespace halfplane::functional::HALFPLANE_ISA_NAME
