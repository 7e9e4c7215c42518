// Sixteen small or medium triangles at a time through triangle_setup: the same integers, a triangle a lane.
// Included inside the namespace of an instruction set: see raster.inl.

/// Triangles of a slice that wait, and after set_up() their constants: fields of lanes, one for each.
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
  alignas(64) Lane first_tile;  ///< of the box: column + kMediumTiles row
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

  /// The records' fields; live.
  void load(int first_x, int first_y);
  /// `Side`: tiles along a side of a box at most.
  template <std::size_t Side>
  void set_up(const Slice& slice, const FrameContext& frame, const LaneFormat& depth_format,
              const LaneFormat& color_format, int first_x, int first_y);
};

/// The reciprocals of sixteen areas below 2^31 and their shifts. significant_bits <= 29: a quotient fits 31 bits.
HALFPLANE_INLINE void reciprocal_lanes(const I16& area, int significant_bits, L16& value, L16& shift) {
  const D16 divisor = convert<double>(max(area, I16(1)));
  const auto bits = as<L16>(divisor);
  shift = shift_right_logical(bits, 52) - (1023 - significant_bits);
  const L16 power_bits = (shift + 1024) << 52;  // of 2^(shift + 1)
  const auto power = as<D16>(power_bits);
  L16 quotient = convert<std::int64_t>(convert<std::int32_t>(power / divisor));
  const L16 remainder = (L16(1) << (shift + 1)) - multiply_narrow(quotient, convert<std::int64_t>(area));
  quotient = quotient + (remainder < 0) - (remainder >= convert<std::int64_t>(area));
  value = shift_right_logical(quotient + 1, 1);
}

/// Gradients of sixteen planes: numerators times reciprocals, rounded.
struct GradientLanes {
  static constexpr std::int64_t kRaise = std::int64_t{1} << 62;  ///< makes a product positive: no shift needs a sign
  L16 reciprocal, left, right;                                   ///< shifts: one of them 0
  L16 addend, lowered;

  /// `k`: bits that a product drops; negative: gains.
  HALFPLANE_INLINE GradientLanes(const L16& reciprocal_, const I16& k)
      : reciprocal(reciprocal_),
        left(convert<std::int64_t>(max(-k, I16(0)))),
        right(convert<std::int64_t>(max(k, I16(0)))),
        addend(shift_right_logical(L16(1) << right, 1) + kRaise),
        lowered(shift_right_logical(L16(kRaise), right)) {}

  HALFPLANE_INLINE L16 operator()(const I16& numerator) const {
    return rounded(multiply_narrow(convert<std::int64_t>(numerator), reciprocal));
  }
  HALFPLANE_INLINE L16 operator()(const L16& numerator) const { return rounded(numerator * reciprocal); }

  HALFPLANE_INLINE L16 rounded(const L16& product) const {
    return shift_right_logical((product << left) + addend, right) - lowered;
  }
};

/// round_shift(), the lower 32 bits. bits <= 32.
HALFPLANE_INLINE I16 round_shift_lanes(const L16& value, int bits) {
  if (bits <= 0) return convert<std::int32_t>(value << -bits);
  return convert<std::int32_t>(shift_right_logical(value + (std::int64_t{1} << (bits - 1)), bits));
}

HALFPLANE_NOINLINE void SmallBatch::load(int first_x, int first_y) {
  for (std::size_t i = static_cast<std::size_t>(count); i < 16; ++i) records[i] = records[0];
  const auto half = [this](int i, int first_word) HALFPLANE_LAMBDA {
    return reinterpret_cast<const std::int32_t*>(records[static_cast<std::size_t>(i)]) + first_word;
  };
  const auto [v0, v1, v2, low] = turned_rows([&](int i) HALFPLANE_LAMBDA { return half(i, 0); });
  const auto [high, left_top, right_bottom, traits] = turned_rows([&](int i) HALFPLANE_LAMBDA { return half(i, 4); });
  const I16 covered = traits >> Record::kSamplesShift;
  v = {v0, v1, v2};
  low.store(z_low.data());
  high.store(z_high.data());
  const I16 x0 = (left_top << 16 >> 16) - first_x, y0 = (left_top >> 16) - first_y;
  const I16 box_x = max(x0, I16(0)), box_y = max(y0, I16(0));
  box_x.store(left.data());
  box_y.store(top.data());
  ((box_x >> kTileShift) + (box_y >> kTileShift) * kMediumTiles).store(first_tile.data());
  min((right_bottom << 16 >> 16) - first_x, I16(kBinSize - 1)).store(right.data());
  min((right_bottom >> 16) - first_y, I16(kBinSize - 1)).store(bottom.data());
  // Of two by two samples the bin may have one column or row: those on the left, or those on the right moved there.
  constexpr std::int32_t kLeft = 1 | 4, kUpper = 1 | 2;
  const I16 in_columns = select(x0 < 0, shift_right_logical(covered, 1) & kLeft,
                                select(x0 == kBinSize - 1, covered & kLeft, covered));
  const I16 in_bin = select(y0 < 0, shift_right_logical(in_columns, 2) & kUpper,
                            select(y0 == kBinSize - 1, in_columns & kUpper, in_columns));
  in_bin.store(samples.data());
  live = ((1U << count) - 1) & ~bits_of(((traits & Record::kDrawsNothing) != 0) | ((covered != 0) & (in_bin == 0)));
}

template <std::size_t Side>
HALFPLANE_NOINLINE void SmallBatch::set_up(const Slice& slice, const FrameContext& frame,
                                           const LaneFormat& depth_format, const LaneFormat& color_format, int first_x,
                                           int first_y) {
  const Config& config = frame.config;
  const Widths& widths = frame.widths;
  const int s = widths.grid_bits, F = widths.plane_fraction, half = 1 << (s - 1);
  const auto fetch = [&](std::size_t k) HALFPLANE_LAMBDA {
    Lane at;
    v[k].store(at.data());
    return load_vertices(slice.vertices.data(), at.data());
  };
  const SnappedLanes a = fetch(0);
  SnappedLanes b = fetch(1), c = fetch(2);
  const auto choose = [](const I16& mask, const SnappedLanes& p, const SnappedLanes& q) HALFPLANE_LAMBDA {
    return SnappedLanes{select(mask, p.x, q.x), select(mask, p.y, q.y), select(mask, p.z, q.z),
                    select(mask, p.rgba, q.rgba)};
  };
  I16 area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  const I16 is_turned = area < 0;
  const SnappedLanes turned_b = choose(is_turned, c, b);
  c = choose(is_turned, b, c);
  b = turned_b;
  area = (area ^ is_turned) - is_turned;
  live &= ~bits_of(area == 0);
  const auto is_before = [](const SnappedLanes& p, const SnappedLanes& q)
                             HALFPLANE_LAMBDA { return (p.y < q.y) | ((p.y == q.y) & (p.x < q.x)); };
  SnappedLanes origin = choose(is_before(b, a), b, a);
  origin = choose(is_before(c, origin), c, origin);

  const I16 box_x = I16::load(left.data()), box_y = I16::load(top.data());
  const I16 px = (((box_x & ~(kBlockSize - 1)) + first_x) << s) + half,
            py = (((box_y & ~(kBlockSize - 1)) + first_y) << s) + half;
  const std::array<const SnappedLanes*, 4> corner{&a, &b, &c, &a};
  for (std::size_t e = 0; e < 3 && !has_samples; ++e) {
    const SnappedLanes &from = *corner[e], &to = *corner[e + 1];
    const I16 dx = to.x - from.x, dy = to.y - from.y;
    const I16 is_in = (dy < 0) | ((dy == 0) & (dx > 0));  // top or left
    const I16 value = (dx * (py - from.y) - dy * (px - from.x) + ~is_in) >> s;
    value.store(edge[e].data());
    pairs(dx, -dy).store(edge_step[e].data());
    (dy * -kBlockSize).store(to_right[e].data());
    (dx * kBlockSize).store(to_below[e].data());
  }

  const I16 column = box_x >> 2, row = box_y >> 2, number = I16::of([](int i) { return i; });
  (number | column << 8 | row << 16).store(place.data());
  const I16 is_drawn = I16::of([](int i) { return 1 << i; }) & static_cast<std::int32_t>(live);
  const I16 has_right = ((I16::load(right.data()) >> 2) > column) & 2,
            has_below = ((I16::load(bottom.data()) >> 2) > row) & 4;
  select(is_drawn != 0, has_right | has_below | ((has_right << 2) & (has_below << 1)) | 1, I16(0)).store(there.data());

  L16 reciprocal, shift;
  reciprocal_lanes(area, config.depth_bits + config.reciprocal_extra_bits, reciprocal, shift);
  const GradientLanes gradient(reciprocal, convert<std::int32_t>(shift) - F);
  const I16 ax = b.x - a.x, ay = b.y - a.y, bx = c.x - a.x, by = c.y - a.y;
  const auto anchor_of = [&](const I16& box, int first) HALFPLANE_LAMBDA {  // of the box's first tile
    return (((box & ~(kTileSize - 1)) + (first + kTileSize / 2)) << s) + half;
  };
  const I16 to_x = anchor_of(box_x, first_x) - origin.x, to_y = anchor_of(box_y, first_y) - origin.y;
  const int to_tile = kTileShift + s;
  // To the tiles that follow: with has_samples, to that of the next sample.
  const auto to_next_tile = [this](const I16& at) HALFPLANE_LAMBDA {
    return has_samples ? (at & (kTileSize - 1)) == kTileSize - 1 : I16(-1);
  };
  const I16 to_right_tile = to_next_tile(box_x), to_lower_tile = to_next_tile(box_y);
  // A plane at the anchors of the tiles, the bits from `drop` on. Where the products of the bits below fit 32, that is
  // all that a lane needs: what is above wraps.
  using Anchors = std::array<I16, kMediumTiles * kMediumTiles>;
  const auto anchors = [&](const I16& at_origin, const L16& step_x, const L16& step_y, const LaneFormat& format,
                           Anchors& out) HALFPLANE_LAMBDA {
    const int drop = format.drop;
    // Offsets below 64 pixels; two products, two steps to tiles and a bias.
    if (constexpr int kOffset = 6 + 2; drop + s + kOffset < 32) {
      const std::int32_t below = (std::int32_t{1} << drop) - 1;
      const I16 x0 = convert<std::int32_t>(step_x) & below, y0 = convert<std::int32_t>(step_y) & below;
      const I16 x1 = convert<std::int32_t>(shift_right_logical(step_x, drop)),
                y1 = convert<std::int32_t>(shift_right_logical(step_y, drop));
      I16 upper = (at_origin << (F - drop)) + x1 * to_x + y1 * to_y +
                  static_cast<std::int32_t>(static_cast<std::uint32_t>(format.anchor_bias >> drop));
      I16 lower = x0 * to_x + y0 * to_y + (static_cast<std::int32_t>(format.anchor_bias) & below);
      const I16 right1 = (x1 << to_tile) & to_right_tile, right0 = (x0 << to_tile) & to_right_tile,
                down1 = (y1 << to_tile) & to_lower_tile, down0 = (y0 << to_tile) & to_lower_tile;
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
    L16 first = (convert<std::int64_t>(at_origin) << F) + step_x * convert<std::int64_t>(to_x) +
                step_y * convert<std::int64_t>(to_y) + static_cast<std::int64_t>(format.anchor_bias);
    const L16 aside = (step_x << to_tile) & convert<std::int64_t>(to_right_tile),
              down = (step_y << to_tile) & convert<std::int64_t>(to_lower_tile);
    for (std::size_t j = 0; j < Side; ++j) {
      L16 value = first;
      for (std::size_t i = 0; i < Side; ++i) {
        out[j * kMediumTiles + i] = convert<std::int32_t>(shift_right_logical(value, drop)) << format.up;
        value += aside;
      }
      first += down;
    }
  };
  const auto for_each_anchor = [&](auto&& visit) HALFPLANE_LAMBDA {
    for (std::size_t j = 0; j < Side; ++j)
      for (std::size_t i = 0; i < Side; ++i) visit(j * kMediumTiles + i);
  };
  const auto local = [](const L16& step, const LaneFormat& format)
                         HALFPLANE_LAMBDA { return round_shift_lanes(step, format.step_drop) << format.up; };
  {
    const I16 az = b.z - a.z, bz = c.z - a.z;
    L16 step_x, step_y;
    // From here on 32 bits are too few. Of medium triangles whatever Side is: that counts tiles of the bin.
    const std::int32_t steep = std::int32_t{1} << (30 - extent_bits(kMediumPixelBits, widths));
    if (is_any(I16::load(z_high.data()) - I16::load(z_low.data()) >= steep)) {
      const auto difference = [](const I16& p, const I16& q, const I16& r, const I16& t) HALFPLANE_LAMBDA {  // pq - rt
        const auto product = [](const I16& m, const I16& n) HALFPLANE_LAMBDA {
          return multiply_narrow(convert<std::int64_t>(m), convert<std::int64_t>(n));
        };
        return product(p, q) - product(r, t);
      };
      step_x = gradient(difference(az, by, bz, ay));
      step_y = gradient(difference(ax, bz, bx, az));
    } else {
      step_x = gradient(az * by - bz * ay);
      step_y = gradient(ax * bz - bx * az);
    }
    Anchors at;
    anchors(origin.z, step_x, step_y, depth_format, at);
    for_each_anchor([&](std::size_t i) HALFPLANE_LAMBDA { at[i].store(z_anchor[i].data()); });
    local(step_x, depth_format).store(z_step_x.data());
    local(step_y, depth_format).store(z_step_y.data());
  }
  if (!slice.state.color_write) return;
  const bool is_flat = slice.state.is_flat;
  for (std::size_t p = 0; p < 2; ++p) {
    struct Half {
      Anchors at;
      I16 step_x, step_y, low, high;
    };
    std::array<Half, 2> halves;
    for (std::size_t h = 0; h < 2; ++h) {
      Half& to = halves[h];
      const int down = static_cast<int>(8 * (p + 2 * h));  // red and blue, green and alpha
      const auto code = [down](const I16& rgba) HALFPLANE_LAMBDA { return shift_right_logical(rgba, down) & 255; };
      const I16 ca = code(a.rgba), cb = is_flat ? ca : code(b.rgba), cc = is_flat ? ca : code(c.rgba);
      to.low = min(min(ca, cb), cc);
      to.high = max(max(ca, cb), cc);
      if (bits_of(to.low == to.high) == 0xffff) {  // the same everywhere: the clamp alone makes it
        to.at.fill(I16(0));
        to.step_x = to.step_y = I16(0);
        continue;
      }
      const I16 c0 = is_flat ? ca : code(origin.rgba);
      const I16 ac = cb - ca, bc = cc - ca;
      const L16 gx = gradient(ac * by - bc * ay), gy = gradient(ax * bc - bx * ac);
      anchors(c0, gx, gy, color_format, to.at);
      to.step_x = local(gx, color_format);
      to.step_y = local(gy, color_format);
    }
    const Half &low = halves[0], &high = halves[1];
    for_each_anchor([&](std::size_t i)
                        HALFPLANE_LAMBDA { pairs(low.at[i], high.at[i]).store(c_anchor[p][i].data()); });
    pairs(low.step_x, high.step_x).store(c_step_x[p].data());
    pairs(low.step_y, high.step_y).store(c_step_y[p].data());
    pairs(low.low, high.low).store(c_low[p].data());
    pairs(low.high, high.high).store(c_high[p].data());
  }
}
