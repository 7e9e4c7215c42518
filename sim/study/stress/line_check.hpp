// Lines: pixels covered by the stages, and the exact oracle's answer pixel by pixel.
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "model/golden/exact_line.hpp"
#include "model/host/line_setup.hpp"
#include "model/stages/line_raster.hpp"
#include "sim/study/vertices.hpp"

namespace halfplane::stress {

/// A configuration with derived constants.
struct LineSpace {
  explicit LineSpace(const Config& config_) : config(config_), widths(derive_widths(config)) {}
  /// The guard band, including the pixel to its left and above, into which a line along its border is moved.
  [[nodiscard]] PixelBounds everything() const {
    return {-config.guard_band - 1, -config.guard_band - 1, config.guard_band - 1, config.guard_band - 1};
  }
  [[nodiscard]] PixelBounds target() const { return {0, 0, config.target_width - 1, config.target_height - 1}; }
  Config config;
  Widths widths;
};

inline std::vector<LinePixel> pixels_of(const exact::Line& line, const LineSpace& space, const PixelBounds& limit) {
  std::vector<LinePixel> pixels;
  const auto setup = setup_line(line.start, line.end, line.rule, line.drops_last, limit, space.widths);
  if (setup) line_raster(*setup, space.widths, [&](const LinePixel& pixel) { pixels.push_back(pixel); });
  return pixels;
}

inline std::vector<LinePixel> pixels_of(const exact::Line& line, const LineSpace& space) {
  return pixels_of(line, space, space.everything());
}

using Positions = std::vector<std::pair<int, int>>;

/// The positions, sorted: a set for comparison.
inline Positions positions(const std::vector<LinePixel>& pixels) {
  Positions list;
  for (const LinePixel& pixel : pixels) list.emplace_back(pixel.x, pixel.y);
  std::sort(list.begin(), list.end());
  return list;
}

/// Positions by the oracle: two pixels to each side of the line, across its major axis, and beyond its ends.
inline Positions oracle_positions_nearby(const exact::Line& line) {
  const int s = line.grid_bits;
  const auto dx = std::int64_t{line.end.x} - line.start.x, dy = std::int64_t{line.end.y} - line.start.y;
  const bool is_x_major = std::abs(dx) >= std::abs(dy);
  const SnappedVertex& low = (is_x_major ? dx : dy) >= 0 ? line.start : line.end;
  const SnappedVertex& high = (is_x_major ? dx : dy) >= 0 ? line.end : line.start;
  const int first = (is_x_major ? low.x : low.y) >> s, last = (is_x_major ? high.x : high.y) >> s;
  Positions list;
  for (int i = first - 2; i <= last + 2; ++i) {
    const double t = dx == 0 && dy == 0
                         ? 0
                         : std::ldexp(i - first, s) / static_cast<double>(is_x_major ? std::abs(dx) : std::abs(dy));
    const double minor0 = is_x_major ? low.y : low.x, minor1 = is_x_major ? high.y : high.x;
    const int near = static_cast<int>(std::floor(std::ldexp(minor0 + (minor1 - minor0) * t, -s)));
    for (int j = near - 2; j <= near + 2; ++j)
      if (exact::covers(line, is_x_major ? i : j, is_x_major ? j : i))
        list.emplace_back(is_x_major ? i : j, is_x_major ? j : i);
  }
  std::sort(list.begin(), list.end());
  return list;
}

/// Anywhere in `reach` (0...1) of the guard band, random depth and colour; one coordinate in four on a half pixel.
template <class Random>
SnappedVertex random_vertex(Random& random, const LineSpace& space, double reach) {
  const auto& range = space.widths.coordinate.range;
  const int half = 1 << (space.widths.grid_bits - 1);
  const auto coordinate = [&] {
    const double v = reach * random.between(static_cast<double>(range.lo), static_cast<double>(range.hi));
    const int subpixels = static_cast<int>(v);
    return random.index(4) == 0 ? subpixels & -half : subpixels;
  };
  SnappedVertex v;
  v.x = coordinate();
  v.y = coordinate();
  v.depth() =
      static_cast<std::uint32_t>(random.between(0, static_cast<double>(space.widths.depth().code.range.hi) + 1));
  set_colors(v, space.widths, [&] { return random.index(256); });
  return v;
}

/// |code - exact|, in LSB.
inline double code_error(std::uint32_t code, const exact::Rational& exact) {
  return std::abs(static_cast<double>(static_cast<int128>(code) * exact.denominator - exact.numerator)) /
         static_cast<double>(exact.denominator);
}

/// The largest errors of depth and colour over a line's pixels.
struct LineErrors {
  double depth = 0, color = 0;
};

inline void add_errors(LineErrors& worst, const exact::Line& line, const std::vector<LinePixel>& pixels,
                       const LineSpace& space) {
  for (const LinePixel& pixel : pixels) {
    worst.depth = std::max(worst.depth, code_error(pixel.code[kDepthPlane], exact::depth_at(line, pixel.x, pixel.y)));
    for (int c = 0; c < space.widths.color_planes; ++c)
      worst.color = std::max(worst.color, code_error(pixel.code[kColorPlane + static_cast<std::size_t>(c)],
                                                     exact::color_at(line, pixel.x, pixel.y, c)));
  }
}

}  // namespace halfplane::stress
