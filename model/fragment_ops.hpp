// What happens to a fragment once its attributes are known: the arithmetic of each operation, once.
//
// In program order of a fragment: the tests own what they compare (today depth; stencil and alpha belong beside it),
// then the colour (today it is packed; blending belongs before that), then the write masks. Nothing here knows packets,
// tiles or memories: stages/depth_test and stages/rop put the pieces together for stamps, and the engines for what they
// hold at once.
// Lane: std::uint32_t, or a vector of them. The scalar instance is the specification; a test holds vectors against it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "config.hpp"
#include "packets.hpp"
#include "scene.hpp"

namespace halfplane {

// --- what a draw asks of its fragments ------------------------------------------------------------------------------

/// It rides with its primitives.
using FragmentState = PrimitiveState;

[[nodiscard]] constexpr FragmentState fragment_state(const State& state) {
  return {state.depth_test, state.depth_write, state.color_write};
}

// --- lanes ----------------------------------------------------------------------------------------------------------

/// The result of a comparison of lanes as a mask: all bits set where it holds.
template <class Lane, class Comparison>
[[nodiscard]] constexpr Lane lane_mask(const Comparison& holds) {
  if constexpr (std::is_integral_v<Lane>)
    return holds ? static_cast<Lane>(~Lane{}) : Lane{};
  else
    return (Lane)holds;  // as wide
}

/// `value` where the mask is set, `stored` elsewhere.
template <class Lane>
[[nodiscard]] constexpr Lane write_where(const Lane& mask, const Lane& value, const Lane& stored) {
  return (value & mask) | (stored & ~mask);
}

// --- tests ----------------------------------------------------------------------------------------------------------

/// A fragment's depth code against the stored one. Codes are unsigned integers; 0 is nearest with the default, less.
template <DepthFunc Func, class Code>
[[nodiscard]] constexpr bool depth_passes(Code fragment, Code stored) {
  switch (Func) {
    case DepthFunc::never: return false;
    case DepthFunc::less: return fragment < stored;
    case DepthFunc::lequal: return fragment <= stored;
    case DepthFunc::equal: return fragment == stored;
    case DepthFunc::greater: return fragment > stored;
    case DepthFunc::gequal: return fragment >= stored;
    case DepthFunc::notequal: return fragment != stored;
    case DepthFunc::always: return true;
  }
}

/// The same, chosen at run time.
[[nodiscard]] constexpr bool depth_passes(DepthFunc func, std::uint32_t fragment, std::uint32_t stored) {
  switch (func) {
    case DepthFunc::never: break;
    case DepthFunc::less: return depth_passes<DepthFunc::less>(fragment, stored);
    case DepthFunc::lequal: return depth_passes<DepthFunc::lequal>(fragment, stored);
    case DepthFunc::equal: return depth_passes<DepthFunc::equal>(fragment, stored);
    case DepthFunc::greater: return depth_passes<DepthFunc::greater>(fragment, stored);
    case DepthFunc::gequal: return depth_passes<DepthFunc::gequal>(fragment, stored);
    case DepthFunc::notequal: return depth_passes<DepthFunc::notequal>(fragment, stored);
    case DepthFunc::always: return depth_passes<DepthFunc::always>(fragment, stored);
  }
  return false;
}

/// The same for lanes, without a branch: a function is the outcomes of one comparison that it lets pass.
struct DepthOutcomes {
  std::uint32_t less, equal, greater;  ///< all bits set where the outcome passes

  constexpr explicit DepthOutcomes(DepthFunc func)
      : less(lane_mask<std::uint32_t>(depth_passes(func, 0, 1))),
        equal(lane_mask<std::uint32_t>(depth_passes(func, 0, 0))),
        greater(lane_mask<std::uint32_t>(depth_passes(func, 1, 0))) {}

  /// The mask of the lanes that pass.
  template <class Lane>
  [[nodiscard]] constexpr Lane operator()(const Lane& fragment, const Lane& stored) const {
    return (lane_mask<Lane>(fragment < stored) & less) | (lane_mask<Lane>(fragment == stored) & equal) |
           (lane_mask<Lane>(fragment > stored) & greater);
  }
};

/// Whether a fragment that passes may have a larger code than the one it replaces.
[[nodiscard]] constexpr bool can_raise_depth(DepthFunc func) { return depth_passes(func, 1, 0); }

// --- colour ---------------------------------------------------------------------------------------------------------

/// The nearest 5- or 6-bit code of an 8-bit one: floor(c * 31 / 255 + 1/2), or with 63, as one multiply, add and shift
/// (exact for all 256 inputs; tested).
template <class Lane>
[[nodiscard]] constexpr Lane to_5_bits(const Lane& c) {
  return (c * 249 + 1014) >> 11;
}
template <class Lane>
[[nodiscard]] constexpr Lane to_6_bits(const Lane& c) {
  return (c * 253 + 505) >> 10;
}

template <class Lane>
[[nodiscard]] constexpr Lane pack_rgb565(const Lane& r, const Lane& g, const Lane& b) {
  return to_5_bits(r) << 11 | to_6_bits(g) << 5 | to_5_bits(b);
}
template <class Lane>
[[nodiscard]] constexpr Lane pack_rgba8888(const Lane& r, const Lane& g, const Lane& b, const Lane& a) {
  return r | g << 8 | b << 16 | a << 24;
}

/// 8-bit codes R, G, B, A to the stored code. rgb565 does not look at the last.
template <class Lane>
[[nodiscard]] constexpr Lane pack_color(ColorFormat format, const std::array<Lane, 4>& c) {
  return format == ColorFormat::rgb565 ? pack_rgb565(c[0], c[1], c[2]) : pack_rgba8888(c[0], c[1], c[2], c[3]);
}
[[nodiscard]] constexpr std::uint32_t pack_color(ColorFormat format, const std::array<std::uint8_t, 4>& c) {
  return pack_color(format, std::array<std::uint32_t, 4>{c[0], c[1], c[2], c[3]});
}

/// A stored code taken apart: R, G, B, A as they are stored, 5, 6, 5 bits or 8 each. Of rgb565 the last is 0.
template <class Lane>
[[nodiscard]] constexpr std::array<Lane, 4> unpack_color(ColorFormat format, const Lane& color) {
  if (format == ColorFormat::rgb565) return {color >> 11 & 31, color >> 5 & 63, color & 31, Lane{}};
  return {color & 255, color >> 8 & 255, color >> 16 & 255, color >> 24};
}

// --- one fragment, all of it ----------------------------------------------------------------------------------------

/// Runs the operations on one fragment, in order, on the codes stored at its pixel. Returns whether it passed the tests.
/// `depth`: the code in the stored format. `color()` gives the four 8-bit codes; asked only when colour is written.
template <class Color>
constexpr bool apply_fragment(const FragmentState& state, ColorFormat format, std::uint32_t depth, Color&& color,
                              std::uint32_t& stored_depth, std::uint32_t& stored_color) {
  if (!depth_passes(state.depth_test, depth, stored_depth)) return false;
  if (state.depth_write) stored_depth = depth;
  if (state.color_write) stored_color = pack_color(format, color());
  return true;
}

}  // namespace halfplane
