// Vectors of three binary64 numbers, for meshes and cameras.
#pragma once

#include <array>

#include "model/binary64.hpp"

namespace halfplane {

using Vec3 = std::array<double, 3>;

[[nodiscard]] inline Vec3 add(const Vec3& a, const Vec3& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
[[nodiscard]] inline Vec3 subtract(const Vec3& a, const Vec3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
[[nodiscard]] inline Vec3 scaled(const Vec3& a, double factor) { return {a[0] * factor, a[1] * factor, a[2] * factor}; }
[[nodiscard]] inline double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
[[nodiscard]] inline double length(const Vec3& a) { return length3(a[0], a[1], a[2]); }

[[nodiscard]] inline Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// The vector of length 1 in the same direction; zero stays zero.
[[nodiscard]] inline Vec3 normalized(const Vec3& a) {
  const double norm = length(a);
  return norm > 0 ? Vec3{a[0] / norm, a[1] / norm, a[2] / norm} : Vec3{};
}

}  // namespace halfplane
