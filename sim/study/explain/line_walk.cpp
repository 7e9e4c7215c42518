#include "line_walk.hpp"

#include <algorithm>
#include <cstdlib>

#include "model/stages/line_raster.hpp"

namespace halfplane::explain {
namespace {

/// The pixels of the ends, and the line in its octant: whole pixels.
struct PixelLine {
  std::int64_t x0, y0, x1, y1;
  [[nodiscard]] std::int64_t run() const { return std::abs(x1 - x0); }
  [[nodiscard]] std::int64_t rise() const { return std::abs(y1 - y0); }
  [[nodiscard]] bool is_x_major() const { return run() >= rise(); }
  [[nodiscard]] std::int64_t major() const { return std::max(run(), rise()); }
  [[nodiscard]] std::int64_t minor() const { return std::min(run(), rise()); }
  /// Whether a tie between two pixels goes to the later one: the pixel on the left end's side wins; for a steep line
  /// the left one, in either direction.
  [[nodiscard]] bool tie_moves() const { return x1 < x0; }
  /// Pixel (i along, j across) from the start.
  [[nodiscard]] LineStep at(std::int64_t i, std::int64_t j) const {
    const std::int64_t along_x = is_x_major() ? i : j, along_y = is_x_major() ? j : i;
    LineStep step;
    step.step = static_cast<std::uint32_t>(i);
    step.x = static_cast<int>(x0 + (x1 < x0 ? -along_x : along_x));
    step.y = static_cast<int>(y0 + (y1 < y0 ? -along_y : along_y));
    return step;
  }
};

PixelLine pixels_of(const DrawnLine& line, int grid_bits) {
  return {line.start.x >> grid_bits, line.start.y >> grid_bits, line.end.x >> grid_bits, line.end.y >> grid_bits};
}

/// Walks with decision(i, j), > 0 for a diagonal step.
template <class Decision>
std::vector<LineStep> walk(const PixelLine& line, Decision&& decision) {
  std::vector<LineStep> steps;
  for (std::int64_t i = 0, j = 0; i <= line.major(); ++i) {
    LineStep step = line.at(i, j);
    step.error = decision(i, j);
    step.moves = step.error > 0 || (step.error == 0 && line.tie_moves());
    j += step.moves ? 1 : 0;
    steps.push_back(step);
  }
  return steps;
}

/// Keeps the steps at the pixel's place along the line.
void keep_at(std::vector<LineStep>& steps, Pixel at, bool is_x_major) {
  std::erase_if(steps, [&](const LineStep& step) { return is_x_major ? step.x != at.x : step.y != at.y; });
}

}  // namespace

std::vector<LineStep> register_steps(const DrawnLine& line, LineRule rule, bool drops_last, const PixelBounds& limit,
                                     const Widths& widths) {
  std::vector<LineStep> steps;
  const auto setup = setup_line(line.start, line.end, rule, drops_last, limit, widths);
  if (!setup) return steps;
  LineState state = first_state(*setup);
  for (std::uint32_t n = 0;; ++n) {
    steps.push_back({n, state.x, state.y, state.error, state.error >= 0});
    if (state.remaining == 0) return steps;
    advance(state, *setup, widths);
  }
}

std::vector<LineStep> bresenham_steps(const DrawnLine& line, int grid_bits) {
  const PixelLine pixels = pixels_of(line, grid_bits);
  const std::int64_t d = pixels.minor(), D = pixels.major();
  std::int64_t p = 2 * d - D, before = 0;
  return walk(pixels, [&](std::int64_t i, std::int64_t j) {
    if (i != 0) p += j != before ? 2 * d - 2 * D : 2 * d;
    before = j;
    return p;
  });
}

std::vector<LineStep> midpoint_steps(const DrawnLine& line, int grid_bits) {
  const PixelLine pixels = pixels_of(line, grid_bits);
  return walk(pixels, [&](std::int64_t i, std::int64_t j) {
    // F(i, j) = d i - D j is 0 on the line, positive where it has passed below; M = (i + 1, j + 1/2).
    return 2 * pixels.minor() * (i + 1) - pixels.major() * (2 * j + 1);
  });
}

LineFigure line_figure(const LinePrimitive& primitive, LineRule rule, const PixelBounds& limit, const Widths& widths,
                       Pixel at, bool wants_all) {
  const DrawnLine& line = primitive.drawn;
  const int s = widths.grid_bits;
  LineFigure figure;
  figure.rule = rule;
  figure.setup = primitive.setup;
  const bool is_diamond = rule == LineRule::diamond;
  const PixelLine pixels = pixels_of(line, s);
  const std::int64_t run = is_diamond ? std::abs(std::int64_t{line.end.x} - line.start.x) : pixels.run() << s;
  const std::int64_t rise = is_diamond ? std::abs(std::int64_t{line.end.y} - line.start.y) : pixels.rise() << s;
  figure.is_x_major = run >= rise;
  figure.major = std::max(run, rise);
  figure.minor = std::min(run, rise);
  for (const LineRule each : {LineRule::midpoint, LineRule::bresenham, LineRule::diamond}) {
    const bool drops_last = each == rule ? line.drops_last : drops_last_by_default(each);
    figure.walks.push_back({each, register_steps(line, each, drops_last, limit, widths)});
  }
  figure.bresenham = bresenham_steps(line, s);
  figure.midpoint = midpoint_steps(line, s);
  if (wants_all) return figure;
  for (LineWalk& each : figure.walks) keep_at(each.steps, at, figure.is_x_major);
  keep_at(figure.bresenham, at, figure.is_x_major);
  keep_at(figure.midpoint, at, figure.is_x_major);
  return figure;
}

}  // namespace halfplane::explain
