// Level of detail: the number of texels that a pixel spans, as a power of two, which selects a texture's level.
//
//   lambda = log2 max(|(u_x, v_x)|, |(u_y, v_y)|), derivatives in texels a pixel
//
// computed at each pixel separately: neither neighbours nor the coverage of the stamp matter. With u = P / Q, u_x = N_x
// / Q^2, N_x = P_x Q - P Q_x. P and Q are planes, so d N_x / dx = 0: N_x is a linear function of y alone, and N_y = P_y
// Q - P Q_y of x alone. With c_k = Q_i Q_j (u_i - u_j), (i, j, k) in turn, and A twice the area,
//
//   N_x = sum c_k (y - y_k) / A,  N_y = -sum c_k (x - x_k) / A
//
// so u and v have four lines with two slopes between them. They are held in 32-bit lanes, scaled by a power of two,
// 2^g, that brings their largest value at the triangle's vertices to 2^30...2^31. Because they are modulo 2^32, values
// far outside do no harm. Then
//
//   lambda = L(max(oct(N_xu, N_xv), oct(N_yu, N_yv))) - 2 L(Q) + 2 l - g
//
// oct: a length by a polygon, within -3.0 % and +0.8 %; L: log2 from the eight bits after the leading one. All
// logarithms have 8 fraction bits.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "../fixed.hpp"
#include "perspective.hpp"

namespace halfplane {

inline constexpr int kLodFraction = 8;  ///< fraction bits of a level of detail
using Lod = std::int32_t;               ///< 2^-8 levels

/// N_x or N_y of one coordinate, 2^-g, modulo 2^32: at_zero + n step at the centres of pixel row or column n.
struct LodLine {
  std::uint32_t at_zero = 0, step = 0;

  /// The line's magnitude.
  [[nodiscard]] constexpr std::uint32_t at(int n) const {
    const std::uint32_t value = at_zero + static_cast<std::uint32_t>(n) * step;
    return value >> 31 != 0 ? 0 - value : value;
  }
};

/// Data of a textured triangle besides its planes.
struct LodSetup {
  std::array<LodLine, 2> along_y{};  ///< N_x of u and of v
  std::array<LodLine, 2> along_x{};  ///< N_y of u and of v
  Lod offset = 0;                    ///< 2 l - g
};

/// `v`, `q` and the coordinates in texels, all in canonical order; l = `guard_bits` of Q. Host, binary64.
[[nodiscard]] LodSetup setup_lod(const std::array<SnappedVertex, 3>& v, std::int64_t area, const QCodes& q,
                                 const std::array<std::array<double, 3>, 2>& uv, int guard_bits, int grid_bits);

/// The length of a vector by an octagon's distance: max(a, 7/8 a + 1/2 b), a >= b.
[[nodiscard]] constexpr std::uint32_t octagon_length(std::uint32_t a, std::uint32_t b) {
  const std::uint32_t high = std::max(a, b), low = std::min(a, b);
  return std::max(high, high - (high >> 3) + (low >> 1));
}

/// log2(value), 8 fraction bits; of 0 as of 1. A parabola between powers of two, off by at most 1/64.
[[nodiscard]] constexpr Lod log2_code(std::uint64_t value) {
  if (value == 0) return 0;
  const int e = floor_log2(value);
  const auto part =
      static_cast<Lod>((e < kLodFraction ? value << (kLodFraction - e) : value >> (e - kLodFraction)) & 255U);
  return (e << kLodFraction) + part + (part * (256 - part) * 95 >> 16);
}

/// lambda at pixel (x, y), `q` from q_at().
[[nodiscard]] constexpr Lod level_of_detail(const LodSetup& setup, std::uint64_t q, int x, int y) {
  const std::uint32_t to_right = octagon_length(setup.along_y[0].at(y), setup.along_y[1].at(y)),
                      down = octagon_length(setup.along_x[0].at(x), setup.along_x[1].at(x));
  return log2_code(std::max(to_right, down)) - 2 * log2_code(q) + setup.offset;
}

/// The one level nearest to lambda, the lower of two: ceil(lambda + 1/2) - 1, from 0 to the last.
[[nodiscard]] constexpr int nearest_level(Lod lod, int last_level) {
  return std::clamp((lod + 127) >> kLodFraction, 0, last_level);
}

/// The two levels around lambda, and the weight of the upper one, in 256ths.
struct LevelPair {
  int lower = 0, upper = 0;
  std::uint32_t part = 0;
};
[[nodiscard]] constexpr LevelPair levels_around(Lod lod, int last_level) {
  const int level = lod >> kLodFraction;
  return {std::clamp(level, 0, last_level), std::clamp(level + 1, 0, last_level),
          static_cast<std::uint32_t>(lod) & 255U};
}

}  // namespace halfplane
