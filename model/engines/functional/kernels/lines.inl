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

/// Colours of the pixels `n` of a line.
HALFPLANE_INLINE I16 line_colors(const LineBatch& line, std::size_t i, const I16& n, ColorFormat format) {
  const auto channel = [&](std::size_t c) HALFPLANE_LAMBDA { return n * line.color_step[c][i] + line.color[c][i]; };
  const auto byte = [](const I16& value, int down) HALFPLANE_LAMBDA {
    return shift_right_logical(value, down) & static_cast<std::int32_t>(0xff000000U >> down);
  };
  const I16 rgba =
      shift_right_logical(channel(0), 24) | byte(channel(1), 16) | byte(channel(2), 8) | byte(channel(3), 0);
  return packed(rgba, format);
}

/// `Depth`: an integer as wide as the depth register, or wider.
template <class Fragments, class Depth>
HALFPLANE_NOINLINE void draw_pixels(Bin& bin, const LineBatch& line, std::size_t i) {
  constexpr int kDepthBits = 8 * static_cast<int>(sizeof(Depth)), kGroup = 16;
  const int depth_down = kDepthBits - bin.config.depth_bits;
  const bool has_color = bin.state.color_write;
  const auto depth_of = [](std::int64_t value)
                            HALFPLANE_LAMBDA { return static_cast<Depth>(value >> (64 - kDepthBits)); };
  const Depth first_depth = depth_of(line.depth[i]), depth_step = depth_of(line.depth_step[i]);
  const I16 is_x_major(line.is_x_major[i]), x_sign(line.x_sign[i]), y_sign(line.y_sign[i]);
  const I16 first_x(line.x[i] - line.x_sign[i]), first_y(line.y[i] - line.y_sign[i]);
  const ColorFormat format = Fragments::format(bin.config);
  const typename Fragments::Writer write(bin);
  FragmentLanes group;
  std::uint64_t tiles = 0, passed_pixels = 0;
  const int pixels_left = line.pixels[i];
  for (int first = 0; first < pixels_left; first += kGroup) {
    const int count = std::min(pixels_left - first, kGroup);
    const I16 n = bin.position.lane + first;
    const I16 moved = convert<std::int32_t>(convert<double>(n) * line.slope[i] + line.row[i]);
    const I16 x = (select(is_x_major, n, moved) ^ x_sign) + first_x,
              y = (select(is_x_major, moved, n) ^ y_sign) + first_y;
    const I16 at = place_of(x, y);  // lanes after the last pixel: anywhere in the bin
    at.store(group.place.data());
    const std::uint64_t touched = or_of_bits(I16(1), at >> 6, (1U << count) - 1);
    tiles |= touched;
    if ((touched & ~bin.line_tiles) != 0) touch_line_tiles<Fragments>(bin, touched & ~bin.line_tiles);
    const Pack<Depth, 16> depth = convert<Depth>(n) * depth_step + first_depth;
    convert<std::int32_t>(shift_right_logical(depth, depth_down)).store(group.depth.data());
    if (has_color) line_colors(line, i, n, format).store(group.color.data());
    if (first == 0 && line.shows_start[i] != 0) {
      group.depth[0] = line.depth_start[i];
      if (has_color) group.color[0] = packed(I16(line.color_start[i]), format).part[0][0];
    }
    passed_pixels += write(group, count);
  }
  bin.job.counters.tiles_visited += static_cast<unsigned>(std::popcount(tiles));
  count_fragments(bin, static_cast<std::uint64_t>(line.pixels[i]), passed_pixels);
}

/// Line `i` of a batch.
template <class Fragments>
HALFPLANE_INLINE void draw_line(Bin& bin, const LineBatch& lines, std::size_t i) {
  using Narrow = std::conditional_t<Fragments::kIsOpaque, std::int32_t, std::int64_t>;  // one instance suffices
  if (bin.widths.depth().line.bits <= 32)
    draw_pixels<Fragments, Narrow>(bin, lines, i);
  else
    draw_pixels<Fragments, std::int64_t>(bin, lines, i);
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

/// A line that was set up alone: cut by the scissor or the clipper. Its part in the bin becomes bin.cut_line; false if
/// there is none.
HALFPLANE_NOINLINE bool set_up_cut_line(Bin& bin, const LineSetup& line) {
  const std::int64_t d = line.step_stay, D = line.step_stay - line.step_move;
  const bool is_x_major = line.is_x_major != 0;
  Steps steps{0, line.remaining};
  const int x = line.x - bin.first_x, y = line.y - bin.first_y;
  clip_steps(steps, x, line.is_x_negative != 0, line.error, d, is_x_major ? 0 : D);
  clip_steps(steps, y, line.is_y_negative != 0, line.error, d, is_x_major ? D : 0);
  if (steps.first > steps.last) return false;
  const std::int64_t n = steps.first, remainder = line.error + (n - 1) * d + D;
  const auto major = static_cast<int>(n), minor = static_cast<int>(remainder / D);
  const int right = is_x_major ? major : minor, down = is_x_major ? minor : major;
  LineBatch& part = bin.cut_line;
  part.pixels[0] = static_cast<std::int32_t>(steps.last - n + 1);
  part.x_sign[0] = -line.is_x_negative;
  part.y_sign[0] = -line.is_y_negative;
  part.x[0] = x + (right ^ part.x_sign[0]) - part.x_sign[0];
  part.y[0] = y + (down ^ part.y_sign[0]) - part.y_sign[0];
  part.is_x_major[0] = -line.is_x_major;
  part.shows_start[0] = n == 0 ? -line.is_before_start : 0;
  part.row[0] = (static_cast<double>(remainder - minor * D) + 0.5) / static_cast<double>(D);
  part.slope[0] = static_cast<double>(d) / static_cast<double>(D);
  const int depth_up = 64 - bin.widths.depth().line.bits, color_up = 32 - bin.widths.color().line.bits;
  const auto steps_on = static_cast<std::uint64_t>(n);
  part.depth[0] = static_cast<std::int64_t>((line.value[kDepthPlane] + steps_on * line.step[kDepthPlane]) << depth_up);
  part.depth_step[0] = static_cast<std::int64_t>(line.step[kDepthPlane] << depth_up);
  for (std::size_t c = 0; c < 4; ++c) {
    part.color[c][0] = static_cast<std::int32_t>(
        static_cast<std::uint32_t>(line.value[kColorPlane + c] + steps_on * line.step[kColorPlane + c]) << color_up);
    part.color_step[c][0] =
        static_cast<std::int32_t>(static_cast<std::uint32_t>(line.step[kColorPlane + c]) << color_up);
  }
  part.depth_start[0] = static_cast<std::int32_t>(line.start[kDepthPlane]);
  part.color_start[0] = static_cast<std::int32_t>(packed_channels(line.start));
  return true;
}

template <class Fragments>
HALFPLANE_INLINE void draw_cut_line(Bin& bin, const LineSetup& line) {
  if (set_up_cut_line(bin, line)) draw_line<Fragments>(bin, bin.cut_line, 0);
}

/// Draws the pending lines.
template <class Fragments>
void draw_lines(Bin& bin, const Slice& slice) {
  if (bin.lines.count == 0) return;
  set_up_lines(bin.lines, slice, bin.job.frame, bin.first_x, bin.first_y);
  for (std::size_t i = 0; i < static_cast<std::size_t>(bin.lines.count); ++i)
    if (bin.lines.pixels[i] > 0) draw_line<Fragments>(bin, bin.lines, i);
  bin.lines.count = 0;
}

}  // namespace
}  // namespace halfplane::functional::HALFPLANE_ISA_NAME
