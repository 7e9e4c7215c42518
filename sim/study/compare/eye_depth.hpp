// Window depth back to eye-space depth, for errors in the scene's own units.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "model/golden/golden.hpp"

namespace halfplane {

/// Under one perspective projection window z is affine in 1/w: z = a + b / w, and w is the eye-space depth.
struct EyeMapping {
  double a = 0, b = 0;

  /// The eye-space depth of a window z in [0, 1]; none at or beyond infinity.
  [[nodiscard]] std::optional<double> eye_depth(double z) const;
};

/// For every command of the scene, the mapping of its draw: fitted through the two vertices whose 1/w differ most, and
/// kept only if all its vertices agree. None for orthographic draws, window space without w, and draws that are clipped
/// away.
[[nodiscard]] std::vector<std::optional<EyeMapping>> fit_eye_mappings(std::span<const golden::Outline> outlines,
                                                                      std::size_t command_count);

}  // namespace halfplane
