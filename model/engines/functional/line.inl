// The part of a line in the bin: line_raster from the first of its pixels there, found by quotient and remainder.
// Included inside class Bin: see raster.inl.

/// Steps [first, last] of a line, counted from its first pixel, in which one coordinate is inside the bin.
struct Steps {
  std::int64_t first = 0, last = 0;
};

/// `start`: where the coordinate is at step 0, in pixels of the bin; `is_negative`: it falls. D: 0 for the coordinate
/// that moves in every step; otherwise it has moved floor((error + (n - 1) d + D) / D) pixels after n steps.
HALFPLANE_INLINE static void clip_steps(Steps& steps, std::int32_t start, bool is_negative, std::int64_t error,
                                        std::int64_t d, std::int64_t D) {
  const std::int64_t enters = is_negative ? start - (kBinSize - 1) : -start;  // moves that bring it in
  const std::int64_t leaves = is_negative ? start : kBinSize - 1 - start;     // the last move that keeps it in
  const auto step_of = [&](std::int64_t move) HALFPLANE_LAMBDA {  // the first step after which it has moved so far
    if (D == 0) return move;
    const std::int64_t numerator = (move - 1) * D - error;
    if (d == 0) return numerator <= 0 ? std::int64_t{1} : std::int64_t{1} << 40;
    return (numerator > 0 ? (numerator + d - 1) / d : -(-numerator / d)) + 1;
  };
  if (enters > 0) steps.first = std::max(steps.first, step_of(enters));
  if (leaves < 0) steps.last = -1;
  if (leaves >= 0 && leaves < steps.last) steps.last = std::min(steps.last, step_of(leaves + 1) - 1);
}

template <DepthFunc Test>
HALFPLANE_NOINLINE void draw_line(const LineSetup& line, const Record& record) {
  const std::int64_t d = line.step_stay, D = line.step_stay - line.step_move;
  const bool is_x_major = line.is_x_major != 0;
  Steps steps{0, line.remaining};
  int x = line.x - first_x_, y = line.y - first_y_;
  clip_steps(steps, x, line.is_x_negative != 0, line.error, d, is_x_major ? 0 : D);
  clip_steps(steps, y, line.is_y_negative != 0, line.error, d, is_x_major ? D : 0);
  if (steps.first > steps.last) return;
  const std::int64_t n = steps.first;
  const std::int64_t moved = n == 0 || D == 0 ? 0 : (line.error + (n - 1) * d + D) / D;
  std::int64_t error = line.error + n * d - moved * D;
  const int major = static_cast<int>(n), minor = static_cast<int>(moved);
  const int sign_x = line.is_x_negative != 0 ? -1 : 1, sign_y = line.is_y_negative != 0 ? -1 : 1;
  x += sign_x * (is_x_major ? major : minor);
  y += sign_y * (is_x_major ? minor : major);
  // Steps of one pixel: along the major axis always, across it when the error says so.
  const int along_x = is_x_major ? sign_x : 0, along_y = is_x_major ? 0 : sign_y;
  const int across_x = is_x_major ? 0 : sign_x, across_y = is_x_major ? sign_y : 0;
  const int guard_bits = widths_.line_guard_bits;
  const std::uint64_t depth_mask = ~0ULL >> (64 - widths_.line_depth.bits);
  std::uint64_t depth = line.depth + static_cast<std::uint64_t>(n) * line.depth_step;
  typedef std::uint32_t U4 __attribute__((vector_size(16)));
  typedef std::uint8_t Bytes __attribute__((vector_size(4)));
  const auto channels_of = [](const std::array<std::uint64_t, 4>& c) HALFPLANE_LAMBDA {
    return U4{static_cast<std::uint32_t>(c[0]), static_cast<std::uint32_t>(c[1]), static_cast<std::uint32_t>(c[2]),
              static_cast<std::uint32_t>(c[3])};
  };
  const U4 color_step = channels_of(line.color_step);
  U4 color = channels_of(line.color) + static_cast<std::uint32_t>(n) * color_step;
  const std::uint32_t color_mask = (1U << widths_.line_color.bits) - 1;

  const std::uint32_t depth_write = state_.depth_write ? ~0U : 0;
  int last_tile = -1;
  std::uint64_t passed_pixels = 0;
  bool shows_start = n == 0 && line.is_before_start != 0;
  for (std::int64_t left = steps.last - n;; --left) {
    const int tile = tile_of(x, y), at = pixel_of(x, y);
    if (tile != last_tile) {
      need_depth(tile);
      if (state_.color_write) need_color(tile);
      if (state_.depth_write) widen<Test>(tile, record.z_low, record.z_high);
      last_tile = tile;
      ++job_.counters.tiles_visited;
    }
    auto code = static_cast<std::int32_t>((depth & depth_mask) >> guard_bits);
    if (shows_start) code = static_cast<std::int32_t>(line.depth_start);
    // Masks, not branches: what passes is anybody's guess.
    std::int32_t& stored = memory_.depth[static_cast<std::size_t>(at)];
    const bool is_passed = Test == DepthFunc::less ? code < stored
                                                   : depth_passes(state_.depth_test, static_cast<std::uint32_t>(code),
                                                                  static_cast<std::uint32_t>(stored));
    const std::uint32_t passed = 0U - static_cast<std::uint32_t>(is_passed);
    passed_pixels += passed & 1;
    stored ^= (stored ^ code) & static_cast<std::int32_t>(passed & depth_write);
    if (state_.color_write) {
      const U4 channel = (color & color_mask) >> guard_bits;
      std::uint32_t packed;
      if (config_.color_format == ColorFormat::rgba8888) {
        const auto bytes = __builtin_convertvector(channel, Bytes);
        std::memcpy(&packed, &bytes, 4);
        if (shows_start) packed = line.color_start;
      } else {
        U4 shown = channel;
        if (shows_start)
          shown = U4{line.color_start & 255, line.color_start >> 8 & 255, line.color_start >> 16 & 255, 0};
        packed = pack_rgb565<std::uint32_t>(shown[0], shown[1], shown[2]);
      }
      std::uint32_t& pixel = memory_.color[static_cast<std::size_t>(at)];
      pixel ^= (pixel ^ packed) & passed;
    }
    if (left == 0) break;
    shows_start = false;
    const std::int64_t moves = ~(error >> 63);
    x += along_x + (across_x & static_cast<int>(moves));
    y += along_y + (across_y & static_cast<int>(moves));
    error += d - (D & moves);
    depth += line.depth_step;
    color += color_step;
  }
  count(static_cast<std::uint64_t>(steps.last - n + 1), passed_pixels);
}
