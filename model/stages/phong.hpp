// Phong: light of each fragment, from a normal that is interpolated over w and renormalised.
//
//   normal           P = n Q at a pixel (perspective.hpp), three planes. P / |P| is n / |n|: nothing is divided by Q
//   m                P with 15 bits and a sign, scaled to its largest component: rounded, one shift for all three
//   1 / |m|          a table of 256 lines, from m^2
//   N.L, N.H         m.L / |m| and m.H / |m|, clamped at 0, in 2^-17; L and H of 15 bits and a sign
//   (N.H)^shininess  a table of 256 lines over 1 - N.H below 2^-j; 0 beyond
//   colour           C (ambient + diffuse N.L) + specular (N.H)^shininess where N.L > 0, clamped to 255
//
// One light at infinity, viewer at infinity, so that L and H are constant over the draw. Both, the colours and the
// table of the power are part of a draw's state and made on the host, in binary64 with square roots only: the same on
// every machine.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "../scene.hpp"
#include "perspective.hpp"

namespace halfplane {

inline constexpr int kNormalFraction = 15;      ///< fraction bits of a vertex's normal, and of L and H
inline constexpr int kBlockBits = 15;           ///< bits of m, without its sign
inline constexpr int kRootLines = 7;            ///< log2 of the lines of 1 / sqrt in each of two octaves
inline constexpr int kRootPlaceBits = 10;       ///< bits of a place on a line
inline constexpr int kRootFraction = 18;        ///< fraction bits of 1 / sqrt
inline constexpr int kCosineFraction = 17;      ///< fraction bits of N.L and N.H
inline constexpr int kPowerLines = 8;           ///< log2 of the lines of a power
inline constexpr int kPowerStartFraction = 15;  ///< fraction bits of a line's numbers
inline constexpr int kLightFraction = 12;       ///< fraction bits of the factors of colours

/// Precision of the planes of normals: as those of colours, with two bits more.
[[nodiscard]] constexpr OverWFormat normal_format(const PerspectiveFormat& format) {
  return {format.q_bits < 20 ? format.q_bits : 20, 0, 0, false};
}

/// A normal of length 1, or 0 where it is 0; in binary64, with no library function but the exact root of IEEE 754.
[[nodiscard]] std::array<double, 3> unit_normal(const std::array<double, 3>& normal);
/// Codes of a vertex's normal: |n| <= 1.
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

/// m: P with 15 bits and a sign. 0 if P is 0.
[[nodiscard]] Normal block_normal(const std::array<std::int64_t, 3>& p);

/// 1 / |m| as in hardware: `root` 2^-18 2^-exponent.
struct InverseLength {
  int exponent = 0;        ///< 14 or 15: floor(log2 |m|)
  std::uint32_t root = 0;  ///< 2^17 to 2^18 - 1
};
/// Precondition: m is not 0.
[[nodiscard]] InverseLength inverse_length(const Normal& m);
/// The 256 lines: 1 / sqrt(1...2), then 1 / sqrt(2...4).
[[nodiscard]] const std::array<FallingLine, std::size_t{2} << kRootLines>& root_lines();

/// The cosine between m and a direction: 0 to 2^17, and slightly more. 0 if m points away.
[[nodiscard]] std::uint32_t cosine(const Normal& m, const InverseLength& length, const Normal& direction);

/// The light on a normal.
struct LightFactors {
  std::uint32_t diffuse = 0;   ///< N.L, 2^-12: 0...2^12
  std::uint32_t specular = 0;  ///< (N.H)^shininess, likewise; 0 where N.L is 0
};

/// The registers for a pixel's light: all that hardware holds.
struct LightRegisters {
  Normal direction{}, half{};
  std::array<std::uint32_t, 3> ambient{}, diffuse{};  ///< 2^-12
  std::array<std::uint8_t, 3> specular{};
  int narrow = 0;  ///< j: the table covers 1 - N.H below 2^-j
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
  /// The light as given in the state.
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
  /// The ambient part of a colour, and the part added by light falling straight on it: 2^-12.
  [[nodiscard]] const std::array<std::uint32_t, 3>& ambient() const { return registers_.ambient; }
  [[nodiscard]] const std::array<std::uint32_t, 3>& diffuse() const { return registers_.diffuse; }

  using Factors = LightFactors;
  [[nodiscard]] Factors factors(const Normal& m) const { return registers_.factors(m); }
  [[nodiscard]] std::uint32_t power(std::uint32_t cosine) const { return registers_.power(cosine); }
  [[nodiscard]] std::uint32_t lit(std::size_t channel, std::uint32_t color, const Factors& factors) const {
    return registers_.lit(channel, color, factors);
  }

  /// Error bounds of the factors against a real normal with the given N.L and N.H, if the normal of the planes is off
  /// by `turn` of its length.
  struct Bounds {
    double diffuse = 0, specular = 0;
  };
  [[nodiscard]] Bounds error_bounds(double cosine_of_light, double cosine_of_half, double turn) const;
  /// Error bound of lit() for factors with these errors, LSB.
  [[nodiscard]] double error_bound(std::size_t channel, std::uint32_t color, const Bounds& bounds) const;

 private:
  [[nodiscard]] double real_power(double x) const;
  void make_power();

  Given given_;
  LightRegisters registers_;
  double half_length_ = 1;  ///< of the half vector, corrected in the table
};

/// The light of a draw's fragments; null: no light. Draws with equal state share one.
[[nodiscard]] std::shared_ptr<const PhongLight> phong_light(const State& state);

/// x^n, 0 <= x < 2, by squares and square roots: relative error below 2^-40, the same on every machine. n in 2^-16.
[[nodiscard]] double power_of(double x, std::uint32_t n);

}  // namespace halfplane
