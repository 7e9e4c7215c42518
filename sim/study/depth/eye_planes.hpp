// The exact eye depth of a scene's triangles at any pixel: what every quantized depth is held against.
#pragma once

#include <vector>

#include "model/scene.hpp"

namespace halfplane {

/// 1/w over the screen, from the triangle's unsnapped clip coordinates, uncut: 1/w = a x + b y + c, pixels, y down. Where
/// w is the eye depth, as under every perspective projection, that is one over the eye depth.
struct EyePlane {
  double a = 0, b = 0, c = 0;  ///< all 0: a triangle seen edge-on, or no filled triangle at all

  [[nodiscard]] bool is_empty() const { return a == 0 && b == 0 && c == 0; }
  /// At the centre of a pixel.
  [[nodiscard]] double eye_depth(int x, int y) const { return 1 / (a * (x + 0.5) + b * (y + 0.5) + c); }
};

/// By number of the input primitive over the whole scene, as in Rendering::ids. Throws InputError for a scene whose filled
/// triangles are not all in clip space, or that moves depth by depth_range or polygon_offset: its eye depth is not known; and for
/// one that clears depth between its draws or has several frames.
[[nodiscard]] std::vector<EyePlane> eye_planes(const Scene& scene);

}  // namespace halfplane
