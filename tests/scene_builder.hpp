// Small scenes for tests, one call per triangle, and the tests' own random numbers and states.
#pragma once

#include <cstdint>
#include <random>

#include "sim/scene/random_state.hpp"
#include "sim/scene/scene_builder.hpp"

namespace halfplane::test {

using halfplane::at;
using halfplane::clip_at;
using halfplane::SceneBuilder;

/// Repeatable random numbers: the distributions of the standard library differ from one library to the next. Draw at
/// most one in the arguments of a call: compilers evaluate those in different orders (braces go from left to right).
class Random {
 public:
  explicit Random(std::uint32_t seed) : engine_(seed) {}
  /// In [0, 1), 32 bits.
  double unit() { return static_cast<double>(engine_()) / 4294967296.0; }
  double between(double low, double high) { return low + (high - low) * unit(); }
  /// In [0, count).
  int index(int count) { return static_cast<int>(unit() * count); }

 private:
  std::mt19937 engine_;
};

}  // namespace halfplane::test
