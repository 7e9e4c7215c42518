#include "level_of_detail.hpp"

#include <cmath>

#include "../binary64.hpp"

namespace halfplane {
namespace {

/// One coordinate's functions before scaling, in texels Q^2 per subpixel times A.
struct Numerators {
  double slope = 0;                ///< sum c_k
  std::array<double, 3> row{};     ///< N_x at the rows of the vertices
  std::array<double, 3> column{};  ///< -N_y at their columns
};

Numerators numerators(const std::array<SnappedVertex, 3>& v, const QCodes& q, const std::array<double, 3>& u) {
  std::array<double, 3> c{};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
    c[k] = static_cast<double>(q[i]) * static_cast<double>(q[j]) * (u[i] - u[j]);
  }
  Numerators n;
  n.slope = c[0] + c[1] + c[2];
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      n.row[i] += c[k] * static_cast<double>(std::int64_t{v[i].y} - v[k].y);
      n.column[i] += c[k] * static_cast<double>(std::int64_t{v[i].x} - v[k].x);
    }
  return n;
}

/// The line through `value` at `position` subpixels. Stepped from the pixel at that place, so that the rounding of the
/// step acts only inside the triangle.
LodLine to_line(double value, double slope, int position, double scale, int grid_bits) {
  const auto residue = [](double number) {
    double whole = std::floor(number + 0.5);
    if (!(std::abs(whole) < 0x1p62)) whole = std::remainder(whole, 0x1p32);
    return static_cast<std::uint32_t>(static_cast<std::int64_t>(whole));
  };
  const int pixel = position >> grid_bits;
  const double centre = scaled(pixel + 0.5, grid_bits);
  LodLine line;
  line.step = residue(scaled(slope * scale, grid_bits));
  line.at_zero = residue((value + slope * (centre - position)) * scale) - static_cast<std::uint32_t>(pixel) * line.step;
  return line;
}

}  // namespace

LodSetup setup_lod(const std::array<SnappedVertex, 3>& v, std::int64_t area, const QCodes& q,
                   const std::array<std::array<double, 3>, 2>& uv, int guard_bits, int grid_bits) {
  const std::array<Numerators, 2> n{numerators(v, q, uv[0]), numerators(v, q, uv[1])};
  double largest = 0, sum = 0;
  for (const Numerators& of : n)
    for (std::size_t i = 0; i < 3; ++i) {
      largest = std::max({largest, std::abs(of.row[i]), std::abs(of.column[i])});
      sum += std::abs(of.row[i]) + std::abs(of.column[i]);
    }
  LodSetup setup;
  if (!std::isfinite(sum) || largest == 0) {  // more texels than binary64 can count, or a constant coordinate
    setup.offset = (largest == 0 ? -64 : 64) * (1 << kLodFraction);
    return setup;
  }
  // N per pixel is N per subpixel times 2^s.
  const double to_pixels = power_of_two(grid_bits) / static_cast<double>(area);
  const int g = 30 - floor_log2_of(largest * to_pixels);
  const double scale = scaled(to_pixels, g);
  for (std::size_t c = 0; c < 2; ++c) {
    setup.along_y[c] = to_line(n[c].row[0], n[c].slope, v[0].y, scale, grid_bits);
    setup.along_x[c] = to_line(n[c].column[0], n[c].slope, v[0].x, scale, grid_bits);
  }
  setup.offset = (2 * guard_bits - g) * (1 << kLodFraction);
  return setup;
}

}  // namespace halfplane
