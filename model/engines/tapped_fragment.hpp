// What RenderOptions::fragment_tap is told of a fragment.
#pragma once

#include <cstdint>
#include <optional>

#include "../stages/surface.hpp"
#include "render.hpp"

namespace halfplane {

/// A covered sample with its attributes, at the entry of the operations: not yet encoded, tested or packed.
struct TappedFragment {
  PrimitiveKind kind = PrimitiveKind::triangle;  ///< triangle, line or point
  std::uint32_t primitive = 0;                   ///< as in Rendering::ids
  std::uint32_t draw = 0;                        ///< index into Scene::commands
  std::uint32_t item = 0;                        ///< index into Rendering::triangles, lines or points
  const Triangle* triangle = nullptr;            ///< the triangle, valid during the call; null for the other two kinds
  const DrawnLine* line = nullptr;               ///< likewise
  const DrawnPoint* point = nullptr;             ///< likewise
  int x = 0, y = 0;                              ///< pixels
  int guard_bits = 0;                            ///< l of its planes; for a line of G'
  int sample = 0;                                ///< number in its pixel: each covered sample is a fragment of its own
  int shaded_at = -1;  ///< shading place: -1 the pixel's centre, else a sample (stages/multisample.hpp)
  PerPlane<PlaneSample> plane{};
  std::optional<SurfaceSample> surface{};  ///< for triangles whose colour is more than their planes
};

}  // namespace halfplane
