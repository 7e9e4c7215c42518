// Conventions that can be chosen for study: never the default, and only the scalar engine has them. docs/rules.md shows
// what each does.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace halfplane {

/// Which samples exactly on an edge belong to a triangle.
enum class FillRule {
  top_left,      ///< those on top and left edges: the pipeline's own rule
  offset_point,  ///< those on edges that have the point (-1, -1) on the triangle's side: Shirley's rule
  inclusive      ///< all
};

/// In which order, and by what arithmetic, the samples of a triangle are found.
enum class Traversal {
  tiled,     ///< tiles, rejected and accepted as a whole, then stamps: the pipeline's own
  bbox,      ///< every sample of the box, edge functions stepped from sample to sample
  scanline,  ///< two edges walked from row to row; between them no sample is tested
  brute      ///< every sample of the target, edge functions evaluated directly
};

/// By enumerator, as typed on the command line and printed in results.
inline constexpr std::array<std::string_view, 3> kFillRuleNames{"top_left", "offset_point", "inclusive"};
inline constexpr std::array<std::string_view, 4> kTraversalNames{"tiled", "bbox", "scanline", "brute"};

[[nodiscard]] constexpr std::string_view name_of(FillRule rule) {
  return kFillRuleNames[static_cast<std::size_t>(rule)];
}
[[nodiscard]] constexpr std::string_view name_of(Traversal traversal) {
  return kTraversalNames[static_cast<std::size_t>(traversal)];
}

/// What is studied.
struct StudyRules {
  Traversal traversal = Traversal::tiled;
  FillRule fill_rule = FillRule::top_left;
  bool operator==(const StudyRules&) const = default;
};

}  // namespace halfplane
