// Golden cull and triangle setup: signed area, orientation, the three edge functions.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "viewport.hpp"

namespace halfplane::golden {

/// One edge of a triangle of positive area: the inside is where value() > 0.
template <class Real>
struct Edge {
  Real x = 0, y = 0, dx = 0, dy = 0;
  Real sign = 1;
  bool owns_ties = false;  ///< top or left edge: samples exactly on it belong to this triangle

  [[nodiscard]] Real value(Real px, Real py) const { return sign * (dx * (py - y) - dy * (px - x)); }
  [[nodiscard]] bool inside(Real e) const { return e > 0 || (e == 0 && owns_ties); }
};

/// The edge from a to b. It is evaluated from its upper end in either direction, so that the two triangles that share
/// it get values of opposite sign and the same magnitude, with any rounding.
template <class Real>
[[nodiscard]] Edge<Real> make_edge(const ScreenVertex<Real>& a, const ScreenVertex<Real>& b) {
  const Real dx = b.x - a.x, dy = b.y - a.y;
  const bool is_top = dy == 0 && dx > 0, is_left = dy < 0;
  const bool from_b = b.y < a.y || (b.y == a.y && b.x < a.x);
  const auto& start = from_b ? b : a;
  const Real sign = from_b ? Real(-1) : Real(1);
  return {start.x, start.y, sign * dx, sign * dy, sign, is_top || is_left};
}

/// Twice the signed area, pixels^2; positive is clockwise as seen on the screen.
template <class Real>
[[nodiscard]] Real signed_area(const std::array<ScreenVertex<Real>, 3>& v) {
  return (v[1].x - v[0].x) * (v[2].y - v[0].y) - (v[1].y - v[0].y) * (v[2].x - v[0].x);
}

template <class Real>
[[nodiscard]] bool is_culled(Real area, const State& state) {
  if (area == 0 || !std::isfinite(area)) return true;  // no finite area: a vertex at the eye, or beyond the scalar type
  const bool is_front = (area > 0) == (state.front == FrontFace::cw);
  return state.cull == Cull::both || state.cull == (is_front ? Cull::front : Cull::back);
}

/// For a triangle that is not culled. Lines and points, a triangle's outline too, show their front.
template <class Real>
[[nodiscard]] bool shows_back(Real area, const State& state) {
  return (area > 0) != (state.front == FrontFace::cw);
}

/// A triangle of positive area.
template <class Real>
struct Setup {
  std::array<ScreenVertex<Real>, 3> v{};
  std::array<Edge<Real>, 3> edge{};  ///< edge[i] is opposite v[i]: its value is area times the weight of v[i]
  Real area = 0;
};

template <class Real>
[[nodiscard]] Setup<Real> setup_triangle(std::array<ScreenVertex<Real>, 3> v) {
  if (signed_area(v) < 0) std::swap(v[1], v[2]);
  Setup<Real> setup{v, {}, signed_area(v)};
  for (std::size_t i = 0; i < 3; ++i) setup.edge[i] = make_edge(v[(i + 1) % 3], v[(i + 2) % 3]);
  return setup;
}

}  // namespace halfplane::golden
