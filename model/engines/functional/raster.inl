// Setup, coarse raster, fine raster, interpolation, depth test and ROP of one bin, fused. Bits as in the stages; the
// order of the work is this engine's own:
//
//   triangle within two by two pixels  sixteen at a time through setup, then their samples
//   within two by two tiles            sixteen at a time through setup, then the blocks that each covers
//   within three by three, in a row    the same
//   larger                             its 64 tiles sixteen at a time: outside, behind, taken as a whole, or drawn
//
// A block is 4 x 4 pixels: sixteen lanes, one cache line. A tile is four of them.
//
// A tile that a triangle covers wholly, in front of all that is there, is taken without looking at a pixel: it remembers
// the triangle. Its depths and colours are computed when somebody needs them, at the end row by row: often nobody does.
// Included inside the namespace of an instruction set: see kernels.inl.

constexpr int kBlockShift = 2, kBlockSize = 1 << kBlockShift, kBlockPixels = 16;

/// Lanes as places.
struct LanePositions {
  I16 pair_x, pair_y;  ///< of two rows of eight
  I16 lane;            ///< its number
  I16 to_sign;         ///< 31 - lane: moves bit number `lane` to the sign
  I16 block_x, block_y;
  I16 block_yx;  ///< pairs: row low, column high
  /// Columns (rows) of the left and right (upper and lower) blocks of a tile, from its anchor; also in both halves.
  std::array<I16, 2> column, row, column_pair, row_pair;

  LanePositions() {
    pair_x = I16::of([](int i) { return i % 8; });
    pair_y = I16::of([](int i) { return i / 8; });
    lane = I16::of([](int i) { return i; });
    to_sign = I16::of([](int i) { return 31 - i; });
    block_x = I16::of([](int i) { return i % 4; });
    block_y = I16::of([](int i) { return i / 4; });
    block_yx = pairs(block_y, block_x);
    for (int side = 0; side < 2; ++side) {
      const auto at = static_cast<std::size_t>(side);
      column[at] = block_x + (kBlockSize * side - kTileSize / 2);
      row[at] = block_y + (kBlockSize * side - kTileSize / 2);
      column_pair[at] = pairs(column[at], column[at]);
      row_pair[at] = pairs(row[at], row[at]);
    }
  }
};

/// Made when a kernel first runs, not when the program starts: the machine may not have these instructions.
static const LanePositions& lane_positions() {
  static const LanePositions positions;
  return positions;
}

/// How the values of a tile are held and read back: in the upper bits of a lane, so that they wrap by themselves.
struct LaneFormat {
  int drop;       ///< from a plane's value at the anchor to a tile's
  int up;         ///< from a tile's value to a lane
  int down;       ///< from a lane to a code plus `bias`
  int step_drop;  ///< from a plane's step to a step of a pixel in a tile
  std::int32_t bias;
  std::uint64_t anchor_bias;

  /// `lane_bits`: of the lane.
  LaneFormat(int bits, const Width& local, int lane_bits, const Widths& widths) {
    const int guard_bits = local.bits - bits - 1;
    drop = widths.plane_fraction - guard_bits;
    up = lane_bits - local.bits;
    down = up + guard_bits;
    step_drop = drop - widths.grid_bits;
    bias = std::int32_t{1} << (bits - 1);
    anchor_bias = plane_bias(bits, widths);
  }
};

/// Two channels in the halves of a lane: red and blue, green and alpha.
using ChannelPairs = std::array<std::int32_t, 2>;

/// What the colours of a triangle have in common, in lanes.
struct ColorSteps {
  ChannelPairs step_x, step_y, low, high;  ///< of a pixel; codes of the vertices
};

/// Inclusive.
struct Box {
  std::int32_t left, top, right, bottom;
};

/// One triangle, as one bin sees it. Positions are pixels of the bin, tiles those of the bin.
struct BinTriangle {
  std::array<std::int32_t, 3> edge, dx, dy;  ///< at the bin's first pixel, held within +-2^30; steps as in Edge
  Box box;
  std::int32_t z_low, z_high;                 ///< codes of the vertices
  std::int64_t z_anchor, z_tile_x, z_tile_y;  ///< plane at the first tile's anchor; steps from tile to tile
  std::int32_t z_step_x, z_step_y;            ///< of a pixel, in a lane
  bool is_gentle;                             ///< no value of a tile that it touches wraps
  bool is_whole;                              ///< its edges alone say what it covers
  std::array<std::int64_t, 4> c_anchor, c_tile_x, c_tile_y;  ///< likewise, channel by channel
  ColorSteps color;
};

/// reciprocal() by a division in binary64, put right by its remainder: exact.
HALFPLANE_INLINE Reciprocal fast_reciprocal(std::int64_t area, int significant_bits) {
  const int shift = 63 - std::countl_zero(static_cast<std::uint64_t>(area)) + significant_bits;
  double power;
  const std::uint64_t bits = static_cast<std::uint64_t>(1023 + shift + 1) << 52;
  std::memcpy(&power, &bits, sizeof power);
  std::int64_t quotient = static_cast<std::int64_t>(power / static_cast<double>(area));
  const std::uint64_t numerator =
      shift + 1 < 64 ? std::uint64_t{2} << shift : 0;  // modulo 2^64: the remainder is small
  const auto remainder =
      static_cast<std::int64_t>(numerator - static_cast<std::uint64_t>(quotient) * static_cast<std::uint64_t>(area));
  quotient += remainder < 0 ? -1 : remainder >= area ? 1 : 0;
  return {static_cast<std::uint64_t>((quotient + 1) >> 1), shift};
}

#include "small_batch.inl"

#include "line_batch.inl"

/// A bin while its records are drawn.
class Bin {
 public:
  explicit Bin(BinJob& job)
      : job_(job),
        config_(job.frame.config),
        widths_(job.frame.widths),
        skip_(job.frame.skip),
        depth_format_(config_.depth_bits, widths_.local_depth, 32, widths_),
        color_format_(8, widths_.local_color, 16, widths_),
        first_x_(job.bin % job.frame.bins_x * kBinSize),
        first_y_(job.bin / job.frame.bins_x * kBinSize),
        are_lines_(job.target.has_whole_lines()),
        tile_low_(job.tiles.z_low.data() + std::ptrdiff_t{job.bin} * kTiles),
        tile_high_(job.tiles.z_high.data() + std::ptrdiff_t{job.bin} * kTiles),
        memory_(memory()) {
    const std::uint8_t* pending = job.tiles.pending.data() + std::ptrdiff_t{job.bin} * kTiles;
    for (int t = 0; t < kTiles; ++t) {
      depth_owner_[t] = (pending[t] & TileStates::kDepthCleared) != 0 ? kCleared : kInTarget;
      color_owner_[t] = (pending[t] & TileStates::kColorCleared) != 0 ? kCleared : kInTarget;
    }
    if (!are_lines_) fetch_ahead();
  }

  void draw() {
    for (const Slice* const at : job_.slices) {
      const Slice& slice = *at;
      const std::uint32_t* first = slice.bin_records.data() + slice.bin_first[static_cast<std::size_t>(job_.bin)];
      const std::uint32_t* last = slice.bin_records.data() + slice.bin_first[static_cast<std::size_t>(job_.bin) + 1];
      if (first == last) continue;
      state_ = slice.state;
      find_bin_range();
      falls_ = state_.depth_test == DepthFunc::less || state_.depth_test == DepthFunc::lequal;
      rises_ = state_.depth_test == DepthFunc::greater || state_.depth_test == DepthFunc::gequal;
      // Twice: for the test that nearly every scene has, and for any.
      if (state_.depth_test == DepthFunc::less)
        draw_records<DepthFunc::less>(slice, first, last);
      else
        draw_records<DepthFunc::always>(slice, first, last);
    }
    finish();
  }

 private:
  static constexpr int kTiles = kBinTiles * kBinTiles;
  static constexpr std::size_t kPlanes = 256;  ///< triangles that wait at most: more than two for each tile
  static constexpr std::uint8_t kTouches = 4;  ///< batches of small triangles after which a tile's range is found anew
  // Who holds a tile's depths or colours; 0 and more: a triangle of planes_.
  static constexpr std::int32_t kInMemory = -1, kCleared = -2, kInTarget = -3;

  /// The pixels of a bin: tile after tile, block after block, row after row.
  struct Memory {
    alignas(64) std::array<std::int32_t, kBinSize * kBinSize> depth;
    alignas(64) std::array<std::uint32_t, kBinSize * kBinSize> color;
    alignas(64) std::array<BinTriangle, kPlanes> planes;
  };
  static Memory& memory() {
    static thread_local Memory memory;
    return memory;
  }

  /// The bin's part of the target is asked for now: it is written at the end, and comes from far away.
  void fetch_ahead() const {
    constexpr int kLine = 16;  // pixels
    const int rows = std::min(kBinSize, job_.target.height - first_y_),
              columns = std::min(kBinSize, job_.target.width - first_x_);
    for (int y = 0; y < rows; ++y) {
      const std::size_t at = job_.target.at(first_x_, first_y_ + y);
      for (int x = 0; x < columns + kLine - 1; x += kLine) {
        const std::size_t pixel = at + static_cast<std::size_t>(std::min(x, columns - 1));
        __builtin_prefetch(job_.target.depth.data() + pixel, 1, 2);
        __builtin_prefetch(job_.target.color.data() + pixel, 1, 2);
      }
    }
  }

  // --- which records ------------------------------------------------------------------------------------------------

  template <DepthFunc Test>
  void draw_records(const Slice& slice, const std::uint32_t* first, const std::uint32_t* last) {
    line_tiles_ = 0;
    constexpr std::ptrdiff_t kAhead = 8;
    for (; first != last; ++first) {
      const Record& record = slice.records[*first];
      if (last - first > kAhead) {
        const Record& next = slice.records[first[kAhead]];
        __builtin_prefetch(&next);
        if (const Record& near = slice.records[first[kAhead / 2]]; near.kind() == RecordKind::whole_line)
          for (std::size_t k = 0; k < 2; ++k) __builtin_prefetch(&slice.vertices[near.v[k]]);
      }
      const auto box = [&]() HALFPLANE_LAMBDA {
        return Box{std::max(record.left() - first_x_, 0), std::max(record.top() - first_y_, 0),
                   std::min(record.right() - first_x_, kBinSize - 1),
                   std::min(record.bottom() - first_y_, kBinSize - 1)};
      };
      const auto leave_out = [&](const Box& at) {
        const auto tiles = static_cast<unsigned>(((at.right >> kTileShift) - (at.left >> kTileShift) + 1) *
                                                 ((at.bottom >> kTileShift) - (at.top >> kTileShift) + 1));
        job_.counters.tiles_visited += tiles;
        job_.counters.skipped.tiles_hiz += tiles;
      };
      if (skip_.tiles_hiz && is_behind<Test>(record, bin_low_, bin_high_)) {
        leave_out(box());
        continue;
      }
      // A batch pays for medium triangles from the third in a row on.
      constexpr int kAlone = 2;
      const bool is_medium = record.has(Record::kMedium);
      small_run_ = is_medium ? small_run_ + 1 : 0;
      if (record.has(Record::kSmall) || (is_medium && small_run_ > kAlone)) {
        // Nearer than what every tile may hold: no need to look at its own.
        if (skip_.tiles_hiz && (Test != DepthFunc::less || record.z_low >= bin_lowest_high_)) {
          const Box at = box();
          const int a = tile_of(at.left, at.top), b = tile_of(at.right, at.top), c = tile_of(at.left, at.bottom),
                    d = tile_of(at.right, at.bottom);
          const bool is_over_two = b > a + 1 || c > a + kBinTiles;
          const std::int32_t low = std::min({tile_low_[a], tile_low_[b], tile_low_[c], tile_low_[d]});
          const std::int32_t high = std::max({tile_high_[a], tile_high_[b], tile_high_[c], tile_high_[d]});
          if (is_over_two ? is_behind_tiles<Test>(record, at) : is_behind<Test>(record, low, high)) {
            leave_out(at);
            continue;
          }
        }
        if (small_.add(record)) draw_batch<Test>(slice);
        continue;
      }
      if (record.kind() == RecordKind::whole_line) {
        if (lines_.add(record)) draw_lines<Test>(slice);
        continue;
      }
      draw_batch<Test>(slice);
      draw_lines<Test>(slice);
      if (record.kind() == RecordKind::cut_line) {
        draw_cut_line<Test>(slice.lines[record.v[0]]);
        continue;
      }
      BinTriangle triangle;
      triangle.box = box();
      triangle.is_whole = record.has(Record::kWhole);
      // Nearer than all of the bin: no need to look at its tiles.
      const bool may_be_behind = Test != DepthFunc::less || record.z_low >= bin_low_;
      if (skip_.tiles_hiz && may_be_behind && is_behind_tiles<Test>(record, triangle.box)) {
        leave_out(triangle.box);
        if (may_be_lower_) find_bin_range();  // what follows may lie behind all of it
        continue;
      }
      if (set_up(slice, record, triangle) && !record.has(Record::kDrawsNothing)) draw_large<Test>(triangle);
    }
    draw_batch<Test>(slice);
    draw_lines<Test>(slice);
  }

  static int tile_of(int x, int y) { return (y >> kTileShift) * kBinTiles + (x >> kTileShift); }

  /// Whether no depth in [record.z_low, record.z_high] passes against one in [low, high].
  template <DepthFunc Test>
  bool is_behind(const Record& record, std::int32_t low, std::int32_t high) const {
    if (Test == DepthFunc::less) return record.z_low >= high;
    switch (state_.depth_test) {
      case DepthFunc::less: return record.z_low >= high;
      case DepthFunc::lequal: return record.z_low > high;
      case DepthFunc::greater: return record.z_high <= low;
      case DepthFunc::gequal: return record.z_high < low;
      case DepthFunc::equal: return record.z_low > high || record.z_high < low;
      case DepthFunc::never: return true;
      default: return false;
    }
  }

  /// The same for all tiles of a box.
  template <DepthFunc Test>
  HALFPLANE_INLINE bool is_behind_tiles(const Record& record, const Box& box) const {
    const int left = box.left >> kTileShift, right = box.right >> kTileShift, top = box.top >> kTileShift,
              bottom = box.bottom >> kTileShift;
    const I16 is_column = (position_.pair_x >= left) & (position_.pair_x <= right);
    I16 low(0x7fffffff), high(-1);
    for (int row = top & ~1; row <= bottom; row += 2) {
      const I16 y = position_.pair_y + row, is_in = is_column & (y >= top) & (y <= bottom);
      high = max(high, select(is_in, I16::load(tile_high_ + row * kBinTiles), I16(-1)));
      if (Test != DepthFunc::less)
        low = min(low, select(is_in, I16::load(tile_low_ + row * kBinTiles), I16(0x7fffffff)));
    }
    return is_behind<Test>(record, Test == DepthFunc::less ? 0 : min_lane(low), max_lane(high));
  }

  // --- setup --------------------------------------------------------------------------------------------------------

  /// The triangle's constants; false when it has no area.
  bool set_up(const Slice& slice, const Record& record, BinTriangle& out) const {
    const SnappedVertex* v = slice.vertices.data();
    const SnappedVertex *a = v + record.v[0], *b = v + record.v[1], *c = v + record.v[2];
    out.z_low = record.z_low;
    out.z_high = record.z_high;
    if (record.kind() == RecordKind::rectangle) {
      set_up_flat(*a, out);
      return true;
    }
    std::int64_t area = signed_area(*a, *b, *c);
    if (area == 0) return false;
    if (area < 0) {
      std::swap(b, c);
      area = -area;
    }
    set_up_edges(*a, *b, *c, out);
    const SnappedVertex* origin = a;  // the smallest (Y, X): two in one place would leave no area
    const auto is_before = [](const SnappedVertex& p, const SnappedVertex& q) HALFPLANE_LAMBDA {
      return (std::int64_t{p.y} << 32) + p.x < (std::int64_t{q.y} << 32) + q.x;
    };
    origin = is_before(*b, *origin) ? b : origin;
    origin = is_before(*c, *origin) ? c : origin;
    const int s = widths_.grid_bits, F = widths_.plane_fraction;
    const auto anchor = [s](int first) HALFPLANE_LAMBDA {
      return (std::int64_t{first + kTileSize / 2} << s) + (std::int64_t{1} << (s - 1));
    };
    const std::int64_t dx = anchor(first_x_) - origin->x, dy = anchor(first_y_) - origin->y;
    const Reciprocal reciprocal = fast_reciprocal(area, config_.depth_bits + config_.reciprocal_extra_bits);
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
                                               product(step_y, dy) + depth_format_.anchor_bias);
      out.z_tile_x = step_x << to_tile;
      out.z_tile_y = step_y << to_tile;
      const std::int64_t local_x = round_shift(step_x, depth_format_.step_drop),
                         local_y = round_shift(step_y, depth_format_.step_drop);
      out.z_step_x = static_cast<std::int32_t>(static_cast<std::uint32_t>(local_x) << depth_format_.up);
      out.z_step_y = static_cast<std::int32_t>(static_cast<std::uint32_t>(local_y) << depth_format_.up);
      // A pixel of the tile is inside the triangle; seven steps either way must stay in the window of codes.
      const auto slope = static_cast<double>(std::abs(numerator_x)) + static_cast<double>(std::abs(numerator_y));
      const std::int64_t window = (std::int64_t{1} << (config_.depth_bits - 1)) - 2 * kTileSize;
      out.is_gentle =
          slope * static_cast<double>((kTileSize - 1) << s) < static_cast<double>(window) * static_cast<double>(area);
    }
    set_up_colors(*a, *b, *c, *origin, {ax, ay, bx, by, dx, dy}, R, k, out);
    return true;
  }

  static std::uint64_t product(std::int64_t a, std::int64_t b) {
    return static_cast<std::uint64_t>(a) * static_cast<std::uint64_t>(b);
  }

  /// The three edges at once: edge_function(), whose values binary64 holds. Inside a bin they move by less than 2^30:
  /// beyond that a sign is the same everywhere.
  HALFPLANE_INLINE void set_up_edges(const SnappedVertex& a, const SnappedVertex& b, const SnappedVertex& c,
                                     BinTriangle& out) const {
    typedef std::int32_t Words __attribute__((vector_size(16)));
    typedef double Values __attribute__((vector_size(32)));
    const int s = widths_.grid_bits, half = 1 << (s - 1);
    const Words x{a.x, b.x, c.x, 0}, y{a.y, b.y, c.y, 0};
    const Words dx = __builtin_shufflevector(x, x, 1, 2, 0, 3) - x, dy = __builtin_shufflevector(y, y, 1, 2, 0, 3) - y;
    const Words px = (first_x_ << s) + half - x, py = (first_y_ << s) + half - y;
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

  struct ColorFrame {
    std::int64_t ax, ay, bx, by, dx, dy;
  };

  /// A number for each channel.
  typedef std::int64_t Channels __attribute__((vector_size(32)));
  HALFPLANE_INLINE static Channels load(const std::array<std::int64_t, 4>& from) {
    typedef std::int64_t InMemory __attribute__((vector_size(32), aligned(8), may_alias));
    return *reinterpret_cast<const InMemory*>(from.data());
  }
  HALFPLANE_INLINE static void store(std::array<std::int64_t, 4>& to, const Channels& value) {
    typedef std::int64_t InMemory __attribute__((vector_size(32), aligned(8), may_alias));
    *reinterpret_cast<InMemory*>(to.data()) = value;
  }
  /// Of the lower halves: red with blue, green with alpha.
  HALFPLANE_INLINE static ChannelPairs channel_pairs(const Channels& value) {
    typedef std::int32_t Codes __attribute__((vector_size(16)));
    const Codes code = __builtin_convertvector(value, Codes);
    const Codes pair = (code & 0xffff) | __builtin_shufflevector(code, code, 2, 3, 0, 1) << 16;
    return {pair[0], pair[1]};
  }
  /// round_shift(). The lanes have no signed shift: what is left of the sign bit goes through all bits above it.
  HALFPLANE_INLINE static Channels round_shift_channels(const Channels& value, int bits) {
    if (bits <= 0) return value << -bits;
    typedef std::uint64_t Unsigned __attribute__((vector_size(32)));
    const Channels half = (Channels)((Unsigned)value >> (bits - 1)) & 1;
    const auto sign = static_cast<std::int64_t>(std::uint64_t{1} << (63 - bits));
    return (((Channels)((Unsigned)value >> bits)) ^ sign) - sign + half;
  }

  /// The four channels at once.
  HALFPLANE_INLINE void set_up_colors(const SnappedVertex& a, const SnappedVertex& b, const SnappedVertex& c,
                                      const SnappedVertex& origin, const ColorFrame& f, std::int64_t R, int k,
                                      BinTriangle& out) const {
    const int s = widths_.grid_bits, F = widths_.plane_fraction;
    const auto codes = [](const SnappedVertex& v) HALFPLANE_LAMBDA {
      return Channels{v.rgba[0], v.rgba[1], v.rgba[2], v.rgba[3]};
    };
    const Channels ca = codes(a), cb = state_.is_flat ? ca : codes(b), cc = state_.is_flat ? ca : codes(c);
    const Channels ab = cb - ca, ac = cc - ca;
    const auto gradient = [R, k](const Channels& numerator)
                              HALFPLANE_LAMBDA { return round_shift_channels(numerator * R, k); };
    const Channels step_x = gradient(ab * f.by - ac * f.ay), step_y = gradient(ac * f.ax - ab * f.bx);
    const Channels at_origin = state_.is_flat ? ca : codes(origin);
    store(out.c_anchor, (at_origin << F) + step_x * f.dx + step_y * f.dy +
                            static_cast<std::int64_t>(color_format_.anchor_bias));
    store(out.c_tile_x, step_x << (kTileShift + s));
    store(out.c_tile_y, step_y << (kTileShift + s));
    const auto local = [this](const Channels& step) HALFPLANE_LAMBDA {
      return channel_pairs(round_shift_channels(step, color_format_.step_drop) << color_format_.up);
    };
    const auto smaller = [](const Channels& p, const Channels& q) HALFPLANE_LAMBDA { return p < q ? p : q; };
    const auto larger = [](const Channels& p, const Channels& q) HALFPLANE_LAMBDA { return p > q ? p : q; };
    out.color = {local(step_x), local(step_y), channel_pairs(smaller(smaller(ca, cb), cc)),
                 channel_pairs(larger(larger(ca, cb), cc))};
  }

  /// A rectangle of one depth and one colour: no edges.
  void set_up_flat(const SnappedVertex& v, BinTriangle& out) const {
    out.edge = {};
    out.dx = out.dy = {};
    const int F = widths_.plane_fraction;
    out.z_anchor = static_cast<std::int64_t>((static_cast<std::uint64_t>(v.z) << F) + depth_format_.anchor_bias);
    out.z_tile_x = out.z_tile_y = 0;
    out.z_step_x = out.z_step_y = 0;
    out.is_gentle = true;
    out.c_tile_x = out.c_tile_y = {};
    for (std::size_t i = 0; i < 4; ++i)
      out.c_anchor[i] = static_cast<std::int64_t>((std::uint64_t{v.rgba[i]} << F) + color_format_.anchor_bias);
    const ChannelPairs codes = channel_pairs(Channels{v.rgba[0], v.rgba[1], v.rgba[2], v.rgba[3]});
    out.color = {{}, {}, codes, codes};
  }

  // --- values of a tile ---------------------------------------------------------------------------------------------

  /// The depth at a tile's anchor, in a lane.
  HALFPLANE_INLINE std::int32_t depth_anchor(const BinTriangle& t, int tile_x, int tile_y) const {
    const auto value =
        static_cast<std::uint64_t>(t.z_anchor) + product(t.z_tile_x, tile_x) + product(t.z_tile_y, tile_y);
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(static_cast<std::int64_t>(value) >> depth_format_.drop)
                                     << depth_format_.up);
  }
  HALFPLANE_INLINE ChannelPairs color_anchor(const BinTriangle& t, int tile_x, int tile_y) const {
    typedef std::uint64_t Unsigned __attribute__((vector_size(32)));
    const Channels value = load(t.c_anchor) + load(t.c_tile_x) * tile_x + load(t.c_tile_y) * tile_y;
    return channel_pairs((Channels)((Unsigned)value >> color_format_.drop << color_format_.up));
  }

  HALFPLANE_INLINE static I16 decode(const I16& value, const LaneFormat& format, const I16& low, const I16& high) {
    return min(max(shift_right_logical(value, format.down) - format.bias, low), high);
  }

  template <DepthFunc Test>
  HALFPLANE_INLINE I16 passes(const I16& depth, const I16& stored) const {
    if (Test == DepthFunc::less) return depth < stored;
    switch (state_.depth_test) {
      case DepthFunc::less: return depth < stored;
      case DepthFunc::lequal: return depth <= stored;
      case DepthFunc::greater: return depth > stored;
      case DepthFunc::gequal: return depth >= stored;
      case DepthFunc::equal: return depth == stored;
      case DepthFunc::notequal: return depth != stored;
      case DepthFunc::always: return I16(-1);
      default: return I16(0);
    }
  }

  /// The same for one fragment.
  template <DepthFunc Test>
  HALFPLANE_INLINE bool passes_one(std::int32_t depth, std::int32_t stored) const {
    return depth_passes(Test == DepthFunc::less ? Test : state_.depth_test, static_cast<std::uint32_t>(depth),
                        static_cast<std::uint32_t>(stored));
  }

  /// A plane over a tile: its first block, and the steps from there to the blocks on the right and below.
  template <class Lanes>
  struct BlockRamp {
    Lanes first, right, below;

    HALFPLANE_INLINE Lanes operator()(std::size_t block) const {
      const Lanes upper = (block & 1) != 0 ? first + right : first;
      return (block >> 1) != 0 ? upper + below : upper;
    }
  };
  using ColorRamp = std::array<BlockRamp<S32>, 2>;

  HALFPLANE_INLINE BlockRamp<I16> depth_ramp(const BinTriangle& t, std::int32_t anchor) const {
    return {position_.column[0] * t.z_step_x + position_.row[0] * t.z_step_y + anchor, I16(kBlockSize * t.z_step_x),
            I16(kBlockSize * t.z_step_y)};
  }
  HALFPLANE_INLINE ColorRamp color_ramp(const ColorSteps& t, const ChannelPairs& anchor) const {
    ColorRamp ramp;
    for (std::size_t p = 0; p < 2; ++p) {
      const auto step_x = as<S32>(I16(t.step_x[p])), step_y = as<S32>(I16(t.step_y[p]));
      ramp[p] = {as<S32>(position_.column_pair[0]) * step_x + as<S32>(position_.row_pair[0]) * step_y +
                     as<S32>(I16(anchor[p])),
                 step_x << kBlockShift, step_y << kBlockShift};
    }
    return ramp;
  }

  /// Depths in block 0...3 of a tile.
  HALFPLANE_INLINE I16 depths(const BinTriangle& t, const BlockRamp<I16>& ramp, std::size_t block) const {
    return decode(ramp(block), depth_format_, t.z_low, t.z_high);
  }
  /// Packed colours.
  HALFPLANE_INLINE static I16 colors(const ColorSteps& t, const ColorRamp& ramp, std::size_t block,
                                     const LaneFormat& format, ColorFormat pixels) {
    const auto pair = [&](std::size_t p) HALFPLANE_LAMBDA {
      return color_codes(ramp[p](block), I16(t.low[p]), I16(t.high[p]), format);
    };
    return packed(pair(0), pair(1), pixels);
  }

  /// Two channels' codes, in the halves of each lane, as everything here: columns and rows from the anchor.
  [[nodiscard]] HALFPLANE_INLINE I16 channel_codes(const I16& column, const I16& row, const I16& step_x,
                                                   const I16& step_y, const I16& anchor, const I16& low,
                                                   const I16& high) const {
    return color_codes(as<S32>(column) * as<S32>(step_x) + as<S32>(row) * as<S32>(step_y) + as<S32>(anchor), low, high,
                       color_format_);
  }
  [[nodiscard]] HALFPLANE_INLINE static I16 color_codes(const S32& value, const I16& low, const I16& high,
                                                        const LaneFormat& format) {
    const S32 code = shift_right_logical(value, format.down) - static_cast<std::int16_t>(format.bias);
    return as<I16>(min(max(code, as<S32>(low)), as<S32>(high)));
  }

  /// Codes of 8 bits, red with blue and green with alpha, as the target has them.
  [[nodiscard]] HALFPLANE_INLINE static I16 packed(const I16& red_blue, const I16& green_alpha, ColorFormat format) {
    if (format == ColorFormat::rgba8888) return red_blue | green_alpha << 8;
    // 16 bits suffice: 255 * 253 + 1014 < 2^16.
    const auto rounded = [](const I16& codes, std::int16_t factor, std::int16_t addend, int drop) HALFPLANE_LAMBDA {
      return as<I16>(shift_right_logical(as<S32>(codes) * factor + addend, drop));
    };
    return multiply_add_pairs(rounded(red_blue, 249, 1014, 11), I16(1 << 16 | 1 << 11)) |
           multiply_add_pairs(rounded(green_alpha, 253, 505, 10), I16(1 << 5));
  }
  /// R lowest, A highest.
  [[nodiscard]] HALFPLANE_INLINE static I16 packed(const I16& rgba, ColorFormat format) {
    return packed(rgba & 0xff00ff, shift_right_logical(rgba, 8) & 0xff00ff, format);
  }

  // --- memory -------------------------------------------------------------------------------------------------------

  /// First pixel of a tile in the bin's memory.
  static int first_of(int tile) { return tile * kTileSize * kTileSize; }

  /// First pixels of the blocks in the bin's memory: what a column of blocks adds, and a row.
  using BlockPlaces = std::array<std::int32_t, kBinSize / kBlockSize>;
  static constexpr BlockPlaces kColumnPlaces = [] {
    BlockPlaces places{};
    for (std::size_t i = 0; i < places.size(); ++i)
      places[i] = static_cast<std::int32_t>((i >> 1) * kTileSize * kTileSize + (i & 1) * kBlockPixels);
    return places;
  }();
  static constexpr BlockPlaces kRowPlaces = [] {
    BlockPlaces places{};
    for (std::size_t i = 0; i < places.size(); ++i)
      places[i] = static_cast<std::int32_t>((i >> 1) * kBinTiles * kTileSize * kTileSize + (i & 1) * 2 * kBlockPixels);
    return places;
  }();

  /// Where pixel (x, y) of the bin is in its memory.
  HALFPLANE_INLINE static I16 place_of(const I16& x, const I16& y) {
    return (((x & 56) << 3) | ((x & 4) << 2) | (x & 3)) + (((y & 56) << 6) | ((y & 4) << 3) | ((y & 3) << 2));
  }

  /// First pixel of a tile in the target, or none where the bin hangs over it.
  [[nodiscard]] std::ptrdiff_t in_target(int tile) const {
    const int x = first_x_ + tile % kBinTiles * kTileSize, y = first_y_ + tile / kBinTiles * kTileSize;
    if (x >= job_.target.width || y >= job_.target.height) return -1;
    return static_cast<std::ptrdiff_t>(job_.target.at(x, y));
  }

  /// Makes the tile's depths be in memory.
  HALFPLANE_INLINE void need_depth(int tile) {
    if (depth_owner_[tile] != kInMemory) fetch_depth(tile);
  }
  HALFPLANE_INLINE void need_color(int tile) {
    if (color_owner_[tile] != kInMemory) fetch_color(tile);
  }

  HALFPLANE_NOINLINE void fetch_depth(int tile) {
    std::int32_t* to = memory_.depth.data() + first_of(tile);
    const std::int32_t owner = depth_owner_[tile];
    if (owner >= 0) {
      const TileBlocks blocks = depths_of(tile);
      for (std::size_t i = 0; i < 4; ++i) blocks[i].store(to + kBlockPixels * i);
      depth_owner_[tile] = kInMemory;
      return;
    }
    fetch(to, tile, owner == kCleared, job_.clear_depth, job_.target.depth);
    depth_owner_[tile] = kInMemory;
  }

  HALFPLANE_NOINLINE void fetch_color(int tile) {
    std::uint32_t* to = memory_.color.data() + first_of(tile);
    const std::int32_t owner = color_owner_[tile];
    if (owner >= 0) {
      const TileBlocks blocks = colors_of(tile);
      for (std::size_t i = 0; i < 4; ++i) blocks[i].store(to + kBlockPixels * i);
      color_owner_[tile] = kInMemory;
      return;
    }
    fetch(to, tile, owner == kCleared, job_.clear_color, job_.target.color);
    color_owner_[tile] = kInMemory;
  }

  template <class Element>
  void fetch(Element* to, int tile, bool is_cleared, std::uint32_t clear,
             const Framebuffer::Image& image) const {
    const std::ptrdiff_t from = in_target(tile);
    for (int block = 0; block < 4; ++block) {
      const std::ptrdiff_t at =
          from + (block >> 1) * kBlockSize * std::ptrdiff_t{job_.target.stride} + (block & 1) * kBlockSize;
      const I16 value = is_cleared || from < 0 ? I16(static_cast<std::int32_t>(clear))
                                               : load_block(image.data() + at, job_.target.stride);
      value.store(to + kBlockPixels * block);
    }
  }

  void find_bin_range() {
    may_be_lower_ = false;
    I16 low = I16::load(tile_low_), high = I16::load(tile_high_), lowest_high = high;
    for (int t = 16; t < kTiles; t += 16) {
      const I16 highs = I16::load(tile_high_ + t);
      low = min(low, I16::load(tile_low_ + t));
      high = max(high, highs);
      lowest_high = min(lowest_high, highs);
    }
    bin_low_ = min_lane(low);
    bin_high_ = max_lane(high);
    bin_lowest_high_ = min_lane(lowest_high);
  }

  /// The range of a tile's depths, from its pixels.
  HALFPLANE_INLINE void find_range(int tile) {
    const std::int32_t* from = memory_.depth.data() + first_of(tile);
    I16 low = I16::load(from), high = low;
    for (int block = 1; block < 4; ++block) {
      const I16 depth = I16::load(from + kBlockPixels * block);
      low = min(low, depth);
      high = max(high, depth);
    }
    tile_low_[tile] = min_lane(low);
    tile_high_[tile] = max_lane(high);
  }

  /// A tile may now hold any depths beside what it held. A store, not a minimum: the next triangle of the tile need not
  /// wait for it.
  template <DepthFunc Test>
  HALFPLANE_INLINE void forget_range(int tile) {
    if (Test == DepthFunc::less || !rises_) tile_low_[tile] = 0;
    if (Test != DepthFunc::less && !falls_) tile_high_[tile] = 0x7fffffff;
  }

  // --- fragments ----------------------------------------------------------------------------------------------------

  void count(std::uint64_t covered, std::uint64_t passed) {
    Counters& counters = job_.counters;
    counters.covered += covered;
    counters.depth_passed += passed;
    if (state_.depth_write || state_.color_write) counters.written += passed;
    if (skip_.fragments_early_z) counters.skipped.fragments_early_z += covered - passed;
  }

#include "small.inl"

  // --- tiles --------------------------------------------------------------------------------------------------------

  /// A pair of rows of tiles, one a lane.
  struct TileLanes {
    I16 live, full;           ///< to be looked at; wholly covered
    I16 z_low, z_high;        ///< range of the triangle's depths
    std::array<I16, 3> edge;  ///< at the tiles' first pixels
  };

  /// What the pairs of rows of a triangle have in common. Of the depths at the tiles' anchors the bits below `drop`
  /// only carry: where their sums fit 32 bits, that is all that a lane needs.
  struct TileRows {
    std::array<std::int32_t, 3> outside, cut;  ///< from a tile's first pixel to where an edge is largest, smallest
    std::array<std::int32_t, 3> edge_step;     ///< from a row of tiles to the next
    std::array<I16, 3> edge;   ///< of the first pair of rows
    I16 beside;                ///< signs: columns without a pixel of the box
    std::int32_t to_low, to_high;  ///< from an anchor
    bool is_narrow;
    I16 upper, lower;  ///< depth at the anchors of row 0
    std::int32_t upper_step, lower_step;
    I16 z_low, z_high;
  };

  HALFPLANE_INLINE TileRows tile_rows(const BinTriangle& t) const {
    TileRows rows;
    constexpr int kExtent = kTileSize - 1, kSumBits = 4;  // sums of 7 + 7 + 1
    const I16 x = position_.pair_x * kTileSize, y = position_.pair_y * kTileSize;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int32_t dx = t.dx[i], dy = t.dy[i];
      rows.edge[i] = y * dx - x * dy + t.edge[i];
      rows.edge_step[i] = kTileSize * dx;
      rows.outside[i] = kExtent * (std::max(dx, 0) + std::max(-dy, 0));
      rows.cut[i] = kExtent * (std::min(dx, 0) + std::min(-dy, 0));
    }
    rows.beside = (x + (kExtent - t.box.left)) | (t.box.right - x);
    // From the anchor a tile reaches four pixels to the left and up, three to the right and down.
    const auto reach = [](std::int32_t step, bool is_high) HALFPLANE_LAMBDA {
      return (step > 0) == is_high ? (kTileSize / 2 - 1) * step : -kTileSize / 2 * step;
    };
    rows.to_low = reach(t.z_step_x, false) + reach(t.z_step_y, false);
    rows.to_high = reach(t.z_step_x, true) + reach(t.z_step_y, true);
    const int drop = depth_format_.drop;
    rows.is_narrow = drop + kSumBits <= 32;
    if (rows.is_narrow) {
      const auto upper = [drop](std::int64_t v) HALFPLANE_LAMBDA { return static_cast<std::int32_t>(v >> drop); };
      const auto lower = [drop](std::int64_t v) HALFPLANE_LAMBDA {
        return static_cast<std::int32_t>(v & ((std::int64_t{1} << drop) - 1));
      };
      rows.upper_step = upper(t.z_tile_y);
      rows.lower_step = lower(t.z_tile_y);
      rows.upper = position_.pair_x * upper(t.z_tile_x) + position_.pair_y * rows.upper_step + upper(t.z_anchor);
      rows.lower = position_.pair_x * lower(t.z_tile_x) + position_.pair_y * rows.lower_step + lower(t.z_anchor);
    }
    rows.z_low = I16(t.z_low);
    rows.z_high = I16(t.z_high);
    return rows;
  }

  HALFPLANE_INLINE TileLanes classify_tiles(const BinTriangle& t, const TileRows& rows, int row) {
    TileLanes lanes;
    constexpr int kExtent = kTileSize - 1;
    I16 outside(0), cut(0);
    for (std::size_t i = 0; i < 3; ++i) {
      lanes.edge[i] = rows.edge[i] + row * rows.edge_step[i];
      outside |= lanes.edge[i] + rows.outside[i];
      cut |= lanes.edge[i] + rows.cut[i];
    }
    const I16 y = position_.pair_y * kTileSize + row * kTileSize;
    const I16 apart = rows.beside | (y + (kExtent - t.box.top)) | (t.box.bottom - y);  // from the box
    if (!t.is_whole) {
      const I16 x = position_.pair_x * kTileSize;
      cut |= (x - t.box.left) | ((t.box.right - kExtent) - x) | (y - t.box.top) | ((t.box.bottom - kExtent) - y);
    }
    const std::uint32_t box = ~bits_of(apart) & 0xffff;
    outside |= apart;
    job_.counters.tiles_visited += static_cast<unsigned>(std::popcount(box));
    if (skip_.tiles_outside) {
      job_.counters.skipped.tiles_outside += static_cast<unsigned>(std::popcount(bits_of(outside) & box));
      lanes.live = ~(outside >> 31);
    } else {
      lanes.live = ~(apart >> 31);
    }
    lanes.full = ~((outside | cut) >> 31);
    lanes.z_low = rows.z_low;
    lanes.z_high = rows.z_high;
    if (t.is_gentle) {
      const I16 anchor = depth_anchors(t, rows, row);
      lanes.z_low = decode(anchor + rows.to_low, depth_format_, rows.z_low, rows.z_high);
      lanes.z_high = decode(anchor + rows.to_high, depth_format_, rows.z_low, rows.z_high);
    }
    return lanes;
  }

  /// The depths at the anchors of a pair of rows of tiles, in lanes.
  HALFPLANE_INLINE I16 depth_anchors(const BinTriangle& t, const TileRows& rows, int row) const {
    if (rows.is_narrow)
      return (rows.upper + row * rows.upper_step +
              shift_right_logical(rows.lower + row * rows.lower_step, depth_format_.drop))
             << depth_format_.up;
    const L16 value = convert<std::int64_t>(position_.pair_x) * t.z_tile_x +
                      convert<std::int64_t>(position_.pair_y + row) * t.z_tile_y + t.z_anchor;
    return convert<std::int32_t>(shift_right_logical(value, depth_format_.drop)) << depth_format_.up;
  }

  /// Tiles where no fragment passes, and tiles where all do.
  template <DepthFunc Test>
  HALFPLANE_INLINE void compare_ranges(const TileLanes& lanes, const I16& low, const I16& high, I16& behind,
                                       I16& front) const {
    behind = front = I16(0);
    switch (Test == DepthFunc::less ? Test : state_.depth_test) {
      case DepthFunc::less: behind = lanes.z_low >= high, front = lanes.z_high < low; break;
      case DepthFunc::lequal: behind = lanes.z_low > high, front = lanes.z_high <= low; break;
      case DepthFunc::greater: behind = lanes.z_high <= low, front = lanes.z_low > high; break;
      case DepthFunc::gequal: behind = lanes.z_high < low, front = lanes.z_low >= high; break;
      case DepthFunc::equal: behind = (lanes.z_low > high) | (lanes.z_high < low); break;
      case DepthFunc::notequal: front = (lanes.z_low > high) | (lanes.z_high < low); break;
      case DepthFunc::always: front = I16(-1); break;
      case DepthFunc::never: behind = I16(-1); break;
    }
  }

  template <DepthFunc Test>
  void draw_large(const BinTriangle& t) {
    std::int32_t plane = -1;
    line_tiles_ = 0;
    const TileRows rows = tile_rows(t);
    bool is_changed = false;
    for (int row = t.box.top >> kTileShift & ~1; row <= t.box.bottom >> kTileShift; row += 2) {
      TileLanes lanes = classify_tiles(t, rows, row);
      std::int32_t* low = tile_low_ + row * kBinTiles;
      std::int32_t* high = tile_high_ + row * kBinTiles;
      const I16 stored_low = I16::load(low), stored_high = I16::load(high);
      I16 behind, front;
      compare_ranges<Test>(lanes, stored_low, stored_high, behind, front);
      if (skip_.tiles_hiz) {
        job_.counters.skipped.tiles_hiz += static_cast<unsigned>(std::popcount(bits_of(lanes.live & behind)));
        lanes.live &= ~behind;
      }
      I16 taken(0);
      if (skip_.attributes && skip_.trivially_accepted && (state_.depth_write || state_.color_write)) {
        taken = lanes.live & lanes.full & front;
        if (is_any(taken)) take_tiles(t, row, taken, lanes, plane);
      }
      const std::uint32_t full_bits = bits_of(lanes.full);
      const std::uint32_t live_bits = bits_of(lanes.live);
      is_changed |= live_bits != 0;
      std::uint32_t rest = live_bits & ~bits_of(taken);
      if (rest == 0) continue;
      struct {
        std::array<std::array<std::int32_t, 16>, 3> edge;
      } lane;
      for (std::size_t e = 0; e < 3; ++e) lanes.edge[e].store(lane.edge[e].data());
      for (; rest != 0; rest &= rest - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(rest));
        const bool is_full = skip_.trivially_accepted && (full_bits >> i & 1) != 0;
        draw_tile<Test>(t, row * kBinTiles + static_cast<int>(i), is_full,
                        {lane.edge[0][i], lane.edge[1][i], lane.edge[2][i]});
      }
    }
    if (!is_changed || !state_.depth_write) return;
    if (Test != DepthFunc::less) return find_bin_range();
    // An upper bound that only falls: the old one will do.
    bin_low_ = std::min(bin_low_, t.z_low);
    may_be_lower_ = true;
  }

  /// Tiles that the triangle takes as a whole.
  HALFPLANE_INLINE void take_tiles(const BinTriangle& t, int row, const I16& taken, const TileLanes& lanes,
                                   std::int32_t& plane) {
    if (plane < 0) {
      if (plane_count_ == kPlanes) drop_planes();
      plane = static_cast<std::int32_t>(plane_count_);
      memory_.planes[plane_count_++] = t;
    }
    const auto replace = [&](std::int32_t* at, const I16& with)
                             HALFPLANE_LAMBDA { select(taken, with, I16::load(at)).store(at); };
    in_memory_ &= ~(std::uint64_t{bits_of(taken)} << (row * kBinTiles));
    if (state_.depth_write) {
      replace(depth_owner_.data() + row * kBinTiles, I16(plane));
      replace(tile_low_ + row * kBinTiles, lanes.z_low);
      replace(tile_high_ + row * kBinTiles, lanes.z_high);
    }
    if (state_.color_write) {
      const I16 owner = I16::load(color_owner_.data() + row * kBinTiles);
      job_.counters.skipped.attributes += 64 * static_cast<unsigned>(std::popcount(bits_of(taken & ~(owner >> 31))));
      replace(color_owner_.data() + row * kBinTiles, I16(plane));
    }
    const std::uint64_t pixels = 64 * static_cast<std::uint64_t>(std::popcount(bits_of(taken)));
    job_.counters.skipped.trivially_accepted += pixels / 64;
    count(pixels, pixels);
  }

  /// Forgets the triangles of which no tile is left.
  HALFPLANE_NOINLINE void drop_planes() {
    std::array<std::int32_t, kPlanes> moved;
    moved.fill(-1);
    for (const auto* owners : {&depth_owner_, &color_owner_})
      for (const std::int32_t owner : *owners)
        if (owner >= 0) moved[static_cast<std::size_t>(owner)] = 0;
    plane_count_ = 0;
    for (std::size_t i = 0; i < kPlanes; ++i) {
      if (moved[i] < 0) continue;
      moved[i] = static_cast<std::int32_t>(plane_count_);
      memory_.planes[plane_count_++] = memory_.planes[i];
    }
    for (auto* owners : {&depth_owner_, &color_owner_})
      for (std::int32_t& owner : *owners)
        if (owner >= 0) owner = moved[static_cast<std::size_t>(owner)];
  }

  template <class Visit>
  HALFPLANE_INLINE static void for_each_block(Visit&& visit) {
    visit(std::integral_constant<std::size_t, 0>{});
    visit(std::integral_constant<std::size_t, 1>{});
    visit(std::integral_constant<std::size_t, 2>{});
    visit(std::integral_constant<std::size_t, 3>{});
  }

  /// The part of a triangle in one tile, block by block.
  template <DepthFunc Test>
  HALFPLANE_NOINLINE void draw_tile(const BinTriangle& t, int tile, bool is_full,
                                    const std::array<std::int32_t, 3>& edge) {
    const int tile_x = tile % kBinTiles, tile_y = tile / kBinTiles;
    const int x = tile_x * kTileSize, y = tile_y * kTileSize;
    const int left = std::max(t.box.left - x, 0), right = std::min(t.box.right - x, 7);
    const int top = std::max(t.box.top - y, 0), bottom = std::min(t.box.bottom - y, 7);
    const bool is_whole = t.is_whole || (left == 0 && top == 0 && right == 7 && bottom == 7);
    need_depth(tile);
    const BlockRamp<I16> depth_plane = depth_ramp(t, depth_anchor(t, tile_x, tile_y));
    std::array<BlockRamp<I16>, 3> edge_plane;
    for (std::size_t e = 0; e < 3; ++e)
      edge_plane[e] = {position_.block_y * t.dx[e] - position_.block_x * t.dy[e] + edge[e], I16(-kBlockSize * t.dy[e]),
                       I16(kBlockSize * t.dx[e])};
    // Copies: what is stored to memory might change the members, for all that the compiler knows.
    const LaneFormat format = depth_format_;
    const I16 z_low(t.z_low), z_high(t.z_high);
    const bool has_depth = state_.depth_write, skips = skip_.fragments_early_z;
    std::int32_t* const stored_depths = memory_.depth.data() + first_of(tile);
    std::array<I16, 4> passed;                          // signs
    std::uint64_t covered_bits = 0, passed_bits = 0;  // of a block: sixteen
    I16 lowest(0x7fffffff), highest(0);
    for_each_block([&](auto block) HALFPLANE_LAMBDA {
      constexpr int kX = (block & 1) * kBlockSize, kY = (block >> 1) * kBlockSize;
      I16 outside(0);  // signs
      if (!is_full) outside = edge_plane[0](block) | edge_plane[1](block) | edge_plane[2](block);
      if (!is_whole)
        outside |= (position_.block_x + (kX - left)) | ((right - kX) - position_.block_x) |
                   (position_.block_y + (kY - top)) | ((bottom - kY) - position_.block_y);
      std::int32_t* const at = stored_depths + block * kBlockPixels;
      const I16 stored = I16::load(at), depth = decode(depth_plane(block), format, z_low, z_high);
      passed[block] = ~outside & passes<Test>(depth, stored);
      const I16 now = select_by_sign(passed[block], depth, stored);
      covered_bits |= std::uint64_t{~bits_of(outside) & 0xffff} << (kBlockPixels * block);
      passed_bits |= std::uint64_t{bits_of(passed[block])} << (kBlockPixels * block);
      lowest = min(lowest, now);
      highest = max(highest, now);
      if (has_depth) now.store(at);
    });
    if (state_.color_write && (passed_bits != 0 || !skips)) {
      need_color(tile);
      const ColorRamp color_plane = color_ramp(t.color, color_anchor(t, tile_x, tile_y));
      std::uint32_t* const pixels = memory_.color.data() + first_of(tile);
      const ColorSteps steps = t.color;
      const LaneFormat color_format = color_format_;
      const ColorFormat pixel_format = config_.color_format;
      for_each_block([&](auto block) HALFPLANE_LAMBDA {
        if ((passed_bits >> (kBlockPixels * block) & 0xffff) == 0 && skips) return;
        std::uint32_t* const at = pixels + block * kBlockPixels;
        const I16 color = colors(steps, color_plane, block, color_format, pixel_format);
        select_by_sign(passed[block], color, I16::load(at)).store(at);
      });
    }
    const auto covered_pixels = static_cast<std::uint64_t>(std::popcount(covered_bits)),
               passed_pixels = static_cast<std::uint64_t>(std::popcount(passed_bits));
    Counters& counters = job_.counters;
    if (is_full)
      ++counters.skipped.trivially_accepted;
    else
      counters.samples_tested += static_cast<unsigned>((right - left + 1) * (bottom - top + 1));
    count(covered_pixels, passed_pixels);
    if (state_.depth_write && passed_pixels != 0) {
      tile_low_[tile] = min_lane(lowest);
      tile_high_[tile] = max_lane(highest);
    }
  }

  // --- lines --------------------------------------------------------------------------------------------------------

#include "line.inl"

  // --- end ----------------------------------------------------------------------------------------------------------

  /// Everything that is new goes to the target, a row of tiles at a time.
  void finish() {
    const int columns = tiles_along(job_.target.width - first_x_), rows = tiles_along(job_.target.height - first_y_);
    const auto depths = [this](int tile) HALFPLANE_LAMBDA { return depths_of(tile); };
    const auto colors = [this](int tile) HALFPLANE_LAMBDA { return colors_of(tile); };
    const auto depth_rows = [this](auto&&... of) HALFPLANE_LAMBDA { write_depth_rows(of...); };
    const auto color_rows = [this](auto&&... of) HALFPLANE_LAMBDA { write_color_rows(of...); };
    for (int row = 0; row < rows; ++row) {
      const int tile = row * kBinTiles;
      const std::size_t to = job_.target.at(first_x_, first_y_ + row * kTileSize);
      finish_row(tile, columns, job_.target.depth.data() + to, depth_owner_, TileStates::kDepthCleared, depths,
                 depth_rows);
      finish_row(tile, columns, job_.target.color.data() + to, color_owner_, TileStates::kColorCleared, colors,
                 color_rows);
    }
    finish_lines();
  }
  static int tiles_along(int pixels) { return std::min((pixels + kTileSize - 1) / kTileSize, kBinTiles); }

  using TileBlocks = std::array<I16, 4>;
  /// A row of tiles as rows of pixels.
  using PixelRows = std::array<std::array<std::uint32_t, kBinSize>, kTileSize>;
  using TileOwners = std::array<std::int32_t, kTiles>;

  /// The row of tiles that begins with `first`. `cleared`: what is no longer pending where they were written.
  /// `blocks_of(tile)`: its values; `write_rows(left, right, tile, rows)`: those of two that triangles have taken.
  template <class BlocksOf, class WriteRows>
  HALFPLANE_INLINE void finish_row(int first, int columns, std::uint32_t* image, const TileOwners& owners,
                                   std::uint8_t cleared, BlocksOf&& blocks_of, WriteRows&& write_rows) {
    const std::int32_t* owner = owners.data() + first;
    alignas(64) PixelRows rows;
    std::uint32_t is_new = 0;
    for (int i = 0; i < columns; ++i) is_new |= (owner[i] >= kInMemory ? 1U : 0U) << i;
    if (is_new == 0) return;
    for (int i = 0; i < kBinTiles; i += 2) {
      if ((is_new >> i & 3) == 3 && owner[i] >= 0 && owner[i + 1] >= 0) {
        const auto plane = [&](int at) HALFPLANE_LAMBDA -> const BinTriangle& {
          return memory_.planes[static_cast<std::size_t>(owner[at])];
        };
        write_rows(plane(i), plane(i + 1), first + i, rows);
        continue;
      }
      for (int at = i; at < i + 2; ++at) {
        if ((is_new >> at & 1) == 0) continue;
        const TileBlocks blocks = blocks_of(first + at);
        for (std::size_t half = 0; half < 2; ++half)
          store_blocks(rows[half * kBlockSize].data() + at * kTileSize, kBinSize, blocks[2 * half],
                       blocks[2 * half + 1]);
      }
    }
    const std::size_t first_tile = static_cast<std::size_t>(job_.bin * kTiles + first);
    for (std::uint32_t rest = is_new; rest != 0; rest &= rest - 1) {
      const std::size_t at = first_tile + static_cast<std::size_t>(std::countr_zero(rest));
      job_.tiles.pending[at] &= static_cast<std::uint8_t>(~cleared);
      job_.tiles.held[at] &= static_cast<std::uint8_t>(~cleared);
    }
    const int stride = job_.target.stride;
    const std::uint32_t in_lines = are_lines_ ? is_new & is_new >> 1 & 0x55 : 0, alone = is_new & ~(in_lines * 3);
    for (int y = 0; y < kTileSize; ++y) {
      const std::uint32_t* from = rows[static_cast<std::size_t>(y)].data();
      std::uint32_t* const to = image + y * stride;
      if (in_lines == 0x55) {
        for (int x = 0; x < kBinSize; x += 16) stream_line(to + x, I16::load(from + x));
        continue;
      }
      for (std::uint32_t rest = in_lines; rest != 0; rest &= rest - 1) {
        const int x = std::countr_zero(rest) * kTileSize;
        stream_line(to + x, I16::load(from + x));
      }
      for (std::uint32_t rest = alone; rest != 0; rest &= rest - 1) {
        const int x = std::countr_zero(rest) * kTileSize;
        std::memcpy(to + x, from + x, kTileSize * sizeof *to);
      }
    }
  }

  /// Depths of two tiles side by side, each a triangle's as a whole, row by row: a cache line each.
  HALFPLANE_INLINE void write_depth_rows(const BinTriangle& left, const BinTriangle& right, int tile,
                                         PixelRows& rows) const {
    const int to = tile % kBinTiles * kTileSize;
    const auto both = [&](auto&& of) HALFPLANE_LAMBDA { return halves(of(left), of(right)); };
    const I16 step_y = both([](const BinTriangle& t) HALFPLANE_LAMBDA { return t.z_step_y; });
    const I16 low = both([](const BinTriangle& t) HALFPLANE_LAMBDA { return t.z_low; });
    const I16 high = both([](const BinTriangle& t) HALFPLANE_LAMBDA { return t.z_high; });
    const I16 step_x = both([](const BinTriangle& t) HALFPLANE_LAMBDA { return t.z_step_x; });
    I16 value = (position_.pair_x - kTileSize / 2) * step_x - step_y * (kTileSize / 2) +
                halves(depth_anchor(left, tile % kBinTiles, tile / kBinTiles),
                       depth_anchor(right, tile % kBinTiles + 1, tile / kBinTiles));
    for (auto& row : rows) {
      decode(value, depth_format_, low, high).store(row.data() + to);
      value += step_y;
    }
  }
  /// Likewise colours.
  HALFPLANE_INLINE void write_color_rows(const BinTriangle& left, const BinTriangle& right, int tile,
                                         PixelRows& rows) const {
    const int to = tile % kBinTiles * kTileSize;
    const auto both = [&](const auto& of) HALFPLANE_LAMBDA { return as<S32>(halves(of(left.color), of(right.color))); };
    const ChannelPairs at_left = color_anchor(left, tile % kBinTiles, tile / kBinTiles),
                       at_right = color_anchor(right, tile % kBinTiles + 1, tile / kBinTiles);
    const I16 x = position_.pair_x - kTileSize / 2;
    const auto column = as<S32>(pairs(x, x));
    std::array<S32, 2> value, step_y, low, high;
    const LaneFormat format = color_format_;
    const ColorFormat pixels = config_.color_format;
    for (std::size_t p = 0; p < 2; ++p) {
      step_y[p] = both([p](const ColorSteps& t) HALFPLANE_LAMBDA { return t.step_y[p]; });
      low[p] = both([p](const ColorSteps& t) HALFPLANE_LAMBDA { return t.low[p]; });
      high[p] = both([p](const ColorSteps& t) HALFPLANE_LAMBDA { return t.high[p]; });
      value[p] = column * both([p](const ColorSteps& t) HALFPLANE_LAMBDA { return t.step_x[p]; }) -
                 (step_y[p] << (kTileShift - 1)) + as<S32>(halves(at_left[p], at_right[p]));
    }
    for (auto& row : rows) {
      const auto pair = [&](std::size_t p) HALFPLANE_LAMBDA {
        return color_codes(value[p], as<I16>(low[p]), as<I16>(high[p]), format);
      };
      packed(pair(0), pair(1), pixels).store(row.data() + to);
      for (std::size_t p = 0; p < 2; ++p) value[p] += step_y[p];
    }
  }

  /// A tile's depths, which are in memory or those of a triangle.
  HALFPLANE_INLINE TileBlocks depths_of(int tile) const {
    TileBlocks blocks;
    const std::int32_t owner = depth_owner_[tile];
    if (owner >= 0) {
      const BinTriangle& t = memory_.planes[static_cast<std::size_t>(owner)];
      const auto ramp = depth_ramp(t, depth_anchor(t, tile % kBinTiles, tile / kBinTiles));
      for (std::size_t i = 0; i < 4; ++i) blocks[i] = depths(t, ramp, i);
    } else {
      const std::int32_t* from = memory_.depth.data() + first_of(tile);
      for (std::size_t i = 0; i < 4; ++i) blocks[i] = I16::load(from + kBlockPixels * i);
    }
    return blocks;
  }
  HALFPLANE_INLINE TileBlocks colors_of(int tile) const {
    TileBlocks blocks;
    const std::int32_t owner = color_owner_[tile];
    if (owner >= 0) {
      const BinTriangle& t = memory_.planes[static_cast<std::size_t>(owner)];
      const auto ramp = color_ramp(t.color, color_anchor(t, tile % kBinTiles, tile / kBinTiles));
      for (std::size_t i = 0; i < 4; ++i) blocks[i] = colors(t.color, ramp, i, color_format_, config_.color_format);
    } else {
      const std::uint32_t* from = memory_.color.data() + first_of(tile);
      for (std::size_t i = 0; i < 4; ++i) blocks[i] = I16::load(from + kBlockPixels * i);
    }
    return blocks;
  }

  BinJob& job_;
  const Config& config_;
  const Widths& widths_;
  const Skip& skip_;
  LaneFormat depth_format_, color_format_;
  int first_x_, first_y_;  ///< pixels
  bool are_lines_;         ///< sixteen pixels of a row of the target are a cache line
  std::int32_t *tile_low_, *tile_high_;
  Memory& memory_;
  FragmentState state_;
  std::int32_t bin_low_ = 0, bin_high_ = 0;  ///< range of its depths, or wider
  std::int32_t bin_lowest_high_ = 0;         ///< of its tiles' upper bounds, or of earlier ones
  const LanePositions& position_ = lane_positions();
  SmallBatch small_;
  int small_run_ = 0;  ///< records in a row that were small or medium
  LineBatch lines_, cut_line_;  ///< cut_line_: one, in lane 0
  std::uint64_t line_tiles_ = 0;  ///< touched by lines since triangles last were drawn
  static constexpr std::size_t kSmallBlocks = kMediumTiles * kTileSize / kBlockSize;  ///< along a side
  std::array<Block, 16 * kSmallBlocks * kSmallBlocks + 1> blocks_;  ///< and room for one that is not kept
  bool falls_ = false, rises_ = false;  ///< what a passing depth may do to the stored one
  std::size_t plane_count_ = 0;
  bool may_be_lower_ = false;    ///< the bin's upper bound, since it was found
  std::uint64_t in_memory_ = 0;  ///< tiles whose depths and colours are in memory, as far as small triangles know
  std::array<std::uint8_t, kTiles> touches_{};
  alignas(64) std::array<std::int32_t, kTiles> depth_owner_, color_owner_;
};

static void raster(BinJob& job) { Bin(job).draw(); }
