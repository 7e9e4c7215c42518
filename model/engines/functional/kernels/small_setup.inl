// Sixteen small or medium triangles at a time through triangle_setup: the same integers, a triangle a lane.
// A room of the kernels, compiled once for each instruction set: see ../kernels.inl.

/// Triangles of a slice that wait, and after set_up_small() their constants: fields of lanes, one for each.
struct SmallBatch {
  using Lane = std::array<std::int32_t, 16>;
  template <std::size_t N>
  using LaneArray = std::array<Lane, N>;

  int count = 0;
  std::array<const Record*, 16> records;
  bool has_samples = true;  ///< of all that wait

  std::uint32_t live = 0;                     ///< lanes that draw something in this bin
  std::array<I16, 3> v;                       ///< corners, into Slice::vertices
  alignas(64) Lane left, top, right, bottom;  ///< pixels of the bin
  alignas(64) Lane first_tile;                ///< of the box: column + kMediumTiles row
  alignas(64) Lane z_low, z_high;
  alignas(64) Lane samples;  ///< Record::samples() of the part of its box that lies in the bin

  alignas(64) LaneArray<3> edge;                ///< at the first pixel of the box's first block
  alignas(64) LaneArray<3> to_right, to_below;  ///< from a block to its neighbours
  alignas(64) Lane place;                       ///< the first block: lane, column, row, a byte each
  alignas(64) Lane there;              ///< bits: the box touches that block, its right neighbour, the lower, both's
  alignas(64) LaneArray<3> edge_step;  ///< pairs: a row down low, a column to the right high
  /// Of the tiles that the box may touch, kMediumTiles a row; with has_samples, of those of its four samples.
  alignas(64) LaneArray<kMediumTiles * kMediumTiles> z_anchor;
  alignas(64) Lane z_step_x, z_step_y;
  alignas(64) std::array<LaneArray<kMediumTiles * kMediumTiles>, 2> c_anchor;  ///< by channel pair
  alignas(64) LaneArray<2> c_step_x, c_step_y, c_low, c_high;

  /// True when that was the last for which there is room.
  HALFPLANE_INLINE bool add(const Record& record) {
    has_samples = (count == 0 || has_samples) && record.samples() != 0;
    records[static_cast<std::size_t>(count)] = &record;
    return ++count == 16;
  }
};

/// The fields of the records that wait; live.
HALFPLANE_NOINLINE void load_records(SmallBatch& batch, int first_x, int first_y) {
  for (std::size_t i = static_cast<std::size_t>(batch.count); i < 16; ++i) batch.records[i] = batch.records[0];
  const auto half = [&batch](int i, int first_word) HALFPLANE_LAMBDA {
    return reinterpret_cast<const std::int32_t*>(batch.records[static_cast<std::size_t>(i)]) + first_word;
  };
  const auto [v0, v1, v2, low] = turned_rows([&](int i) HALFPLANE_LAMBDA { return half(i, 0); });
  const auto [high, left_top, right_bottom, traits] = turned_rows([&](int i) HALFPLANE_LAMBDA { return half(i, 4); });
  const I16 covered = traits >> Record::kSamplesShift;
  batch.v = {v0, v1, v2};
  low.store(batch.z_low.data());
  high.store(batch.z_high.data());
  const I16 x0 = (left_top << 16 >> 16) - first_x, y0 = (left_top >> 16) - first_y;
  const I16 box_x = max(x0, I16(0)), box_y = max(y0, I16(0));
  box_x.store(batch.left.data());
  box_y.store(batch.top.data());
  ((box_x >> kTileShift) + (box_y >> kTileShift) * kMediumTiles).store(batch.first_tile.data());
  min((right_bottom << 16 >> 16) - first_x, I16(kBinSize - 1)).store(batch.right.data());
  min((right_bottom >> 16) - first_y, I16(kBinSize - 1)).store(batch.bottom.data());
  // Of two by two batch.samples the bin may have one column or row: those on the batch.left, or those on the batch.right moved there.
  constexpr std::int32_t kLeft = 1 | 4, kUpper = 1 | 2;
  const I16 in_columns =
      select(x0 < 0, shift_right_logical(covered, 1) & kLeft, select(x0 == kBinSize - 1, covered & kLeft, covered));
  const I16 in_bin = select(y0 < 0, shift_right_logical(in_columns, 2) & kUpper,
                            select(y0 == kBinSize - 1, in_columns & kUpper, in_columns));
  in_bin.store(batch.samples.data());
  batch.live =
      ((1U << batch.count) - 1) & ~bits_of(((traits & Record::kDrawsNothing) != 0) | ((covered != 0) & (in_bin == 0)));
}

/// The corners of a batch's triangles, turned so that no area is negative; and the first of them in the order of (Y, X).
struct SmallCorners {
  SnappedLanes a, b, c, origin;
  I16 area;
};

/// Takes those of no area out of batch.live.
HALFPLANE_INLINE SmallCorners small_corners(SmallBatch& batch, const Slice& slice) {
  const auto fetch = [&](std::size_t k) HALFPLANE_LAMBDA {
    SmallBatch::Lane at;
    batch.v[k].store(at.data());
    return load_vertices(slice.vertices.data(), at.data());
  };
  const auto choose = [](const I16& mask, const SnappedLanes& p, const SnappedLanes& q) HALFPLANE_LAMBDA {
    return SnappedLanes{select(mask, p.x, q.x), select(mask, p.y, q.y), select(mask, p.z, q.z),
                        select(mask, p.rgba, q.rgba)};
  };
  const auto is_before = [](const SnappedLanes& p, const SnappedLanes& q)
                             HALFPLANE_LAMBDA { return (p.y < q.y) | ((p.y == q.y) & (p.x < q.x)); };
  const SnappedLanes a = fetch(0), b = fetch(1), c = fetch(2);
  SmallCorners corners;
  const I16 area = cross(b.x - a.x, b.y - a.y, c.x - a.x, c.y - a.y), is_turned = area < 0;
  corners.a = a;
  corners.b = choose(is_turned, c, b);
  corners.c = choose(is_turned, b, c);
  corners.area = turned(area, is_turned);
  batch.live &= ~bits_of(corners.area == 0);
  corners.origin = choose(is_before(corners.b, a), corners.b, a);
  corners.origin = choose(is_before(corners.c, corners.origin), corners.c, corners.origin);
  return corners;
}

/// `s`: bits of the subpixel grid.
HALFPLANE_INLINE void set_up_small_edges(SmallBatch& batch, const SmallCorners& corners, int s, int first_x,
                                         int first_y) {
  const int half = 1 << (s - 1);
  const auto first_of_block = [&](const SmallBatch::Lane& box, int first) HALFPLANE_LAMBDA {
    return (((I16::load(box.data()) & ~(kBlockSize - 1)) + first) << s) + half;
  };
  const I16 px = first_of_block(batch.left, first_x), py = first_of_block(batch.top, first_y);
  const std::array<const SnappedLanes*, 4> corner{&corners.a, &corners.b, &corners.c, &corners.a};
  for (std::size_t e = 0; e < 3; ++e) {
    const SnappedLanes &from = *corner[e], &to = *corner[e + 1];
    const I16 dx = to.x - from.x, dy = to.y - from.y;
    const I16 value = (cross(dx, dy, px - from.x, py - from.y) + ~is_top_left(dx, dy)) >> s;
    value.store(batch.edge[e].data());
    pairs(dx, -dy).store(batch.edge_step[e].data());
    (dy * -kBlockSize).store(batch.to_right[e].data());
    (dx * kBlockSize).store(batch.to_below[e].data());
  }
}

/// The first block of each box, and which of its neighbours the box touches.
HALFPLANE_INLINE void find_places(SmallBatch& batch) {
  const auto block_of = [](const SmallBatch::Lane& at) HALFPLANE_LAMBDA { return I16::load(at.data()) >> kBlockShift; };
  const I16 column = block_of(batch.left), row = block_of(batch.top), number = I16::of([](int i) { return i; });
  (number | column << 8 | row << 16).store(batch.place.data());
  const I16 is_drawn = I16::of([](int i) { return 1 << i; }) & static_cast<std::int32_t>(batch.live);
  const I16 has_right = (block_of(batch.right) > column) & 2, has_below = (block_of(batch.bottom) > row) & 4;
  const I16 has_both = (has_right << 2) & (has_below << 1);
  select(is_drawn != 0, has_right | has_below | has_both | 1, I16(0)).store(batch.there.data());
}

/// What the planes of a batch have in common.
struct SmallPlanes {
  int fraction, to_tile;   ///< bits: of a plane; from a step of a pixel to one of a tile
  I16 ax, ay, bx, by;      ///< corners b and c from corner a
  I16 to_x, to_y;          ///< from the origin to the anchor of the box's first tile
  I16 is_right, is_below;  ///< whether the tiles that follow differ: with has_samples, that of the next sample
  GradientLanes gradient;

  HALFPLANE_INLINE SmallPlanes(const SmallBatch& batch, const SmallCorners& corners, const L16& reciprocal,
                               const I16& shift, const Widths& widths, int first_x, int first_y)
      : fraction(widths.plane_fraction),
        to_tile(kTileShift + widths.grid_bits),
        gradient(reciprocal, shift - widths.plane_fraction) {
    const auto& [a, b, c, origin, area] = corners;
    ax = b.x - a.x;
    ay = b.y - a.y;
    bx = c.x - a.x;
    by = c.y - a.y;
    const int s = widths.grid_bits, half = 1 << (s - 1);
    const auto anchor_of = [&](const I16& box, int first) HALFPLANE_LAMBDA {
      return (((box & ~(kTileSize - 1)) + (first + kTileSize / 2)) << s) + half;
    };
    const I16 box_x = I16::load(batch.left.data()), box_y = I16::load(batch.top.data());
    to_x = anchor_of(box_x, first_x) - origin.x;
    to_y = anchor_of(box_y, first_y) - origin.y;
    const auto is_next = [&batch](const I16& at) HALFPLANE_LAMBDA {
      return batch.has_samples ? (at & (kTileSize - 1)) == kTileSize - 1 : I16(-1);
    };
    is_right = is_next(box_x);
    is_below = is_next(box_y);
  }
};

/// A plane at the anchors of the tiles.
using Anchors = std::array<I16, kMediumTiles * kMediumTiles>;

template <std::size_t Side, class Visit>
HALFPLANE_INLINE void for_each_anchor(Visit&& visit) {
  for (std::size_t j = 0; j < Side; ++j)
    for (std::size_t i = 0; i < Side; ++i) visit(j * kMediumTiles + i);
}

/// The bits from `drop` on. Where the products of the bits below fit 32, that is all that a lane needs: what is above
/// wraps.
template <std::size_t Side>
HALFPLANE_INLINE void find_anchors(const SmallPlanes& f, const I16& at_origin, const L16& step_x, const L16& step_y,
                                   const LaneFormat& format, Anchors& out) {
  const int drop = format.drop;
  // Offsets below 64 pixels; two products, two steps to tiles and a bias.
  if (constexpr int kOffset = 6 + 2; drop + f.to_tile - kTileShift + kOffset < 32) {
    const std::int32_t below = (std::int32_t{1} << drop) - 1;
    const I16 x0 = convert<std::int32_t>(step_x) & below, y0 = convert<std::int32_t>(step_y) & below;
    const I16 x1 = convert<std::int32_t>(shift_right_logical(step_x, drop)),
              y1 = convert<std::int32_t>(shift_right_logical(step_y, drop));
    I16 upper = (at_origin << (f.fraction - drop)) + x1 * f.to_x + y1 * f.to_y +
                static_cast<std::int32_t>(static_cast<std::uint32_t>(format.anchor_bias >> drop));
    I16 lower = x0 * f.to_x + y0 * f.to_y + (static_cast<std::int32_t>(format.anchor_bias) & below);
    const I16 right1 = (x1 << f.to_tile) & f.is_right, right0 = (x0 << f.to_tile) & f.is_right,
              down1 = (y1 << f.to_tile) & f.is_below, down0 = (y0 << f.to_tile) & f.is_below;
    for (std::size_t j = 0; j < Side; ++j) {
      I16 high = upper, low = lower;
      for (std::size_t i = 0; i < Side; ++i) {
        out[j * kMediumTiles + i] = (high + (low >> drop)) << format.up;
        high += right1;
        low += right0;
      }
      upper += down1;
      lower += down0;
    }
    return;
  }
  L16 first = (convert<std::int64_t>(at_origin) << f.fraction) + step_x * convert<std::int64_t>(f.to_x) +
              step_y * convert<std::int64_t>(f.to_y) + static_cast<std::int64_t>(format.anchor_bias);
  const L16 aside = (step_x << f.to_tile) & convert<std::int64_t>(f.is_right),
            down = (step_y << f.to_tile) & convert<std::int64_t>(f.is_below);
  for (std::size_t j = 0; j < Side; ++j) {
    L16 value = first;
    for (std::size_t i = 0; i < Side; ++i) {
      out[j * kMediumTiles + i] = convert<std::int32_t>(shift_right_logical(value, drop)) << format.up;
      value += aside;
    }
    first += down;
  }
}

/// A step of a pixel, in a lane.
HALFPLANE_INLINE I16 local_step(const L16& step, const LaneFormat& format) {
  return round_shift_lanes(step, format.step_drop) << format.up;
}

/// `steep`: differences of codes from here on need products of more than 32 bits.
template <std::size_t Side>
HALFPLANE_INLINE void set_up_small_depth(SmallBatch& batch, const SmallCorners& corners, const SmallPlanes& f,
                                         const LaneFormat& format, std::int32_t steep) {
  const I16 az = corners.b.z - corners.a.z, bz = corners.c.z - corners.a.z;
  L16 step_x, step_y;
  if (is_any(I16::load(batch.z_high.data()) - I16::load(batch.z_low.data()) >= steep)) {
    const auto difference = [](const I16& p, const I16& q, const I16& r, const I16& t) HALFPLANE_LAMBDA {  // pq - rt
      const auto product = [](const I16& m, const I16& n) HALFPLANE_LAMBDA {
        return multiply_narrow(convert<std::int64_t>(m), convert<std::int64_t>(n));
      };
      return product(p, q) - product(r, t);
    };
    step_x = f.gradient(difference(az, f.by, bz, f.ay));
    step_y = f.gradient(difference(f.ax, bz, f.bx, az));
  } else {
    step_x = f.gradient(az * f.by - bz * f.ay);
    step_y = f.gradient(f.ax * bz - f.bx * az);
  }
  Anchors at;
  find_anchors<Side>(f, corners.origin.z, step_x, step_y, format, at);
  for_each_anchor<Side>([&](std::size_t i) HALFPLANE_LAMBDA { at[i].store(batch.z_anchor[i].data()); });
  local_step(step_x, format).store(batch.z_step_x.data());
  local_step(step_y, format).store(batch.z_step_y.data());
}

/// One channel of sixteen triangles: half of a lane.
struct SmallChannel {
  Anchors at;
  I16 step_x, step_y, low, high;
};

/// `down`: the channel's place in a colour.
template <std::size_t Side>
HALFPLANE_INLINE void set_up_small_channel(const SmallCorners& corners, const SmallPlanes& f, const LaneFormat& format,
                                           bool is_flat, int down, SmallChannel& to) {
  const auto code = [down](const SnappedLanes& v) HALFPLANE_LAMBDA { return shift_right_logical(v.rgba, down) & 255; };
  const I16 ca = code(corners.a), cb = is_flat ? ca : code(corners.b), cc = is_flat ? ca : code(corners.c);
  to.low = min(min(ca, cb), cc);
  to.high = max(max(ca, cb), cc);
  if (bits_of(to.low == to.high) == 0xffff) {  // the same everywhere: the clamp alone makes it
    to.at.fill(I16(0));
    to.step_x = to.step_y = I16(0);
    return;
  }
  const I16 c0 = is_flat ? ca : code(corners.origin);
  const I16 ac = cb - ca, bc = cc - ca;
  const L16 gx = f.gradient(ac * f.by - bc * f.ay), gy = f.gradient(f.ax * bc - f.bx * ac);
  find_anchors<Side>(f, c0, gx, gy, format, to.at);
  to.step_x = local_step(gx, format);
  to.step_y = local_step(gy, format);
}

template <std::size_t Side>
HALFPLANE_INLINE void set_up_small_colors(SmallBatch& batch, const SmallCorners& corners, const SmallPlanes& f,
                                          const LaneFormat& format, bool is_flat) {
  for (std::size_t p = 0; p < 2; ++p) {  // red and blue, green and alpha
    std::array<SmallChannel, 2> halves;
    for (std::size_t h = 0; h < 2; ++h)
      set_up_small_channel<Side>(corners, f, format, is_flat, static_cast<int>(8 * (p + 2 * h)), halves[h]);
    const SmallChannel &low = halves[0], &high = halves[1];
    for_each_anchor<Side>([&](std::size_t i)
                              HALFPLANE_LAMBDA { pairs(low.at[i], high.at[i]).store(batch.c_anchor[p][i].data()); });
    pairs(low.step_x, high.step_x).store(batch.c_step_x[p].data());
    pairs(low.step_y, high.step_y).store(batch.c_step_y[p].data());
    pairs(low.low, high.low).store(batch.c_low[p].data());
    pairs(low.high, high.high).store(batch.c_high[p].data());
  }
}

/// The constants of a batch that is loaded. `Side`: tiles along a side of a box at most.
template <std::size_t Side>
HALFPLANE_NOINLINE void set_up_small(SmallBatch& batch, const Slice& slice, const FrameContext& frame,
                                     const LaneFormat& depth_format, const LaneFormat& color_format, int first_x,
                                     int first_y) {
  const Config& config = frame.config;
  const Widths& widths = frame.widths;
  const SmallCorners corners = small_corners(batch, slice);
  if (!batch.has_samples) set_up_small_edges(batch, corners, widths.grid_bits, first_x, first_y);
  find_places(batch);
  L16 reciprocal, shift;
  reciprocal_lanes(corners.area, config.depth_bits + config.reciprocal_extra_bits, reciprocal, shift);
  const SmallPlanes planes(batch, corners, reciprocal, convert<std::int32_t>(shift), widths, first_x, first_y);
  // Of medium triangles whatever Side is: that counts tiles of the bin.
  const std::int32_t steep = std::int32_t{1} << (30 - extent_bits(kMediumPixelBits, widths));
  set_up_small_depth<Side>(batch, corners, planes, depth_format, steep);
  if (slice.state.color_write) set_up_small_colors<Side>(batch, corners, planes, color_format, slice.state.is_flat);
}
