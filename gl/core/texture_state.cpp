// Parameters of textures, environments and coordinate generation.
#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <variant>

#include "commands.hpp"
#include "matrix.hpp"
#include "texture.hpp"

namespace halfplane::gl {
namespace {

/// Place of a parameter, and its legal values.
struct Place {
  std::variant<GLenum*, int*, bool*, double*, Vec4*, std::array<int, 4>*> where;
  std::span<const GLenum> allowed{};  ///< of an enum
  ValueKind kind = ValueKind::real;   ///< color: held to 0...1, integers map linearly
};

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

std::optional<Place> texture_place(TextureObject& t, GLenum pname) {
  switch (pname) {
    case GL_TEXTURE_MIN_FILTER: return Place{&t.min_filter, kMinFilters};
    case GL_TEXTURE_MAG_FILTER: return Place{&t.mag_filter, kMagFilters};
    case GL_TEXTURE_WRAP_S: return Place{&t.wrap[0], kWraps};
    case GL_TEXTURE_WRAP_T: return Place{&t.wrap[1], kWraps};
    case GL_TEXTURE_WRAP_R: return Place{&t.wrap[2], kWraps};
    case GL_TEXTURE_BORDER_COLOR: return Place{&t.border_color, {}, ValueKind::color};
    case GL_TEXTURE_PRIORITY: return Place{&t.priority, {}, ValueKind::color};
    case GL_TEXTURE_MIN_LOD: return Place{&t.min_lod};
    case GL_TEXTURE_MAX_LOD: return Place{&t.max_lod};
    case GL_TEXTURE_LOD_BIAS: return Place{&t.lod_bias};
    case GL_TEXTURE_BASE_LEVEL: return Place{&t.base_level};
    case GL_TEXTURE_MAX_LEVEL: return Place{&t.max_level};
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
    case GL_TEXTURE_ENV_COLOR: return Place{&unit.env_color, {}, ValueKind::color};
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

TextureUnit& active_unit(Context& context) {
  return context.state.texture.unit[static_cast<std::size_t>(context.state.texture.active)];
}

/// Sets a parameter, or reports the error. Whether it was set. `takes_scalars`: also vectors, whose rest is then 0.
bool set(Context& context, const std::optional<Place>& place, const Params& params, bool takes_scalars) {
  const auto refuse = [&context](GLenum error) {
    context.fail(error);
    return false;
  };
  if (!place) return refuse(GL_INVALID_ENUM);
  const Vec4 value = place->kind == ValueKind::color ? color_of(params) : params.value;
  const auto in_range = [&place](double v) { return place->kind == ValueKind::color ? held(v) : v; };
  if (GLenum* const* where = std::get_if<GLenum*>(&place->where)) {
    const auto found = std::ranges::find_if(place->allowed, [&value](GLenum allowed) { return value[0] == allowed; });
    if (found == place->allowed.end()) return refuse(GL_INVALID_ENUM);
    **where = *found;
  } else if (int* const* number = std::get_if<int*>(&place->where)) {
    if (!(value[0] >= 0)) return refuse(GL_INVALID_VALUE);
    **number = static_cast<int>(std::min(value[0] + 0.5, 2147483647.0));
  } else if (bool* const* flag = std::get_if<bool*>(&place->where)) {
    **flag = value[0] != 0;
  } else if (double* const* real = std::get_if<double*>(&place->where)) {
    **real = in_range(value[0]);
  } else if (!params.is_vector && !takes_scalars) {
    return refuse(GL_INVALID_ENUM);
  } else if (Vec4* const* vector = std::get_if<Vec4*>(&place->where)) {
    std::ranges::transform(value, (*vector)->begin(), in_range);
  } else {
    std::ranges::transform(value, std::get<std::array<int, 4>*>(place->where)->begin(), [](double v) {
      return v > -2147483648.0 ? static_cast<int>(std::min(v, 2147483647.0)) : 0;
    });
  }
  return true;
}

Values get(Context& context, const std::optional<Place>& place) {
  if (!place) {
    context.fail(GL_INVALID_ENUM);
    return {};
  }
  if (GLenum* const* where = std::get_if<GLenum*>(&place->where))
    return {ValueKind::integer, {static_cast<double>(**where)}};
  if (int* const* number = std::get_if<int*>(&place->where))
    return {ValueKind::integer, {static_cast<double>(**number)}};
  if (bool* const* flag = std::get_if<bool*>(&place->where)) return {ValueKind::boolean, {**flag ? 1.0 : 0.0}};
  if (double* const* real = std::get_if<double*>(&place->where)) return {place->kind, {**real}};
  if (Vec4* const* vector = std::get_if<Vec4*>(&place->where))
    return {place->kind, {(*vector)->begin(), (*vector)->end()}};
  const auto& integers = *std::get<std::array<int, 4>*>(place->where);
  return {ValueKind::integer, {integers.begin(), integers.end()}};
}

}  // namespace

void tex_parameter(Context& context, GLenum target, GLenum pname, Params params) {
  TextureObject* texture = bound_texture(context, target);
  if (texture != nullptr) set(context, texture_place(*texture, pname), params, false);
}

void tex_env(Context& context, GLenum target, GLenum pname, Params params) {
  const bool is_scale = target == GL_TEXTURE_ENV && (pname == GL_RGB_SCALE || pname == GL_ALPHA_SCALE);
  if (const double scale = params.value[0]; is_scale && scale != 1 && scale != 2 && scale != 4)
    return context.fail(GL_INVALID_VALUE);
  set(context, environment_place(active_unit(context), target, pname), params, true);
}

void tex_gen(Context& context, GLenum coord, GLenum pname, Params params) {
  TextureUnit& unit = active_unit(context);
  if (set(context, generation_place(unit, coord, pname), params, true) && pname == GL_EYE_PLANE) {
    Vec4& plane = unit.gen[coord - GL_S].eye;
    plane = transformed_plane(plane, inverse(context.modelview.back()));
  }
}

Values get_tex_env(Context& context, GLenum target, GLenum pname) {
  return get(context, environment_place(active_unit(context), target, pname));
}

Values get_tex_gen(Context& context, GLenum coord, GLenum pname) {
  return get(context, generation_place(active_unit(context), coord, pname));
}

Values get_tex_parameter(Context& context, GLenum target, GLenum pname) {
  TextureObject* texture = bound_texture(context, target);
  if (texture == nullptr) return {};
  if (pname == GL_TEXTURE_RESIDENT) return {ValueKind::boolean, {1}};
  return get(context, texture_place(*texture, pname));
}

}  // namespace halfplane::gl
