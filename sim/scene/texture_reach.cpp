#include "sim/scene/texture_reach.hpp"

#include <algorithm>
#include <cstdio>

#include "model/host/primitive_assembly.hpp"
#include "model/stages/perspective.hpp"

namespace halfplane {

std::optional<BeyondReach> beyond_reach(const Scene& scene) {
  constexpr double kSpan = 2 << kMaxReach;
  BeyondReach beyond;
  for (const Command& command : scene.commands) {
    const Draw* const draw = std::get_if<Draw>(&command);
    if (draw == nullptr || primitive_type(draw->topology) != PrimitiveType::triangle) continue;
    const State& state = scene.states[draw->state];
    if (!state.texture) continue;
    const Texture& texture = scene.textures[*state.texture];
    for_each_triangle(scene, *draw, Provoking::first, [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      const auto span = [&](double Vertex::*coordinate, int size) {
        const auto [low, high] =
            std::minmax({scene.vertices[a].*coordinate, scene.vertices[b].*coordinate, scene.vertices[c].*coordinate});
        return (high - low) * size;
      };
      const double longer = std::max(span(&Vertex::u, texture.width()), span(&Vertex::v, texture.height()));
      if (longer <= kSpan) return;
      ++beyond.triangles;
      beyond.span = std::max(beyond.span, longer);
    });
  }
  return beyond.triangles > 0 ? std::optional(beyond) : std::nullopt;
}

std::string text(const BeyondReach& beyond) {
  char line[200];
  std::snprintf(
      line, sizeof line,
      "%llu textured triangle%s more than 2^%d texels (%.3g the most): the texture is in the wrong place there; "
      "split them, or repeat it less often",
      static_cast<unsigned long long>(beyond.triangles), beyond.triangles == 1 ? " spans" : "s span", kMaxReach + 1,
      beyond.span);
  return line;
}

}  // namespace halfplane
