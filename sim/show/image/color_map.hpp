// Colours for numbers: maps whose lightness follows the value, and round numbers for their legends.
#pragma once

#include <string>

#include "sim/show/image/picture.hpp"

namespace halfplane {

/// For magnitudes: t in [0, 1], dark violet to yellow; clamped outside. Lightness rises throughout (the viridis map by
/// van der Walt and Smith).
[[nodiscard]] Rgb sequential_color(double t);

/// For signed errors: t in [-1, 1], blue - white - red; clamped outside. t and -t are equally light (straight lines in
/// the OKLab space by Ottosson, 2020).
[[nodiscard]] Rgb diverging_color(double t);

/// The end of a scale up to `value`: a short number that is >= value and at most 4/3 of it; 1 for zero.
[[nodiscard]] double nice_ceiling(double value);

/// The shortest form: "-0.5", "20", "1e+06".
[[nodiscard]] std::string short_number(double value);

}  // namespace halfplane
