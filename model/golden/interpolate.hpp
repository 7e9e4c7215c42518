// Golden interpolation: barycentric weights at the pixel centre; depth linear on the screen, colour so or with
// perspective.
#pragma once

#include <array>
#include <cstddef>

#include "triangle_setup.hpp"

namespace halfplane::golden {

template <class Real>
struct Fragment {
  Real z = 0;                  ///< window depth, 0...1
  std::array<Real, 4> rgba{};  ///< 0...255
};

/// The attributes at a sample whose edge values are `e`, colour by `rule`.
template <class Real>
[[nodiscard]] Fragment<Real> interpolate(const Setup<Real>& t, const std::array<Real, 3>& e, ColorInterp rule) {
  // Differences to vertex 0, so that an attribute equal at all three stays exactly constant.
  const Real b1 = e[1] / t.area, b2 = e[2] / t.area;
  const auto blend = [&](Real a, Real b, Real c, Real w1, Real w2) { return a + w1 * (b - a) + w2 * (c - a); };
  const auto& [v0, v1, v2] = t.v;

  Fragment<Real> f;
  f.z = blend(v0.z, v1.z, v2.z, b1, b2);
  if (rule == ColorInterp::affine) {
    for (std::size_t c = 0; c < 4; ++c) f.rgba[c] = blend(v0.rgba[c], v1.rgba[c], v2.rgba[c], b1, b2);
    return f;
  }
  const Real inverse_w = blend(v0.inverse_w, v1.inverse_w, v2.inverse_w, b1, b2);
  const bool has_w = v0.inverse_w > 0 && v1.inverse_w > 0 && v2.inverse_w > 0;  // a window-space w may be anything
  const Real p1 = has_w ? b1 * v1.inverse_w / inverse_w : b1, p2 = has_w ? b2 * v2.inverse_w / inverse_w : b2;
  for (std::size_t c = 0; c < 4; ++c) f.rgba[c] = blend(v0.rgba[c], v1.rgba[c], v2.rgba[c], p1, p2);
  return f;
}

}  // namespace halfplane::golden
