// A line step by step: the registers of line_raster by each rule, and the values of two textbooks.
//
// Bresenham's algorithm adds up its decision p; the midpoint method evaluates on which side of the line the point M
// between the two candidates lies, 2 F(M). Both move between the centres of the end pixels and here break ties as
// line_setup does: to the pixel on the left end's side. They are written from the books, in whole pixels, and share no
// code with the stage.
#pragma once

#include "history.hpp"
#include "model/host/primitives.hpp"

namespace halfplane::explain {

/// The registers of line_raster from the first pixel inside `limit` to the last.
[[nodiscard]] std::vector<LineStep> register_steps(const DrawnLine& line, LineRule rule, bool drops_last,
                                                   const PixelBounds& limit, const Widths& widths);

/// J. E. Bresenham, Algorithm for computer control of a digital plotter (1965): p = 2 d - D at the start, then 2 d is
/// added, less 2 D after a diagonal step. Both end pixels.
[[nodiscard]] std::vector<LineStep> bresenham_steps(const DrawnLine& line, int grid_bits);

/// M. L. V. Pitteway (1967), J. R. Van Aken (1984): 2 F(M), evaluated anew at each pixel.
[[nodiscard]] std::vector<LineStep> midpoint_steps(const DrawnLine& line, int grid_bits);

/// The data of a line at a pixel; `wants_all`: of every pixel.
[[nodiscard]] LineFigure line_figure(const LinePrimitive& primitive, LineRule rule, const PixelBounds& limit,
                                     const Widths& widths, Pixel at, bool wants_all);

}  // namespace halfplane::explain
