// The errors of the textures that a target shows, taken apart, over its pixels.
#pragma once

#include <vector>

#include "statistics.hpp"
#include "surface_oracle.hpp"

namespace halfplane {

struct TextureErrors {
  std::uint64_t pixels = 0;
  ErrorMoments coordinate;         ///< the worse of u and v, texels of level 0
  ErrorMoments footprints;         ///< the same in extents of a pixel on the texture
  double coordinate_of_bound = 0;  ///< the largest part of its triangle's bound that a coordinate takes up
  ErrorMoments level;              ///< model less real, levels
  /// Of the texel's channels, LSB of 8 bits: they sum to `total`, the texel less the exact one.
  PartStats part_coordinate, part_level, part_weights, part_rounding, total;

  /// Per pixel, rows from the top, NaN without a texture: `coordinate`, `footprints`, `level` as above; of a part its worst
  /// channel, LSB.
  struct Pictures {
    std::vector<float> coordinate, footprints, level, weights, rounding;
  } picture;
};

/// Gathers them.
class TextureErrorSets {
 public:
  explicit TextureErrorSets(std::size_t pixels);
  /// Of pixel y * width + x; `errors` of a sample with a texture.
  void add(std::size_t pixel, const SurfaceErrors& errors);
  [[nodiscard]] TextureErrors result() &&;

 private:
  TextureErrors errors_;
  MomentSet coordinate_, footprints_, level_;
  PartSet part_coordinate_, part_level_, part_weights_, part_rounding_, total_;
};

}  // namespace halfplane
