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
//
// A line wider than a pixel is as many strands of one, side by side across the major axis (OpenGL ES 1.1, 3.4.2): the
// line moved along the minor axis, after the snap, by i - (N - 1)/2 pixels, 0 <= i < N. Where the rule rounds the ends
// to pixels a strand lies in whole rows, and of an even N the larger half on the side that grows. No pixel is in two
// strands, and what is drawn along the line is the same in all of them.
#pragma once

#include <optional>

#include "../packets.hpp"
#include "../scene.hpp"
#include "cull.hpp"

namespace halfplane {

/// Whether a rule leaves out the last pixel when nobody says: the textbooks draw both ends; diamond exit never does.
[[nodiscard]] constexpr bool drops_last_by_default(LineRule rule) { return rule == LineRule::diamond; }

/// The line from `start` to `end` inside `limit` (inclusive, anywhere in the guard band), or nothing when it covers no
/// pixel there. `drops_last`: leaves out the pixel of `end`; diamond exit leaves it out whatever this says.
[[nodiscard]] std::optional<LineSetup> setup_line(const SnappedVertex& start, const SnappedVertex& end, LineRule rule,
                                                  bool drops_last, const PixelBounds& limit, const Widths& widths);

/// How many strands a line of that width has: rounded, at least 1. `width`: pixels, below 2^30.
[[nodiscard]] int strands_of(double width);

/// Moves the ends of a line to strand `i` of `count`. They must not leave 31 bits.
void move_to_strand(SnappedVertex& start, SnappedVertex& end, int i, int count, LineRule rule, int grid_bits);

}  // namespace halfplane
