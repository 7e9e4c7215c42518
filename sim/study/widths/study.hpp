// The widths of a configuration, tried: the used part of each derived range, and overflows with one bit less.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "model/stages/perspective.hpp"
#include "model/widths.hpp"
#include "sim/study/widths/probes.hpp"

namespace halfplane {

// The ratio of w over a triangle for which attributes over w keep a given error.

/// The errors on the page of widths: 1/16 texel, 2 LSB of 8 bits.
inline constexpr double kProvenTexels = 0.0625, kProvenColor = 2;

/// The largest ratio of w over a triangle for which over_w_bound() is at most `error` (texels, LSB) for an attribute of
/// extent `extent`; none if it is larger even with equal w.
[[nodiscard]] std::optional<double> proven_w_ratio(double extent, double error, const PerspectiveFormat& format,
                                                   const OverWFormat& attribute, int tile_size);

/// The ratio for a texture coordinate over `texels`, with kProvenTexels.
[[nodiscard]] inline std::optional<double> proven_w_ratio(double texels, const PerspectiveFormat& format,
                                                          int tile_size) {
  return proven_w_ratio(texels, kProvenTexels, format, format.coordinate, tile_size);
}

/// An input whose value does not fit a width with one bit less.
struct Overflow {
  Probe probe;
  int128 value = 0;
  std::uint64_t first_probe = 0;    ///< the first of the random probes that overflows, from 1; 0: only the search did
  std::uint64_t random_probes = 0;  ///< number of these
};

/// One width, derived and observed.
struct WidthRow {
  Width width;
  bool is_observed = false;  ///< false: exact by construction: see WidthObserver::is_observed()
  Interval range;            ///< value_range()
  Seen seen;
  int needed_bits = 0;                ///< for the observed values
  std::optional<Overflow> overflows;  ///< with one bit less; none: no observed value does

  [[nodiscard]] bool attains_lo() const { return seen.count != 0 && seen.lo == range.lo; }
  [[nodiscard]] bool attains_hi() const { return seen.count != 0 && seen.hi == range.hi; }
  [[nodiscard]] bool is_within() const { return seen.count == 0 || (seen.lo >= range.lo && seen.hi <= range.hi); }
  [[nodiscard]] int spare_bits() const { return width.bits - needed_bits; }
  /// The largest fraction of either end that was observed, 0...1.
  [[nodiscard]] double used() const;
};

/// Bits that hold every value of [lo, hi]: in two's complement if `is_signed`; modulo 2^bits, enough to distinguish its
/// values.
[[nodiscard]] int bits_needed(const Interval& values, bool is_signed, bool is_modular);

struct WidthStudyOptions {
  std::uint64_t seed = 1;
  std::uint64_t samples = 20000;  ///< random probes
  int climb_steps = 1500;         ///< for each end of each width, half of them from a fresh start
  /// Gets the fraction done and the probes tried; may be empty. Interrupted, thrown there, ends the study, which
  /// returns its results so far.
  std::function<void(double fraction, std::uint64_t probes)> progress;
};

struct WidthStudy {
  std::uint64_t probes = 0;    ///< tried in all
  std::vector<WidthRow> rows;  ///< in the order of Widths::all()

  /// Rows that would overflow with one bit less: ordered by the first random probe that overflows, then by their
  /// number.
  [[nodiscard]] std::vector<std::size_t> overflow_order() const;
};

/// Random probes, the directed extremes, and a search from the best of them towards each end of each range.
[[nodiscard]] WidthStudy study_widths(const Config& config, const WidthStudyOptions& options);

}  // namespace halfplane
