// Setup, coarse raster, fine raster, interpolation, depth test and ROP of one bin, fused. Bits as in the stages; the
// order of the work is this engine's own:
//
//   triangle within two by two pixels  sixteen at a time through setup, then their samples
//   within two by two tiles            sixteen at a time through setup, then the blocks that each covers
//   larger                             its 64 tiles sixteen at a time: outside, behind, taken as a whole, or drawn
//
// A block is 4 x 4 pixels: sixteen lanes, one cache line. A tile is four of them.
//
// A tile that a triangle covers wholly, in front of all that is there, is taken without looking at a pixel: it remembers
// the triangle. Its depths and colours are computed when somebody needs them: often nobody does.
// Included inside the namespace of an instruction set: see kernels.inl.

constexpr int kBlockSize = 4, kBlockPixels = 16;

/// Lanes as places.
struct LanePositions {
  I16 pair_x, pair_y;  ///< of two rows of eight
  I16 lane, lane_bit;  ///< its number; 1 << lane
  D16 lane_d;
  I16 block_x, block_y;
  I16 block_yx;  ///< pairs: row low, column high
  /// Columns (rows) of the left and right (upper and lower) blocks of a tile, from its anchor; also in both halves.
  std::array<I16, 2> column, row, column_pair, row_pair;

  LanePositions() {
    pair_x = I16::of([](int i) { return i % 8; });
    pair_y = I16::of([](int i) { return i / 8; });
    lane = I16::of([](int i) { return i; });
    lane_d = convert<double>(lane);
    lane_bit = I16::of([](int i) { return 1 << i; });
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

/// One triangle, as one bin sees it. Positions are pixels of the bin, tiles those of the bin.
struct BinTriangle {
  std::array<std::int32_t, 3> edge, dx, dy;  ///< at the bin's first pixel, held within +-2^30; steps as in Edge
  std::int32_t left, top, right, bottom;
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
    find_bin_range();
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
  static constexpr std::uint8_t kTouches = 8;  ///< small triangles after which a tile's range is found anew
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
        if (const Record& near = slice.records[first[kAhead / 2]]; near.kind == RecordKind::whole_line)
          for (std::size_t k = 0; k < 2; ++k) __builtin_prefetch(&slice.vertices[near.v[k]]);
      }
      const int left = std::max(record.left - first_x_, 0), right = std::min(record.right - first_x_, kBinSize - 1);
      const int top = std::max(record.top - first_y_, 0), bottom = std::min(record.bottom - first_y_, kBinSize - 1);
      const auto leave_out = [&] {
        const auto tiles = static_cast<unsigned>(((right >> kTileShift) - (left >> kTileShift) + 1) *
                                                 ((bottom >> kTileShift) - (top >> kTileShift) + 1));
        job_.counters.tiles_visited += tiles;
        job_.counters.skipped.tiles_hiz += tiles;
      };
      if (skip_.tiles_hiz && is_behind<Test>(record, bin_low_, bin_high_)) {
        leave_out();
        continue;
      }
      if (record.is_small) {
        if (skip_.tiles_hiz) {
          const int a = tile_of(left, top), b = tile_of(right, top), c = tile_of(left, bottom),
                    d = tile_of(right, bottom);
          const std::int32_t low = std::min({tile_low_[a], tile_low_[b], tile_low_[c], tile_low_[d]});
          const std::int32_t high = std::max({tile_high_[a], tile_high_[b], tile_high_[c], tile_high_[d]});
          if (is_behind<Test>(record, low, high)) {
            leave_out();
            continue;
          }
        }
        const std::uint32_t samples = samples_in_bin(record);
        if (record.samples != 0 && samples == 0) continue;
        if (small_.add(record, left, top, right, bottom, samples)) draw_batch<Test>(slice);
        continue;
      }
      if (record.kind == RecordKind::whole_line) {
        if (lines_.add(record)) draw_lines<Test>(slice);
        continue;
      }
      draw_batch<Test>(slice);
      draw_lines<Test>(slice);
      if (record.kind == RecordKind::cut_line) {
        draw_cut_line<Test>(slice.lines[record.v[0]]);
        continue;
      }
      BinTriangle triangle;
      triangle.left = left;
      triangle.top = top;
      triangle.right = right;
      triangle.bottom = bottom;
      triangle.is_whole = record.is_whole;
      // Nearer than all of the bin: no need to look at its tiles.
      const bool may_be_behind = Test != DepthFunc::less || record.z_low >= bin_low_;
      if (skip_.tiles_hiz && may_be_behind && is_behind_tiles<Test>(record, triangle)) {
        leave_out();
        continue;
      }
      if (set_up(slice, record, triangle) && !record.draws_nothing) draw_large<Test>(triangle);
    }
    draw_batch<Test>(slice);
    draw_lines<Test>(slice);
  }

  /// Record::samples of the part of its box that lies in this bin.
  [[nodiscard]] HALFPLANE_INLINE std::uint32_t samples_in_bin(const Record& record) const {
    constexpr std::uint32_t kLeft = 1 | 4, kUpper = 1 | 2;
    const int left = record.left - first_x_, top = record.top - first_y_;
    std::uint32_t samples = record.samples;
    samples = left < 0 ? samples >> 1 & kLeft : left == kBinSize - 1 ? samples & kLeft : samples;
    return top < 0 ? samples >> 2 & kUpper : top == kBinSize - 1 ? samples & kUpper : samples;
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
  HALFPLANE_INLINE bool is_behind_tiles(const Record& record, const BinTriangle& box) const {
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
    if (record.kind == RecordKind::rectangle) {
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
      const auto gradient = [R, k](std::int64_t numerator) HALFPLANE_LAMBDA {
        return static_cast<std::int64_t>(round_shift(static_cast<int128>(numerator) * R, k));
      };
      const std::int64_t numerator_x = az * by - bz * ay, numerator_y = ax * bz - bx * az;
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

  void set_up_edges(const SnappedVertex& a, const SnappedVertex& b, const SnappedVertex& c, BinTriangle& out) const {
    const std::array<const SnappedVertex*, 4> v{&a, &b, &c, &a};
    for (std::size_t i = 0; i < 3; ++i) {
      out.dx[i] = v[i + 1]->x - v[i]->x;
      out.dy[i] = v[i + 1]->y - v[i]->y;
      // Inside a bin a value moves by less than 2^30: beyond that its sign is the same everywhere.
      constexpr EdgeValue kFar = EdgeValue{1} << 30;
      const EdgeValue value = edge_function(*v[i], *v[i + 1], first_x_, first_y_, widths_.grid_bits);
      out.edge[i] = static_cast<std::int32_t>(value < -kFar ? -kFar : value > kFar ? kFar : value);
    }
  }

  struct ColorFrame {
    std::int64_t ax, ay, bx, by, dx, dy;
  };

  static std::int32_t pair_of(std::int64_t low, std::int64_t high) {
    return static_cast<std::int32_t>((static_cast<std::uint32_t>(low) & 0xffff) | static_cast<std::uint32_t>(high)
                                                                                      << 16);
  }
  template <class Channel>
  static ChannelPairs channel_pairs(Channel&& channel) {
    return {pair_of(channel(0), channel(2)), pair_of(channel(1), channel(3))};
  }

  void set_up_colors(const SnappedVertex& a, const SnappedVertex& b, const SnappedVertex& c,
                     const SnappedVertex& origin, const ColorFrame& f, std::int64_t R, int k, BinTriangle& out) const {
    const int s = widths_.grid_bits, F = widths_.plane_fraction;
    const bool is_flat = state_.is_flat;
    std::array<std::int64_t, 4> step_x, step_y, low, high;
    for (std::size_t i = 0; i < 4; ++i) {
      const std::int64_t ca = a.rgba[i], cb = is_flat ? a.rgba[i] : b.rgba[i], cc = is_flat ? a.rgba[i] : c.rgba[i];
      const std::uint64_t c0 = is_flat ? a.rgba[i] : origin.rgba[i];
      const std::int64_t ac = cb - ca, bc = cc - ca;
      step_x[i] = round_shift((ac * f.by - bc * f.ay) * R, k);
      step_y[i] = round_shift((f.ax * bc - f.bx * ac) * R, k);
      out.c_anchor[i] = static_cast<std::int64_t>((c0 << F) + product(step_x[i], f.dx) + product(step_y[i], f.dy) +
                                                  color_format_.anchor_bias);
      out.c_tile_x[i] = step_x[i] << (kTileShift + s);
      out.c_tile_y[i] = step_y[i] << (kTileShift + s);
      low[i] = std::min({ca, cb, cc});
      high[i] = std::max({ca, cb, cc});
    }
    const auto local = [this](const std::array<std::int64_t, 4>& step) {
      return channel_pairs(
          [&](std::size_t i) { return round_shift(step[i], color_format_.step_drop) << color_format_.up; });
    };
    out.color = {local(step_x), local(step_y), channel_pairs([&](std::size_t i) { return low[i]; }),
                 channel_pairs([&](std::size_t i) { return high[i]; })};
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
    const ChannelPairs codes = channel_pairs([&](std::size_t i) { return std::int64_t{v.rgba[i]}; });
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
  ChannelPairs color_anchor(const BinTriangle& t, int tile_x, int tile_y) const {
    return channel_pairs([&](std::size_t i) {
      const auto value =
          static_cast<std::uint64_t>(t.c_anchor[i]) + product(t.c_tile_x[i], tile_x) + product(t.c_tile_y[i], tile_y);
      return static_cast<std::int64_t>(value) >> color_format_.drop << color_format_.up;
    });
  }

  HALFPLANE_INLINE static I16 decode(const I16& value, const LaneFormat& format, const I16& low, const I16& high) {
    return min(max(shift_right_logical(value, format.down) - format.bias, low), high);
  }

  /// The mask whose lanes are the bits.
  HALFPLANE_INLINE I16 from_bits(std::uint32_t bits) const {
    return (I16(static_cast<std::int32_t>(bits)) & position_.lane_bit) != 0;
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

  /// Packed colours in block 0...3 of a tile.
  HALFPLANE_INLINE I16 colors(const ColorSteps& t, const ChannelPairs& anchor, std::size_t block) const {
    const auto pair = [&](std::size_t p) HALFPLANE_LAMBDA {
      return channel_codes(position_.column_pair[block & 1], position_.row_pair[block >> 1], t.step_x[p], t.step_y[p],
                           anchor[p], t.low[p], t.high[p]);
    };
    return packed(pair(0) | pair(1) << 8);
  }

  /// Two channels' codes, in the halves of each lane, as everything here: columns and rows from the anchor.
  [[nodiscard]] HALFPLANE_INLINE I16 channel_codes(const I16& column, const I16& row, const I16& step_x,
                                                   const I16& step_y, const I16& anchor, const I16& low,
                                                   const I16& high) const {
    const S32 value = as<S32>(column) * as<S32>(step_x) + as<S32>(row) * as<S32>(step_y) + as<S32>(anchor);
    const S32 code = shift_right_logical(value, color_format_.down) - static_cast<std::int16_t>(color_format_.bias);
    return as<I16>(min(max(code, as<S32>(low)), as<S32>(high)));
  }

  /// Colours of 8 bits a channel, R lowest, as the target has them.
  [[nodiscard]] HALFPLANE_INLINE I16 packed(const I16& rgba) const {
    if (config_.color_format == ColorFormat::rgba8888) return rgba;
    const I16 r = rgba & 255, g = shift_right_logical(rgba, 8) & 255, b = shift_right_logical(rgba, 16) & 255;
    return (r * 249 + 1014) >> 11 << 11 | (g * 253 + 505) >> 10 << 5 | (b * 249 + 1014) >> 11;
  }

  // --- memory -------------------------------------------------------------------------------------------------------

  /// First pixel of a tile in the bin's memory.
  static int first_of(int tile) { return tile * kTileSize * kTileSize; }

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

  /// Depths of a triangle in block 0...3 of a tile, from the value at the tile's anchor.
  HALFPLANE_INLINE I16 depth_block(const BinTriangle& t, std::int32_t anchor, std::size_t block) const {
    return decode(position_.column[block & 1] * t.z_step_x + position_.row[block >> 1] * t.z_step_y + anchor,
                  depth_format_, t.z_low, t.z_high);
  }

  void find_bin_range() {
    I16 low = I16::load(tile_low_), high = I16::load(tile_high_);
    for (int t = 16; t < kTiles; t += 16) {
      low = min(low, I16::load(tile_low_ + t));
      high = max(high, I16::load(tile_high_ + t));
    }
    bin_low_ = min_lane(low);
    bin_high_ = max_lane(high);
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

  /// A tile may now hold depths in [low, high] beside what it held.
  template <DepthFunc Test>
  HALFPLANE_INLINE void widen(int tile, std::int32_t low, std::int32_t high) {
    if (Test == DepthFunc::less || !rises_) tile_low_[tile] = std::min(tile_low_[tile], low);
    if (Test != DepthFunc::less && !falls_) tile_high_[tile] = std::max(tile_high_[tile], high);
  }

  /// The same of any depths. A store, not a minimum: the next triangle of the tile need not wait for it.
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

  HALFPLANE_INLINE TileLanes classify_tiles(const BinTriangle& t, int row) {
    TileLanes lanes;
    const I16 x = position_.pair_x * kTileSize, y = (position_.pair_y + row) * kTileSize;
    constexpr int kExtent = kTileSize - 1;
    I16 outside(0), cut(0);
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int32_t dx = t.dx[i], dy = t.dy[i];
      lanes.edge[i] = y * dx - x * dy + t.edge[i];
      outside |= lanes.edge[i] + kExtent * (std::max(dx, 0) + std::max(-dy, 0));
      cut |= lanes.edge[i] + kExtent * (std::min(dx, 0) + std::min(-dy, 0));
    }
    const I16 in_box = ~(((x + kExtent - t.left) | (t.right - x) | (y + kExtent - t.top) | (t.bottom - y)) >> 31);
    if (!t.is_whole) cut |= (x - t.left) | ((t.right - kExtent) - x) | (y - t.top) | ((t.bottom - kExtent) - y);
    lanes.live = in_box & ~(outside >> 31);
    lanes.full = lanes.live & ~(cut >> 31);
    const auto box = static_cast<unsigned>(std::popcount(bits_of(in_box)));
    job_.counters.tiles_visited += box;
    if (skip_.tiles_outside)
      job_.counters.skipped.tiles_outside += box - static_cast<unsigned>(std::popcount(bits_of(lanes.live)));
    else
      lanes.live = in_box;
    lanes.z_low = I16(t.z_low);
    lanes.z_high = I16(t.z_high);
    if (t.is_gentle) {
      const L16 value = convert<std::int64_t>(position_.pair_x) * t.z_tile_x +
                        convert<std::int64_t>(position_.pair_y) * t.z_tile_y +
                        static_cast<std::int64_t>(static_cast<std::uint64_t>(t.z_anchor) + product(t.z_tile_y, row));
      const I16 anchor = convert<std::int32_t>(value >> depth_format_.drop) << depth_format_.up;
      // From the anchor a tile reaches four pixels to the left and up, three to the right and down.
      const auto reach = [](std::int32_t step, bool is_high) HALFPLANE_LAMBDA {
        return (step > 0) == is_high ? (kTileSize / 2 - 1) * step : -kTileSize / 2 * step;
      };
      lanes.z_low =
          decode(anchor + (reach(t.z_step_x, false) + reach(t.z_step_y, false)), depth_format_, t.z_low, t.z_high);
      lanes.z_high =
          decode(anchor + (reach(t.z_step_x, true) + reach(t.z_step_y, true)), depth_format_, t.z_low, t.z_high);
    }
    return lanes;
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
    for (int row = t.top >> kTileShift & ~1; row <= t.bottom >> kTileShift; row += 2) {
      TileLanes lanes = classify_tiles(t, row);
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
      std::uint32_t rest = bits_of(lanes.live & ~taken);
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
    find_bin_range();
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

  /// The part of a triangle in one tile, block by block.
  template <DepthFunc Test>
  HALFPLANE_NOINLINE void draw_tile(const BinTriangle& t, int tile, bool is_full,
                                    const std::array<std::int32_t, 3>& edge) {
    const int tile_x = tile % kBinTiles, tile_y = tile / kBinTiles;
    const int left = std::max(t.left - tile_x * kTileSize, 0), right = std::min(t.right - tile_x * kTileSize, 7);
    const int top = std::max(t.top - tile_y * kTileSize, 0), bottom = std::min(t.bottom - tile_y * kTileSize, 7);
    const bool is_whole = t.is_whole || (left == 0 && top == 0 && right == 7 && bottom == 7);
    need_depth(tile);
    const std::int32_t depth_at = depth_anchor(t, tile_x, tile_y);
    ChannelPairs color_at{};
    bool has_color = false;  // asked for when a pixel passes: often none does
    std::int32_t* depths = memory_.depth.data() + first_of(tile);
    std::uint32_t* pixels = memory_.color.data() + first_of(tile);
    std::array<I16, 3> ramp;
    for (std::size_t e = 0; e < 3; ++e) ramp[e] = position_.block_y * t.dx[e] - position_.block_x * t.dy[e] + edge[e];
    std::uint64_t covered_pixels = 0, passed_pixels = 0;
    I16 lowest(0x7fffffff), highest(0);
    for (int block = 0; block < 4; ++block) {
      const int x = (block & 1) * kBlockSize, y = (block >> 1) * kBlockSize;
      const auto at = static_cast<std::size_t>(block) * kBlockPixels;
      I16 signs(0);
      if (!is_full)
        for (std::size_t e = 0; e < 3; ++e) signs |= ramp[e] + (y * t.dx[e] - x * t.dy[e]);
      if (!is_whole)
        signs |= (position_.block_x + (x - left)) | ((right - x) - position_.block_x) |
                 (position_.block_y + (y - top)) | ((bottom - y) - position_.block_y);
      const I16 covered = ~(signs >> 31), stored = I16::load(depths + at);
      const I16 depth = depth_block(t, depth_at, static_cast<std::size_t>(block));
      const I16 passed = covered & passes<Test>(depth, stored);
      const std::uint32_t passed_bits = bits_of(passed);
      const I16 now = select(passed, depth, stored);
      covered_pixels += static_cast<unsigned>(std::popcount(bits_of(covered)));
      passed_pixels += static_cast<unsigned>(std::popcount(passed_bits));
      lowest = min(lowest, now);
      highest = max(highest, now);
      if (passed_bits == 0 && skip_.fragments_early_z) continue;
      if (state_.depth_write) now.store(depths + at);
      if (!state_.color_write) continue;
      if (!has_color) {
        need_color(tile);
        color_at = color_anchor(t, tile_x, tile_y);
        has_color = true;
      }
      const I16 color = colors(t.color, color_at, static_cast<std::size_t>(block));
      select(passed, color, I16::load(pixels + at)).store(pixels + at);
    }
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

  /// Everything that is new goes to the target, two tiles at a time: a cache line of each row.
  void finish() {
    for (int tile = 0; tile < kTiles; tile += 2) {
      const std::ptrdiff_t to = in_target(tile);
      if (to < 0) continue;
      const bool has_right = in_target(tile + 1) >= 0;
      finish_pair(tile, to, has_right, depth_owner_.data(), job_.target.depth.data(), TileStates::kDepthCleared,
                  [this](int t) HALFPLANE_LAMBDA { return depths_of(t); });
      finish_pair(tile, to, has_right, color_owner_.data(), job_.target.color.data(), TileStates::kColorCleared,
                  [this](int t) HALFPLANE_LAMBDA { return colors_of(t); });
    }
    finish_lines();
  }

  using TileBlocks = std::array<I16, 4>;

  /// `blocks_of(tile)`: its values. `cleared`: what is no longer pending where they were written.
  template <class BlocksOf>
  HALFPLANE_INLINE void finish_pair(int tile, std::ptrdiff_t to, bool has_right, const std::int32_t* owner,
                                    std::uint32_t* image, std::uint8_t cleared, BlocksOf&& blocks_of) {
    const bool is_left_new = owner[tile] >= kInMemory, is_right_new = has_right && owner[tile + 1] >= kInMemory;
    if (!is_left_new && !is_right_new) return;
    const int stride = job_.target.stride;
    const std::size_t first_tile = static_cast<std::size_t>(job_.bin * kTiles + tile);
    const auto written = [&](std::size_t at) HALFPLANE_LAMBDA {
      job_.tiles.pending[at] &= static_cast<std::uint8_t>(~cleared);
      job_.tiles.held[at] &= static_cast<std::uint8_t>(~cleared);
    };
    if (is_left_new) written(first_tile);
    if (is_right_new) written(first_tile + 1);
    if (is_left_new && is_right_new) {
      const TileBlocks left = blocks_of(tile), right = blocks_of(tile + 1);
      for (std::size_t half = 0; half < 2; ++half)
        store_lines(image + to + static_cast<int>(half) * kBlockSize * stride, stride, are_lines_, left[2 * half],
                    left[2 * half + 1], right[2 * half], right[2 * half + 1]);
      return;
    }
    const TileBlocks blocks = blocks_of(is_left_new ? tile : tile + 1);
    for (std::size_t half = 0; half < 2; ++half)
      store_blocks(image + to + (is_left_new ? 0 : kTileSize) + static_cast<int>(half) * kBlockSize * stride, stride,
                   blocks[2 * half], blocks[2 * half + 1]);
  }

  /// A tile's depths, which are in memory or those of a triangle.
  HALFPLANE_INLINE TileBlocks depths_of(int tile) const {
    TileBlocks blocks;
    const std::int32_t owner = depth_owner_[tile];
    if (owner >= 0) {
      const BinTriangle& t = memory_.planes[static_cast<std::size_t>(owner)];
      const std::int32_t anchor = depth_anchor(t, tile % kBinTiles, tile / kBinTiles);
      for (std::size_t i = 0; i < 4; ++i) blocks[i] = depth_block(t, anchor, i);
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
      const ChannelPairs anchor = color_anchor(t, tile % kBinTiles, tile / kBinTiles);
      for (std::size_t i = 0; i < 4; ++i) blocks[i] = colors(t.color, anchor, i);
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
  std::int32_t bin_low_ = 0, bin_high_ = 0;
  const LanePositions& position_ = lane_positions();
  SmallBatch small_;
  LineBatch lines_, cut_line_;  ///< cut_line_: one, in lane 0
  std::uint64_t line_tiles_ = 0;  ///< touched by lines since triangles last were drawn
  std::array<Block, 16 * 16 + 1> blocks_;  ///< sixteen of a triangle, and room for one that is not kept
  bool falls_ = false, rises_ = false;  ///< what a passing depth may do to the stored one
  std::size_t plane_count_ = 0;
  std::array<std::uint8_t, kTiles> touches_{};
  alignas(64) std::array<std::int32_t, kTiles> depth_owner_, color_owner_;
};

static void raster(BinJob& job) { Bin(job).draw(); }
