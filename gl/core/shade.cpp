// What vertices are shaded with, and the order of that; the arithmetic is in shade_lanes.inl.
#include "shade_kernels.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "../../model/engines/functional/kernels.hpp"
#include "matrix.hpp"

namespace halfplane::gl {
namespace {

constexpr double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
constexpr Vec3 scaled(const Vec3& a, double factor) { return {a[0] * factor, a[1] * factor, a[2] * factor}; }
constexpr Vec3 sum(const Vec3& a, const Vec3& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
constexpr Vec3 xyz(const Vec4& v) { return {v[0], v[1], v[2]}; }
/// Zero stays zero.
Vec3 unit(const Vec3& a) {
  const double square = dot(a, a);
  return square > 0 ? scaled(a, 1 / std::sqrt(square)) : a;
}
/// The point of homogeneous coordinates.
constexpr Vec3 point_of(const Vec4& v) { return {v[0] / v[3], v[1] / v[3], v[2] / v[3]}; }

LightConstants constants_of(const Light& light) {
  LightConstants constants{
      .ambient = xyz(light.ambient), .diffuse = xyz(light.diffuse), .specular = xyz(light.specular)};
  constants.is_positional = light.position[3] != 0;
  constants.position = constants.is_positional ? point_of(light.position) : unit(xyz(light.position));
  constants.half = unit(sum(constants.position, kTowardsViewer));
  constants.is_spot = light.spot_cutoff != 180;
  constants.spot_direction = unit(light.spot_direction);
  if (constants.is_spot) constants.spot_cosine = std::cos(light.spot_cutoff * std::numbers::pi / 180);
  constants.spot_exponent = light.spot_exponent;
  constants.attenuation = light.attenuation;
  constants.is_attenuated = constants.is_positional && light.attenuation != Vec3{1, 0, 0};
  return constants;
}

MaterialUse use_of(const LightingState& state, std::size_t side) {
  const GLenum face = state.color_material_face, mode = state.color_material_mode;
  const bool follows = state.color_material && face != (side == 0 ? GLenum{GL_BACK} : GLenum{GL_FRONT});
  const bool follows_both = follows && mode == GL_AMBIENT_AND_DIFFUSE;
  MaterialUse use{.follows_color = {follows_both || (follows && mode == GL_AMBIENT),
                                    follows_both || (follows && mode == GL_DIFFUSE), follows && mode == GL_SPECULAR,
                                    follows && mode == GL_EMISSION}};
  use.is_shiny = use.follows_color[MaterialUse::specular] || xyz(state.material[side].specular) != Vec3{};
  return use;
}

}  // namespace

const ShadeKernels& shade_kernels() {
  static const ShadeKernels& kernels = []() -> const ShadeKernels& {
#if defined(__x86_64__) && !defined(__clang__)
    for (const ShadeKernels* const of : {&kAvx512Shading, &kAvx2Shading})
      if (of->name == functional::available_kernels().front()->name) return *of;
#endif
    return kPortableShading;
  }();
  return kernels;
}

void update_shading(Context& context) {
  if (!context.shading) context.shading = std::make_shared<ShadingConstants>();
  ShadingConstants& constants = *context.shading;
  if (constants.revision == context.revision && constants.render_mode == context.render_mode) return;
  constants.revision = context.revision;
  constants.render_mode = context.render_mode;
  const State& state = context.state;
  constants.to_clip = product(context.projection.back(), context.modelview.back());

  constants.needs_normal = state.lighting.enabled;
  for (std::size_t i = 0; i < kTextureUnits; ++i) {
    const TextureUnit& texture = state.texture.unit[i];
    // Selection needs none; feedback returns them without a texture as well.
    constants.has_texture[i] =
        context.render_mode == GL_FEEDBACK || std::ranges::find(texture.enabled, true) != texture.enabled.end();
    constants.has_texgen[i] = std::ranges::any_of(texture.gen, [](const TexGen& gen) { return gen.enabled; });
    constants.has_texture_matrix[i] = context.texture_matrix[i].back() != kIdentity;
    constants.needs_normal |= constants.has_texture[i] && constants.has_texgen[i];
  }
  const Mat4 inverted = inverse(context.modelview.back());
  for (std::size_t i = 0; i < 3; ++i)
    constants.normal_rows[i] = {inverted[4 * i], inverted[4 * i + 1], inverted[4 * i + 2]};
  if (state.transform.rescale_normal) {
    const Vec3 third{inverted[2], inverted[6], inverted[10]};
    const double length = std::sqrt(dot(third, third));
    if (length > 0)
      for (Vec3& row : constants.normal_rows) row = scaled(row, 1 / length);
  }

  constants.scene_ambient = xyz(state.lighting.model_ambient);
  constants.lights.clear();
  for (std::size_t i = 0; i < kLights; ++i)
    if (state.lighting.enabled && state.lighting.light_enabled[i])
      constants.lights.push_back(constants_of(state.lighting.light[i]));
  constants.is_attenuated = state.point.attenuation != Vec3{1, 0, 0};
}

bool place_vertices(const Context& context, const InputVertices& vertices, ShadedVertices& shaded) {
  return shade_kernels().place(context, vertices, shaded.size() / kVertexLanes, shaded.reserve(vertices.size())) != 0;
}

void finish_vertices(Context& context, const InputVertices& vertices, const InputVertices::Values& values,
                     ShadedVertices& shaded, bool all_textures) {
  for (std::size_t side = 0; side < 2; ++side) context.shading->material[side] = use_of(context.state.lighting, side);
  // Vertices that were shaded with another material are kept in the block that they share with new ones.
  const std::size_t block = shaded.size() / kVertexLanes, kept = shaded.size() % kVertexLanes;
  ShadedVertices::Block* const blocks = shaded.reserve(vertices.size());
  ShadedVertices::Block before;
  if (kept != 0) before = blocks[block];
  shade_kernels().finish(context, vertices, values, block, blocks, all_textures);
  const std::size_t in_block = std::min(vertices.size() - block * kVertexLanes, kVertexLanes);
  for (std::size_t i = 0; kept != 0 && i < before.size(); ++i) {
    Column& column = blocks[block][i];
    std::copy_n(before[i].begin(), kept, column.begin());
    std::fill(column.begin() + in_block, column.end(), column[0]);
  }
  shaded.resize(vertices.size());
}

void shade_pending(Context& context) {
  if (context.input.size() == context.shaded.size()) return;
  place_vertices(context, context.input, context.shaded);
  finish_vertices(context, context.input, context.input.values(), context.shaded);
}

std::span<const std::uint32_t> counting(std::size_t count) {
  thread_local std::vector<std::uint32_t> numbers;
  if (numbers.size() < count) {
    const std::size_t old = numbers.size();
    numbers.resize(std::max(count, 2 * old));
    std::iota(numbers.begin() + static_cast<std::ptrdiff_t>(old), numbers.end(), static_cast<std::uint32_t>(old));
  }
  return {numbers.data(), count};
}

}  // namespace halfplane::gl
