// Surface: the colour of a triangle at a covered sample, where it is more than the codes of its affine planes: colours over
// w, a texture, and the two combined.
//
//   colours      affine codes, or P / Q (perspective.hpp)
//   coordinates  u, v over w, or affine: the same planes with Q the same at all vertices
//   level        level_of_detail.hpp, from the coordinates' planes
//   texel        texture_sample.hpp
#pragma once

#include <array>
#include <optional>

#include "../config.hpp"
#include "level_of_detail.hpp"
#include "perspective.hpp"
#include "texture_sample.hpp"

namespace halfplane {

/// How precise the attributes over w of a configuration are.
[[nodiscard]] PerspectiveFormat perspective_format(const Config& config);

/// Whether the filled triangles of a draw need one.
[[nodiscard]] constexpr bool has_surface(const State& state) {
  return state.texture.has_value() || state.color_interp == ColorInterp::perspective;
}

class Surface {
 public:
  /// `setup` of `triangle`, not empty; `texture`: that of the state, or none. Every w > 0 (has_positive_w).
  Surface(const Triangle& triangle, const TriangleSetup& setup, const State& state, const Texture* texture,
          const Config& config, const Widths& widths);

  /// R, G, B, A at a covered sample.
  [[nodiscard]] Texel color(int x, int y) const;

 private:
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

  [[nodiscard]] Divisor make_divisor(const std::array<double, 3>& w) const;
  [[nodiscard]] Attribute make_attribute(const std::array<double, 3>& value, const Divisor& divisor,
                                         const OverWFormat& attribute) const;
  [[nodiscard]] std::uint64_t q_of(const Divisor& divisor, const PixelPlace& place) const;
  [[nodiscard]] std::int64_t value_of(const Attribute& attribute, const OverWFormat& of, const PixelReciprocal& q,
                                      const PixelPlace& place) const;
  void set_texture(const Triangle& triangle, const State& state, const Texture& texture);

  const TriangleSetup& setup_;
  const Widths& widths_;
  PerspectiveFormat format_;
  std::array<std::size_t, 3> order_{};     ///< canonical
  std::array<SnappedVertex, 3> vertex_{};  ///< in that order
  std::optional<Divisor> color_divisor_, texture_divisor_;
  std::array<Attribute, 4> color_{};
  std::array<Attribute, 2> coordinate_{};  ///< u and v, texels
  std::array<std::int32_t, 2> reference_{};
  LodSetup lod_;
  Sampler sampler_;
  TextureCombine combine_ = TextureCombine::modulate;
};

/// Whether a division by w has a meaning all over the triangle.
[[nodiscard]] constexpr bool has_positive_w(const Triangle& triangle) {
  return triangle.surface[0].w > 0 && triangle.surface[1].w > 0 && triangle.surface[2].w > 0;
}

}  // namespace halfplane
