// The state as shading reads it (shade.cpp), for the sources of vertices: vertex.cpp, arrays.cpp, eval.cpp.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "context.hpp"

namespace halfplane::gl {

/// A light that is on.
struct LightConstants {
  Vec3 ambient{}, diffuse{}, specular{};
  Vec3 position{};        ///< of a directional light the unit vector to it
  Vec3 half{};            ///< of a directional light, for a viewer at infinity: unit vector between both
  Vec3 spot_direction{};  ///< unit vector
  Vec3 attenuation{};
  double spot_cosine = 0, spot_exponent = 0;
  bool is_positional = false, is_spot = false, is_attenuated = false;
};

struct ShadingConstants {
  std::uint64_t revision = 0;  ///< of the context when these were made, and its render mode
  GLenum render_mode = GL_RENDER;
  Mat4 to_clip{};
  std::array<Vec3, 3> normal_rows{};  ///< a normal in eye space is its products with these
  Vec3 scene_ambient{};
  std::vector<LightConstants> lights;
  std::array<bool, kTextureUnits> has_texture{}, has_texgen{}, has_texture_matrix{};
  bool needs_normal = false, is_attenuated = false;  ///< attenuated: the size of points

  /// The colours of the vertex before: they are the next one's where the normal is all that they depend on.
  struct Lit {
    bool is_known = false;  ///< not after a change of a material
    Vec3 normal{};
    std::array<Vec4, 2> color{}, secondary{};
  };
  bool depends_on_normal_alone = false;  ///< every light directional, the viewer at infinity
  Lit lit;
};

/// After a change of a material, which glBegin allows and which therefore raises no revision.
inline void forget_lit(Context& context) {
  if (context.shading) context.shading->lit.is_known = false;
}

/// Brings Context::shading up to date; to be called before the first vertex after a change of state.
void update_shading(Context& context);
/// The vertex at `position` with the current attributes. `all_textures`: texture coordinates also where no texture is on.
/// Precondition: update_shading().
void shade_current(const Context& context, const Vec4& position, ShadedVertex& vertex, bool all_textures = false);

/// 0, 1, ..., count - 1. Valid until the next call in this thread.
[[nodiscard]] std::span<const std::uint32_t> counting(std::size_t count);

/// Keeps the current attributes, the materials that follow the colour, and the size of points, while others take their place.
class CurrentKept {
 public:
  explicit CurrentKept(Context& context)
      : context_(context),
        current_(context.state.current),
        material_(context.state.lighting.material),
        size_(context.state.point.size) {}
  ~CurrentKept() {
    context_.state.current = current_;
    context_.state.lighting.material = material_;
    context_.state.point.size = size_;
    forget_lit(context_);
  }
  CurrentKept(const CurrentKept&) = delete;
  CurrentKept& operator=(const CurrentKept&) = delete;

 private:
  Context& context_;
  CurrentState current_;
  std::array<Material, 2> material_;
  double size_;
};

}  // namespace halfplane::gl
