// Golden fog: the fraction of a colour that remains at a distance, in real arithmetic (OpenGL ES 1.1.12, 3.8).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "../scene.hpp"
#include "color.hpp"

namespace halfplane::golden {

/// f, 0...1. `inverse_w`: 1/w of the fragment; 0 or less is beyond all fog.
[[nodiscard]] inline double fog_part(const Fog& fog, double inverse_w) {
  const double w = inverse_w > 0 ? 1 / inverse_w : HUGE_VAL;
  const double depth = fog.start == 0 ? 0 : fog.start * w;
  switch (fog.kind) {
    case FogKind::exp: return std::exp(-depth);
    case FogKind::exp2: return std::exp(-depth * depth);
    case FogKind::linear: break;
  }
  const double start = std::min(fog.start, fog.end - fog.end / 256);
  return w < fog.end ? std::min(1.0, (fog.end - w) / (fog.end - start)) : 0.0;
}

/// R, G and B blended with the fog's colour.
[[nodiscard]] inline RealColor in_fog(const State& state, const RealColor& color, double part) {
  RealColor result = color;
  for (std::size_t c = 0; c < 3; ++c) result[c] = color[c] * part + state.fog_color[c] * (1 - part);
  return result;
}

}  // namespace halfplane::golden
