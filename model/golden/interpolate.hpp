// Golden interpolation: barycentric weights at the pixel centre; depth linear in the window, colours and
// texture coordinates linear or over w.
#pragma once

#include <array>
#include <cstddef>

#include "texture.hpp"
#include "triangle_setup.hpp"

namespace halfplane::golden {

template <class Real>
struct Fragment {
  Real z = 0;                  ///< window depth, 0...1
  std::array<Real, 4> rgba{};  ///< 0...255
  TextureCoordinates texture;  ///< for triangles
  Real inverse_w = 1;          ///< likewise; 0 or less for an invalid window-space w
};

/// Interpolation of colours and texture coordinates over a primitive.
struct InterpolationRules {
  ColorInterp color = ColorInterp::affine;
  TextureInterp texture = TextureInterp::perspective;
};

/// A value at a sample and its change per pixel: linear in the window, or a quotient of two linear values.
template <class Real>
struct Slope {
  Real value = 0, x = 0, y = 0;

  [[nodiscard]] friend Slope operator/(const Slope& a, const Slope& b) {
    const Real quotient = a.value / b.value;
    return {quotient, (a.x - quotient * b.x) / b.value, (a.y - quotient * b.y) / b.value};
  }
};

/// Sum of three weights times the values at the vertices.
template <class Real>
[[nodiscard]] Slope<Real> weighted(const std::array<Slope<Real>, 3>& weight, const std::array<Real, 3>& at) {
  Slope<Real> sum;
  for (std::size_t i = 0; i < 3; ++i) {
    sum.value += weight[i].value * at[i];
    sum.x += weight[i].x * at[i];
    sum.y += weight[i].y * at[i];
  }
  return sum;
}

/// Texture coordinates for given weights of the vertices; the weights need not add up to 1.
template <class Real, class Vertex>
[[nodiscard]] TextureCoordinates texture_at(const std::array<Slope<Real>, 3>& weight, const std::array<Vertex, 3>& v) {
  const Slope<Real> sum = weighted(weight, {1, 1, 1});
  const auto coordinate = [&](std::size_t k) {
    // Relative to vertex 0, so that a coordinate equal at all three stays constant.
    const Real base = v[0].uv[k];
    Slope<Real> c = weighted(weight, {0, v[1].uv[k] - base, v[2].uv[k] - base}) / sum;
    c.value += base;
    return c;
  };
  const Slope<Real> u = coordinate(0), w = coordinate(1);
  const auto wide = [](Real value) { return static_cast<double>(value); };
  return {wide(u.value), wide(w.value), wide(u.x), wide(u.y), wide(w.x), wide(w.y)};
}

/// The attributes at a sample whose edge values are `e`.
template <class Real>
[[nodiscard]] Fragment<Real> interpolate(const Setup<Real>& t, const std::array<Real, 3>& e, InterpolationRules rules) {
  // Differences to vertex 0, so that an attribute equal at all three stays exactly constant.
  const Real b1 = e[1] / t.area, b2 = e[2] / t.area;
  const auto blend = [&](Real a, Real b, Real c, Real w1, Real w2) { return a + w1 * (b - a) + w2 * (c - a); };
  const auto& [v0, v1, v2] = t.v;
  const bool has_w = v0.inverse_w > 0 && v1.inverse_w > 0 && v2.inverse_w > 0;  // a window-space w may be anything

  Fragment<Real> f;
  f.z = blend(v0.z, v1.z, v2.z, b1, b2);
  std::array<Slope<Real>, 3> weight;
  for (std::size_t i = 0; i < 3; ++i) {
    const Real q = has_w && rules.texture == TextureInterp::perspective ? t.v[i].inverse_w : Real(1);
    weight[i] = {q * e[i], q * -t.edge[i].sign * t.edge[i].dy, q * t.edge[i].sign * t.edge[i].dx};
  }
  f.texture = texture_at(weight, t.v);
  const Real inverse_w = blend(v0.inverse_w, v1.inverse_w, v2.inverse_w, b1, b2);
  f.inverse_w = has_w ? inverse_w : Real(0);
  if (rules.color == ColorInterp::affine) {
    for (std::size_t c = 0; c < 4; ++c) f.rgba[c] = blend(v0.rgba[c], v1.rgba[c], v2.rgba[c], b1, b2);
    return f;
  }
  const Real p1 = has_w ? b1 * v1.inverse_w / inverse_w : b1, p2 = has_w ? b2 * v2.inverse_w / inverse_w : b2;
  for (std::size_t c = 0; c < 4; ++c) f.rgba[c] = blend(v0.rgba[c], v1.rgba[c], v2.rgba[c], p1, p2);
  return f;
}

}  // namespace halfplane::golden
