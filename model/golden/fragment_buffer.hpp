// Golden framebuffer: what the operations leave of the fragments that came to each pixel, in real arithmetic. It is the
// last room of the golden and of nobody else: no code of the model's, and nothing is rounded here.
//
// In: clears and fragments in program order. Out: for each pixel the depth that was written last, the value that came
// with it, and whose it is. Operations today: the depth test and the two write masks; a colour is stored as it came.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "../scene.hpp"
#include "depth_test.hpp"

namespace halfplane::golden {

/// What became of a fragment.
struct Fate {
  bool passed = false;   ///< the tests
  bool written = false;  ///< it owns the pixel now: it passed, and its draw writes depth, colour or both
};

/// Depth: what the test compares. Value: what colour writes store: channels, or whatever says more about a fragment.
template <class Depth, class Value>
class FragmentBuffer {
 public:
  FragmentBuffer(std::size_t pixels, Depth depth, const Value& value)
      : depth_(pixels, depth), value_(pixels, value), owner_(pixels, -1) {}

  /// Runs the operations of `state` on a fragment of `owner`, not negative.
  Fate apply(std::size_t pixel, const State& state, Depth depth, const Value& value, std::int32_t owner) {
    if (!passes(state.depth_test, depth, depth_[pixel])) return {};
    if (!state.depth_write && !state.color_write) return {true, false};
    if (state.depth_write) depth_[pixel] = depth;
    if (state.color_write) value_[pixel] = value;
    owner_[pixel] = owner;
    return {true, true};
  }

  void clear_depth(std::size_t pixel, Depth depth) { depth_[pixel] = depth; }
  void clear_value(std::size_t pixel, const Value& value) { value_[pixel] = value; }
  /// A clear of either leaves a pixel to nobody.
  void disown(std::size_t pixel) { owner_[pixel] = -1; }

  [[nodiscard]] Depth depth(std::size_t pixel) const { return depth_[pixel]; }
  [[nodiscard]] const Value& value(std::size_t pixel) const { return value_[pixel]; }
  [[nodiscard]] const std::vector<Value>& values() const { return value_; }
  [[nodiscard]] const std::vector<std::int32_t>& owners() const { return owner_; }

 private:
  std::vector<Depth> depth_;
  std::vector<Value> value_;
  std::vector<std::int32_t> owner_;
};

}  // namespace halfplane::golden
