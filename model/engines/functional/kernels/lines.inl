// The part of a line in the bin: the pixels of line_raster, sixteen at a time, from the closed form of its steps.
#pragma once

#include "bin.inl"
#include "fragments.inl"
#include "line_setup.inl"
#include "tile_memory.inl"

namespace halfplane::functional::HALFPLANE_ISA_NAME {
namespace {

/// Tiles that lines have not touched since triangles last did: they must be in memory, and their ranges become unknown.
template <class Fragments>
HALFPLANE_NOINLINE void touch_line_tiles(Bin& bin, std::uint64_t tiles) {
  bin.line_tiles |= tiles;
  for (; tiles != 0; tiles &= tiles - 1) {
    const int tile = std::countr_zero(tiles);
    need_depth(bin, tile);
    if (bin.state.color_write) need_color(bin, tile);
    if (bin.state.depth_write) forget_range<Fragments>(bin, tile);
  }
  if (!Fragments::kIsLess) find_bin_range(bin);
}

/// Colours along a line, from its first pixel.
struct LineColors {
  I16 first[4], step[4];
  Packing packing;

  HALFPLANE_INLINE LineColors(const LineBatch& line, std::size_t i, const Packing& packing_) : packing(packing_) {
    for (std::size_t c = 0; c < 4; ++c) {
      first[c] = I16(line.color[c][i]);
      step[c] = I16(line.color_step[c][i]);
    }
  }

  /// Of the pixels `n`, at these places.
  HALFPLANE_INLINE I16 operator()(const I16& n, const I16& place) const {
    const auto channel = [&](std::size_t c) HALFPLANE_LAMBDA { return n * step[c] + first[c]; };
    return packed_at(place, highest_bytes(channel(0), channel(1), channel(2), channel(3)), packing);
  }
};

/// Places of the pixels of a line.
struct LinePlaces {
  const std::int32_t* major;
  bool is_x_major, is_long;
  int fine, block, tile;            ///< shifts of a position across to the bits of a place
  I16 in_block, of_block, of_tile;  ///< those bits
  I16 minor, step;
  double row, slope;

  HALFPLANE_INLINE LinePlaces(const std::int32_t* places, const LineBatch& line, std::size_t i)
      : major(places + line.major[i]),
        is_x_major(line.is_x_major[i] != 0),
        is_long(line.is_long),
        fine(kMinorPoint - (is_x_major ? 2 : 0)),
        block(kMinorPoint - (is_x_major ? 3 : 2)),
        tile(kMinorPoint - (is_x_major ? 6 : 3)),
        in_block(is_x_major ? 3 << 2 : 3),
        of_block(is_x_major ? 4 << 3 : 4 << 2),
        of_tile(is_x_major ? 56 << 6 : 56 << 3),
        minor(line.minor[i]),
        step(line.minor_step[i]),
        row(is_long ? line.row[i] : 0),
        slope(is_long ? line.slope[i] : 0) {}

  /// Of the pixels `n`, consecutive from `first` on. After the last pixel of the bin: anywhere in the bin.
  HALFPLANE_INLINE I16 operator()(const I16& n, int first) const {
    I16 position = n * step + minor;
    if (is_long) [[unlikely]] {
      const I16 moved = convert<std::int32_t>(convert<double>(n) * slope + row), sign = step >> 31;
      position = (((moved ^ sign) - sign) << kMinorPoint) + minor;
    }
    return I16::load(major + first) + ((shift_right_logical(position, fine) & in_block) |
                                       (shift_right_logical(position, block) & of_block) |
                                       (shift_right_logical(position, tile) & of_tile));
  }
};

/// Visits of tiles along a line, which never returns to a tile.
struct TileVisits {
  I16 previous;
  unsigned visits = 1;

  HALFPLANE_INLINE TileVisits() : previous(0) {}

  /// Adds the first `count` of the next sixteen pixels.
  HALFPLANE_INLINE void add(const I16& place, int count, bool is_first) {
    constexpr std::int32_t kUpToSign = 0x7fffffff - (int{kTilePixels} - 1);
    const std::uint32_t lanes = (1U << count) - (is_first ? 2 : 1);
    visits += static_cast<unsigned>(std::popcount(bits_of((place ^ moved_up(previous, place)) + kUpToSign) & lanes));
    previous = place;
  }
};

/// The first `count` lines of a batch. `Depth`: an integer as wide as the depth register, or wider.
template <class Fragments, class Depth>
HALFPLANE_NOINLINE void draw_pixels(Bin& bin, const LineBatch& lines, std::size_t count) {
  constexpr int kDepthBits = 8 * static_cast<int>(sizeof(Depth)), kGroup = 16;
  const int depth_down = kDepthBits - bin.config.depth_bits;
  const bool has_color = bin.state.color_write;
  const Packing packing = Fragments::packing(bin);
  const std::int32_t* const places = bin.line_positions.place.data();
  const typename Fragments::Writer write(bin);
  const I16 lane = bin.position.lane;
  FragmentLanes group;
  unsigned visits = 0;
  std::uint64_t covered_pixels = 0, passed_pixels = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const int pixels_left = lines.pixels[i];
    if (pixels_left <= 0) continue;
    const auto depth_of = [](std::int64_t value)
                              HALFPLANE_LAMBDA { return static_cast<Depth>(value >> (64 - kDepthBits)); };
    const Pack<Depth, 16> first_depth(depth_of(lines.depth[i])), depth_step(depth_of(lines.depth_step[i]));
    const LineColors color(lines, i, packing);
    const LinePlaces place(places, lines, i);
    TileVisits tiles;
    for (int first = 0; first < pixels_left; first += kGroup) {
      const int pixels = std::min(pixels_left - first, kGroup);
      const I16 n = lane + first, at = place(n, first);
      at.store(group.place.data());
      tiles.add(at, pixels, first == 0);
      if (~bin.line_tiles != 0)
        if (const std::uint64_t touched = or_of_bits(I16(1), at >> 6, (1U << pixels) - 1) & ~bin.line_tiles;
            touched != 0)
          touch_line_tiles<Fragments>(bin, touched);
      const Pack<Depth, 16> depth = convert<Depth>(n) * depth_step + first_depth;
      convert<std::int32_t>(shift_right_logical(depth, depth_down)).store(group.depth.data());
      if (has_color) color(n, at).store(group.color.data());
      if (first == 0 && lines.shows_start[i] != 0) {
        group.depth[0] = lines.depth_start[i];
        if (has_color) group.color[0] = packed_at(at, I16(lines.color_start[i]), packing).part[0][0];
      }
      passed_pixels += write(group, pixels);
    }
    visits += tiles.visits;
    covered_pixels += static_cast<unsigned>(pixels_left);
  }
  bin.job.counters.tiles_visited += visits;
  count_fragments(bin, covered_pixels, passed_pixels);
}

/// Steps [first, last] of a line, counted from its first pixel, in which one coordinate is inside the bin.
struct Steps {
  std::int64_t first = 0, last = 0;
};

/// `start`: the coordinate at step 0, in pixels of the bin; `is_negative`: the coordinate decreases. D: 0 for the
/// coordinate that moves in every step; otherwise it has moved floor((error + (n - 1) d + D) / D) pixels after n steps.
HALFPLANE_INLINE void clip_steps(Steps& steps, std::int32_t start, bool is_negative, std::int64_t error, std::int64_t d,
                                 std::int64_t D) {
  const std::int64_t enters = is_negative ? start - (kBinSize - 1) : -start;  // moves until it enters the bin
  const std::int64_t leaves = is_negative ? start : kBinSize - 1 - start;     // the last move within the bin
  const auto step_of = [&](std::int64_t move) HALFPLANE_LAMBDA {              // the first step after this many moves
    if (D == 0) return move;
    const std::int64_t numerator = (move - 1) * D - error;
    if (d == 0) return numerator <= 0 ? std::int64_t{1} : std::int64_t{1} << 40;
    return (numerator > 0 ? (numerator + d - 1) / d : -(-numerator / d)) + 1;
  };
  if (enters > 0) steps.first = std::max(steps.first, step_of(enters));
  if (leaves < 0) steps.last = -1;
  if (leaves >= 0 && leaves < steps.last) steps.last = std::min(steps.last, step_of(leaves + 1) - 1);
}

/// Lane `i` of a batch: a line that was set up alone, cut by the scissor or the clipper.
HALFPLANE_NOINLINE void set_up_cut_line(const Bin& bin, const LineSetup& line, LineBatch& part, std::size_t i) {
  const std::int64_t d = line.step_stay, D = line.step_stay - line.step_move;
  const bool is_x_major = line.is_x_major != 0;
  Steps steps{0, line.remaining};
  const int x = line.x - bin.first_x, y = line.y - bin.first_y;
  clip_steps(steps, x, line.is_x_negative != 0, line.error, d, is_x_major ? 0 : D);
  clip_steps(steps, y, line.is_y_negative != 0, line.error, d, is_x_major ? D : 0);
  part.pixels[i] = static_cast<std::int32_t>(std::max<std::int64_t>(steps.last - steps.first + 1, 0));
  if (part.pixels[i] == 0) return;
  const std::int64_t n = steps.first, remainder = line.error + (n - 1) * d + D;
  const auto major = static_cast<int>(n), minor = static_cast<int>(remainder / D);
  const int right = is_x_major ? major : minor, down = is_x_major ? minor : major;
  const auto moved_by = [](int from, int by, auto is_negative) { return is_negative != 0 ? from - by : from + by; };
  const int first_x = moved_by(x, right, line.is_x_negative), first_y = moved_by(y, down, line.is_y_negative);
  part.is_x_major[i] = -line.is_x_major;
  part.major[i] = LinePositions::first<std::int32_t>(is_x_major ? first_x : first_y, part.is_x_major[i],
                                                     -(is_x_major ? line.is_x_negative : line.is_y_negative));
  part.shows_start[i] = n == 0 ? -line.is_before_start : 0;
  part.is_long |= D >= kLongLine;
  part.row[i] = (static_cast<double>(remainder - minor * D) + 0.5) / static_cast<double>(D);
  part.slope[i] = static_cast<double>(d) / static_cast<double>(D);
  constexpr double kPixel = 1 << kMinorPoint;
  const bool is_minor_negative = (is_x_major ? line.is_y_negative : line.is_x_negative) != 0;
  const auto first_minor = static_cast<std::uint32_t>((is_x_major ? first_y : first_x) + (is_minor_negative ? 1 : 0));
  const auto fraction = static_cast<std::int32_t>(part.row[i] * kPixel),
             step = static_cast<std::int32_t>(part.slope[i] * kPixel);
  part.minor[i] = static_cast<std::int32_t>((first_minor << kMinorPoint) +
                                            static_cast<std::uint32_t>(is_minor_negative ? -fraction : fraction));
  part.minor_step[i] = is_minor_negative ? -step : step;
  const int depth_up = 64 - bin.widths.depth().line.bits, color_up = 32 - bin.widths.color().line.bits;
  const auto steps_on = static_cast<std::uint64_t>(n);
  part.depth[i] = static_cast<std::int64_t>((line.value[kDepthPlane] + steps_on * line.step[kDepthPlane]) << depth_up);
  part.depth_step[i] = static_cast<std::int64_t>(line.step[kDepthPlane] << depth_up);
  for (std::size_t c = 0; c < 4; ++c) {
    part.color[c][i] = static_cast<std::int32_t>(
        static_cast<std::uint32_t>(line.value[kColorPlane + c] + steps_on * line.step[kColorPlane + c]) << color_up);
    part.color_step[c][i] =
        static_cast<std::int32_t>(static_cast<std::uint32_t>(line.step[kColorPlane + c]) << color_up);
  }
  part.depth_start[i] = static_cast<std::int32_t>(line.start[kDepthPlane]);
  part.color_start[i] = static_cast<std::int32_t>(packed_channels(line.start));
}

/// Draws the pending lines.
template <class Fragments>
void draw_lines(Bin& bin, const Slice& slice) {
  LineBatch& lines = bin.lines;
  if (lines.count == 0) return;
  lines.is_long = false;
  if (lines.cut != (1U << lines.count) - 1) set_up_lines(lines, slice, bin.job.frame, bin.first_x, bin.first_y);
  for (std::uint32_t left = lines.cut; left != 0; left &= left - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(left));
    set_up_cut_line(bin, slice.lines[lines.cut_line[i]], lines, i);
  }
  if (bin.widths.depth().line.bits <= 32) {
    using Narrow = std::conditional_t<Fragments::kIsOpaque, std::int32_t, std::int64_t>;  // one instance suffices
    draw_pixels<Fragments, Narrow>(bin, lines, static_cast<std::size_t>(lines.count));
  } else {
    draw_pixels<Fragments, std::int64_t>(bin, lines, static_cast<std::size_t>(lines.count));
  }
  lines.count = 0;
  lines.cut = 0;
}

}  // namespace
}  // namespace halfplane::functional::HALFPLANE_ISA_NAME
