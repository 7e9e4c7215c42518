// The neighbourhood of a pixel, enlarged: grid, samples, edges before and after the snap, and the covered samples of
// each primitive.
#pragma once

#include "history.hpp"
#include "sim/show/image/picture.hpp"

namespace halfplane::explain {

/// A rectangle of pixels around the requested ones, inside the target.
struct Window {
  int left = 0, top = 0, width = 0, height = 0;
};

/// `margin` pixels on each side of the box, if inside the target.
[[nodiscard]] Window window_around(const Rect& box, int margin, const Scene& scene);

[[nodiscard]] bool is_in(const Rect& box, Pixel at);

/// `around`: explained pixels of the window, row by row. Draws the primitives in the histories of the pixels of `box`:
/// primitives that cover one of them, else primitives nearby.
[[nodiscard]] Picture neighbourhood_picture(const Explanation& around, const Window& window, const Rect& box,
                                            const Config& config, std::string_view title);

}  // namespace halfplane::explain
