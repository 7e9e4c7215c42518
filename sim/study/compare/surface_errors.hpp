// Errors of the shown surface at a sample, and over a target: figures of the oracle (surface_oracle.hpp).
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "model/golden/interpolate.hpp"
#include "sim/study/compare/statistics.hpp"

namespace halfplane {

/// A figure and its bound; infinite without a bound.
struct Held {
  double value = 0, bound = HUGE_VAL;
  [[nodiscard]] bool holds() const { return !std::isfinite(bound) || value <= bound; }  // no NaN satisfies a bound
  [[nodiscard]] double ratio() const { return value / bound; }
};

/// The channels of a texel, in 2^-20 LSB of 8 bits.
struct TexelErrors {
  std::array<std::int64_t, 4> coordinate{}, level_of_detail{}, weights{}, rounding{};
};

/// One sample of a surface compared with the real one.
struct SurfaceErrors {
  golden::Color exact{};  ///< the exact colour, 0...255
  Held color;             ///< a colour over w, its worst channel, LSB of 8 bits
  bool is_lit = false;
  Held light;                ///< the channel nearest to its bound, against the same colour in real light; LSB of 8 bits
  bool has_texture = false;  ///< otherwise no texture figures
  Held coordinate;           ///< the worse of u and v, texels of level 0
  double footprints = 0;     ///< the same in extents of a pixel on the texture
  double level = 0;          ///< model less real, levels; magnification counts as one level below 0
  Held level_size;           ///< its size
  Held filter;               ///< texel less the real one at the hardware's own coordinate and level, LSB of 8 bits
  TexelErrors texel;
  bool has_fog = false;
  Held fog_factor;  ///< f, times 255
  Held fog;         ///< the fogged channel nearest to its bound, against the same colour in real fog; LSB of 8 bits
};

// The errors of a target's visible textures, split into parts, over its pixels.

struct TextureErrors {
  std::uint64_t pixels = 0;
  ErrorMoments coordinate;         ///< the worse of u and v, texels of level 0
  ErrorMoments footprints;         ///< the same in extents of a pixel on the texture
  double coordinate_of_bound = 0;  ///< the largest fraction of a triangle's bound used by a coordinate
  ErrorMoments level;              ///< model less real, levels
  /// Errors of the texel's channels, LSB of 8 bits: they sum to `total`, the texel less the exact one.
  PartStats part_coordinate, part_level, part_weights, part_rounding, total;

  /// Per pixel, rows from the top, NaN without a texture: `coordinate`, `footprints`, `level` as above; for a part its
  /// worst channel, LSB.
  struct Pictures {
    std::vector<float> coordinate, footprints, level, weights, rounding;
  } picture;
};

/// Collects the errors.
class TextureErrorSets {
 public:
  explicit TextureErrorSets(std::size_t pixels);
  /// For pixel y * width + x; `errors` of a sample with a texture.
  void add(std::size_t pixel, const SurfaceErrors& errors);
  [[nodiscard]] TextureErrors result() &&;

 private:
  TextureErrors errors_;
  MomentSet coordinate_, footprints_, level_;
  PartSet part_coordinate_, part_level_, part_weights_, part_rounding_, total_;
};

}  // namespace halfplane
