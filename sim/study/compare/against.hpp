// Against: a whole foreign rasterizer, judged by its image alone. Pixel by pixel the model's image against it; each that
// differs is put down to one kind.
//
// First by hypotheses (against_hypotheses.hpp): the scene drawn again with one thing changed, a depth function, a blend
// factor, a texture filter, the snap. One that predicts the foreign image in three of four pixels that it changes is no
// coincidence: the pixels that it predicts are put down to it. The rest are put down one by one, to the first that holds:
//
//   edge_rule  a triangle has the sample exactly on its border, and the image shows what another rule for ties would
//   snap       it shows another fragment, or what a pixel beside it shows, where a side runs past within a subpixel or so
//   depth      it shows another fragment of the pixel, or what lay there before: the depth test came out otherwise; of a
//              depth image also a depth that is a few codes off
//   dither, blend, texture
//              the colour is a code or so off where the fragment is dithered, blended or textured, and no pixel without
//              these is
//   color      the colour is a code or so off
//   other      nothing of that
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "compare.hpp"

namespace halfplane {

/// What another rasterizer drew, rows from the top.
struct ForeignImage {
  int width = 0, height = 0;
  bool is_depth = false;  ///< stored depth codes; otherwise colours of 8 bits, R in the lowest byte, no alpha
  std::vector<std::uint32_t> value;  ///< width * height
};

/// .png: a colour picture; .npy: depth codes, <u4. Throws InputError naming the file, also when its size is another one.
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

/// How far a pixel may be off and still count as equal, codes of the stored format: of each channel, of the depth.
struct Tolerance {
  std::uint32_t color = 0, depth = 0;
};

/// Pixels of one kind, and how far off they are: the worst channel in LSB of 8 bits, or depth codes.
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
  std::uint64_t pixels = 0;  ///< that are put down to it
};

struct AgainstOptions {
  StudyRules rules;  ///< that the foreign rasterizer is to have, and the comparison was made by
  Tolerance tolerance;
  std::size_t listed = 10;                        ///< pixels in AgainstResult::first, at most
  std::function<void(double fraction)> progress;  ///< 0...1; may be empty
};

struct AgainstResult {
  std::uint64_t pixels = 0;
  std::uint64_t different = 0;         ///< by more than the tolerance; everything else is about these
  std::uint64_t within_tolerance = 0;  ///< that differ, but by no more
  std::array<DifferenceStats, kForeignDifferences.size()> kinds{};
  std::vector<Explanation> explanations;
  std::optional<ForeignPixel> first_pixel;  ///< row by row
  std::vector<ForeignPixel> first;          ///< likewise, as many as were asked for
  std::vector<std::uint32_t> expected;      ///< the model's image, width * height
  std::vector<std::uint8_t> kind_of;        ///< of each pixel: 0 none, 1 + ForeignDifference
};

/// How far apart two values of an image are: the worst channel in LSB of 8 bits, or depth codes.
[[nodiscard]] double distance_between(std::uint32_t a, std::uint32_t b, bool is_depth);

/// `comparison`: of the same scene, by the same rules.
[[nodiscard]] AgainstResult compare_against(const Scene& scene, const Config& config, const Comparison& comparison,
                                            const ForeignImage& image, const AgainstOptions& options = {});

}  // namespace halfplane
