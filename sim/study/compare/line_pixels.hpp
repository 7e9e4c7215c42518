// The pixels that the model's lines and points own: what S, H and the stages say of each.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>

#include "model/config.hpp"
#include "model/engines/render.hpp"
#include "model/golden/exact.hpp"
#include "model/scene.hpp"

namespace halfplane {

/// One quantity, in LSB: the exact value S between the snapped vertices, and the hardware's H before storage rounding.
struct ExactAndHardware {
  exact::Rational exact, hardware;
};

/// A pixel that the model owns, and what it must hold.
struct OwnedPixel {
  std::size_t p = 0;  ///< y * width + x
  std::uint32_t primitive = 0;
  std::uint32_t draw = 0;                   ///< index into Scene::commands
  bool is_line = false;                     ///< or a point
  ExactAndHardware depth;                   ///< 0 where the draw writes no depth
  std::array<ExactAndHardware, 4> color{};  ///< LSB of 8 bits; 0 where the draw writes no colour
  std::uint32_t depth_code = 0;             ///< what the stages compute
  std::array<std::uint8_t, 4> color_code{};
};

/// Calls visit for every pixel that a line or point of `rendering` owns; where several lines of one primitive cover it,
/// for one whose codes are stored there. Returns how many pixels are owned by a primitive of which no line or point
/// covers them.
std::uint64_t for_each_line_pixel(const Scene& scene, const Config& config, const Rendering& rendering,
                                  const std::function<void(const OwnedPixel&)>& visit);

}  // namespace halfplane
