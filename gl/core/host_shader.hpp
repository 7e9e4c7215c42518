// Fragments shaded on the host, where the model's texture unit has not what a draw asks for: several textures, environments
// of any kind, 3D textures, cube maps, depth comparison, a second colour and fog after the texture (OpenGL 1.5, 3.8.13 to
// 3.10). Their colours are an image that lies on the window, and the model draws the triangles with it: coverage, depth,
// stencil, alpha test, blending and logic operations stay those of the model.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "primitive.hpp"
#include "sampler.hpp"

namespace halfplane::gl {

/// The texture environments of all units (OpenGL 1.5, tables 3.22 to 3.25). Valid while the context stays as it is.
class TextureEnvironments {
 public:
  explicit TextureEnvironments(const Context& context);
  /// The colour after the last unit, of a primary colour in 0...1.
  [[nodiscard]] Vec4 operator()(const Vec4& primary, const std::array<TexturePlace, kTextureUnits>& places) const;

 private:
  const TextureState& state_;
  std::array<std::optional<Sampler>, kTextureUnits> sampler_;
};

/// 1 without fog, 0 where nothing but fog is seen (OpenGL 1.5, 3.10).
[[nodiscard]] double fog_factor(const FogState& fog, double distance);

struct Shading {
  bool has_fog = false;      ///< fog is mixed in here
  bool is_stippled = false;  ///< by the polygon stipple
};
/// Draws a list of triangles in `state`, which says all but the texture; its space is that of the vertices' `clip`.
void draw_shaded(Context& context, const halfplane::State& state, std::span<const ShadedVertex> vertices,
                 const Shading& shading);

}  // namespace halfplane::gl
