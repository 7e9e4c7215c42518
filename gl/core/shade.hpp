// From a vertex as the program gives it to one as primitives take it: transformation, lighting, texture coordinates and fog
// (OpenGL 1.5, 2.11 to 2.14).
#pragma once

#include "state.hpp"

namespace halfplane::gl {

struct Context;

/// A vertex with the attributes that it was given.
struct InputVertex {
  Vec4 position{0, 0, 0, 1};
  Vec3 normal{0, 0, 1};
  Vec4 color{1, 1, 1, 1}, secondary{0, 0, 0, 1};
  std::array<Vec4, kTextureUnits> tex_coord;
  double fog_coord = 0;
  bool edge_flag = true;
};

struct ShadedVertex {
  Vec4 eye{}, clip{};
  /// Lit for the front and for the back, held to 0...1; equal where there is no two-sided light. `secondary` is zero where
  /// nothing is added after the texture.
  std::array<Vec4, 2> color{}, secondary{};
  std::array<Vec4, kTextureUnits> tex_coord{};  ///< after texgen and the texture matrix
  double fog_distance = 0;                      ///< |z| in eye space or the fog coordinate
  double point_size = 1;                        ///< after attenuation
  bool edge_flag = true;                        ///< the edge to the next vertex is one of the polygon's
};

/// The state in the form that shading reads; brought up to date by Context::revision.
struct ShadingConstants;
struct ShadingConstantsDeleter {
  void operator()(ShadingConstants* constants) const;
};

/// `shade` of a whole batch calls this function for each vertex. Material is that of Context::state at the time of the call.
[[nodiscard]] ShadedVertex shade(Context& context, const InputVertex& vertex);

}  // namespace halfplane::gl
