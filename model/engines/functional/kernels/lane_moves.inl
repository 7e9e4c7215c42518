// Lanes to bits, to one number, to memory and back.
// One room of the kernels, compiled once for each instruction set: see ../kernels.inl.

/// One bit for each lane whose sign bit is set.
HALFPLANE_INLINE std::uint32_t bits_of(const I16& mask) {
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

/// One bit for each lane's value, 0...63, of the lanes whose bit is set in `lanes`.
HALFPLANE_INLINE std::uint64_t or_of_bits(const I16& values, std::uint32_t lanes) {
#if HALFPLANE_ISA == 512
  const __m512i one = _mm512_set1_epi64(1), v = (__m512i)values.part[0];
  const __m512i low =
      _mm512_maskz_sllv_epi64(static_cast<__mmask8>(lanes), one, _mm512_cvtepi32_epi64(_mm512_castsi512_si256(v)));
  const __m512i high = _mm512_maskz_sllv_epi64(static_cast<__mmask8>(lanes >> 8), one,
                                               _mm512_cvtepi32_epi64(_mm512_extracti64x4_epi64(v, 1)));
  return static_cast<std::uint64_t>(_mm512_reduce_or_epi64(_mm512_or_si512(low, high)));
#elif HALFPLANE_ISA == 256
  const L16 is_in =
      (L16::of([](int i) HALFPLANE_LAMBDA { return std::int64_t{1} << i; }) & static_cast<std::int64_t>(lanes)) != 0;
  const L16 bits = (L16(1) << convert<std::int64_t>(values)) & is_in;
  const L16::Register all = (bits.part[0] | bits.part[1]) | (bits.part[2] | bits.part[3]);
  return static_cast<std::uint64_t>(all[0] | all[1] | all[2] | all[3]);
#else
  std::uint64_t bits = 0;
  for (int i = 0; i < 16; ++i)
    bits |= static_cast<std::uint64_t>(lanes >> i & 1) << (values.part[i / I16::kLanes][i % I16::kLanes] & 63);
  return bits;
#endif
}

HALFPLANE_INLINE bool is_any(const I16& mask) { return bits_of(mask) != 0; }

/// One bit for each of 64 lanes whose sign bit is set.
HALFPLANE_INLINE std::uint64_t bits_of(const S64& mask) {
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

/// The other way round: a mask.
HALFPLANE_INLINE S64 lanes_of(std::uint64_t bits) {
  S64 r;
#if HALFPLANE_ISA == 512
  for (int i = 0; i < 2; ++i) r.part[i] = (S64::Register)_mm512_movm_epi16(static_cast<__mmask32>(bits >> 32 * i));
#else
  constexpr int kLanes = S64::kLanes;
  S64::Register bit;
  for (int i = 0; i < kLanes; ++i) bit[i] = static_cast<std::int16_t>(1U << i);
  for (int i = 0; i < S64::kParts; ++i)
    r.part[i] = ((S64::Register{} + static_cast<std::int16_t>(bits >> kLanes * i)) & bit) == bit;
#endif
  return r;
}

/// One bit for each lane with a >= b.
HALFPLANE_INLINE std::uint64_t bits_at_least(const U64& a, const U64& b) {
#if HALFPLANE_ISA == 512
  return _mm512_cmpge_epu16_mask((__m512i)a.part[0], (__m512i)b.part[0]) |
         std::uint64_t{_mm512_cmpge_epu16_mask((__m512i)a.part[1], (__m512i)b.part[1])} << 32;
#else
  return bits_of(max(a, b) == a);
#endif
}

/// One bit for each lane with a == b.
HALFPLANE_INLINE std::uint64_t bits_equal(const U64& a, const U64& b) {
#if HALFPLANE_ISA == 512
  return _mm512_cmpeq_epu16_mask((__m512i)a.part[0], (__m512i)b.part[0]) |
         std::uint64_t{_mm512_cmpeq_epu16_mask((__m512i)a.part[1], (__m512i)b.part[1])} << 32;
#else
  return bits_of(a == b);
#endif
}

/// a in the lanes whose bit is set, b elsewhere. `to_sign`: 31 - lane.
HALFPLANE_INLINE I16 select_by_bits(std::uint32_t bits, const I16& a, const I16& b,
                                    [[maybe_unused]] const I16& to_sign) {
#if HALFPLANE_ISA == 512
  I16 r;
  r.part[0] =
      (I16::Register)_mm512_mask_mov_epi32((__m512i)b.part[0], static_cast<__mmask16>(bits), (__m512i)a.part[0]);
  return r;
#else
  return select_by_sign(I16(static_cast<std::int32_t>(bits)) << to_sign, a, b);
#endif
}

/// 32 bits from base + 4 index, lane by lane.
HALFPLANE_INLINE I16 gather(const void* base, const I16& index) {
  I16 r;
#if HALFPLANE_ISA == 512
  r.part[0] = (I16::Register)_mm512_i32gather_epi32((__m512i)index.part[0], base, 4);
#elif HALFPLANE_ISA == 256
  for (int i = 0; i < 2; ++i)
    r.part[i] = (I16::Register)_mm256_i32gather_epi32(static_cast<const int*>(base), (__m256i)index.part[i], 4);
#else
  for (int i = 0; i < 16; ++i)
    std::memcpy(reinterpret_cast<char*>(&r) + 4 * i,
                static_cast<const char*>(base) + std::ptrdiff_t{index.part[i / 4][i % 4]} * 4, 4);
#endif
  return r;
}

/// One number in the lower eight lanes, another in the upper.
HALFPLANE_INLINE I16 halves(std::int32_t low, std::int32_t high) {
  I16 r;
#if HALFPLANE_ISA == 512
  r.part[0] = (I16::Register)_mm512_inserti64x4(_mm512_set1_epi32(low), _mm256_set1_epi32(high), 1);
#else
  for (int i = 0; i < I16::kParts; ++i) r.part[i] = I16::Register{} + (2 * i < I16::kParts ? low : high);
#endif
  return r;
}

/// The smallest lane.
HALFPLANE_INLINE std::int32_t min_lane(const I16& v) {
#if HALFPLANE_ISA == 512
  return _mm512_reduce_min_epi32((__m512i)v.part[0]);
#else
  // Half against half, down to one lane.
  typedef std::int32_t Four __attribute__((vector_size(16)));
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
HALFPLANE_INLINE std::int32_t max_lane(const I16& v) { return ~min_lane(~v); }

HALFPLANE_INLINE std::uint32_t min_lane(const U64& v) {
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
HALFPLANE_INLINE std::uint32_t max_lane(const U64& v) { return 0xffff - min_lane(~v); }

/// Sixteen numbers below 2^16 from and to memory.
HALFPLANE_INLINE I16 load_narrow(const std::uint16_t* from) {
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
HALFPLANE_INLINE void store_narrow(const I16& value, std::uint16_t* to) {
#if HALFPLANE_ISA == 512
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), _mm512_cvtepi32_epi16((__m512i)value.part[0]));
#elif HALFPLANE_ISA == 256
  const __m256i both = _mm256_packus_epi32((__m256i)value.part[0], (__m256i)value.part[1]);
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), _mm256_permute4x64_epi64(both, 0xd8));
#else
  for (int i = 0; i < 16; ++i) to[i] = static_cast<std::uint16_t>(value.part[i / 4][i % 4]);
#endif
}

/// Four columns of sixteen rows of four numbers.
struct Columns {
  I16 first, second, third, fourth;
};

#if defined(__x86_64__)
/// Four registers, of which each quarter holds a row of four numbers: columns to rows and rows to columns.
HALFPLANE_INLINE void turn_quarters(I16::Register& a, I16::Register& b, I16::Register& c, I16::Register& d) {
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
HALFPLANE_INLINE Columns turned_rows(RowAt&& row_at) {
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

/// The other way round: lane i to the row at `to` + i * `stride` bytes.
HALFPLANE_INLINE void store_rows(const Columns& from, void* to, std::size_t stride) {
  const auto row_at = [=](int i)
                          HALFPLANE_LAMBDA { return static_cast<char*>(to) + static_cast<std::size_t>(i) * stride; };
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

/// Four rows of four pixels of an image.
template <class Element>
HALFPLANE_INLINE I16 load_block(const Element* from, int stride) {
  typedef std::int32_t Row __attribute__((vector_size(16), aligned(1), may_alias));
  typedef std::int32_t Four __attribute__((vector_size(16)));
  std::array<Four, 4> row;
  for (std::size_t j = 0; j < 4; ++j) row[j] = *reinterpret_cast<const Row*>(from + static_cast<int>(j) * stride);
  I16 r;
#if HALFPLANE_ISA == 128
  for (std::size_t j = 0; j < 4; ++j) r.part[j] = row[j];
#else
  typedef std::int32_t Eight __attribute__((vector_size(32)));
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
HALFPLANE_INLINE void store_blocks(Element* to, int stride, const I16& left, const I16& right) {
#if HALFPLANE_ISA == 512
  typedef std::int32_t Row __attribute__((vector_size(32), aligned(4), may_alias));
  const auto &a = left.part[0], &b = right.part[0];
  const auto put = [&](int j, const Row& row) HALFPLANE_LAMBDA { *reinterpret_cast<Row*>(to + j * stride) = row; };
  const auto upper = __builtin_shufflevector(a, b, 0, 1, 2, 3, 16, 17, 18, 19, 4, 5, 6, 7, 20, 21, 22, 23);
  const auto lower = __builtin_shufflevector(a, b, 8, 9, 10, 11, 24, 25, 26, 27, 12, 13, 14, 15, 28, 29, 30, 31);
  put(0, __builtin_shufflevector(upper, upper, 0, 1, 2, 3, 4, 5, 6, 7));
  put(1, __builtin_shufflevector(upper, upper, 8, 9, 10, 11, 12, 13, 14, 15));
  put(2, __builtin_shufflevector(lower, lower, 0, 1, 2, 3, 4, 5, 6, 7));
  put(3, __builtin_shufflevector(lower, lower, 8, 9, 10, 11, 12, 13, 14, 15));
#elif HALFPLANE_ISA == 256
  typedef std::int32_t Row __attribute__((vector_size(32), aligned(4), may_alias));
  const auto put = [&](int j, const Row& row) HALFPLANE_LAMBDA { *reinterpret_cast<Row*>(to + j * stride) = row; };
  for (int part = 0; part < 2; ++part) {
    const auto &a = left.part[part], &b = right.part[part];
    put(2 * part, __builtin_shufflevector(a, b, 0, 1, 2, 3, 8, 9, 10, 11));
    put(2 * part + 1, __builtin_shufflevector(a, b, 4, 5, 6, 7, 12, 13, 14, 15));
  }
#else
  for (int j = 0; j < 4; ++j) {
    std::memcpy(to + j * stride, reinterpret_cast<const char*>(&left) + 16 * j, 16);
    std::memcpy(to + j * stride + 4, reinterpret_cast<const char*>(&right) + 16 * j, 16);
  }
#endif
}

/// Sixteen pixels past the caches to the beginning of a cache line: what is written whole need not be read first.
/// Behind the last: finish_lines().
template <class Element>
HALFPLANE_INLINE void stream_line(Element* to, const I16& row) {
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

HALFPLANE_INLINE void finish_lines() {
#if defined(__x86_64__)
  _mm_sfence();
#endif
}
