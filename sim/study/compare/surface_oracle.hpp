// What a surface should show at a sample, in real arithmetic through the snapped vertices, and how far what it shows is
// from that, step by step.
//
// Real is binary64: edge values of snapped vertices are exact, all weights have one sign, coordinates count from a vertex,
// so that nothing cancels; 2^-30 texel where a triangle spans 2^20 of them. The filter is the golden's.
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

/// A figure and the most that it may be; infinite where nothing is promised.
struct Held {
  double value = 0, bound = HUGE_VAL;
  [[nodiscard]] bool holds() const { return !std::isfinite(bound) || value <= bound; }  // of a promise, no NaN does
  [[nodiscard]] double ratio() const { return value / bound; }
};

/// The channels of a texel, in 2^-20 LSB of 8 bits.
struct TexelErrors {
  std::array<std::int64_t, 4> coordinate{}, level_of_detail{}, weights{}, rounding{};
};

/// One sample of a surface against the real one.
struct SurfaceErrors {
  golden::Color exact{};  ///< what should show, 0...255
  Held color;             ///< a colour over w, its worst channel, LSB of 8 bits
  bool is_lit = false;
  Held light;                ///< the channel nearest to its bound, of the same colour in real light; LSB of 8 bits
  bool has_texture = false;  ///< otherwise nothing of the texture
  Held coordinate;           ///< the worse of u and v, texels of level 0
  double footprints = 0;     ///< the same in extents of a pixel on the texture
  double level = 0;          ///< model less real, levels; what magnifies counts as one level below 0
  Held level_size;           ///< its size
  Held filter;               ///< texel less real one at the hardware's own coordinate and level, LSB of 8 bits
  TexelErrors texel;
  bool has_fog = false;
  Held fog_factor;  ///< f, times 255
  Held fog;         ///< the channel in fog that is nearest to its bound, of the same colour in real fog; LSB of 8 bits
};

class SurfaceOracle {
 public:
  /// A triangle of `scene` with has_surface(), not of zero area; at a sample, `offset` from pixel centres, the triangle moved
  /// there (moved_to_sample).
  SurfaceOracle(const Scene& scene, const Config& config, const Triangle& triangle, const SampleOffset& offset = {});
  [[nodiscard]] SurfaceErrors errors(const SurfaceSample& sample, int x, int y) const;
  /// How far coordinates that are affine on the screen lie from those over w, texels; 0 where the state has the latter.
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
  golden::Setup<double> setup_, normals_;  ///< the latter with normals as colours, where there is light
  double color_bound_ = HUGE_VAL, level_bound_ = HUGE_VAL;
  std::array<double, 2> coordinate_bound_{};
  std::shared_ptr<const FogTable> fog_;              ///< none: no fog
  std::shared_ptr<const PhongLight> phong_;          ///< none: no light
  double normal_code_ = 0, normal_lost_ = 0;         ///< what a code of P is of a normal over w, how many it is off
  double q_code_ = 0, q_lost_ = 0, q_relative_ = 0;  ///< what a code of Q is, how many it is off, and what part besides
};

/// What real arithmetic allows an attribute over w to be off, texels or LSB: coordinate_error_bound(), which is to first
/// order in the errors of Q, to all orders. Where Q is not known to be more than its error, whatever its bits can hold.
[[nodiscard]] double over_w_bound(double extent, double w_ratio, const PerspectiveFormat& format,
                                  const OverWFormat& attribute, int roundings);

/// The largest w ratio to which a level of detail is promised to be 0.1 off at most: a code of Q is then 2^-9 of the
/// smallest or less.
[[nodiscard]] double largest_level_w_ratio(const PerspectiveFormat& format);

// The errors of the textures that a target shows, taken apart, over its pixels.

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
