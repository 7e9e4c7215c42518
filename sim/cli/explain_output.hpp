// Output of `halfplane explain` for a pixel: as JSON, and as text for people.
#pragma once

#include <iosfwd>

#include "sim/cli/options.hpp"
#include "sim/study/explain/history.hpp"

namespace halfplane::explain {

/// {x, y, history, final}, the contract's form. With several samples: an entry of the history for each, primitive by
/// primitive, and their stored values in `samples`.
[[nodiscard]] Json pixel_json(PixelSamples pixel, const Explanation& all, const Scene& scene, const Config& config);

void print_pixel(std::ostream& out, PixelSamples pixel, const Explanation& all, const Scene& scene,
                 const Config& config);

/// "0x03f2": as many digits as the bits need, two's complement.
[[nodiscard]] std::string hex_text(std::uint64_t value, int bits);

/// A rational number as a real one.
[[nodiscard]] double to_real(const exact::Rational& value);

/// The golden's verdict on an entry, in the words of verdicts; "dropped" before its raster.
[[nodiscard]] std::string_view golden_verdict(const GoldenFigure& golden);

/// The word of a state's value, as in captures.
[[nodiscard]] std::string_view state_word(std::string_view state, const State& of);

}  // namespace halfplane::explain
