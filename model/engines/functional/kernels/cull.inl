/// Sixteen snapped vertices.
struct SnappedLanes {
  I16 x, y, z, rgba;
};

/// Those that `index` names.
HALFPLANE_INLINE SnappedLanes load_vertices(const SnappedVertex* vertices, const std::int32_t* index) {
  static_assert(sizeof(SnappedVertex) == 16);
  const auto [x, y, z, rgba] = turned_rows([&](int i) HALFPLANE_LAMBDA { return vertices + index[i]; });
  return {x, y, z, rgba};
}

/// Sixteen triangles while they are culled.
struct TriangleLanes {
  std::array<I16, 3> v, x, y, z;
  I16 left, top, right, bottom;
};

/// Differences of coordinates over a triangle.
HALFPLANE_INLINE I16 extent(const std::array<I16, 3>& c) {
  return max(max(c[0], c[1]), c[2]) - min(min(c[0], c[1]), c[2]);
}

/// What triangles of at most two by two pixel centres cover of them.
struct SampleLanes {
  I16 is_known;  ///< for which triangles; the others are left at 0
  I16 samples;   ///< bits: upper left, upper right, lower left, lower right
};

HALFPLANE_INLINE SampleLanes covered_samples(const TriangleLanes& t, const I16& is_turned, int grid_bits) {
  const I16 is_wide = t.right > t.left, is_high = t.bottom > t.top;
  // By its own extent, not by what the scissor leaves of it: the products below must fit.
  const I16 is_small = (t.right - t.left <= 1) & (t.bottom - t.top <= 1) & (extent(t.x) < 4 << grid_bits) &
                       (extent(t.y) < 4 << grid_bits);
  if (!is_any(is_small)) return {I16(0), I16(0)};
  const int half = 1 << (grid_bits - 1);
  const I16 px = (t.left << grid_bits) + half, py = (t.top << grid_bits) + half;
  std::array<I16, 4> outside{I16(0), I16(0), I16(0), I16(0)};  // negative where the sample is outside one edge
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    I16 dx = t.x[j] - t.x[i], dy = t.y[j] - t.y[i];
    I16 e = dx * (py - t.y[i]) - dy * (px - t.x[i]);
    dx = (dx ^ is_turned) - is_turned;
    dy = (dy ^ is_turned) - is_turned;
    e = (e ^ is_turned) - is_turned;
    e += ~((dy < 0) | ((dy == 0) & (dx > 0)));  // -1 unless it is a top or left edge
    const I16 right = e - (dy << grid_bits), down = dx << grid_bits;
    outside[0] |= e;
    outside[1] |= right;
    outside[2] |= e + down;
    outside[3] |= right + down;
  }
  const auto bit = [](const I16& is_outside, int at) HALFPLANE_LAMBDA { return ~(is_outside >> 31) & (1 << at); };
  const I16 covered = bit(outside[0], 0) | (bit(outside[1], 1) & is_wide) | (bit(outside[2], 2) & is_high) |
                      (bit(outside[3], 3) & is_wide & is_high);
  return {is_small, is_small & covered};
}

/// The corners of `count` or sixteen primitives from `first` on, as indices into Slice::vertices. `number`: of the
/// first, in the slice. What lies beyond `count` is not looked at, but must be there.
HALFPLANE_INLINE std::array<I16, 3> corner_lanes(const FrameContext& frame, const Slice& slice, std::size_t first,
                                                 std::size_t count, std::size_t number) {
  const I16 lane = I16::of([](int i) { return i; });
  std::array<I16, 3> v;
  for (std::size_t k = 0; k < 3; ++k) {
    v[k] = slice.is_wide ? lane * 3 + static_cast<std::int32_t>(3 * number + k)
                         : I16::load(&frame.prepared.index[k][first]) - static_cast<std::int32_t>(slice.low_index);
    if (count < 16) v[k] = select(lane < static_cast<std::int32_t>(count), v[k], I16(0));
  }
  return v;
}

/// What the lanes of SmallBatch hold.
struct LaneLimits {
  int tiles;                   ///< along the side of a triangle's box, below
  std::int32_t extent, range;  ///< subpixels, depth codes, below

  LaneLimits(int tiles_, int pixel_bits, const Widths& widths) : tiles(tiles_) {
    const int bits = extent_bits(pixel_bits, widths);
    extent = 1 << bits;
    // Numerators: two products of a difference of codes and one of coordinates; times the reciprocal below 2^62.
    range = std::int32_t{1} << std::clamp(61 - bits - widths.reciprocal.bits, 0, 30);
  }
};

/// Turns 16 triangles into records; what must go the slow way goes it in its turn.
struct CullLanes {
  const FrameContext& frame;
  Slice& slice;
  SlowPath slow;
  PixelBounds limit;
  Cull mode;
  bool is_front_cw;
  LaneLimits small, medium;

  /// The triangles of `part` from `first` on, `count` or sixteen of them. `number`: of the first, in the slice.
  HALFPLANE_INLINE void operator()(const Slice::Part& part, std::size_t first, std::size_t count, std::size_t number) {
    const int grid_bits = frame.widths.grid_bits, half = 1 << (grid_bits - 1);
    const Skip& skip = frame.skip;
    Counters& counters = slice.counters;
    TriangleLanes t;
    t.v = corner_lanes(frame, slice, part.first + first, count, number);
    const std::uint32_t lanes = (1U << count) - 1;
    std::uint32_t slow_bits = 0, frustum_bits = 0;
    if (slice.any_code != 0) {
      const I16 a = gather(slice.codes.data(), t.v[0]), b = gather(slice.codes.data(), t.v[1]),
                c = gather(slice.codes.data(), t.v[2]);
      slow_bits = bits_of(((a | b | c) & static_cast<int>(Slice::kSlow)) != 0) & lanes;
      if (skip.frustum)
        frustum_bits = bits_of((a & b & c & static_cast<int>(Slice::kVolume)) != 0) & lanes & ~slow_bits;
    }
    for (std::size_t k = 0; k < 3; ++k) {
      std::array<std::int32_t, 16> at;
      t.v[k].store(at.data());
      const SnappedLanes corner = load_vertices(slice.vertices.data(), at.data());
      t.x[k] = corner.x;
      t.y[k] = corner.y;
      t.z[k] = corner.z;
    }
    t.left = max(I16(limit.left), (min(min(t.x[0], t.x[1]), t.x[2]) + (half - 1)) >> grid_bits);
    t.top = max(I16(limit.top), (min(min(t.y[0], t.y[1]), t.y[2]) + (half - 1)) >> grid_bits);
    t.right = min(I16(limit.right), (max(max(t.x[0], t.x[1]), t.x[2]) - half) >> grid_bits);
    t.bottom = min(I16(limit.bottom), (max(max(t.y[0], t.y[1]), t.y[2]) - half) >> grid_bits);
    // Twice the area: products of differences of 23 bits, exact in binary64.
    const I16 ax = t.x[1] - t.x[0], ay = t.y[1] - t.y[0], bx = t.x[2] - t.x[0], by = t.y[2] - t.y[0];
    const D16 area = convert<double>(ax) * convert<double>(by) - convert<double>(ay) * convert<double>(bx);
    const I16 is_turned = convert<std::int32_t>(area < 0.0);
    const std::uint32_t zero_bits = bits_of(convert<std::int32_t>(area == 0.0)) & lanes;
    const std::uint32_t turned_bits = bits_of(is_turned);
    const std::uint32_t front_bits = is_front_cw ? ~turned_bits : turned_bits;
    const std::uint32_t live = lanes & ~slow_bits & ~frustum_bits & ~zero_bits;
    const std::uint32_t culled_bits = mode == Cull::none    ? 0
                                      : mode == Cull::both  ? live
                                      : mode == Cull::front ? live & front_bits
                                                            : live & ~front_bits;
    const std::uint32_t empty_bits = bits_of((t.left > t.right) | (t.top > t.bottom)) & live & ~culled_bits;
    const std::uint32_t drawn = live & ~culled_bits & ~empty_bits;
    SampleLanes few{I16(0), I16(0)};
    if (skip.no_sample && drawn != 0) few = covered_samples(t, is_turned, grid_bits);
    const std::uint32_t sampleless = bits_of(few.is_known & (few.samples == 0)) & drawn;
    const auto count_of = [](std::uint32_t bits)
                              HALFPLANE_LAMBDA { return static_cast<unsigned>(std::popcount(bits)); };
    const std::uint32_t zero = zero_bits & ~slow_bits & ~frustum_bits;
    counters.primitives_in += count_of(lanes & ~slow_bits);
    counters.culled += count_of(frustum_bits | zero | culled_bits | empty_bits);
    counters.drawn += count_of(drawn);
    counters.skipped.frustum += count_of(frustum_bits);
    counters.skipped.zero_area += count_of(zero);
    counters.skipped.backface += count_of(culled_bits);
    counters.skipped.empty += skip.empty ? count_of(empty_bits) : 0;
    counters.skipped.no_sample += count_of(sampleless);
    // Culled, but nobody may leave it out: it is taken along as far as there is a pixel to look at.
    const std::uint32_t dropped = ((skip.zero_area ? 0 : zero) | (skip.backface ? 0 : culled_bits)) &
                                  ~bits_of((t.left > t.right) | (t.top > t.bottom));
    const std::uint32_t kept = (drawn & ~sampleless) | dropped;
    const I16 z_low = min(min(t.z[0], t.z[1]), t.z[2]), z_high = max(max(t.z[0], t.z[1]), t.z[2]);
    const std::uint32_t whole =
        bits_of((t.left > limit.left) & (t.top > limit.top) & (t.right < limit.right) & (t.bottom < limit.bottom));
    const I16 columns = (t.right >> kTileShift) - (t.left >> kTileShift),
              rows = (t.bottom >> kTileShift) - (t.top >> kTileShift), tiles = max(columns, rows);
    const I16 size = max(extent(t.x), extent(t.y)), range = z_high - z_low;
    const auto fits = [&](const LaneLimits& limits) HALFPLANE_LAMBDA {
      return (tiles < limits.tiles) & (size < limits.extent) & (range < limits.range);
    };
    const auto bits_to_lanes = [](std::uint32_t bits) HALFPLANE_LAMBDA {
      return (I16(static_cast<std::int32_t>(bits)) & I16::of([](int i) { return 1 << i; })) != 0;
    };
    const I16 is_whole = bits_to_lanes(whole), is_dropped = bits_to_lanes(dropped);
    const I16 is_small = is_whole & fits(small), is_medium = is_small | (is_whole & fits(medium));
    alignas(64) std::array<Record, 16> lane;
    std::int32_t* const words = reinterpret_cast<std::int32_t*>(lane.data());
    static_assert(static_cast<int>(RecordKind::triangle) == 0);
    store_rows({t.v[0], t.v[1], t.v[2], z_low}, words, sizeof(Record));
    store_rows({z_high, pairs(t.left, t.top), pairs(t.right, t.bottom),
                ((few.samples & is_small & ~is_dropped) << Record::kSamplesShift) | (is_whole & Record::kWhole) |
                    (is_small & Record::kSmall) | (is_medium & Record::kMedium) | (is_dropped & Record::kDrawsNothing)},
               words + 4, sizeof(Record));
    Record* out = slice.records.data() + slice.record_count;
    for (std::uint32_t rest = kept | slow_bits; rest != 0; rest &= rest - 1) {
      const int i = std::countr_zero(rest);
      if ((slow_bits >> i & 1) != 0) {
        slice.record_count = static_cast<std::size_t>(out - slice.records.data());
        slow(frame, slice, part, first + static_cast<std::size_t>(i));
        out = slice.records.data() + slice.record_count;
        continue;
      }
      *out++ = lane[static_cast<std::size_t>(i)];
    }
    slice.record_count = static_cast<std::size_t>(out - slice.records.data());
  }
};

/// Slice::records of a slice of triangles; they are as many as the triangles, or more where the slow path cuts.
static void cull(const FrameContext& frame, Slice& slice, SlowPath slow) {
  const DrawContext& context = *slice.context;
  const Rect& rect = context.rect;
  CullLanes lanes{frame,
                  slice,
                  slow,
                  {rect.x, rect.y, rect.x + rect.width - 1, rect.y + rect.height - 1},
                  context.state.cull,
                  context.state.front == FrontFace::cw,
                  {kSmallTiles, kSmallPixelBits, frame.widths},
                  {kMediumTiles, kMediumPixelBits, frame.widths}};
  std::size_t number = 0;
  for (const Slice::Part& part : slice.parts)
    for (std::size_t first = 0; first < part.count; first += 16) {
      const std::size_t count = std::min<std::size_t>(16, part.count - first);
      lanes(part, first, count, number);
      number += count;
    }
}
