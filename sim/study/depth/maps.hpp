// Pictures of what quantized depth does to a scene: error and z-fighting, pixel by pixel.
#pragma once

#include <cstdint>
#include <span>

#include "sim/show/image/picture.hpp"

namespace halfplane {

/// Magnitudes from `low` (dark) to `high` (bright) by the logarithm; NaN, where nothing was drawn, is grey. A picture
/// wider than `max_width` is reduced by a whole factor, each pixel then showing the worst of its block.
[[nodiscard]] Picture error_map(int width, int height, std::span<const float> errors, double low, double high,
                                int max_width);

/// 0 background, 1 overlapping and in order, 2 a tie, 3 an inversion; likewise reduced.
[[nodiscard]] Picture fight_map(int width, int height, std::span<const std::uint8_t> fights, int max_width);

}  // namespace halfplane
