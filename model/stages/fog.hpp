// Fog: blends a fragment's colour with the fog's colour by its distance from the eye.
//
//   f                from the distance w (scene.hpp, Fog), by a table of q = 1/w, which a pixel has anyway
//   colour           floor((C f + fog (2^12 - f)) / 2^12 + 1/2) for R, G and B, f in 2^-12
//
// The table is looked up by the floating representation of q, read as one integer: exponent and kPlaceBits bits of the
// mantissa. That is a piecewise linear logarithm of q: equally many places in each octave, linear inside an octave.
// 2^lines lines share 2^octaves octaves, from the smallest q with a visible trace of the colour to the first without
// fog; beyond them the first and the last place count. Few octaves, as for a fog that begins far away, have many lines
// each.
//
// A line is the chord through both ends, less half of its error in the middle, so that the two errors are equal. Ends
// are not clamped to 0...1: the begin and the end of a fog are bends of the clamped value, not of the interpolated one.
//
// The table is part of a draw's state and made on the host, in binary64 without any library's exp: the same everywhere.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "../scene.hpp"

namespace halfplane {

inline constexpr int kFogLines = 8;                               ///< log2 of the lines of a table
inline constexpr int kFogOctaves = 4;                             ///< log2 of the most octaves
inline constexpr int kFogPlaceBits = 15;                          ///< significant bits of the mantissa of q
inline constexpr int kFogStartFraction = 15;                      ///< fraction bits of a line's numbers
inline constexpr int kFogStartBits = 18;                          ///< bits with the sign: -4 to 4
inline constexpr int kFogFactorBits = 12;                         ///< fraction bits of f
inline constexpr std::uint32_t kFogClear = 1U << kFogFactorBits;  ///< f = 1

/// A line of a fog's table.
struct FogLine {
  std::int32_t start = 0;  ///< at its first place, 2^-15
  std::int32_t rise = 0;   ///< from there to the next line, at least 0
  bool operator==(const FogLine&) const = default;
};

/// The place of Q = `code` > 0 in a table of 2^octave_bits octaves; `octave`: that of Q = 1.
[[nodiscard]] std::int32_t fog_position(std::uint64_t code, int octave, int octave_bits);
/// f at a place on its line, which has 2^place_bits places: 0...2^12.
[[nodiscard]] std::uint32_t fog_factor_on(const FogLine& line, std::int32_t place, int place_bits);

/// f at a distance w > 0, computed in binary64, the same on every machine. `held`: clamped to 0...1, which only matters
/// for linear.
[[nodiscard]] double fog_factor(const Fog& fog, double w, bool held = true);

class FogTable {
 public:
  using Line = FogLine;

  explicit FogTable(const Fog& fog, const std::array<std::uint8_t, 3>& color = {}, int line_bits = kFogLines);

  [[nodiscard]] const Fog& fog() const { return fog_; }
  [[nodiscard]] const std::array<std::uint8_t, 3>& color() const { return color_; }
  [[nodiscard]] const std::vector<Line>& lines() const { return line_; }
  /// q of the first place: 2^first.
  [[nodiscard]] int first() const { return first_; }
  /// log2 of the octaves, and of a line's places.
  [[nodiscard]] int octave_bits() const { return octave_bits_; }
  [[nodiscard]] int place_bits() const { return place_bits_; }
  [[nodiscard]] std::int32_t last_position() const { return (1 << (kFogPlaceBits + octave_bits_)) - 1; }

  /// The place of q, which is `code` 2^-scale. Precondition: code > 0.
  [[nodiscard]] std::int32_t position(std::uint64_t code, int scale) const;
  /// f at a place, 0...2^12.
  [[nodiscard]] std::uint32_t factor(std::int32_t position) const;
  [[nodiscard]] std::uint32_t factor(std::uint64_t code, int scale) const { return factor(position(code, scale)); }

  /// Bound of the error of factor() for exact q: lines, their rounding, f's, and the ends of the table.
  [[nodiscard]] double error_bound() const;

 private:
  [[nodiscard]] Line line_from(double q, double next) const;
  void find_range();

  Fog fog_;
  std::array<std::uint8_t, 3> color_;
  int first_ = 0, octave_bits_ = 0, place_bits_ = 0;
  std::vector<Line> line_;
};

/// The table of a draw's fog; null: no fog. Draws with equal state share a table.
[[nodiscard]] std::shared_ptr<const FogTable> fog_table(const State& state);

/// Bound of the error of f at a real distance w with relative error `relative` of q. Includes the table's own error.
[[nodiscard]] double fog_error_bound(const FogTable& table, double w, double relative);

/// f of a vertex: for lines and points, which are fogged at their ends. A vertex that is not in front of the eye counts
/// as nearest.
[[nodiscard]] std::uint32_t fog_factor_of_vertex(const Fog& fog, double w);

/// A channel blended with fog.
template <class Lane>
[[nodiscard]] constexpr Lane fogged(const Lane& color, const Lane& fog, const Lane& factor) {
  return (color * factor + fog * (kFogClear - factor) + kFogClear / 2) >> kFogFactorBits;
}

}  // namespace halfplane
