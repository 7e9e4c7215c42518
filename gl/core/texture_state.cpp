// Parameters of textures, environments and coordinate generation.
#include <algorithm>
#include <array>

#include "matrix.hpp"
#include "parameter.hpp"
#include "texture.hpp"

namespace halfplane::gl {
namespace {

constexpr std::array<GLenum, 6> kMinFilters{GL_NEAREST,
                                            GL_LINEAR,
                                            GL_NEAREST_MIPMAP_NEAREST,
                                            GL_LINEAR_MIPMAP_NEAREST,
                                            GL_NEAREST_MIPMAP_LINEAR,
                                            GL_LINEAR_MIPMAP_LINEAR};
constexpr std::array<GLenum, 2> kMagFilters{GL_NEAREST, GL_LINEAR};
constexpr std::array<GLenum, 5> kWraps{GL_CLAMP, GL_REPEAT, GL_CLAMP_TO_EDGE, GL_CLAMP_TO_BORDER, GL_MIRRORED_REPEAT};
constexpr std::array<GLenum, 3> kDepthModes{GL_LUMINANCE, GL_INTENSITY, GL_ALPHA};
constexpr std::array<GLenum, 2> kCompareModes{GL_NONE, GL_COMPARE_R_TO_TEXTURE};
constexpr std::array<GLenum, 8> kCompareFuncs{GL_LEQUAL, GL_GEQUAL,   GL_LESS,   GL_GREATER,
                                              GL_EQUAL,  GL_NOTEQUAL, GL_ALWAYS, GL_NEVER};

constexpr std::array<GLenum, 6> kEnvModes{GL_MODULATE, GL_DECAL, GL_BLEND, GL_REPLACE, GL_ADD, GL_COMBINE};
constexpr std::array<GLenum, 8> kFunctions{GL_REPLACE,     GL_MODULATE, GL_ADD,      GL_ADD_SIGNED,
                                           GL_INTERPOLATE, GL_SUBTRACT, GL_DOT3_RGB, GL_DOT3_RGBA};
constexpr std::array<GLenum, 4> kOperands{GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_SRC_COLOR, GL_ONE_MINUS_SRC_COLOR};
constexpr auto kSources = [] {
  std::array<GLenum, 4 + kTextureUnits> sources{GL_TEXTURE, GL_CONSTANT, GL_PRIMARY_COLOR, GL_PREVIOUS};
  for (std::size_t i = 0; i < kTextureUnits; ++i) sources[4 + i] = GL_TEXTURE0 + static_cast<GLenum>(i);
  return sources;
}();

TextureUnit& active_unit(Context& context) {
  return context.state.texture.unit[static_cast<std::size_t>(context.state.texture.active)];
}

}  // namespace

std::optional<Place> texture_place(TextureParameters& t, GLenum pname) {
  switch (pname) {
    case GL_TEXTURE_MIN_FILTER: return Place{&t.min_filter, kMinFilters};
    case GL_TEXTURE_MAG_FILTER: return Place{&t.mag_filter, kMagFilters};
    case GL_TEXTURE_WRAP_S: return Place{&t.wrap[0], kWraps};
    case GL_TEXTURE_WRAP_T: return Place{&t.wrap[1], kWraps};
    case GL_TEXTURE_WRAP_R: return Place{&t.wrap[2], kWraps};
    case GL_TEXTURE_BORDER_COLOR: return Place{&t.border_color, {}, ValueKind::color, true};
    case GL_TEXTURE_PRIORITY: return Place{&t.priority, {}, ValueKind::color, true};
    case GL_TEXTURE_MIN_LOD: return Place{&t.min_lod};
    case GL_TEXTURE_MAX_LOD: return Place{&t.max_lod};
    case GL_TEXTURE_LOD_BIAS: return Place{&t.lod_bias};
    case GL_TEXTURE_BASE_LEVEL: return Place{.where = &t.base_level, .low = 0};
    case GL_TEXTURE_MAX_LEVEL: return Place{.where = &t.max_level, .low = 0};
    case kTextureCropRect: return Place{&t.crop};
    case GL_GENERATE_MIPMAP: return Place{&t.generate_mipmap};
    case GL_DEPTH_TEXTURE_MODE: return Place{&t.depth_mode, kDepthModes};
    case GL_TEXTURE_COMPARE_MODE: return Place{&t.compare_mode, kCompareModes};
    case GL_TEXTURE_COMPARE_FUNC: return Place{&t.compare_func, kCompareFuncs};
    default: return std::nullopt;
  }
}

std::optional<Place> environment_place(TextureUnit& unit, GLenum target, GLenum pname) {
  if (target == GL_TEXTURE_FILTER_CONTROL && pname == GL_TEXTURE_LOD_BIAS) return Place{&unit.lod_bias};
  if (target == GL_POINT_SPRITE && pname == GL_COORD_REPLACE) return Place{&unit.coord_replace};
  if (target != GL_TEXTURE_ENV) return std::nullopt;
  const std::span<const GLenum> functions = kFunctions, operands = kOperands;
  auto& [rgb, alpha] = unit.combine;
  if (pname - GL_SOURCE0_RGB < 3) return Place{&rgb.source[pname - GL_SOURCE0_RGB], kSources};
  if (pname - GL_SOURCE0_ALPHA < 3) return Place{&alpha.source[pname - GL_SOURCE0_ALPHA], kSources};
  if (pname - GL_OPERAND0_RGB < 3) return Place{&rgb.operand[pname - GL_OPERAND0_RGB], operands};
  if (pname - GL_OPERAND0_ALPHA < 3) return Place{&alpha.operand[pname - GL_OPERAND0_ALPHA], operands.first(2)};
  switch (pname) {
    case GL_TEXTURE_ENV_MODE: return Place{&unit.env_mode, kEnvModes};
    case GL_TEXTURE_ENV_COLOR: return Place{&unit.env_color, {}, ValueKind::color, true};
    case GL_COMBINE_RGB: return Place{&rgb.function, functions};
    case GL_COMBINE_ALPHA: return Place{&alpha.function, functions.first(6)};
    case GL_RGB_SCALE: return Place{&rgb.scale};
    case GL_ALPHA_SCALE: return Place{&alpha.scale};
    default: return std::nullopt;
  }
}

std::optional<Place> generation_place(TextureUnit& unit, GLenum coord, GLenum pname) {
  static constexpr std::array<GLenum, 5> kModes{GL_EYE_LINEAR, GL_OBJECT_LINEAR, GL_NORMAL_MAP, GL_REFLECTION_MAP,
                                                GL_SPHERE_MAP};
  if (coord - GL_S >= 4) return std::nullopt;
  const std::size_t i = coord - GL_S;
  TexGen& gen = unit.gen[i];
  static constexpr std::array<std::size_t, 4> kAllowed{5, 5, 4, 2};
  switch (pname) {
    case GL_TEXTURE_GEN_MODE: return Place{&gen.mode, std::span(kModes).first(kAllowed[i])};
    case GL_OBJECT_PLANE: return Place{&gen.object};
    case GL_EYE_PLANE: return Place{&gen.eye};
    default: return std::nullopt;
  }
}

void tex_parameter(Context& context, GLenum target, GLenum pname, Params params) {
  TextureObject* texture = bound_texture(context, target);
  if (texture != nullptr) set_parameter(context, texture_place(*texture, pname), params, false);
}

void tex_env(Context& context, GLenum target, GLenum pname, Params params) {
  const bool is_scale = target == GL_TEXTURE_ENV && (pname == GL_RGB_SCALE || pname == GL_ALPHA_SCALE);
  if (const double scale = params.value[0]; is_scale && scale != 1 && scale != 2 && scale != 4)
    return context.fail(GL_INVALID_VALUE);
  set_parameter(context, environment_place(active_unit(context), target, pname), params);
}

void tex_gen(Context& context, GLenum coord, GLenum pname, Params params) {
  TextureUnit& unit = active_unit(context);
  if (set_parameter(context, generation_place(unit, coord, pname), params) && pname == GL_EYE_PLANE) {
    Vec4& plane = unit.gen[coord - GL_S].eye;
    plane = transformed_plane(plane, inverse(context.modelview.back()));
  }
}

Values get_tex_env(Context& context, GLenum target, GLenum pname) {
  return parameter(context, environment_place(active_unit(context), target, pname));
}

Values get_tex_gen(Context& context, GLenum coord, GLenum pname) {
  return parameter(context, generation_place(active_unit(context), coord, pname));
}

Values get_tex_parameter(Context& context, GLenum target, GLenum pname) {
  TextureObject* texture = bound_texture(context, target);
  if (texture == nullptr) return {};
  if (pname == GL_TEXTURE_RESIDENT) return {ValueKind::boolean, {1}};
  return parameter(context, texture_place(*texture, pname));
}

}  // namespace halfplane::gl
