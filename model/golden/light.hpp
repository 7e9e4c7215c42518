// Textbook fixed-function lighting in real arithmetic (binary64). Independent of the integer version except for the parameter
// structs.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "../binary64.hpp"
#include "../light.hpp"

namespace halfplane::golden {

using Real3 = std::array<double, 3>;

namespace light_detail {
inline double dot(const Real3& a, const Real3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Real3 normalized(const Real3& v) {
  const double length = length3(v[0], v[1], v[2]);
  return length > 0 ? Real3{v[0] / length, v[1] / length, v[2] / length} : Real3{};
}
}  // namespace light_detail

/// Direction to a light from a place, and the fraction of its intensity there.
struct LightAt {
  Real3 direction{};  ///< length 1
  double strength = 1;
};

/// Both in the same space.
inline LightAt light_at(const Light& light, const Real3& place) {
  using namespace light_detail;
  LightAt at{{light.position[0], light.position[1], light.position[2]}};
  if (light.position[3] == 0) return {normalized(at.direction)};
  for (std::size_t i = 0; i < 3; ++i) at.direction[i] -= place[i];
  const double d = length3(at.direction[0], at.direction[1], at.direction[2]);
  at.strength = 1 / (light.attenuation[0] + light.attenuation[1] * d + light.attenuation[2] * d * d);
  if (light.range > 0) at.strength *= std::max(0.0, 1 - std::pow(d / light.range, 4));
  at.direction = normalized(at.direction);
  if (light.spot_scale == 0) return at;
  const double cosine = -dot(light.spot_direction, at.direction);
  at.strength *= std::pow(std::clamp(cosine * light.spot_scale + light.spot_offset, 0.0, 1.0), 2);
  return at;
}

/// The colour of a vertex at `eye` (eye space) whose normal, of length 1, points to the visible side: 0...255.
inline Real3 light_color(const Lighting& lighting, const Real3& eye, const Real3& normal, const Material& material) {
  using namespace light_detail;
  Real3 sum{};
  for (std::size_t c = 0; c < 3; ++c) sum[c] = material.emission[c] + lighting.ambient[c] * material.ambient[c];
  const Real3 viewer = lighting.has_local_viewer ? normalized({-eye[0], -eye[1], -eye[2]}) : Real3{0, 0, 1};
  for (const Light& light : lighting.lights) {
    const auto [to_light, strength] = light_at(light, eye);
    const double facing = dot(normal, to_light);
    double diffuse = 0, specular = 0;
    if (facing > 0) {
      diffuse = facing;
      const Real3 half = normalized({to_light[0] + viewer[0], to_light[1] + viewer[1], to_light[2] + viewer[2]});
      specular = std::pow(std::max(dot(normal, half), 0.0), std::min(material.shininess, kMostShininess));
    }
    for (std::size_t c = 0; c < 3; ++c)
      sum[c] += strength * (light.ambient[c] * material.ambient[c] + light.diffuse[c] * material.diffuse[c] * diffuse +
                            light.specular[c] * material.specular[c] * specular);
  }
  for (double& c : sum) c = 255 * std::clamp(c, 0.0, 1.0);
  return sum;
}

}  // namespace halfplane::golden
