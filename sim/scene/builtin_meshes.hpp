// The built-in models, each a closed form of its size (and seed). World space, +y up.
#pragma once

#include <cstdint>

#include "sim/scene/mesh.hpp"

namespace halfplane {

/// The Utah teapot on y = 0, spout to +x: 64 n^2 - 8 n triangles for n segments along each side of its 32 patches.
/// Patches that meet share their edge's points bit for bit.
[[nodiscard]] Mesh teapot_mesh(int segments);

/// `boxes` boxes of random height on a square grid of unit lots, and the ground. Wound for back-face culling.
[[nodiscard]] Mesh city_mesh(int boxes, std::uint64_t seed);

/// A tube around the (2, 3) torus knot, `segments` along it, in all hues. Closed; wound for back-face culling.
[[nodiscard]] Mesh knot_mesh(int segments);

/// Two squares that cross along a line at a third of a degree: near it their distance is less than a depth step.
[[nodiscard]] Mesh coplanar_mesh();

/// A closed corridor around the origin of x and z, chequered by cells of one unit, 4 wide, 3 high, 40 long.
[[nodiscard]] Mesh corridor_mesh();

}  // namespace halfplane
