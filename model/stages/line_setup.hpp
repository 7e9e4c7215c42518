// Line setup: two snapped vertices in, everything that line_raster needs to step along the line out.
//
// The line is looked at in its own octant: `a` is the major axis, `b` the minor one, both turned so that they grow from
// start to end; D >= d >= 0 are the differences, subpixels. In column i (pixels across the major axis) the line covers
// the pixel in whose row it crosses the centre of the column:
//
//   row(i) = floor((N(i) / 2^s) / D),   N(i) = b0 D + d (centre(i) - a0) - [a tie stays]
//
// N changes by d 2^s from column to column, so that its low s bits fold into the bias as those of an edge do, and a
// remainder of D is all that is stepped. The rules differ in the ends, and in the tie:
//
//   midpoint    ends moved to the centres of their pixels; a tie goes to the pixel nearer the line's left end
//   bresenham   the same pixels; the two books' decision variables are one and the same integer
//   diamond     subpixel ends; the segment moved by (-e, -e^2) covers the pixels whose diamond it leaves
//
// A clipped line starts at its first pixel inside, found by quotient and remainder: its pixels, depths and colours are
// those of the whole line. Reciprocal and divisions are the setup's own: line_raster only adds.
#pragma once

#include <optional>

#include "../packets.hpp"
#include "../scene.hpp"
#include "cull.hpp"

namespace halfplane {

/// line_setup -> line_raster: a line with at least one pixel inside the scissor.
/// The states ride with the line's place in program order, a PrimitivePacket of kind line.
struct LineSetup {
  std::uint32_t primitive_id = 0;    ///< that of the PrimitivePacket; left at 0 by setup_line
  std::int32_t x = 0, y = 0;         ///< the first pixel; inside the target when it goes to the RTL
  std::uint8_t is_x_major = 0;       ///< 1: every step changes x
  std::uint8_t is_x_negative = 0;    ///< 1: x falls
  std::uint8_t is_y_negative = 0;    ///< likewise y
  std::uint8_t is_before_start = 0;  ///< 1: the first pixel's centre lies before the start: it shows the start's codes
  std::uint32_t remaining = 0;       ///< pixels after the first
  std::int64_t error = 0;            ///< p: >= 0 when the next pixel lies in the next row
  std::int64_t step_stay = 0;        ///< d, added to p after a step along the major axis alone
  std::int64_t step_move = 0;        ///< d - D, added to p after a step along both
  std::uint64_t depth = 0;           ///< 2^-G' LSB at the first pixel's major coordinate, plus one half LSB
  std::uint64_t depth_step = 0;      ///< per pixel
  std::uint32_t depth_start = 0;     ///< code of the start
  std::array<std::uint64_t, 4> color{}, color_step{};  ///< likewise
  std::uint32_t color_start = 0;                       ///< 8 bits a stored channel, R lowest

  static constexpr std::string_view name = "line_setup";
  static constexpr auto fields() {
    using P = LineSetup;
    return std::tuple{Field{"primitive_id", &P::primitive_id, &Widths::primitive_id},
                      Field{"x", &P::x, &Widths::pixel_x},
                      Field{"y", &P::y, &Widths::pixel_y},
                      Field{"is_x_major", &P::is_x_major, &Widths::flag},
                      Field{"is_x_negative", &P::is_x_negative, &Widths::flag},
                      Field{"is_y_negative", &P::is_y_negative, &Widths::flag},
                      Field{"is_before_start", &P::is_before_start, &Widths::flag},
                      Field{"remaining", &P::remaining, &Widths::line_count},
                      Field{"error", &P::error, &Widths::line_error},
                      Field{"step_stay", &P::step_stay, &Widths::line_stay},
                      Field{"step_move", &P::step_move, &Widths::line_move},
                      Field{"depth", &P::depth, &Widths::line_depth},
                      Field{"depth_step", &P::depth_step, &Widths::line_depth},
                      Field{"depth_start", &P::depth_start, &Widths::depth_code},
                      Field{"color", &P::color, &Widths::line_color, &Widths::color_channels},
                      Field{"color_step", &P::color_step, &Widths::line_color, &Widths::color_channels},
                      Field{"color_start", &P::color_start, &Widths::vertex_color}};
  }
};

/// Whether a rule leaves out the last pixel when nobody says: the textbooks draw both ends; diamond exit never does.
[[nodiscard]] constexpr bool drops_last_by_default(LineRule rule) { return rule == LineRule::diamond; }

/// The line from `start` to `end` inside `limit` (inclusive, anywhere in the guard band), or nothing when it covers no
/// pixel there. `drops_last`: leaves out the pixel of `end`; diamond exit leaves it out whatever this says.
[[nodiscard]] std::optional<LineSetup> setup_line(const SnappedVertex& start, const SnappedVertex& end, LineRule rule,
                                                  bool drops_last, const PixelBounds& limit, const Config& config,
                                                  const Widths& widths);

}  // namespace halfplane
