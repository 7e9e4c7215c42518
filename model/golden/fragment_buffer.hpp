// Golden framebuffer: the result of the operations on each pixel's fragments, in real arithmetic. The last stage of the golden:
// no code of the model, no rounding.
//
// In: clears and fragments in program order. Out: for each pixel the last written depth, the value written with it, and
// its owner. Operations: alpha, stencil and depth test, blending, the write masks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <vector>

#include "../scene.hpp"
#include "color.hpp"
#include "depth_test.hpp"

namespace halfplane::golden {

/// The fate of a fragment.
struct Fate {
  bool passed = false;   ///< the stencil and the depth test
  bool killed = false;   ///< passed the other tests, and failed the alpha test
  bool written = false;  ///< it owns the pixel now: it passed, and its draw writes depth, colour or both
  bool stencil_failed = false;
};

/// A fragment at the entry of the operations, without its colour.
template <class Depth>
struct Tested {
  Depth depth{};
  double alpha = 255;             ///< 0...255, after its texture
  bool is_back = false;           ///< of a triangle that shows its back
  bool is_drawn_by_alpha = true;  ///< false: alpha to coverage drops this sample, as the alpha test would
};

/// Depth: the type compared in the test. Value: the type stored by colour writes: channels, which are blended, or any
/// data about a fragment.
template <class Depth, class Value>
class FragmentBuffer {
 public:
  /// `has_alpha`: the stored colour has alpha; otherwise it is opaque.
  FragmentBuffer(std::size_t pixels, Depth depth, const Value& value, bool has_alpha = true)
      : has_alpha_(has_alpha), depth_(pixels, depth), value_(pixels, value), stencil_(pixels, 0), owner_(pixels, -1) {}

  /// Runs the operations of `state` on a fragment of `owner`, not negative.
  Fate apply(std::size_t pixel, const State& state, const Tested<Depth>& fragment, const Value& value,
             std::int32_t owner) {
    const Stencil* stencil = stencil_of(state, fragment.is_back);
    const bool stencil_passes = stencil == nullptr || halfplane::golden::passes(*stencil, stencil_[pixel]);
    const bool is_nearer = passes(state.depth_test, fragment.depth, depth_[pixel]);
    const bool tests_pass = stencil_passes && is_nearer;
    if (!fragment.is_drawn_by_alpha ||
        !passes<double>(state.alpha_test.func, fragment.alpha, state.alpha_test.reference))
      return {tests_pass, tests_pass, false, !stencil_passes};
    if (stencil != nullptr) {
      const StencilOp op = !stencil_passes ? stencil->stencil_fails
                           : is_nearer     ? stencil->passes
                                           : stencil->depth_fails;
      stencil_[pixel] = operated(op, *stencil, stencil_[pixel]);
    }
    if (!tests_pass) return {false, false, false, !stencil_passes};
    const auto& mask = state.color_mask;
    const bool writes_color = state.color_write && (mask[0] || mask[1] || mask[2] || (mask[3] && has_alpha_));
    if (!state.depth_write && !writes_color) return {true, false, false};
    if (state.depth_write) depth_[pixel] = fragment.depth;
    if constexpr (std::is_same_v<Value, RealColor>) {
      if (!has_alpha_) value_[pixel][3] = 255;
      if (writes_color) value_[pixel] = blended(state, value, value_[pixel], has_alpha_);
    } else {
      if (writes_color) value_[pixel] = value;
    }
    owner_[pixel] = owner;
    return {true, false, true};
  }

  void clear_depth(std::size_t pixel, Depth depth) { depth_[pixel] = depth; }
  void clear_value(std::size_t pixel, const Value& value) { value_[pixel] = value; }
  void clear_stencil(std::size_t pixel, int value) { stencil_[pixel] = value; }
  /// A clear of any buffer leaves a pixel without owner.
  void disown(std::size_t pixel) { owner_[pixel] = -1; }

  [[nodiscard]] Depth depth(std::size_t pixel) const { return depth_[pixel]; }
  [[nodiscard]] const Value& value(std::size_t pixel) const { return value_[pixel]; }
  [[nodiscard]] const std::vector<Value>& values() const { return value_; }
  [[nodiscard]] const std::vector<std::int32_t>& owners() const { return owner_; }

 private:
  bool has_alpha_;
  std::vector<Depth> depth_;
  std::vector<Value> value_;
  std::vector<int> stencil_;
  std::vector<std::int32_t> owner_;
};

}  // namespace halfplane::golden
