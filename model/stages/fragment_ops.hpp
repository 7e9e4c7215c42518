// Operations on a fragment with known attributes: the arithmetic of each exists once.
//
// In program order of a fragment: the tests (depth; stencil_ops.hpp), then the colour (color_ops.hpp), then the write
// masks. This file is independent of packets, tiles and memories: stages/depth_test and stages/rop combine the
// operations for stamps, and the engines for their own units of work. Lane: std::uint32_t, or a vector of them. The
// scalar instance is the specification; a test holds vectors against it.
#pragma once

#include <cstdint>
#include <optional>

#include "../config.hpp"
#include "../packets/packets.hpp"
#include "../scene.hpp"
#include "color_ops.hpp"
#include "stencil_ops.hpp"

namespace halfplane {

// --- a draw's states of its fragments ------------------------------------------------------------------------------

/// The state travels with its primitives.
using FragmentState = PrimitiveState;

[[nodiscard]] constexpr FragmentState fragment_state(const State& state, ColorFormat format) {
  return {state.depth_test, state.depth_write, writes_color(state, format)};
}

/// Whether a state reads a fragment's alpha.
[[nodiscard]] constexpr bool looks_at_alpha(const State& state) {
  if (state.alpha_test.func != DepthFunc::always) return true;
  if (!state.blend) return false;
  const auto is_alpha = [](BlendFactor f) {
    return f == BlendFactor::src_alpha || f == BlendFactor::one_minus_src_alpha || f == BlendFactor::src_alpha_saturate;
  };
  return is_alpha(state.blend->src) || is_alpha(state.blend->dst);  // stored alpha matters only in a format with alpha
}

/// `config` with a plane of alpha where a draw of `scene` reads it. The software engines have all units; one more plane
/// changes no bit of the others.
[[nodiscard]] inline Config with_alpha(Config config, const Scene& scene) {
  for (const State& state : scene.states)
    if (looks_at_alpha(state) || (config.msaa_samples > 1 && state.alpha_to_coverage)) config.alpha_units = 1;
  return config;
}

/// The samples of a draw that State::sample_mask lets pass, a bit each.
[[nodiscard]] constexpr unsigned drawn_samples(const State& state) { return state.sample_mask.value_or(~0U); }

/// All operations of a draw.
struct FragmentOps {
  FragmentState state;
  AlphaTest alpha;
  std::optional<StencilSides> stencil;
  ColorOps color;
  int alpha_samples = 0;  ///< samples of a pixel, with alpha to coverage; else 0

  /// Whether the operations are the depth test alone, and colours replace stored ones.
  [[nodiscard]] constexpr bool is_plain() const {
    return alpha.func == DepthFunc::always && alpha_samples == 0 && !stencil &&
           (!state.color_write || color.is_plain());
  }
};

[[nodiscard]] constexpr FragmentOps fragment_ops(const State& state, ColorFormat format) {
  return {fragment_state(state, format), state.alpha_test, stencil_sides(state), color_ops(state, format)};
}

/// The number of a pixel's samples that an alpha of 8 bits draws: samples * alpha / 255, rounded; exact, as in
/// blending.
template <class Lane>
[[nodiscard]] constexpr Lane samples_of_alpha(const Lane& alpha, std::uint32_t samples) {
  const Lane t = alpha * samples + 128U;
  return (t + (t >> 8)) >> 8;
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

/// The result of a test for all values from `low` to `high`.
enum class Outcome { some_pass, all_pass, none_passes };
[[nodiscard]] constexpr Outcome test_outcome(DepthFunc func, std::uint32_t reference, std::uint32_t low,
                                             std::uint32_t high) {
  const bool may_be[] = {low < reference, low <= reference && reference <= high, high > reference};
  const bool passes[] = {depth_passes(func, 0, 1), depth_passes(func, 0, 0), depth_passes(func, 1, 0)};
  bool some_pass = false, some_fail = false;
  for (int i = 0; i < 3; ++i) {
    some_pass |= may_be[i] && passes[i];
    some_fail |= may_be[i] && !passes[i];
  }
  return !some_fail ? Outcome::all_pass : !some_pass ? Outcome::none_passes : Outcome::some_pass;
}

/// The same for lanes, without a branch: a function as the set of comparison outcomes that pass.
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

/// Whether a fragment that passes may have a larger code than the stored one.
[[nodiscard]] constexpr bool can_raise_depth(DepthFunc func) { return depth_passes(func, 1, 0); }

/// The stencil test of a stored value.
[[nodiscard]] constexpr bool stencil_passes(const Stencil& s, std::uint8_t stored) {
  return depth_passes(s.func, std::uint32_t{s.reference} & s.read_mask, std::uint32_t{stored} & s.read_mask);
}

/// The result of the stencil and the depth test for a sample.
struct TestedSample {
  bool passes = false;   ///< both
  bool changes = false;  ///< the stored depth or stencil changes
  std::uint32_t depth = 0;
  std::uint8_t stencil = 0;  ///< the stencil to store then
};

/// A depth code against the stored word. `side`: of the stencil; null: the primitive does not use it.
[[nodiscard]] constexpr TestedSample test_sample(const PrimitiveState& state, const Stencil* side, std::uint32_t depth,
                                                 std::uint32_t stored_depth, std::uint8_t stored_stencil) {
  const bool passes_stencil = side == nullptr || stencil_passes(*side, stored_stencil);
  const bool is_nearer = depth_passes(state.depth_test, depth, stored_depth);
  TestedSample sample{passes_stencil && is_nearer, false, stored_depth, stored_stencil};
  if (sample.passes && state.depth_write) {
    sample.changes = true;
    sample.depth = depth;
  }
  if (side == nullptr) return sample;
  const StencilOp op = stencil_op(*side, passes_stencil, is_nearer);
  if (op != StencilOp::keep && side->write_mask != 0) {
    sample.changes = true;
    sample.stencil = static_cast<std::uint8_t>(apply_stencil(op, *side, std::uint32_t{stored_stencil}));
  }
  return sample;
}

/// Whether alpha to coverage draws sample `k` of a pixel: it draws the first ones. `samples`: of the pixel; 0: no alpha
/// to coverage.
[[nodiscard]] constexpr bool is_drawn_by_alpha(int samples, std::uint32_t alpha, std::uint32_t k) {
  return samples == 0 || k < samples_of_alpha(alpha, static_cast<std::uint32_t>(samples));
}
/// Whether the alpha test keeps it as well.
[[nodiscard]] constexpr bool alpha_keeps(const AlphaTest& test, int samples, std::uint32_t alpha, std::uint32_t k) {
  return depth_passes(test.func, alpha, std::uint32_t{test.reference}) && is_drawn_by_alpha(samples, alpha, k);
}

// --- one fragment, all of it ----------------------------------------------------------------------------------------

/// The fate of a fragment.
enum class Fate {
  failed,  ///< the stencil or the depth test
  killed,  ///< passed both, but not the alpha test
  passed
};

/// The stored values at a fragment's pixel.
struct StoredPixel {
  std::uint32_t& depth;
  std::uint32_t& color;
  std::uint8_t& stencil;
};

/// A fragment at the entry of the operations.
struct TestedFragment {
  std::uint32_t depth = 0;   ///< the code in the stored format
  int x = 0, y = 0;          ///< pixels: dithering
  bool is_back = false;      ///< of a triangle that shows its back
  std::uint32_t sample = 0;  ///< number in its pixel
};

/// Runs the operations on one fragment, in order, on the values stored at its pixel. `color()` gives the four 8-bit
/// codes; called only when needed. A fragment dropped by the alpha test changes nothing, not even the stencil.
template <class Color>
constexpr Fate apply_fragment(const FragmentOps& ops, ColorFormat format, const TestedFragment& fragment, Color&& color,
                              const StoredPixel& stored) {
  using Code = std::uint32_t;
  const Stencil* side = ops.stencil ? &(*ops.stencil)[fragment.is_back ? 1 : 0] : nullptr;
  const TestedSample tested = test_sample(ops.state, side, fragment.depth, stored.depth, stored.stencil);
  if (!tested.passes && !tested.changes) return Fate::failed;
  Channels<Code> source{};
  const bool tests_alpha = ops.alpha.func != DepthFunc::always || ops.alpha_samples != 0;
  if (tests_alpha || (tested.passes && ops.state.color_write)) source = color();
  if (tests_alpha && !alpha_keeps(ops.alpha, ops.alpha_samples, source[3], fragment.sample))
    return tested.passes ? Fate::killed : Fate::failed;
  stored.depth = tested.depth;
  stored.stencil = tested.stencil;
  if (!tested.passes) return Fate::failed;
  if (ops.state.color_write)
    stored.color = store_color<Code>(ops.color, format, source, stored.color, dither_threshold(fragment.x, fragment.y));
  return Fate::passed;
}

}  // namespace halfplane
