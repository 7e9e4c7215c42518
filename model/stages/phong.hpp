// Phong: light of each fragment, from a normal that is interpolated over w and made as long as 1 again.
//
//   normal           P = n Q at a pixel (perspective.hpp), three planes. P / |P| is n / |n|: nothing is divided by Q
//   m                P with 15 bits and a sign, the largest component just fitting: rounded, one shift for all three
//   1 / |m|          a table of 256 lines, from m^2
//   N.L, N.H         m.L / |m| and m.H / |m|, held to 0 and more, in 2^-17; L and H of 15 bits and a sign
//   (N.H)^shininess  a table of 256 lines over 1 - N.H below 2^-j; beyond it is nothing
//   colour           C (ambient + diffuse N.L) + specular (N.H)^shininess where N.L > 0, held to 255
//
// One light from infinitely far, seen from infinitely far, so that L and H are the draw's. Both, the colours and the table of
// the power are part of a draw's state and made on the host, in binary64 with square roots alone: the same everywhere.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "../config.hpp"
#include "../scene.hpp"
#include "perspective.hpp"

namespace halfplane {

inline constexpr int kNormalFraction = 15;      ///< of a vertex's normal, and of L and H
inline constexpr int kBlockBits = 15;           ///< of m, without its sign
inline constexpr int kRootLines = 7;            ///< log2 of the lines of 1 / sqrt in each of two octaves
inline constexpr int kRootPlaceBits = 10;       ///< of a line
inline constexpr int kRootFraction = 18;        ///< of 1 / sqrt
inline constexpr int kCosineFraction = 17;      ///< of N.L and N.H
inline constexpr int kPowerLines = 8;           ///< log2 of the lines of a power
inline constexpr int kPowerStartFraction = 15;  ///< of a line's numbers
inline constexpr int kLightFraction = 12;       ///< of the factors of colours

using Normal = std::array<std::int32_t, 3>;  ///< in 2^-15

/// How precise the planes of normals are: as those of colours, with two bits more.
[[nodiscard]] constexpr OverWFormat normal_format(const PerspectiveFormat& format) {
  return {format.q_bits < 20 ? format.q_bits : 20, 0, 0, false};
}

/// A normal as long as 1, or 0 where it is 0; in binary64, without any library's root but the one that IEEE 754 has.
[[nodiscard]] std::array<double, 3> unit_normal(const std::array<double, 3>& normal);
/// Of a vertex: |n| <= 1.
[[nodiscard]] Normal normal_codes(const std::array<double, 3>& normal);

/// P of one component at the vertices: n Q, with as many bits as the format has.
[[nodiscard]] OverW quantize_normal(const std::array<std::int32_t, 3>& component, const QCodes& q,
                                    const PerspectiveFormat& format);

// ---- Pixel

/// A line of a table: from `start` down by `fall`.
struct FallingLine {
  std::int32_t start = 0, fall = 0;
  bool operator==(const FallingLine&) const = default;
};

/// m: P with 15 bits and a sign. All 0 where P is.
[[nodiscard]] Normal block_normal(const std::array<std::int64_t, 3>& p);

/// 1 / |m| as hardware has it: `root` 2^-18 2^-exponent.
struct InverseLength {
  int exponent = 0;        ///< 14 or 15: floor(log2 |m|)
  std::uint32_t root = 0;  ///< 2^17 to 2^18 - 1
};
/// Precondition: m is not 0.
[[nodiscard]] InverseLength inverse_length(const Normal& m);
/// The 256 lines: 1 / sqrt(1...2), then 1 / sqrt(2...4).
[[nodiscard]] const std::array<FallingLine, std::size_t{2} << kRootLines>& root_lines();

/// The part of m that lies along a direction, of m's length: 0 to 2^17, and a hair more. 0 where it looks away.
[[nodiscard]] std::uint32_t cosine(const Normal& m, const InverseLength& length, const Normal& direction);

/// A normal's light.
struct LightFactors {
  std::uint32_t diffuse = 0;   ///< N.L, 2^-12: 0...2^12
  std::uint32_t specular = 0;  ///< (N.H)^shininess, likewise; 0 where N.L is 0
};

/// What a pixel's light looks at: all that hardware has of it.
struct LightRegisters {
  Normal direction{}, half{};
  std::array<std::uint32_t, 3> ambient{}, diffuse{};  ///< 2^-12
  std::array<std::uint8_t, 3> specular{};
  int narrow = 0;  ///< j: the table is of 1 - N.H below 2^-j
  std::array<FallingLine, std::size_t{1} << kPowerLines> line{};

  /// log2 of a line's places.
  [[nodiscard]] constexpr int place_bits() const { return kCosineFraction - narrow - kPowerLines; }
  [[nodiscard]] LightFactors factors(const Normal& m) const;
  /// (N.H)^shininess of a cosine in 2^-17, 2^-12.
  [[nodiscard]] std::uint32_t power(std::uint32_t cosine) const;
  /// A channel of red, green and blue in this light.
  [[nodiscard]] std::uint32_t lit(std::size_t channel, std::uint32_t color, const LightFactors& factors) const;
};

/// The light of a draw's state.
class PhongLight {
 public:
  /// What of it the state says.
  struct Given {
    std::array<double, 3> direction{}, half{};
    std::array<std::uint8_t, 3> ambient{}, diffuse{}, specular{};
    double shininess = 1;
    bool operator==(const Given&) const = default;
  };
  [[nodiscard]] static Given given_by(const State& state);
  explicit PhongLight(const Given& given);

  [[nodiscard]] const Given& given() const { return given_; }
  [[nodiscard]] const LightRegisters& registers() const { return registers_; }
  [[nodiscard]] const Normal& direction() const { return registers_.direction; }
  [[nodiscard]] const Normal& half() const { return registers_.half; }
  [[nodiscard]] const auto& lines() const { return registers_.line; }
  [[nodiscard]] int narrow() const { return registers_.narrow; }
  [[nodiscard]] int place_bits() const { return registers_.place_bits(); }
  /// What of a colour shows without light, and besides where it falls straight on it: 2^-12.
  [[nodiscard]] const std::array<std::uint32_t, 3>& ambient() const { return registers_.ambient; }
  [[nodiscard]] const std::array<std::uint32_t, 3>& diffuse() const { return registers_.diffuse; }

  using Factors = LightFactors;
  [[nodiscard]] Factors factors(const Normal& m) const { return registers_.factors(m); }
  [[nodiscard]] std::uint32_t power(std::uint32_t cosine) const { return registers_.power(cosine); }
  [[nodiscard]] std::uint32_t lit(std::size_t channel, std::uint32_t color, const Factors& factors) const {
    return registers_.lit(channel, color, factors);
  }

  /// The most that factors are off those of a real normal, whose N.L and N.H are given, where that of the planes is off by
  /// `turn` of its length.
  struct Bounds {
    double diffuse = 0, specular = 0;
  };
  [[nodiscard]] Bounds error_bounds(double cosine_of_light, double cosine_of_half, double turn) const;
  /// The most that lit() is off where the factors are off by so much, LSB.
  [[nodiscard]] double error_bound(std::size_t channel, std::uint32_t color, const Bounds& bounds) const;

 private:
  [[nodiscard]] double real_power(double x) const;
  void make_power();

  Given given_;
  LightRegisters registers_;
  double half_length_ = 1;  ///< of the half, which the table makes up for
};

/// The light of a draw's fragments; none: it has none. Draws of one state get the same one.
[[nodiscard]] std::shared_ptr<const PhongLight> phong_light(const State& state);

/// x^n, 0 <= x < 2, by squares and square roots: within 2^-40 of itself, the same on every machine. n in 2^-16.
[[nodiscard]] double power_of(double x, std::uint32_t n);

}  // namespace halfplane
