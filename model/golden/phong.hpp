// Golden light of fragments, in real arithmetic: Blinn's model with one light at infinity and the viewer at infinity.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "../binary64.hpp"
#include "../scene.hpp"
#include "color.hpp"

namespace halfplane::golden {

using Direction = std::array<double, 3>;

/// Normalised to length 1; 0 where it is 0.
[[nodiscard]] inline Direction unit(const Direction& v) {
  const double largest = std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])});
  if (!(largest > 0)) return {};
  const Direction scaled{v[0] / largest, v[1] / largest, v[2] / largest};
  const double length = length3(scaled[0], scaled[1], scaled[2]);
  return {scaled[0] / length, scaled[1] / length, scaled[2] / length};
}

[[nodiscard]] inline double dot(const Direction& a, const Direction& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// N.L and the highlight of a normal of any length, 0...1.
struct LightFactors {
  double diffuse = 0, specular = 0;
};
[[nodiscard]] inline LightFactors light_factors(const State& state, const Direction& normal) {
  const Direction n = unit(normal);
  const double facing = dot(n, unit(state.light_direction));
  if (!(facing > 0)) return {};
  return {std::min(facing, 1.0), std::pow(std::clamp(dot(n, unit(state.light_half)), 0.0, 1.0), state.light_shininess)};
}

/// R, G and B in the state's light.
[[nodiscard]] inline RealColor in_light(const State& state, const RealColor& color, const LightFactors& factors) {
  RealColor result = color;
  for (std::size_t c = 0; c < 3; ++c) {
    const double shown = (state.light_ambient[c] + state.light_diffuse[c] * factors.diffuse) / 255;
    result[c] = std::min(color[c] * shown + state.light_specular[c] * factors.specular, 255.0);
  }
  return result;
}

}  // namespace halfplane::golden
