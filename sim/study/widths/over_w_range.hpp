// How far apart the w of a triangle may be for what is interpolated over w to keep a given error.
#pragma once

#include <optional>

#include "model/stages/perspective.hpp"

namespace halfplane {

/// What the page of widths asks: 1/16 texel, 2 LSB of 8 bits.
inline constexpr double kProvenTexels = 0.0625, kProvenColor = 2;

/// The largest ratio of w over a triangle to which over_w_bound() is at most `error` (texels, LSB) for an attribute that
/// spans `extent`; nothing when it is more with equal w already.
[[nodiscard]] std::optional<double> proven_w_ratio(double extent, double error, const PerspectiveFormat& format,
                                                   const OverWFormat& attribute, int tile_size);

/// That of a texture coordinate over `texels`, to kProvenTexels.
[[nodiscard]] inline std::optional<double> proven_w_ratio(double texels, const PerspectiveFormat& format,
                                                          int tile_size) {
  return proven_w_ratio(texels, kProvenTexels, format, format.coordinate, tile_size);
}

}  // namespace halfplane
