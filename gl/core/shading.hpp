// The state as shading reads it, and shading itself (shade.cpp): vertices as a program gives them become vertices as primitives
// take them (OpenGL 1.5, 2.11 to 2.14). For the sources of vertices: vertex.cpp, arrays.cpp, list.cpp.
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

/// What follows from a material for all vertices.
struct MaterialUse {
  enum Part : std::uint8_t { ambient, diffuse, specular, emission };
  std::array<bool, 4> follows_color{};  ///< GL_COLOR_MATERIAL, by Part
  bool is_shiny = false;                ///< has a specular part
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

  std::array<MaterialUse, 2> material;  ///< of front and back, at the last finish_vertices()
};

inline constexpr Vec3 kTowardsViewer{0, 0, 1};  ///< for a viewer at infinity

/// Brings Context::shading up to date; to be called before the first vertex after a change of state.
void update_shading(Context& context);

// Vertices from shaded.size() on are shaded, in two steps. Precondition: update_shading().

/// Their positions in clip space. Whether all of them lie beyond one plane of the view volume.
bool place_vertices(const Context& context, const InputVertices& vertices, ShadedVertices& shaded);
/// Everything else. Material is that of Context::state, attributes that do not vary are of `values`. `all_textures`: texture
/// coordinates also where no texture is on.
void finish_vertices(Context& context, const InputVertices& vertices, const InputVertices::Values& values,
                     ShadedVertices& shaded, bool all_textures = false);
/// Both for the vertices since glBegin, before a change of the material.
void shade_pending(Context& context);

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
    if (context_.inside_begin()) context_.input.load(context_.state);
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
