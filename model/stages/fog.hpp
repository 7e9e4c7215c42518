// Fog: a fragment's colour gives way to that of the fog, the more the farther it is from the eye.
//
//   f                of the distance w (scene.hpp, Fog), by a table of q = 1/w, which a pixel has anyway
//   colour           floor((C f + fog (2^12 - f)) / 2^12 + 1/2) of R, G and B, f in 2^-12
//
// The table is looked up by the floating representation of q, read as one integer: exponent and kPlaceBits bits of the
// mantissa. That is a piecewise linear logarithm of q: so many places in each octave, straight inside of an octave. 2^lines
// lines share 2^octaves octaves, from the last q that shows a trace of the colour to the first that shows no fog; beyond them
// the first and the last place count. Few octaves, as of a fog that begins far off, have many lines each.
//
// A line is what a straight line through both ends is, less half of what it is off in the middle, so that the two errors are
// alike. Ends are not held to 0...1: where a fog begins and ends is a bend of what is held, not of what is interpolated.
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
inline constexpr int kFogPlaceBits = 15;                          ///< of the mantissa of q that count
inline constexpr int kFogStartFraction = 15;                      ///< of a line's numbers
inline constexpr int kFogStartBits = 18;                          ///< with the sign: -4 to 4
inline constexpr int kFogFactorBits = 12;                         ///< fraction bits of f
inline constexpr std::uint32_t kFogClear = 1U << kFogFactorBits;  ///< f = 1

/// A line of a fog's table.
struct FogLine {
  std::int32_t start = 0;  ///< at its first place, 2^-15
  std::int32_t rise = 0;   ///< from there to the next line's, at least 0
  bool operator==(const FogLine&) const = default;
};

/// The place of Q = `code` > 0 in a table of 2^octave_bits octaves; `octave`: the one where Q = 1 would lie.
[[nodiscard]] std::int32_t fog_position(std::uint64_t code, int octave, int octave_bits);
/// f of a place on its line, which has 2^place_bits of them: 0...2^12.
[[nodiscard]] std::uint32_t fog_factor_on(const FogLine& line, std::int32_t place, int place_bits);

/// f at a distance w > 0, as real as binary64 is, the same on every machine. `held`: to 0...1, which it is but for linear.
[[nodiscard]] double fog_factor(const Fog& fog, double w, bool held = true);

/// The table of a fog.
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

  /// The most that factor() is off where q is known: lines, their rounding, f's, and the ends of the table.
  [[nodiscard]] double error_bound() const;

 private:
  [[nodiscard]] Line line_from(double q, double next) const;
  void find_range();

  Fog fog_;
  std::array<std::uint8_t, 3> color_;
  int first_ = 0, octave_bits_ = 0, place_bits_ = 0;
  std::vector<Line> line_;
};

/// The table of a draw's fog; none: there is no fog. Draws of one state get the same one.
[[nodiscard]] std::shared_ptr<const FogTable> fog_table(const State& state);

/// The most that f is off at a real distance w where q is off by `relative` of itself. The table's own part is in it.
[[nodiscard]] double fog_error_bound(const FogTable& table, double w, double relative);

/// f of a vertex: of lines and points, whose ends are fogged. What is not in front of the eye is as near as can be.
[[nodiscard]] std::uint32_t fog_factor_of_vertex(const Fog& fog, double w);

/// A channel in fog.
template <class Lane>
[[nodiscard]] constexpr Lane fogged(const Lane& color, const Lane& fog, const Lane& factor) {
  return (color * factor + fog * (kFogClear - factor) + kFogClear / 2) >> kFogFactorBits;
}

}  // namespace halfplane
