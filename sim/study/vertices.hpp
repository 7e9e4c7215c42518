// Snapped vertices for studies: making them and showing them.
#pragma once

#include <array>
#include <cstdint>

#include "model/packets/packets.hpp"

namespace halfplane {

/// A vertex with that depth code and the 8-bit codes R, G, B, A.
[[nodiscard]] inline SnappedVertex snapped_vertex(int x, int y, std::uint32_t depth = 0,
                                                  const std::array<std::uint8_t, 4>& rgba = {}) {
  SnappedVertex v{x, y, {depth}};
  for (std::size_t c = 0; c < 4; ++c) v.code[kColorPlane + c] = rgba[c];
  return v;
}

/// Its colour in the form of a scene's vertex.
[[nodiscard]] inline std::array<double, 4> colors_of(const SnappedVertex& v) {
  const auto channel = color_channels(v.code);
  return {1.0 * channel[0], 1.0 * channel[1], 1.0 * channel[2], 1.0 * channel[3]};
}

/// Random codes in the colour planes: draw() gives one. A channel without a plane takes a number as well, so that later
/// numbers do not depend on the colour format.
template <class Draw>
void set_colors(SnappedVertex& v, const Widths& widths, Draw&& draw) {
  for (int c = 0; c < 4; ++c) {
    const auto code = static_cast<std::uint32_t>(draw());
    if (c < widths.color_planes) v.code[kColorPlane + static_cast<std::size_t>(c)] = code;
  }
}

}  // namespace halfplane
