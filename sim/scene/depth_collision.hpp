// Positions of a scene that have the same depth code.
#pragma once

#include <optional>
#include <string>

#include "model/config.hpp"
#include "model/scene.hpp"

namespace halfplane {

/// Two vertices in view with one code of depth, whose distances (w) differ by a twentieth or more: which of two surfaces there
/// is seen, the order of drawing decides.
struct DepthCollision {
  double nearer = 0, farther = 0;
  int bits = 0;                       ///< B
  std::optional<int> enough_bits;     ///< that tell such distances apart; none: more than there are
  std::optional<double> near;         ///< the scene's near plane
  std::optional<double> near_enough;  ///< that does, at the same bits; none where the scene does not say `near`
};

/// The collision of the largest ratio; nothing where there is none, in window space, or with a depth.mapping or depth.format of
/// its own, whose codes are others. Linear in the scene.
[[nodiscard]] std::optional<DepthCollision> depth_collision(const Scene& scene, const Config& config);

/// One line.
[[nodiscard]] std::string text(const DepthCollision& collision);

}  // namespace halfplane
