// The exact oracle: coverage and attribute planes of one snapped triangle in integers and rationals, straight from the
// definition. No stepping, no canonical order, no code shared with the stages or the golden, which it checks.
//
// Bounds, with |X|, |Y| < 2^31 subpixels and codes < 2^32: differences < 2^32, products < 2^64, edge values and areas
// < 2^65, plane numerators < 2^65 * 2^32 * 3 < 2^99, on the grid of 2^-20 LSB < 2^120: all fit int128.
#pragma once

#include <array>
#include <cstdint>

#include "../fixed.hpp"
#include "../formats/sample_pattern.hpp"
#include "../packets/packets.hpp"
#include "../study/rules.hpp"

namespace halfplane::exact {

/// Fraction bits of the grid on which errors are held: fine enough that its half step never shows in a reported digit.
inline constexpr int kGridBits = 20;

/// An exact quotient, denominator > 0.
struct Rational {
  int128 numerator = 0;
  int128 denominator = 1;
};

/// Whether the triangle covers the centre of pixel (x, y). Both orientations; area 0 covers nothing. Coordinates in
/// units of 2^-grid_bits pixel, grid_bits >= 1 (Widths::grid_bits).
[[nodiscard]] bool covers(const Triangle& triangle, int x, int y, int grid_bits, FillRule rule = FillRule::top_left);

/// Whether that centre is on the closed triangle's border: exactly on an edge or a vertex.
[[nodiscard]] bool is_on_border(const Triangle& triangle, int x, int y, int grid_bits);

/// The plane through the three snapped vertices' depth codes at that centre, in depth LSB. The area must not be zero.
[[nodiscard]] Rational depth_at(const Triangle& triangle, int x, int y, int grid_bits);

/// The same through the 8-bit colour codes of one channel, in LSB of 8 bits.
[[nodiscard]] Rational color_at(const Triangle& triangle, int x, int y, int grid_bits, int channel);

/// The weights of the vertices at one sample: every plane through three codes follows from them.
struct PlaneWeights {
  std::array<int128, 3> weight{};
  int128 area = 1;  ///< their sum

  [[nodiscard]] Rational plane(const std::array<std::uint32_t, 3>& code) const {
    return {weight[0] * code[0] + weight[1] * code[1] + weight[2] * code[2], area};
  }
};

/// The same results for many samples of one triangle: constants are computed once, and products that fit use 64 bits.
/// Still each sample separately, without stepping.
class TriangleOracle {
 public:
  TriangleOracle(const Triangle& triangle, int grid_bits, FillRule rule = FillRule::top_left);
  [[nodiscard]] bool covers(int x, int y) const;
  [[nodiscard]] Rational depth_at(int x, int y) const;
  [[nodiscard]] Rational color_at(int x, int y, int channel) const;
  [[nodiscard]] PlaneWeights weights_at(int x, int y) const;

 private:
  struct Edge {
    std::int64_t x, y, dx, dy;  ///< start and direction, oriented so that the inside is positive
    bool owns;                  ///< includes the samples exactly on it
  };
  Triangle triangle_;
  int grid_bits_;
  int128 area_;                  ///< doubled, non-negative
  std::array<Edge, 3> edge_{};   ///< edge i lies opposite vertex i
  std::int64_t narrow_limit_{};  ///< for samples below it in both coordinates edge values fit 64 bits; 0: never
};

/// The triangle seen from a sample at `offset` from the centre of each pixel, on the same grid: moved the opposite way,
/// so that a test at a centre is a test at the sample.
[[nodiscard]] Triangle seen_from(Triangle triangle, const SampleOffset& offset);

/// floor(value * scale_numerator / scale_denominator * 2^kGridBits + 1/2), scale_numerator < 2^7.
[[nodiscard]] std::int64_t on_grid(const Rational& value, int scale_numerator = 1, int scale_denominator = 1);

}  // namespace halfplane::exact
