// The stencil test and the update of the stored value: 8 bits per pixel. Lane: std::uint32_t, or a vector of them.
// Source: OpenGL ES 2.0.25, 4.1.4.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "../scene.hpp"
#include "color_ops.hpp"

namespace halfplane {

/// For triangles that show their front, and their back.
using StencilSides = std::array<Stencil, 2>;

/// The stencil test of a state, if it has one.
[[nodiscard]] constexpr std::optional<StencilSides> stencil_sides(const State& state) {
  if (!state.stencil) return std::nullopt;
  return StencilSides{*state.stencil, state.stencil_back.value_or(*state.stencil)};
}

/// The stored value after an operation.
template <class Lane>
[[nodiscard]] constexpr Lane apply_stencil(StencilOp op, const Stencil& s, const Lane& stored) {
  const Lane full = Lane{} + 255;
  const auto result = [&]() -> Lane {
    switch (op) {
      case StencilOp::keep: return stored;
      case StencilOp::zero: return Lane{};
      case StencilOp::replace: return Lane{} + s.reference;
      case StencilOp::incr: return least<Lane>(stored + 1, full);
      case StencilOp::decr: return largest<Lane>(stored, Lane{} + 1) - 1;
      case StencilOp::invert: return full - stored;
      case StencilOp::incr_wrap: return (stored + 1) & 255;
      case StencilOp::decr_wrap: return (stored + 255) & 255;
    }
    return stored;
  };
  const std::uint32_t mask = s.write_mask;
  return (result() & mask) | (stored & ~mask);
}

/// Selects the operation by the results of the tests.
[[nodiscard]] constexpr StencilOp stencil_op(const Stencil& s, bool stencil_passes, bool depth_passes) {
  return !stencil_passes ? s.stencil_fails : depth_passes ? s.passes : s.depth_fails;
}

/// Whether any outcome changes the stored value.
[[nodiscard]] constexpr bool writes_stencil(const Stencil& s) {
  return s.write_mask != 0 &&
         (s.stencil_fails != StencilOp::keep || s.depth_fails != StencilOp::keep || s.passes != StencilOp::keep);
}

}  // namespace halfplane
