// Against: a whole foreign rasterizer, judged by its image alone. The model's image is compared pixel by pixel; each
// difference is attributed to one kind.
//
// First by hypotheses (against_hypotheses.hpp): the scene drawn again with one thing changed, a depth function, a blend
// factor, a texture filter, the snap. A hypothesis that predicts the foreign image in three of four pixels that it
// changes is no coincidence: its predicted pixels are attributed to it. The others are attributed one by one, to the
// first kind that applies:
//
//   edge_rule  a triangle has the sample exactly on its border, and the image shows the result of another tie rule
//   snap       another fragment, or a neighbouring pixel's value, is shown where a side passes within a subpixel or so
//   depth      another fragment of the pixel, or its value before: the depth test had another result; in a
//              depth image also a depth that is a few codes off
//   dither, blend, texture
//              the colour is a code or so off where the fragment is dithered, blended or textured, and no pixel without
//              these is
//   color      the colour is a code or so off
//   other      none of these
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "compare.hpp"

namespace halfplane {

/// The image drawn by another rasterizer, rows from the top.
struct ForeignImage {
  int width = 0, height = 0;
  bool is_depth = false;  ///< stored depth codes; otherwise colours of 8 bits, R in the lowest byte, no alpha
  std::vector<std::uint32_t> value;  ///< width * height
};

/// .png: a colour picture; .npy: depth codes, <u4. Throws InputError naming the file, also when its size differs.
[[nodiscard]] ForeignImage read_foreign_image(const std::string& path, int width, int height);

enum class ForeignDifference : std::uint8_t {
  edge_rule,
  depth_func,
  depth,
  snap,
  texture,
  blend,
  dither,
  color,
  other
};
inline constexpr std::array<std::string_view, 9> kForeignDifferences{
    "edge_rule", "depth_func", "depth", "snap", "texture", "blend", "dither", "color", "other"};
[[nodiscard]] constexpr std::string_view name_of(ForeignDifference kind) {
  return kForeignDifferences[static_cast<std::size_t>(kind)];
}

/// The largest difference of a pixel that counts as equal, codes of the stored format: of each channel, of the depth.
struct Tolerance {
  std::uint32_t color = 0, depth = 0;
};

/// Pixels of one kind, and their differences: the worst channel in LSB of 8 bits, or depth codes.
struct DifferenceStats {
  std::uint64_t pixels = 0;
  double max = 0, sum_of_squares = 0;
  [[nodiscard]] double rms() const;
};

/// A pixel that differs, as values of a ForeignImage.
struct ForeignPixel {
  int x = 0, y = 0;
  ForeignDifference kind = ForeignDifference::other;
  std::uint32_t expected = 0, found = 0;
};

/// A change of the scene that predicts the foreign image where it differs.
struct Explanation {
  ForeignDifference kind = ForeignDifference::other;
  std::string change;        ///< "depth_test lequal in place of less"
  std::uint64_t pixels = 0;  ///< attributed to it
};

struct AgainstOptions {
  StudyRules rules;  ///< expected of the foreign rasterizer, and used for the comparison
  Tolerance tolerance;
  std::size_t listed = 10;                        ///< pixels in AgainstResult::first, at most
  std::function<void(double fraction)> progress;  ///< 0...1; may be empty
};

struct AgainstResult {
  std::uint64_t pixels = 0;
  std::uint64_t different = 0;         ///< by more than the tolerance; the other members are about these
  std::uint64_t within_tolerance = 0;  ///< pixels that differ within the tolerance
  std::array<DifferenceStats, kForeignDifferences.size()> kinds{};
  std::vector<Explanation> explanations;
  std::optional<ForeignPixel> first_pixel;  ///< row by row
  std::vector<ForeignPixel> first;          ///< likewise, up to the requested number
  std::vector<std::uint32_t> expected;      ///< the model's image, width * height
  std::vector<std::uint8_t> kind_of;        ///< by pixel: 0 none, 1 + ForeignDifference
};

/// The difference of two values of an image: the worst channel in LSB of 8 bits, or depth codes.
[[nodiscard]] double distance_between(std::uint32_t a, std::uint32_t b, bool is_depth);

/// `comparison`: of the same scene, with the same rules.
[[nodiscard]] AgainstResult compare_against(const Scene& scene, const Config& config, const Comparison& comparison,
                                            const ForeignImage& image, const AgainstOptions& options = {});

}  // namespace halfplane
