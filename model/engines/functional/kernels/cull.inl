// Culls triangles, sixteen at a time, and makes records of the others.
#pragma once

#include "lane_memory.inl"
#include "leaf.inl"

namespace halfplane::functional::HALFPLANE_ISA_NAME {
namespace {

/// Sixteen snapped vertices.
struct SnappedLanes {
  I16 x, y, z, rgba;

  HALFPLANE_INLINE SnappedLanes(const I16& x_, const I16& y_, const I16& z_, const I16& rgba_)
      : x(x_), y(y_), z(z_), rgba(rgba_) {}
  HALFPLANE_INLINE SnappedLanes(const SnappedLanes& v) : SnappedLanes(v.x, v.y, v.z, v.rgba) {}
};

/// Lane i: the vertex at row_at(i).
template <class RowAt>
HALFPLANE_INLINE SnappedLanes load_vertices(RowAt&& row_at) {
  const auto [x, y, z, rgba] = turned_rows(row_at);
  return {x, y, z, rgba};
}

/// The vertices that `index` names.
HALFPLANE_INLINE SnappedLanes load_rows(const VertexRow* vertices, const std::int32_t* index) {
  return load_vertices([=](int i) HALFPLANE_LAMBDA { return vertices + index[i]; });
}

/// Sixteen triangles while they are culled.
struct CullTriangles {
  std::array<I16, 3> v, x, y, z;
  I16 left, top, right, bottom;

  HALFPLANE_INLINE explicit CullTriangles(const std::array<I16, 3>& corners) {
    for (std::size_t k = 0; k < 3; ++k) v[k] = corners[k];
  }
};

/// Differences of coordinates over a triangle.
HALFPLANE_INLINE I16 extent(const std::array<I16, 3>& c) {
  return max(max(c[0], c[1]), c[2]) - min(min(c[0], c[1]), c[2]);
}

/// Sign of twice an area: masks.
struct Side {
  I16 is_turned, is_zero;  ///< below 0, 0
};

/// From the first corner to the second (a) and to the third (b): differences of 23 bits.
HALFPLANE_INLINE Side side_of(const I16& ax, const I16& ay, const I16& bx, const I16& by) {
  constexpr int kShort = 15;  // bits of a magnitude whose product fits 32 bits
  const auto above = [](const I16& v) HALFPLANE_LAMBDA { return (v ^ (v >> 31)) >> kShort; };
  if (!is_any(((above(ax) | above(ay)) | (above(bx) | above(by))) != 0)) {
    const I16 area = cross(ax, ay, bx, by);
    return {area >> 31, area == 0};
  }
  // Exact in binary64.
  const D16 area = cross(convert<double>(ax), convert<double>(ay), convert<double>(bx), convert<double>(by));
  return {convert<std::int32_t>(area < 0.0), convert<std::int32_t>(area == 0.0)};
}

/// Coverage of triangles of at most two by two pixel centres.
struct SampleLanes {
  I16 is_known;  ///< mask of these triangles; the others are left at 0
  I16 samples;   ///< bits: upper left, upper right, lower left, lower right
};

HALFPLANE_INLINE SampleLanes covered_samples(const CullTriangles& t, const I16& is_turned, int grid_bits) {
  const I16 is_wide = t.right > t.left, is_high = t.bottom > t.top;
  // The extent of the triangle itself, not of its scissored box: the products below must fit.
  const I16 is_small = (t.right - t.left <= 1) & (t.bottom - t.top <= 1) & (extent(t.x) < 4 << grid_bits) &
                       (extent(t.y) < 4 << grid_bits);
  if (!is_any(is_small)) return {I16(0), I16(0)};
  const int half = 1 << (grid_bits - 1);
  const I16 px = (t.left << grid_bits) + half, py = (t.top << grid_bits) + half;
  std::array<I16, 4> outside{I16(0), I16(0), I16(0), I16(0)};  // negative where the sample is outside one edge
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    I16 dx = t.x[j] - t.x[i], dy = t.y[j] - t.y[i];
    I16 e = cross(dx, dy, px - t.x[i], py - t.y[i]);
    dx = turned(dx, is_turned);
    dy = turned(dy, is_turned);
    e = turned(e, is_turned);
    e += ~is_top_left(dx, dy);  // -1 unless it is a top or left edge
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
/// first, in the slice. Corners beyond `count` are not used, but must be readable.
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

/// Limits of the lanes of SmallBatch.
struct LaneLimits {
  int tiles;                   ///< along the side of a triangle's box, below
  std::int32_t extent, range;  ///< subpixels, depth codes, below

  LaneLimits(int tiles_, int pixel_bits, const Widths& widths) : tiles(tiles_) {
    const int bits = extent_bits(pixel_bits, widths);
    extent = 1 << bits;
    // Numerators: two products of a difference of codes and a difference of coordinates; below 2^62 after
    // multiplication with the reciprocal.
    range = std::int32_t{1} << std::clamp(61 - bits - widths.reciprocal.bits, 0, 30);
  }
};

/// Turns 16 triangles into records; triangles that need the slow path take it in order.
struct CullLanes {
  const FrameContext& frame;
  Slice& slice;
  SlowPath slow;
  PixelBounds limit;
  Cull mode;
  bool is_front_cw;
  LaneLimits small, medium;
  alignas(64) std::array<std::array<std::int32_t, 16>, 3> at{};  ///< the corners, in memory: for scalar code

  /// Sets of triangles, a bit each.
  struct Sets {
    std::uint32_t lanes, slow = 0,
                         frustum = 0;   ///< present; on the slow path; outside a plane of the view volume
    std::uint32_t zero, culled, empty;  ///< numbers of dropped triangles, by the first reason that holds
    std::uint32_t drawn, sampleless;    ///< drawn triangles; among them triangles without a sample
  };

  /// The corners and boxes of triangles whose t.v is known.
  HALFPLANE_INLINE void load_corners(CullTriangles& t) {
    for (std::size_t k = 0; k < 3; ++k) t.v[k].store(at[k].data());
    // Pixels whose centres the box contains; with several samples, pixels that it touches.
    const int grid_bits = frame.widths.grid_bits, has_samples = frame.widths.has_samples;
    const int half = has_samples != 0 ? 0 : 1 << (grid_bits - 1), before = has_samples != 0 ? 0 : half - 1;
    for (std::size_t k = 0; k < 3; ++k) {
      const SnappedLanes corner = load_rows(slice.vertices.data(), at[k].data());
      t.x[k] = corner.x;
      t.y[k] = corner.y;
      t.z[k] = corner.z;
    }
    t.left = max(I16(limit.left), (min(min(t.x[0], t.x[1]), t.x[2]) + before) >> grid_bits);
    t.top = max(I16(limit.top), (min(min(t.y[0], t.y[1]), t.y[2]) + before) >> grid_bits);
    t.right = min(I16(limit.right), (max(max(t.x[0], t.x[1]), t.x[2]) - half) >> grid_bits);
    t.bottom = min(I16(limit.bottom), (max(max(t.y[0], t.y[1]), t.y[2]) - half) >> grid_bits);
  }

  /// Finds triangles to clip by the codes of their vertices.
  HALFPLANE_INLINE void find_clipped(const CullTriangles& t, Sets& sets) const {
    if (slice.any_code == 0) return;
    const I16 a = gather(slice.codes.data(), t.v[0]), b = gather(slice.codes.data(), t.v[1]),
              c = gather(slice.codes.data(), t.v[2]);
    sets.slow = bits_of(((a | b | c) & static_cast<int>(Slice::kSlow)) != 0) & sets.lanes;
    if (frame.skip.frustum)
      sets.frustum = bits_of((a & b & c & static_cast<int>(Slice::kVolume)) != 0) & sets.lanes & ~sets.slow;
  }

  /// Finds drawn triangles by area, side and box. Returns the coverage of the small ones.
  HALFPLANE_INLINE SampleLanes find_drawn(const CullTriangles& t, Sets& sets) const {
    const Side side = side_of(t.x[1] - t.x[0], t.y[1] - t.y[0], t.x[2] - t.x[0], t.y[2] - t.y[0]);
    const I16& is_turned = side.is_turned;
    const std::uint32_t turned_bits = bits_of(is_turned), front = is_front_cw ? ~turned_bits : turned_bits;
    const std::uint32_t fast = sets.lanes & ~sets.slow & ~sets.frustum;
    sets.zero = bits_of(side.is_zero) & fast;
    const std::uint32_t live = fast & ~sets.zero;
    sets.culled = mode == Cull::none    ? 0
                  : mode == Cull::both  ? live
                  : mode == Cull::front ? live & front
                                        : live & ~front;
    sets.empty = bits_of((t.left > t.right) | (t.top > t.bottom)) & live & ~sets.culled;
    sets.drawn = live & ~sets.culled & ~sets.empty;
    const SampleLanes few = frame.skip.no_sample && sets.drawn != 0 && frame.widths.has_samples == 0
                                ? covered_samples(t, is_turned, frame.widths.grid_bits)
                                : SampleLanes{I16(0), I16(0)};
    sets.sampleless = bits_of(few.is_known & (few.samples == 0)) & sets.drawn;
    return {few.is_known, few.samples};
  }

  HALFPLANE_INLINE void count(const Sets& sets) const {
    const auto count_of = [](std::uint32_t bits)
                              HALFPLANE_LAMBDA { return static_cast<unsigned>(std::popcount(bits)); };
    Counters& counters = slice.counters;
    counters.primitives_in += count_of(sets.lanes & ~sets.slow);
    counters.culled += count_of(sets.frustum | sets.zero | sets.culled | sets.empty);
    counters.drawn += count_of(sets.drawn);
    counters.skipped.frustum += count_of(sets.frustum);
    counters.skipped.zero_area += count_of(sets.zero);
    counters.skipped.backface += count_of(sets.culled);
    counters.skipped.empty += frame.skip.empty ? count_of(sets.empty) : 0;
    counters.skipped.no_sample += count_of(sets.sampleless);
  }

  /// Makes records: with packed_columns() of the triangles in `kept`, one after the other, else of all sixteen.
  /// `dropped`: a bit for each triangle that draws nothing.
  HALFPLANE_INLINE void make_records(const CullTriangles& t, const SampleLanes& few, std::uint32_t dropped,
                                     [[maybe_unused]] std::uint32_t kept, Record* records) const {
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
    std::int32_t* const words = reinterpret_cast<std::int32_t*>(records);
    static_assert(static_cast<int>(RecordKind::triangle) == 0);
    const auto store = [&](const Columns& four, std::int32_t* to) HALFPLANE_LAMBDA {
#if HALFPLANE_ISA == 512
      store_rows(packed_columns(four, kept), to, sizeof(Record));
#else
      store_rows(four, to, sizeof(Record));
#endif
    };
    store({t.v[0], t.v[1], t.v[2], z_low}, words);
    store({z_high, pairs(t.left, t.top), pairs(t.right, t.bottom),
           ((few.samples & is_small & ~is_dropped) << Record::kSamplesShift) | (is_whole & Record::kWhole) |
               (is_small & Record::kSmall) | (is_medium & Record::kMedium) | (is_dropped & Record::kDrawsNothing)},
          words + 4);
  }

  /// Culls the triangles of `part` from `first` on, `many` or sixteen of them. `number`: of the first, in the slice.
  HALFPLANE_INLINE void operator()(const Slice::Part& part, std::size_t first, std::size_t many, std::size_t number) {
    CullTriangles t(corner_lanes(frame, slice, part.first + first, many, number));
    Sets sets;
    sets.lanes = (1U << many) - 1;
    find_clipped(t, sets);
    load_corners(t);
    const SampleLanes few = find_drawn(t, sets);
    count(sets);
    // Culled, but Skip forbids to drop it: its record goes on if its box contains a pixel.
    const std::uint32_t dropped = ((frame.skip.zero_area ? 0 : sets.zero) | (frame.skip.backface ? 0 : sets.culled)) &
                                  ~bits_of((t.left > t.right) | (t.top > t.bottom));
    std::uint32_t rest = (sets.drawn & ~sets.sampleless) | dropped | sets.slow;
    if (rest == 0) return;  // back faces come in runs
    Record* out = slice.records.data() + slice.record_count;
#if HALFPLANE_ISA == 512
    if (sets.slow == 0) {
      make_records(t, few, dropped, rest, out);
      slice.record_count += static_cast<unsigned>(std::popcount(rest));
      return;
    }
#endif
    alignas(64) std::array<Record, 16> records;
    make_records(t, few, dropped, 0xffff, records.data());
    for (; rest != 0; rest &= rest - 1) {
      const int i = std::countr_zero(rest);
      if ((sets.slow >> i & 1) != 0) {
        slice.record_count = static_cast<std::size_t>(out - slice.records.data());
        slow(frame, slice, part, first + static_cast<std::size_t>(i));
        out = slice.records.data() + slice.record_count;
        continue;
      }
      *out++ = records[static_cast<std::size_t>(i)];
    }
    slice.record_count = static_cast<std::size_t>(out - slice.records.data());
  }
};

/// Makes Slice::records for a slice of triangles; they are as many as the triangles, or more where the slow path clips.
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
                  {kMediumTiles, kMediumPixelBits, frame.widths},
                  {}};
  std::size_t number = 0;
  for (const Slice::Part& part : slice.parts)
    for (std::size_t first = 0; first < part.count; first += 16) {
      const std::size_t count = std::min<std::size_t>(16, part.count - first);
      lanes(part, first, count, number);
      number += count;
    }
}

}  // namespace
}  // namespace halfplane::functional::HALFPLANE_ISA_NAME
