// The neighbourhood of a pixel, enlarged: grid, samples, edges before and after the snap, and which primitive covers which
// sample.
#pragma once

#include "history.hpp"
#include "sim/show/image/picture.hpp"

namespace halfplane::explain {

/// A rectangle of pixels around those asked about, inside the target.
struct Window {
  int left = 0, top = 0, width = 0, height = 0;
};

/// `margin` pixels on each side of the box, where there are any.
[[nodiscard]] Window window_around(const Rect& box, int margin, const Scene& scene);

[[nodiscard]] bool is_in(const Rect& box, Pixel at);

/// `around`: explained pixels of the window, row by row. Drawn are the primitives that a pixel of `box` tells of: those
/// that cover one of them, and if there are none those that pass near.
[[nodiscard]] Picture neighbourhood_picture(const Explanation& around, const Window& window, const Rect& box,
                                            const Config& config, std::string_view title);

}  // namespace halfplane::explain
