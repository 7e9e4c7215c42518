// The constants of one triangle in one bin: triangle_setup by itself.
// A room of the kernels, compiled once for each instruction set: see ../kernels.inl.

struct ColorFrame {
  std::int64_t ax, ay, bx, by, dx, dy;
};

/// The three edges at once: edge_function(), whose values binary64 holds. Inside a bin they move by less than 2^30:
/// beyond that a sign is the same everywhere.
HALFPLANE_INLINE void set_up_edges(const Bin& bin, const SnappedVertex& a, const SnappedVertex& b,
                                   const SnappedVertex& c, BinTriangle& out) {
  typedef std::int32_t Words __attribute__((vector_size(16)));
  typedef double Values __attribute__((vector_size(32)));
  const int s = bin.widths.grid_bits, half = 1 << (s - 1);
  const Words x{a.x, b.x, c.x, 0}, y{a.y, b.y, c.y, 0};
  const Words dx = __builtin_shufflevector(x, x, 1, 2, 0, 3) - x, dy = __builtin_shufflevector(y, y, 1, 2, 0, 3) - y;
  const Words px = (bin.first_x << s) + half - x, py = (bin.first_y << s) + half - y;
  const auto value_of = [](const Words& v) HALFPLANE_LAMBDA { return __builtin_convertvector(v, Values); };
  const Words is_in = (dy < 0) | ((dy == 0) & (dx > 0));  // top or left
  Values value = value_of(dx) * value_of(py) - value_of(dy) * value_of(px) + value_of(~is_in);
  constexpr double kFar = 1 << 30;
  value *= 1.0 / static_cast<double>(std::int64_t{1} << s);
  value = value < -kFar ? Values{} - kFar : value;
  value = value > kFar - 1 ? Values{} + (kFar - 1) : value;
  const Words edge = __builtin_convertvector(value + kFar, Words) - (1 << 30);  // floor: truncated above 0
  std::memcpy(out.edge.data(), &edge, sizeof out.edge);
  std::memcpy(out.dx.data(), &dx, sizeof out.dx);
  std::memcpy(out.dy.data(), &dy, sizeof out.dy);
}

/// The four channels at once.
HALFPLANE_INLINE void set_up_colors(const Bin& bin, const SnappedVertex& a, const SnappedVertex& b,
                                    const SnappedVertex& c, const SnappedVertex& origin, const ColorFrame& f,
                                    std::int64_t R, int k, BinTriangle& out) {
  const int s = bin.widths.grid_bits, F = bin.widths.plane_fraction;
  const auto codes = [](const SnappedVertex& v) HALFPLANE_LAMBDA {
    return Channels{v.rgba[0], v.rgba[1], v.rgba[2], v.rgba[3]};
  };
  const Channels ca = codes(a), cb = bin.state.is_flat ? ca : codes(b), cc = bin.state.is_flat ? ca : codes(c);
  const Channels ab = cb - ca, ac = cc - ca;
  const auto gradient = [R, k](const Channels& numerator)
                            HALFPLANE_LAMBDA { return round_shift_channels(numerator * R, k); };
  const Channels step_x = gradient(ab * f.by - ac * f.ay), step_y = gradient(ac * f.ax - ab * f.bx);
  const Channels at_origin = bin.state.is_flat ? ca : codes(origin);
  store(out.c_anchor,
        (at_origin << F) + step_x * f.dx + step_y * f.dy + static_cast<std::int64_t>(bin.color_format.anchor_bias));
  store(out.c_tile_x, step_x << (kTileShift + s));
  store(out.c_tile_y, step_y << (kTileShift + s));
  const auto local = [&bin](const Channels& step) HALFPLANE_LAMBDA {
    return channel_pairs(round_shift_channels(step, bin.color_format.step_drop) << bin.color_format.up);
  };
  const auto smaller = [](const Channels& p, const Channels& q) HALFPLANE_LAMBDA { return p < q ? p : q; };
  const auto larger = [](const Channels& p, const Channels& q) HALFPLANE_LAMBDA { return p > q ? p : q; };
  out.color = {local(step_x), local(step_y), channel_pairs(smaller(smaller(ca, cb), cc)),
               channel_pairs(larger(larger(ca, cb), cc))};
}

/// A rectangle of one depth and one colour: no edges.
inline void set_up_flat(const Bin& bin, const SnappedVertex& v, BinTriangle& out) {
  out.edge = {};
  out.dx = out.dy = {};
  const int F = bin.widths.plane_fraction;
  out.z_anchor = static_cast<std::int64_t>((static_cast<std::uint64_t>(v.z) << F) + bin.depth_format.anchor_bias);
  out.z_tile_x = out.z_tile_y = 0;
  out.z_step_x = out.z_step_y = 0;
  out.is_gentle = true;
  out.c_tile_x = out.c_tile_y = {};
  for (std::size_t i = 0; i < 4; ++i)
    out.c_anchor[i] = static_cast<std::int64_t>((std::uint64_t{v.rgba[i]} << F) + bin.color_format.anchor_bias);
  const ChannelPairs codes = channel_pairs(Channels{v.rgba[0], v.rgba[1], v.rgba[2], v.rgba[3]});
  out.color = {{}, {}, codes, codes};
}

/// The triangle's constants; false when it has no area.
inline bool set_up(const Bin& bin, const Slice& slice, const Record& record, BinTriangle& out) {
  const SnappedVertex* v = slice.vertices.data();
  const SnappedVertex *a = v + record.v[0], *b = v + record.v[1], *c = v + record.v[2];
  out.z_low = record.z_low;
  out.z_high = record.z_high;
  if (record.kind() == RecordKind::rectangle) {
    set_up_flat(bin, *a, out);
    return true;
  }
  std::int64_t area = signed_area(*a, *b, *c);
  if (area == 0) return false;
  if (area < 0) {
    std::swap(b, c);
    area = -area;
  }
  set_up_edges(bin, *a, *b, *c, out);
  const SnappedVertex* origin = a;  // the smallest (Y, X): two in one place would leave no area
  const auto is_before = [](const SnappedVertex& p, const SnappedVertex& q) HALFPLANE_LAMBDA {
    return (std::int64_t{p.y} << 32) + p.x < (std::int64_t{q.y} << 32) + q.x;
  };
  origin = is_before(*b, *origin) ? b : origin;
  origin = is_before(*c, *origin) ? c : origin;
  const int s = bin.widths.grid_bits, F = bin.widths.plane_fraction;
  const auto anchor = [s](int first) HALFPLANE_LAMBDA {
    return (std::int64_t{first + kTileSize / 2} << s) + (std::int64_t{1} << (s - 1));
  };
  const std::int64_t dx = anchor(bin.first_x) - origin->x, dy = anchor(bin.first_y) - origin->y;
  const Reciprocal reciprocal = fast_reciprocal(area, bin.config.depth_bits + bin.config.reciprocal_extra_bits);
  const auto R = static_cast<std::int64_t>(reciprocal.value);
  const int k = reciprocal.shift - F;
  const std::int64_t ax = std::int64_t{b->x} - a->x, ay = std::int64_t{b->y} - a->y;
  const std::int64_t bx = std::int64_t{c->x} - a->x, by = std::int64_t{c->y} - a->y;
  const int to_tile = kTileShift + s;
  {
    const std::int64_t az = std::int64_t{b->z} - a->z, bz = std::int64_t{c->z} - a->z;
    const std::int64_t numerator_x = az * by - bz * ay, numerator_y = ax * bz - bx * az;
    constexpr std::int64_t kNarrow = std::int64_t{1} << 32;  // times a reciprocal of 30 bits
    const bool is_narrow = std::abs(numerator_x) < kNarrow && std::abs(numerator_y) < kNarrow;
    const auto gradient = [=](std::int64_t numerator) HALFPLANE_LAMBDA {
      return is_narrow ? round_shift(numerator * R, k)
                       : static_cast<std::int64_t>(round_shift(static_cast<int128>(numerator) * R, k));
    };
    const std::int64_t step_x = gradient(numerator_x), step_y = gradient(numerator_y);
    out.z_anchor = static_cast<std::int64_t>((static_cast<std::uint64_t>(origin->z) << F) + product(step_x, dx) +
                                             product(step_y, dy) + bin.depth_format.anchor_bias);
    out.z_tile_x = step_x << to_tile;
    out.z_tile_y = step_y << to_tile;
    const std::int64_t local_x = round_shift(step_x, bin.depth_format.step_drop),
                       local_y = round_shift(step_y, bin.depth_format.step_drop);
    out.z_step_x = static_cast<std::int32_t>(static_cast<std::uint32_t>(local_x) << bin.depth_format.up);
    out.z_step_y = static_cast<std::int32_t>(static_cast<std::uint32_t>(local_y) << bin.depth_format.up);
    // A pixel of the tile is inside the triangle; seven steps either way must stay in the window of codes.
    const auto slope = static_cast<double>(std::abs(numerator_x)) + static_cast<double>(std::abs(numerator_y));
    const std::int64_t window = (std::int64_t{1} << (bin.config.depth_bits - 1)) - 2 * kTileSize;
    out.is_gentle =
        slope * static_cast<double>((kTileSize - 1) << s) < static_cast<double>(window) * static_cast<double>(area);
  }
  set_up_colors(bin, *a, *b, *c, *origin, {ax, ay, bx, by, dx, dy}, R, k, out);
  return true;
}
