// The exact surface at a sample, in real arithmetic through the snapped vertices, and the error of the shown one, step
// by step.
//
// Real is binary64: edge values of snapped vertices are exact, all weights have one sign, coordinates are relative to a
// vertex, so that nothing cancels; the error is 2^-30 texel for a triangle of 2^20 texels. The filter is the golden's.
//
//   S  filtered at the exact coordinate and level
//   C  at the hardware's coordinate and the exact level
//   L  at the hardware's coordinate and level
//   W  the same with weights of 8 bits, not rounded
//   D  the texel
//
// coordinate = C - S, level_of_detail = L - C, weights = W - L, rounding = D - W: integers of 2^-20 LSB, so that they sum to
// D - S exactly.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "model/golden/interpolate.hpp"
#include "model/scene.hpp"
#include "model/stages/surface.hpp"
#include "sim/study/compare/statistics.hpp"

namespace halfplane {

// Errors of the shown surface at a sample, and over a target: figures of the oracle (surface_oracle.hpp).

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

class SurfaceOracle {
 public:
  /// A triangle of `scene` with has_surface(), not of zero area; at a sample, `offset` from pixel centres, the triangle moved
  /// there (moved_to_sample).
  SurfaceOracle(const Scene& scene, const Config& config, const Triangle& triangle, const SampleOffset& offset = {});
  [[nodiscard]] SurfaceErrors errors(const SurfaceSample& sample, int x, int y) const;
  /// Distance of coordinates that are affine on the screen from coordinates over w, texels; 0 if the state has the latter.
  [[nodiscard]] double affine_texels(int x, int y) const;

 private:
  void set_q(const std::array<double, 3>& w, const PerspectiveFormat& format, int roundings);
  void compare_light(const SurfaceSample& sample, const std::array<double, 3>& normal, double inverse_w,
                     SurfaceErrors& errors) const;
  void compare_fog(const SurfaceSample& sample, double inverse_w, SurfaceErrors& errors) const;
  void compare_texels(const SurfaceSample& sample, const golden::Fragment<double>& exact, double lod,
                      SurfaceErrors& errors) const;
  [[nodiscard]] golden::Fragment<double> exact_at(double x, double y, const golden::Setup<double>& setup,
                                                  const golden::InterpolationRules& rules) const;
  [[nodiscard]] double exact_level(golden::Fragment<double> exact, int x, int y) const;

  const State& state_;
  const Texture* texture_;
  Sampler sampler_;
  golden::InterpolationRules rules_;
  std::array<double, 2> offset_{};         ///< of the sample, pixels
  golden::Setup<double> setup_, normals_;  ///< the latter with normals as colours, if lit
  double color_bound_ = HUGE_VAL, level_bound_ = HUGE_VAL;
  std::array<double, 2> coordinate_bound_{};
  std::shared_ptr<const FogTable> fog_;              ///< none: no fog
  std::shared_ptr<const PhongLight> phong_;          ///< none: no light
  double normal_code_ = 0, normal_lost_ = 0;         ///< one code of P as a normal over w; its error in codes
  double q_code_ = 0, q_lost_ = 0, q_relative_ = 0;  ///< one code of Q; its error in codes, and its relative error
};

/// Error bound of an attribute over w, texels or LSB: coordinate_error_bound(), which is first order in the errors of
/// Q, to all orders. If Q may be below its error, the range of its bits.
[[nodiscard]] double over_w_bound(double extent, double w_ratio, const PerspectiveFormat& format,
                                  const OverWFormat& attribute, int roundings);

/// The largest w ratio for which the error of a level of detail is at most 0.1: a code of Q is then at most 2^-9 of the
/// smallest.
[[nodiscard]] double largest_level_w_ratio(const PerspectiveFormat& format);

}  // namespace halfplane
