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
  const LinePixels at_first{x,
                            y,
                            along_x,
                            along_y,
                            across_x,
                            across_y,
                            error,
                            d,
                            D,
                            line.depth + static_cast<std::uint64_t>(n) * line.depth_step,
                            steps.last - n,
                            n == 0 && line.is_before_start != 0};
  const std::uint64_t passed = state_.color_write ? draw_pixels<Test, true>(line, record, at_first, n)
                                                  : draw_pixels<Test, false>(line, record, at_first, n);
  count(static_cast<std::uint64_t>(steps.last - n + 1), passed);
}

/// Where a line enters the bin and how it goes on.
struct LinePixels {
  int x, y;                                  ///< pixel of the bin
  int along_x, along_y, across_x, across_y;  ///< steps of one pixel
  std::int64_t error, d, D;                  ///< as in LineState
  std::uint64_t depth;
  std::int64_t left;  ///< pixels behind the first
  bool shows_start;
};

/// Draws them; returns how many have passed. Everything that the loop needs is in variables of its own: the compiler
/// cannot know that a pixel is not one of the bin's members.
template <DepthFunc Test, bool HasColor>
HALFPLANE_INLINE std::uint64_t draw_pixels(const LineSetup& line, const Record& record, const LinePixels& from,
                                           std::int64_t n) {
  typedef std::uint32_t U4 __attribute__((vector_size(16)));
  typedef std::uint8_t Bytes __attribute__((vector_size(4)));
  const int guard_bits = widths_.line_guard_bits;
  const std::uint64_t depth_mask = ~0ULL >> (64 - widths_.line_depth.bits), depth_step = line.depth_step;
  const auto channels_of = [](const std::array<std::uint64_t, 4>& c) HALFPLANE_LAMBDA {
    return U4{static_cast<std::uint32_t>(c[0]), static_cast<std::uint32_t>(c[1]), static_cast<std::uint32_t>(c[2]),
              static_cast<std::uint32_t>(c[3])};
  };
  const U4 color_step = channels_of(line.color_step);
  U4 color = channels_of(line.color) + static_cast<std::uint32_t>(n) * color_step;
  const std::uint32_t color_mask = (1U << widths_.line_color.bits) - 1;
  const bool is_rgba = config_.color_format == ColorFormat::rgba8888;
  const std::uint32_t depth_write = state_.depth_write ? ~0U : 0;
  const DepthFunc test = state_.depth_test;
  std::int32_t* const depths = memory_.depth.data();
  std::uint32_t* const pixels = memory_.color.data();
  const std::uint16_t *const column_at = position_.column_at.data(), *const row_at = position_.row_at.data();
  const int along_x = from.along_x, along_y = from.along_y, across_x = from.across_x, across_y = from.across_y;
  const std::int64_t d = from.d, D = from.D;

  int x = from.x, y = from.y, last_tile = -1;
  std::int64_t error = from.error;
  std::uint64_t depth = from.depth, passed_pixels = 0, tiles = 0;
  bool shows_start = from.shows_start;
  for (std::int64_t left = from.left; left >= 0; --left) {
    const int at = column_at[x] + row_at[y], tile = at / (kTileSize * kTileSize);
    if (tile != last_tile) {
      need_depth(tile);
      if (HasColor) need_color(tile);
      if (depth_write != 0) widen<Test>(tile, record.z_low, record.z_high);
      last_tile = tile;
      ++tiles;
    }
    auto code = static_cast<std::int32_t>((depth & depth_mask) >> guard_bits);
    if (shows_start) code = static_cast<std::int32_t>(line.depth_start);
    // Masks, not branches: what passes is anybody's guess.
    const std::int32_t stored = depths[at];
    const bool is_passed = Test == DepthFunc::less ? code < stored
                                                   : depth_passes(test, static_cast<std::uint32_t>(code),
                                                                  static_cast<std::uint32_t>(stored));
    const std::uint32_t passed = 0U - static_cast<std::uint32_t>(is_passed);
    passed_pixels += passed & 1;
    depths[at] = stored ^ ((stored ^ code) & static_cast<std::int32_t>(passed & depth_write));
    if (HasColor) {
      const U4 channel = (color & color_mask) >> guard_bits;
      std::uint32_t packed;
      if (is_rgba) {
        const auto bytes = __builtin_convertvector(channel, Bytes);
        std::memcpy(&packed, &bytes, 4);
      } else {
        packed = pack_rgb565<std::uint32_t>(channel[0], channel[1], channel[2]);
      }
      if (shows_start) {
        const std::uint32_t c = line.color_start;
        packed = is_rgba ? c : pack_rgb565<std::uint32_t>(c & 255, c >> 8 & 255, c >> 16 & 255);
      }
      pixels[at] ^= (pixels[at] ^ packed) & passed;
    }
    shows_start = false;
    const std::int64_t moves = ~(error >> 63);
    x += along_x + (across_x & static_cast<int>(moves));
    y += along_y + (across_y & static_cast<int>(moves));
    error += d - (D & moves);
    depth += depth_step;
    color += color_step;
  }
  job_.counters.tiles_visited += tiles;
  return passed_pixels;
}
