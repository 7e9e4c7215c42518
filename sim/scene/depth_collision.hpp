// Positions of a scene that have the same depth code.
#pragma once

#include <optional>
#include <string>

#include "model/config.hpp"
#include "model/scene.hpp"

namespace halfplane {

/// Two vertices in view with one code of depth, whose distances (w) differ by a twentieth or more: there the order of
/// drawing decides which of two surfaces is visible.
struct DepthCollision {
  double nearer = 0, farther = 0;
  int bits = 0;                       ///< B
  std::optional<int> enough_bits;     ///< enough to tell such distances apart; none: more than available
  std::optional<double> near;         ///< the scene's near plane
  std::optional<double> near_enough;  ///< also enough, at the same bits; none if the scene has no `near`
};

/// The collision with the largest ratio; none without a collision, in window space, or with a depth.mapping or
/// depth.format, whose codes differ. Linear in the scene.
[[nodiscard]] std::optional<DepthCollision> depth_collision(const Scene& scene, const Config& config);

/// One line.
[[nodiscard]] std::string text(const DepthCollision& collision);

}  // namespace halfplane
