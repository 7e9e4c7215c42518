// Textures of any target sampled on the host (OpenGL 1.5, 3.8.5 to 3.8.8 and 3.8.14).
#pragma once

#include "objects.hpp"

namespace halfplane::gl {

/// Homogeneous texture coordinates s, t, r, q at the centre of a pixel, and how they change towards the next one in x and
/// in y. A common factor of all three does not matter.
struct TexturePlace {
  Vec4 at{0, 0, 0, 1}, dx{}, dy{};
};

/// One texture as a unit samples it. Precondition: is_complete().
class Sampler {
 public:
  Sampler(const TextureObject& texture, double unit_lod_bias);

  /// GL_ALPHA, GL_LUMINANCE, ...: of depth textures what they are read as.
  [[nodiscard]] GLenum base() const { return base_; }
  /// The texture's colour as table 3.20 has it.
  [[nodiscard]] Vec4 operator()(const TexturePlace& place) const;

 private:
  /// The image that coordinates mean, with those in it.
  struct Spot {
    std::size_t face = 0;
    Vec3 coordinate{};
    double reference = 0;  ///< r, that depths are compared with
  };
  [[nodiscard]] Vec4 sample_level(const Spot& spot, std::size_t level, bool is_linear) const;
  [[nodiscard]] Vec4 value_of(const Texel& texel, double reference) const;
  [[nodiscard]] Vec4 value_of_depth(double depth, double reference) const;

  const TextureObject* texture_;
  GLenum base_;
  int dimensions_;
  std::size_t first_, last_;  ///< levels
  bool is_depth_;
  double lod_bias_;
};

/// The last level that the minifying filter uses (OpenGL 1.5, 3.8.8: q).
[[nodiscard]] std::size_t last_level(const TextureObject& texture);
/// GL_LINEAR of texels, whatever is done between levels.
[[nodiscard]] bool is_linear(GLenum filter);
/// What a depth texture is read as, else the format of its images.
[[nodiscard]] GLenum base_of(const TextureObject& texture);

}  // namespace halfplane::gl
