// Conventions that can be chosen for study: never the default, and only in the scalar engine. docs/rules.md,
// docs/numerics.md and docs/texture.md show the effect of each.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>
#include <type_traits>

#include "../enum_names.hpp"

namespace halfplane {

/// Ownership of samples exactly on an edge.
enum class FillRule {
  top_left,      ///< samples on top and left edges: the pipeline's own rule
  offset_point,  ///< samples on edges that have the point (-1, -1) on the triangle's side: Shirley's rule
  inclusive,     ///< all samples: a sample on a shared edge is drawn twice
  exclusive      ///< no sample (E > 0 on all three edges): samples on a shared edge are a crack
};

/// Order and arithmetic of the search for a triangle's samples.
enum class Traversal {
  tiled,     ///< tiles, rejected and accepted whole, then stamps: the pipeline's own
  bbox,      ///< every sample of the box, edge functions stepped from sample to sample
  scanline,  ///< two edges walked from row to row; between them no sample is tested
  brute      ///< every sample of the target, edge functions evaluated directly
};

/// Treatment of the part of a clip-space triangle behind the eye.
enum class Clipping {
  polygon,     ///< cut by near, far and the guard band, drawn as a fan: the pipeline's own
  homogeneous  ///< not cut: edge functions in 2D homogeneous coordinates, after Olano and Greer
};

/// Gradients of the planes of triangle_setup. All but the first are faults.
enum class Gradients {
  one_reciprocal,   ///< both times one reciprocal, rounded to nearest: the pipeline's own
  two_reciprocals,  ///< x times a reciprocal rounded down, y times one rounded up
  truncated         ///< per pixel, bits below the fraction of a tile dropped
};

/// Behaviour of a plane that leaves the range of its register. The second is a fault.
enum class Accumulator {
  wrap,     ///< wraps modulo 2^N: the pipeline's own
  saturate  ///< clamps at the end of the range, gradients likewise
};

/// Bits of a weight of a linear texture filter. Fewer than eight are a fault.
enum class Weights {
  eight,  ///< the pipeline's own
  four    ///< rounded to sixteenths
};

/// By enumerator, as typed on the command line and printed in results.
template <class Rule>
inline constexpr auto kRuleNames = kNamesOf<Rule>;
template <>
inline constexpr std::array<std::string_view, 2> kRuleNames<Weights>{"8", "4"};

template <class Rule>
requires std::is_enum_v<Rule>
[[nodiscard]] constexpr std::string_view name_of(Rule rule) { return kRuleNames<Rule>[static_cast<std::size_t>(rule)]; }

struct StudyRules {
  Traversal traversal = Traversal::tiled;
  FillRule fill_rule = FillRule::top_left;
  Clipping clipping = Clipping::polygon;  ///< the golden has both
  Gradients gradients = Gradients::one_reciprocal;
  Accumulator accumulator = Accumulator::wrap;
  Weights weights = Weights::eight;
  bool operator==(const StudyRules&) const = default;
};

}  // namespace halfplane
