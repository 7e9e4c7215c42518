// Hypotheses about a foreign image: the scene's image with one change. Each is drawn completely, to the bit.
//
//   depth_func  another depth function for one that the scene has
//   texture     another filter, wrap, combination or interpolation; coordinates half a texel or a texel off, or upside
//               down; a level more or less; weights of 4 bits
//   blend       another factor or equation, or none; products truncated, shifted by 8, or rounded one by one
//   dither      switched, or with the matrix moved
//   color       codes truncated to 5 and 6 bits, not rounded
//   snap        other subpixel bits, or no snap at all
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "against.hpp"

namespace halfplane {

/// The values of an image, in the form of ForeignImage.
using ImageValues = std::vector<std::uint32_t>;

/// An image of ours in the form of a foreign one.
[[nodiscard]] ImageValues image_values(const Framebuffer& frame, ColorFormat format, bool is_depth);

struct Hypothesis {
  ForeignDifference kind = ForeignDifference::other;
  std::string change;
  std::function<std::optional<ImageValues>()> draw;  ///< none: such a scene cannot be drawn
};

/// Input of hypotheses: all of it must outlive them.
struct HypothesisScene {
  const Scene& scene;
  const Config& config;
  const StudyRules& rules;
  const Framebuffer& golden;
  bool is_depth = false;
  std::vector<bool> is_touched;  ///< by state: a draw with it has fragments where the images differ
};

/// The most likely ones first.
[[nodiscard]] std::vector<Hypothesis> hypotheses(const HypothesisScene& of);

/// Arithmetic of the fragment operations that no state of a draw can request.
struct ForeignArithmetic {
  enum class Products { rounded, cut, shifted, rounded_apart } products = Products::rounded;
  int dither_x = 0, dither_y = 0;  ///< offset of the dithering matrix, pixels, 0...3
  bool cuts_codes = false;         ///< 5 and 6 bits of a colour are its upper bits
};

/// The scene's fragments with other arithmetic, an image for each; none if the fragments of render_scalar and the
/// operations alone do not give `expected`, the model's own image.
[[nodiscard]] std::optional<std::vector<ImageValues>> replay(const HypothesisScene& of, const ImageValues& expected,
                                                             const std::vector<ForeignArithmetic>& arithmetic);

/// Hypotheses for replay(), in groups that fit into memory together.
struct ReplayGroup {
  std::vector<ForeignDifference> kind;
  std::vector<std::string> change;
  std::vector<ForeignArithmetic> arithmetic;
};
[[nodiscard]] std::vector<ReplayGroup> replay_groups(const HypothesisScene& of);

}  // namespace halfplane
