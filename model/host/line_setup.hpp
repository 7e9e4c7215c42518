// Line setup: two snapped vertices in, the constants of line_raster's steps along the line out.
//
// The line is described in its own octant: `a` is the major axis, `b` the minor one, both reversed if necessary so that
// they grow from start to end; D >= d >= 0 are the differences, subpixels. In column i (pixels across the major axis)
// the line covers the pixel in whose row it crosses the centre of the column:
//
//   row(i) = floor((N(i) / 2^s) / D),   N(i) = b0 D + d (centre(i) - a0) - [a tie stays]
//
// N changes by d 2^s from column to column, so that its low s bits fold into the bias as for an edge, and only a
// remainder of D is stepped. The rules differ in the ends, and in the tie:
//
//   midpoint    ends moved to the centres of their pixels; a tie goes to the pixel nearer the line's left end
//   bresenham   the same pixels; the two books' decision variables are one and the same integer
//   diamond     subpixel ends; the segment moved by (-e, -e^2) covers the pixels whose diamond it leaves
//
// A clipped line starts at its first pixel inside, found by quotient and remainder: its pixels, depths and colours are
// those of the whole line. Reciprocal and divisions are part of setup: line_raster only adds.
//
// A line wider than a pixel is N strands of width 1, side by side across the major axis (OpenGL ES 1.1, 3.4.2): the
// line moved along the minor axis, after the snap, by i - (N - 1)/2 pixels, 0 <= i < N. Where the rule rounds the ends
// to pixels a strand lies in whole rows, and for an even N the larger half is on the positive side. No pixel is in two
// strands, and attributes along the line are the same in all strands.
//
// The rule `rectangle` is different: the line is a rectangle of its width about the segment, ends cut square (OpenGL
// 4.6, 14.5.4, the multisampled line), drawn as two triangles. Its corners are the snapped ends plus and minus one
// vector across them, snapped to their grid: an exact parallelogram, whose planes do not change across the line.
#pragma once

#include <array>
#include <optional>

#include "../packets/packets.hpp"
#include "../scene.hpp"
#include "../stages/cull.hpp"

namespace halfplane {

/// Whether a rule leaves out the last pixel by default: the textbooks draw both ends; diamond exit never does.
[[nodiscard]] constexpr bool drops_last_by_default(LineRule rule) { return rule == LineRule::diamond; }

/// The line from `start` to `end` inside `limit` (inclusive, anywhere in the guard band), or none when it covers no
/// pixel there. `drops_last`: leaves out the pixel of `end`; diamond exit always leaves it out.
[[nodiscard]] std::optional<LineSetup> setup_line(const SnappedVertex& start, const SnappedVertex& end, LineRule rule,
                                                  bool drops_last, const PixelBounds& limit, const Widths& widths);

/// The number of strands of a line of that width: rounded, at least 1. `width`: pixels, below 2^30.
[[nodiscard]] int strands_of(double width);

/// Moves the ends of a line to strand `i` of `count`. They must still fit 31 bits.
void move_to_strand(SnappedVertex& start, SnappedVertex& end, int i, int count, LineRule rule, int grid_bits);

/// The corners of a line as a rectangle, in order around it: two of the start, two of the end, with the codes of their
/// ends. None when the ends coincide. `width`: pixels, at least 1, so that the area is not 0. The reversed line has the
/// same corners, and the same diagonal from the first to the third.
[[nodiscard]] std::optional<std::array<SnappedVertex, 4>> line_rectangle(const SnappedVertex& start,
                                                                         const SnappedVertex& end, double width,
                                                                         int grid_bits);

}  // namespace halfplane
