// Against: a whole foreign rasterizer, judged by its image alone. Pixel by pixel the model's image against it; each that
// differs is put down to the first rule that explains it.
//
//   snap       it shows what the scene shows with more or fewer subpixel bits or not snapped at all, if that is the foreign
//              image but for a quarter as many pixels as differ; or another fragment, or what a pixel beside it
//              shows, where a side runs past within a subpixel or so
//   edge_rule  a triangle has the sample exactly on its border, and the image shows what another rule for ties would
//   depth      it shows another fragment of the pixel, or what lay there before: the depth test came out otherwise; of a
//              depth image also a depth that is a few codes off
//   color      the colour is a code or so off
//   other      nothing of that
#pragma once

#include <array>
#include <cstdint>
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

enum class ForeignDifference : std::uint8_t { edge_rule, depth, snap, color, other };
inline constexpr std::array<std::string_view, 5> kForeignDifferences{"edge_rule", "depth", "snap", "color", "other"};

/// Pixels of one kind, and how far off they are: the worst channel in LSB of 8 bits, or depth codes.
struct DifferenceStats {
  std::uint64_t pixels = 0;
  double max = 0, sum_of_squares = 0;
  [[nodiscard]] double rms() const;
};

struct FirstForeignDifference {
  int x = 0, y = 0;
  ForeignDifference kind = ForeignDifference::other;
  std::uint32_t expected = 0, got = 0;
};

struct AgainstResult {
  std::uint64_t pixels = 0, different = 0;
  std::array<DifferenceStats, kForeignDifferences.size()> kinds{};
  std::optional<FirstForeignDifference> first;  ///< row by row
};

/// `comparison`: of the same scene, by the rules that the foreign rasterizer is to have.
[[nodiscard]] AgainstResult compare_against(const Scene& scene, const Config& config, const Comparison& comparison,
                                            const StudyRules& rules, const ForeignImage& image);

}  // namespace halfplane
