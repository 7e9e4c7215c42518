// Random and stressful triangles of eight families.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "model/config.hpp"
#include "sim/scene/scene_builder.hpp"

namespace halfplane::stress {

using Points = std::array<std::array<double, 2>, 3>;

/// Makes triangles of one family; coordinates in pixels, inside the guard band. Random: unit() in [0, 1), between(low,
/// high), index(count).
template <class Random>
class TriangleFamilies {
 public:
  TriangleFamilies(const Config& config, int width, int height, const Random& random)
      : random_(random),
        width_(width),
        height_(height),
        limit_(config.guard_band - 1),
        subpixel_(std::ldexp(1.0, -config.subpixel_bits)) {}

  static constexpr int kFamilies = 8;

  std::array<Vertex, 3> triangle(int family) {
    const Points p = points(family);
    std::array<Vertex, 3> v;
    const int depths = random_.index(5);
    const double base = random_.unit();
    for (std::size_t i = 0; i < 3; ++i) {
      double z = random_.unit();
      if (depths == 1) z = random_.index(2);                // the extreme codes
      if (depths == 2) z = base;                            // constant
      if (depths == 3) z = std::min(base + z * 1e-4, 1.0);  // almost no slope
      std::array<double, 4> rgba;
      for (double& c : rgba) c = random_.index(4) == 0 ? 255.0 * random_.index(2) : random_.between(0, 255);
      v[i] = at(p[i][0], p[i][1], z, rgba);
    }
    return v;
  }

 private:
  double clamp(double value) const { return std::clamp(value, -limit_, limit_); }
  std::array<double, 2> near_target() {
    return {random_.between(-4, width_ + 4.0), random_.between(-4, height_ + 4.0)};
  }
  std::array<double, 2> centre() { return {random_.index(width_) + 0.5, random_.index(height_) + 0.5}; }
  std::array<double, 2> anywhere() { return {random_.between(-limit_, limit_), random_.between(-limit_, limit_)}; }

  Points points(int family) {
    switch (family) {
      case 0: return {near_target(), near_target(), near_target()};
      case 1: return {centre(), centre(), centre()};  // samples on edges and vertices
      case 2: return right_triangle();
      case 3: return sliver();
      case 4: return {anywhere(), anywhere(), anywhere()};
      case 5: return corners();
      case 6: return unit_area();
      default: return small();
    }
  }

  /// Axis-parallel legs through pixel centres.
  Points right_triangle() {
    const auto a = centre(), b = centre();
    return {a, {b[0], a[1]}, {a[0], b[1]}};
  }

  /// Two far ends and a third vertex a few subpixels off their line.
  Points sliver() {
    const auto a = random_.index(2) == 0 ? near_target() : anywhere(), b = near_target();
    const double t = random_.unit();
    const auto off = [&] { return subpixel_ * (random_.index(7) - 3); };
    return {a, b, {clamp(a[0] + t * (b[0] - a[0]) + off()), clamp(a[1] + t * (b[1] - a[1]) + off())}};
  }

  /// Guard-band corners: the largest possible edges.
  Points corners() {
    const auto corner = [&] {
      const double x = random_.index(2) == 0 ? -limit_ : limit_, y = random_.index(2) == 0 ? -limit_ : limit_;
      return std::array{clamp(x + random_.between(-1, 1)), clamp(y + random_.between(-1, 1))};
    };
    return {corner(), corner(), near_target()};
  }

  /// Twice the area is one square subpixel: sides (a, b) and (c, d) with a d - b c = 1.
  Points unit_area() {
    long a = 1 + random_.index(600), b = 1 + random_.index(600);
    const long common = std::gcd(a, b);
    a /= common;
    b /= common;
    long c = 0, d = 1;  // a * d mod b = 1 by search: b is small
    while (d < b && a * d % b != 1 % b) ++d;
    c = (a * d - 1) / b;
    const auto start = centre();
    const double x = std::floor(start[0] / subpixel_) * subpixel_, y = std::floor(start[1] / subpixel_) * subpixel_;
    const auto step = [&](double from, long n) { return clamp(from + static_cast<double>(n) * subpixel_); };
    return {{{x, y}, {step(x, a), step(y, b)}, {step(x, c), step(y, d)}}};
  }

  /// Within a pixel or two, one corner on a pixel centre.
  Points small() {
    const auto a = centre();
    return {a,
            {a[0] + random_.between(-2, 2), a[1] + random_.between(-2, 2)},
            {a[0] + random_.index(5) * 0.5 - 1, a[1] + random_.index(5) * 0.5 - 1}};
  }

  Random random_;
  int width_, height_;
  double limit_, subpixel_;
};

}  // namespace halfplane::stress
