// Viewport and cull, lanes at a time: the bits of stages/viewport and stages/cull for what needs no clipping. What does,
// and what may not be drawn at all, goes the slow way: through the host side's own function, which knows the messages.
// Included inside the namespace of an instruction set: see kernels.inl.

/// floor(value * scale + 1/2) as snap() has it. |value * scale| < 2^31.
HALFPLANE_INLINE I16 snap_lanes(const D16& value, double scale) {
  const D16 scaled = value * scale;
  const I16 truncated = convert<std::int32_t>(scaled);
  const D16 toward_zero = convert<double>(truncated);
  const L16 is_above = toward_zero > scaled;  // truncation went up
  const D16 fraction = scaled - toward_zero;  // exact; in (-1, 1)
  // floor is truncated - 1 where it went up; there the fraction is 1 more.
  const L16 is_up = select(is_above, fraction + 1.0, fraction) >= 0.5;
  return truncated + convert<std::int32_t>(is_above - is_up);
}

/// Sixteen vertices of the scene, attribute by attribute.
struct VertexLanes {
  D16 x, y, z, w;
  I16 rgba;
};

/// What the vertices of a slice are projected with.
struct Projection {
  bool is_clip_space;
  Viewport viewport;
  double near_z, near_w;         ///< distance to near: near_z z + near_w w
  std::array<double, 4> band_w;  ///< the guard band's planes: left, right, top, bottom
  double half_width, half_height;
  bool is_zero_one;
  double range_from, range_by;
  double offset_x, offset_y, scale_y;  ///< of window space
  double grid, codes;                  ///< subpixels in a pixel; largest depth code
  int coordinate_shift;
  double reach;        ///< pixels
  std::int32_t limit;  ///< subpixels

  Projection(const DrawContext& context, const Widths& widths) {
    const State& state = context.state;
    const Config& config = context.config;
    is_clip_space = state.space == Space::clip;
    viewport = context.viewport;
    near_z = context.guard_band[0].c;
    near_w = context.guard_band[0].d;
    for (std::size_t i = 0; i < 4; ++i) band_w[i] = context.guard_band[2 + i].d;
    half_width = context.guard_band[2].a;
    half_height = context.guard_band[5].b;
    is_zero_one = state.clip_z == ClipZ::zero_one;
    range_from = state.depth_range[0];
    range_by = state.depth_range[1] - state.depth_range[0];
    offset_x = offset_y = state.pixel_center == PixelCenter::integer ? 0.5 : 0.0;
    scale_y = state.origin == Origin::bottom_left ? -1 : 1;
    grid = static_cast<double>(std::int64_t{1} << config.subpixel_bits);
    codes = static_cast<double>((std::int64_t{1} << config.depth_bits) - 1);
    coordinate_shift = widths.grid_bits - config.subpixel_bits;
    reach = 2.0 * config.guard_band;
    limit = static_cast<std::int32_t>(config.guard_band << widths.grid_bits);
  }
};

/// Codes of clip-space vertices: which planes of the view volume they lie outside of, and whether they need the clipper.
HALFPLANE_INLINE I16 clip_codes(const VertexLanes& v, const Projection& p) {
  const auto is_inside = [](const D16& distance) HALFPLANE_LAMBDA { return convert<std::int32_t>(distance >= 0.0); };
  const auto bit = [](const I16& inside, int code) HALFPLANE_LAMBDA { return ~inside & code; };
  const I16 near = is_inside(v.z * p.near_z + v.w * p.near_w), far = is_inside(-v.z + v.w);
  const I16 volume = bit(near, 1) | bit(far, 2) | bit(is_inside(v.x + v.w), 4) | bit(is_inside(-v.x + v.w), 8) |
                     bit(is_inside(-v.y + v.w), 16) | bit(is_inside(v.y + v.w), 32);
  const D16 by_x = v.x * p.half_width, by_y = v.y * p.half_height;
  const L16 in_band = (by_x + v.w * p.band_w[0] >= 0.0) & (-by_x + v.w * p.band_w[1] >= 0.0) &
                      (-by_y + v.w * p.band_w[2] >= 0.0) & (by_y + v.w * p.band_w[3] >= 0.0) & (v.w > 0.0);
  // Inside all planes and with w at most this, every coordinate is.
  const L16 is_small = (v.w <= 1e300) & (max(max(v.x, -v.x), max(v.y, -v.y)) <= 1e300) & (max(v.z, -v.z) <= 1e300);
  return volume | bit(near & far & convert<std::int32_t>(in_band & is_small), Slice::kSlow);
}

/// Projects and snaps sixteen vertices; returns their codes.
HALFPLANE_INLINE I16 project_lanes(const VertexLanes& v, const Projection& p, int target_height, SnappedVertex* out) {
  D16 x, y, z;
  I16 codes(0);
  if (p.is_clip_space) {
    codes = clip_codes(v, p);
    const L16 is_fine = convert<std::int64_t>(codes < static_cast<int>(Slice::kSlow));
    const D16 w = select(is_fine, v.w, D16(1.0));  // what is not is not used
    const D16 nx = v.x / w, ny = v.y / w, nz = v.z / w;
    const D16 depth = p.is_zero_one ? nz : (nz + 1.0) * 0.5;  // halves are exact
    x = p.viewport.x + (nx + 1.0) * 0.5 * p.viewport.width;
    y = p.viewport.y + (1.0 - ny) * 0.5 * p.viewport.height;
    z = p.range_from + p.range_by * min(max(depth, D16(0.0)), D16(1.0));
  } else {
    x = v.x + p.offset_x;
    y = v.y + p.offset_y;
    if (p.scale_y < 0) y = static_cast<double>(target_height) - y;
    z = v.z;
  }
  // Coarse: what is beyond does not fit the conversions.
  const L16 fits = (max(x, -x) <= p.reach) & (max(y, -y) <= p.reach) & (z >= -1.0) & (z <= 2.0);
  x = select(fits, x, D16(0.0));
  y = select(fits, y, D16(0.0));
  z = select(fits, z, D16(0.0));
  const I16 sx = snap_lanes(x, p.grid) << p.coordinate_shift, sy = snap_lanes(y, p.grid) << p.coordinate_shift;
  const I16 sz = snap_lanes(z, p.codes);
  const I16 is_legal = (sx >= -p.limit) & (sx < p.limit) & (sy >= -p.limit) & (sy < p.limit) & (sz >= 0) &
                       (sz <= static_cast<std::int32_t>(p.codes)) & convert<std::int32_t>(fits);
  store_rows({sx, sy, sz, v.rgba}, out, sizeof *out);
  return codes | (~is_legal & static_cast<int>(Slice::kSlow));
}

/// Slice::vertices, codes and any_code; both vectors are large enough for sixteen more than there are vertices.
static void project(const FrameContext& frame, Slice& slice) {
  static_assert(sizeof(SnappedVertex) == 16);
  const DrawContext& context = *slice.context;
  const PreparedScene& from = frame.prepared;
  const Projection projection(context, frame.widths);
  I16 any(0);
  const auto put = [&](const VertexLanes& lanes, std::size_t to) HALFPLANE_LAMBDA {
    const I16 codes = project_lanes(lanes, projection, context.scene.height, slice.vertices.data() + to);
    codes.store(slice.codes.data() + to);
    any |= codes;
  };
  if (!slice.is_wide) {
    for (std::size_t i = slice.low_index, to = 0; i <= slice.high_index; i += 16, to += 16)
      put({D16::load(&from.x[i]), D16::load(&from.y[i]), D16::load(&from.z[i]), D16::load(&from.w[i]),
           I16::load(&from.rgba[i])},
          to);
  } else {
    std::size_t to = 0;
    for (const Slice::Part& part : slice.parts)
      for (std::size_t corner = 0; corner < 3 * part.count; corner += 16) {
        std::array<std::size_t, 16> at;
        for (std::size_t k = 0; k < 16; ++k) {
          const std::size_t c = std::min(corner + k, 3 * part.count - 1);
          at[k] = from.index[c % 3][part.first + c / 3];
        }
        const auto attribute = [&at](const std::vector<double>& values) HALFPLANE_LAMBDA {
          return D16::of([&](int k) HALFPLANE_LAMBDA { return values[at[static_cast<std::size_t>(k)]]; });
        };
        put({attribute(from.x), attribute(from.y), attribute(from.z), attribute(from.w),
             I16::of([&](int k) HALFPLANE_LAMBDA {
               return static_cast<std::int32_t>(from.rgba[at[static_cast<std::size_t>(k)]]);
             })},
            to + corner);
        if (corner + 16 >= 3 * part.count) to += 3 * part.count;
      }
  }
  slice.any_code = 0;
  for (std::uint32_t bit = 1; bit <= Slice::kSlow; bit <<= 1)
    slice.any_code |= is_any((any & static_cast<int>(bit)) != 0) ? bit : 0;
}

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
    v[k] = slice.is_wide
               ? lane * 3 + static_cast<std::int32_t>(3 * number + k)
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
    const std::uint32_t whole = bits_of((t.left > limit.left) & (t.top > limit.top) & (t.right < limit.right) &
                                        (t.bottom < limit.bottom));
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
                ((few.samples & is_small & ~is_dropped) << Record::kSamplesShift) |
                    (is_whole & Record::kWhole) | (is_small & Record::kSmall) |
                    (is_medium & Record::kMedium) |
                    (is_dropped & Record::kDrawsNothing)},
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
