// Triangles whose texture coordinates exceed the range of the pipeline.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "model/scene.hpp"

namespace halfplane {

/// Filled triangles of textured draws with a corner more than 2^20 texels (kMaxReach) from the centre of its
/// coordinates, where the pipeline clamps it: between the corners the texture is displaced.
struct BeyondReach {
  std::uint64_t triangles = 0;
  double span = 0;  ///< the largest extent of a triangle, texels of level 0
};

/// None if no triangle is clamped. Whole triangles: a cut triangle may be within reach. Linear in the scene.
[[nodiscard]] std::optional<BeyondReach> beyond_reach(const Scene& scene);

/// One line.
[[nodiscard]] std::string text(const BeyondReach& beyond);

}  // namespace halfplane
