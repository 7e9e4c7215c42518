// What `halfplane explain` says of a pixel: as JSON, and as a person reads it.
#pragma once

#include <iosfwd>

#include "sim/cli/options.hpp"
#include "sim/study/explain/history.hpp"

namespace halfplane::explain {

/// {x, y, history, final}, the contract's form. Of several samples: an entry of the history for each, primitive by primitive,
/// and what they have stored in `samples`.
[[nodiscard]] Json pixel_json(PixelSamples pixel, const Explanation& all, const Scene& scene, const Config& config);

void print_pixel(std::ostream& out, PixelSamples pixel, const Explanation& all, const Scene& scene,
                 const Config& config);

/// "0x03f2": as many digits as the bits need, two's complement.
[[nodiscard]] std::string hex_text(std::uint64_t value, int bits);

/// A rational number as a real one.
[[nodiscard]] double to_real(const exact::Rational& value);

/// What the golden makes of an entry, in the words of verdicts; "dropped" before its raster.
[[nodiscard]] std::string_view golden_verdict(const GoldenFigure& golden);

/// The word of a state's value, as captures have it.
[[nodiscard]] std::string_view state_word(std::string_view state, const State& of);

}  // namespace halfplane::explain
