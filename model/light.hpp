// Fixed-function lighting, at vertices: ambient, directional and point lights, spots, Blinn-Phong, emission, one or two
// sides. The host's arithmetic, in fixed point: for a processor without floating point, bit by bit. The definition in
// real arithmetic: golden/light.hpp. The formats and the error: docs/light.md.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace halfplane {

/// In eye space. Full intensity of a colour is 1; lights may exceed it.
struct Light {
  std::array<double, 4> position{0, 0, 1, 0};  ///< w = 0: direction to the light; 1: its place
  std::array<double, 3> ambient{0, 0, 0}, diffuse{1, 1, 1}, specular{1, 1, 1};
  std::array<double, 3> attenuation{1, 0, 0};  ///< 1 / (constant + linear d + quadratic d^2), for a light with a place
  double range = 0;                            ///< likewise: it fades as 1 - (d / range)^4; 0: no fade
  /// A spot light's direction, length 1, and the square of clamp(cosine scale + offset), 0...1. Scale 0: in all
  /// directions.
  std::array<double, 3> spot_direction{0, 0, -1};
  double spot_scale = 0, spot_offset = 1;
  bool operator==(const Light&) const = default;
};

/// 0...1.
struct Material {
  std::array<double, 3> ambient{0.2, 0.2, 0.2}, diffuse{0.8, 0.8, 0.8}, specular{0, 0, 0}, emission{0, 0, 0};
  double shininess = 0;  ///< exponent of N.H, 0 to kMostShininess
  bool operator==(const Material&) const = default;
};

inline constexpr double kMostShininess = 2047;

/// Constants of all vertices.
struct Lighting {
  std::array<double, 3> ambient{0.2, 0.2, 0.2};  ///< ambient light
  std::vector<Light> lights;
  bool has_local_viewer = true;  ///< the eye is at the origin; false: infinitely far along +z, as in GL ES
};

// --- the formats ------------------------------------------------------------------------------------------------------

using FixedPlace = std::array<std::int32_t, 3>;      ///< s15.16, of places scaled by a power of two
using FixedDirection = std::array<std::int32_t, 3>;  ///< s1.30, length 1 within 2^-29; or zero
/// A light's colour: the largest channel of all three colours takes 31 bits, `bits` of them fraction.
using FixedColor = std::array<std::uint32_t, 3>;

/// Fraction bits; materials and sums of light are u.24.
inline constexpr int kDirectionBits = 30, kPlaceBits = 16, kMaterialBits = 24, kFallOffBits = 32;

/// Direction of any vector; zero for zero.
[[nodiscard]] FixedDirection fixed_direction(const std::array<std::int64_t, 3>& v);
[[nodiscard]] FixedDirection fixed_direction(const std::array<double, 3>& v);
/// s1.30, rounded once.
[[nodiscard]] std::int32_t fixed_dot(const FixedDirection& a, const FixedDirection& b);
/// x^n in u1.30: x in u1.30, n in u11.16. Logarithm and power by 512 lines each.
[[nodiscard]] std::uint32_t fixed_power(std::uint32_t x, std::uint32_t n);

/// Lights and scale as integers.
class FixedLighting {
 public:
  /// `extent`: bound on every coordinate of a place or light.
  FixedLighting(const Lighting& lighting, double extent);

  /// The colour of a vertex that shows its front: channels of 0...255 with 8 fraction bits. `normal` has length 1; for
  /// a back side the caller reverses it.
  [[nodiscard]] std::array<std::uint16_t, 3> color(const FixedPlace& eye, const FixedDirection& normal,
                                                   const Material& material) const;
  [[nodiscard]] FixedPlace place(const std::array<double, 3>& eye) const;

 private:
  struct FixedLight {
    bool is_somewhere = false, is_spot = false;
    FixedPlace place{};
    FixedDirection direction{}, spot{};
    FixedColor ambient{}, diffuse{}, specular{};
    int color_bits = 0;
    struct {
      std::uint64_t mantissa = 0;                  ///< 32 bits
      int bits = 0;                                ///< fraction bits
    } attenuation[3];                              ///< in scaled units
    std::uint64_t inverse_range = 0;               ///< u16.32, likewise
    std::int64_t spot_scale = 0, spot_offset = 0;  ///< s31.32
  };
  [[nodiscard]] std::uint64_t fall_off(const FixedLight& light, std::uint64_t distance,
                                       const FixedDirection& to_light) const;

  int scale_;  ///< a unit is 2^scale_ scaled ones
  bool has_local_viewer_;
  FixedColor ambient_;  ///< u.24
  std::vector<FixedLight> lights_;
};

}  // namespace halfplane
