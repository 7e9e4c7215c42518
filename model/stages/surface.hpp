// Surface: the colour of a triangle at a covered sample, where it is more than the codes of its affine planes: colours
// over w, their light, a texture, both combined, and the result in fog.
//
//   colours      affine codes, or P / Q (perspective.hpp)
//   light        phong.hpp, from normals over w
//   coordinates  u, v over w, or affine: the same planes with equal Q at all vertices
//   level        level_of_detail.hpp, from the coordinates' planes; where one of several samples is shaded, from Q
//   there and the
//                row and column of its pixel's centre
//   texel        texture_sample.hpp
//   fog          fog.hpp, from Q
#pragma once

#include <array>
#include <optional>

#include "../attributes.hpp"
#include "../config.hpp"
#include "fog.hpp"
#include "level_of_detail.hpp"
#include "perspective.hpp"
#include "phong.hpp"
#include "texture_sample.hpp"

namespace halfplane {

/// Precision of the attributes over w of a configuration.
[[nodiscard]] constexpr PerspectiveFormat perspective_format(const Config& config) {
  const int bits = config.perspective_bits, mantissa = config.perspective_mantissa_bits;
  constexpr int kShortMantissa = 16;
  return {bits,
          kPerspectiveGuardBits,
          mantissa,
          bits - kPerspectiveReciprocalLess,
          {bits, mantissa - 1, mantissa < kShortMantissa ? 6 : 8, true},
          {color_over_w_bits(config), kColorNarrowBits, 0, false}};
}

/// Whether the filled triangles of a draw need a surface.
[[nodiscard]] constexpr bool has_surface(const State& state) {
  return state.texture.has_value() || state.color_interp == ColorInterp::perspective || state.fog.has_value() ||
         state.shade == Shade::phong;
}

/// Input of setup for a textured triangle, vertices in the order of `surface`; every w > 0. Host.
struct TextureCoordinates {
  QCodes q{};
  std::array<std::array<double, 3>, 2> texels{};  ///< u and v of each vertex
  std::array<OverW, 2> over_w{};
  std::array<std::int32_t, 2> reference{};  ///< u_ref: wrapped_reference()
};
[[nodiscard]] TextureCoordinates texture_coordinates(const std::array<SurfaceVertex, 3>& surface, const State& state,
                                                     const Texture& texture, const PerspectiveFormat& format);

/// A surface at a covered sample, step by step.
struct SurfaceSample {
  Texel primitive{};                   ///< its own colour
  Normal normal{};                     ///< m; without light 0
  PhongLight::Factors light{};         ///< N.L and the highlight, 2^-12; without light 0
  Texel lit{};                         ///< the primitive's colour in its light; without light unchanged
  std::array<double, 2> coordinate{};  ///< u and v, texels of level 0, before they wrap; 0 without a texture
  TexturePlace place;                  ///< the place as passed to the filter
  Lod lod = 0;                         ///< without bias and bounds
  Texel texel{};                       ///< the texture's colour; without one 0
  Texel clear{};                       ///< R, G, B, A: both combined
  std::uint64_t fog_q = 0;             ///< Q, 2^-l codes; without fog 0
  std::uint32_t fog = kFogClear;       ///< f, the part of that which remains
  Texel color{};                       ///< in fog
};

class Surface {
 public:
  /// Q over the triangle, and the frame of the planes that are divided by it.
  struct Divisor {
    QCodes q{};
    PerspectiveFrame frame;
    Plane plane;
  };
  struct Attribute {
    OverW over_w;
    Plane plane;
  };

  /// At pixel centres; or at a sample of each pixel, `offset` from the centre, with `setup` at that sample
  /// (setup_at_sample). `setup`: of `triangle`, not empty; `texture`, `fog`, `phong`: of the state, or none. Every w >
  /// 0 (require_positive_w).
  Surface(const Triangle& triangle, const TriangleSetup& setup, const State& state, const Texture* texture,
          const FogTable* fog, const PhongLight* phong, const Config& config, const Widths& widths,
          const SampleOffset& offset = {});

  [[nodiscard]] SurfaceSample at(int x, int y, int weight_bits = kTexelFraction) const;
  /// R, G, B, A at a covered sample.
  [[nodiscard]] Texel color(int x, int y) const { return at(x, y).color; }

  // Parts of color(), for engines that compute it in lanes.
  [[nodiscard]] const PerspectiveFormat& format() const { return format_; }
  [[nodiscard]] const std::optional<Divisor>& color_divisor() const { return color_divisor_; }
  [[nodiscard]] const std::optional<Divisor>& texture_divisor() const { return texture_divisor_; }
  [[nodiscard]] const std::optional<Divisor>& fog_divisor() const { return fog_divisor_; }
  [[nodiscard]] const FogTable& fog() const { return *fog_; }
  [[nodiscard]] bool is_lit() const { return phong_ != nullptr; }
  [[nodiscard]] const PhongLight& phong() const { return *phong_; }
  [[nodiscard]] const Plane& normal(std::size_t c) const { return normal_[c]; }
  /// q is Q 2^-scale.
  [[nodiscard]] int fog_scale() const { return fog_scale_; }
  [[nodiscard]] const Attribute& channel(std::size_t c) const { return color_[c]; }
  [[nodiscard]] const Attribute& coordinate(std::size_t axis) const { return coordinate_[axis]; }
  [[nodiscard]] std::int32_t reference(std::size_t axis) const { return reference_[axis]; }
  [[nodiscard]] const LodSetup& lod() const { return lod_; }
  [[nodiscard]] const Sampler& sampler() const { return sampler_; }
  [[nodiscard]] TextureCombine combine() const { return combine_; }
  [[nodiscard]] const std::array<std::uint8_t, 3>& constant() const { return constant_; }

 private:
  [[nodiscard]] Divisor make_divisor(const QCodes& q) const;
  [[nodiscard]] Attribute make_attribute(const std::array<double, 3>& value, const Divisor& divisor,
                                         const OverWFormat& attribute) const;
  [[nodiscard]] Texel primitive_color(int x, int y, const PixelPlace& place) const;
  [[nodiscard]] std::uint64_t q_of(const Divisor& divisor, const PixelPlace& place) const;
  [[nodiscard]] std::int64_t value_of(const Attribute& attribute, const OverWFormat& of, const PixelReciprocal& q,
                                      const PixelPlace& place) const;
  [[nodiscard]] Plane at_sample(const Plane& plane) const;
  void set_texture(const Triangle& triangle, const State& state, const Texture& texture);
  [[nodiscard]] Divisor true_divisor(const std::array<double, 3>& w, bool is_over_w) const;
  void set_normals(const Triangle& triangle, const Divisor& divisor);
  void add_light(const PixelPlace& pixel, SurfaceSample& sample) const;
  void add_texture(int x, int y, int weight_bits, const PixelPlace& pixel, SurfaceSample& sample) const;
  void add_fog(const PixelPlace& pixel, SurfaceSample& sample) const;

  const TriangleSetup& setup_;
  const Widths& widths_;
  SampleOffset offset_;
  PerspectiveFormat format_;
  std::array<std::size_t, 3> order_{};                      ///< canonical
  std::array<SnappedVertex, 3> vertex_{};                   ///< in that order
  std::optional<Divisor> color_divisor_, texture_divisor_;  ///< none: affine colours, no texture
  std::optional<Divisor> fog_divisor_;                      ///< none: no fog
  const FogTable* fog_;
  int fog_scale_ = 0;
  const PhongLight* phong_;
  std::array<Plane, 3> normal_{};
  std::array<Attribute, 4> color_{};
  std::array<Attribute, 2> coordinate_{};  ///< u and v, texels
  std::array<std::int32_t, 2> reference_{};
  LodSetup lod_;
  Sampler sampler_;
  TextureCombine combine_ = TextureCombine::modulate;
  std::array<std::uint8_t, 3> constant_{};
};

}  // namespace halfplane
