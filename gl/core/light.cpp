// Lights, materials and fog as state (OpenGL 1.5, 2.14 and 3.10). Their effect on a vertex: shade.cpp.
#include <limits>
#include <span>

#include "commands.hpp"
#include "matrix.hpp"
#include "shading.hpp"

namespace halfplane::gl {
namespace {

constexpr double kNoBound = std::numeric_limits<double>::max();

/// A parameter that is numbers: its place and its legal values.
template <class Object>
struct Parameter {
  GLenum pname;
  Vec4 Object::*four = nullptr;
  Vec3 Object::*three = nullptr;
  double Object::*one = nullptr;
  ValueKind kind = ValueKind::real;
  double low = -kNoBound, high = kNoBound, also = 0;  ///< bounds, and a value that is allowed beyond them
};

constexpr std::array kLightParameters{
    Parameter<Light>{.pname = GL_AMBIENT, .four = &Light::ambient, .kind = ValueKind::color},
    Parameter<Light>{.pname = GL_DIFFUSE, .four = &Light::diffuse, .kind = ValueKind::color},
    Parameter<Light>{.pname = GL_SPECULAR, .four = &Light::specular, .kind = ValueKind::color},
    Parameter<Light>{.pname = GL_POSITION, .four = &Light::position},
    Parameter<Light>{.pname = GL_SPOT_DIRECTION, .three = &Light::spot_direction},
    Parameter<Light>{.pname = GL_SPOT_EXPONENT, .one = &Light::spot_exponent, .low = 0, .high = 128},
    Parameter<Light>{.pname = GL_SPOT_CUTOFF, .one = &Light::spot_cutoff, .low = 0, .high = 90, .also = 180}};

constexpr std::array kMaterialParameters{
    Parameter<Material>{.pname = GL_AMBIENT, .four = &Material::ambient, .kind = ValueKind::color},
    Parameter<Material>{.pname = GL_DIFFUSE, .four = &Material::diffuse, .kind = ValueKind::color},
    Parameter<Material>{.pname = GL_SPECULAR, .four = &Material::specular, .kind = ValueKind::color},
    Parameter<Material>{.pname = GL_EMISSION, .four = &Material::emission, .kind = ValueKind::color},
    Parameter<Material>{.pname = GL_SHININESS, .one = &Material::shininess, .low = 0, .high = 128},
    Parameter<Material>{.pname = GL_COLOR_INDEXES, .three = &Material::indexes}};

constexpr std::array kFogParameters{
    Parameter<FogState>{.pname = GL_FOG_COLOR, .four = &FogState::color, .kind = ValueKind::color},
    Parameter<FogState>{.pname = GL_FOG_DENSITY, .one = &FogState::density, .low = 0},
    Parameter<FogState>{.pname = GL_FOG_START, .one = &FogState::start},
    Parameter<FogState>{.pname = GL_FOG_END, .one = &FogState::end},
    Parameter<FogState>{.pname = GL_FOG_INDEX, .one = &FogState::index}};

template <class Object>
const Parameter<Object>* find(std::span<const Parameter<Object>> parameters, GLenum pname) {
  const auto found = std::ranges::find(parameters, pname, &Parameter<Object>::pname);
  return found == parameters.end() ? nullptr : &*found;
}

/// Sets a parameter of the table. False: it is none of these, or an error was reported.
template <class Object>
bool set(Context& context, std::span<const Parameter<Object>> parameters, Object& object, GLenum pname,
         const Params& params) {
  const Parameter<Object>* parameter = find(parameters, pname);
  if (parameter == nullptr) {
    context.fail(GL_INVALID_ENUM);
    return false;
  }
  const Vec4& value = params.value;
  if (parameter->four != nullptr) {
    object.*parameter->four = parameter->kind == ValueKind::color ? color_of(params) : value;
  } else if (parameter->three != nullptr) {
    object.*parameter->three = {value[0], value[1], value[2]};
  } else if (!(value[0] >= parameter->low && value[0] <= parameter->high) &&
             !(parameter->also != 0 && value[0] == parameter->also)) {
    context.fail(GL_INVALID_VALUE);
    return false;
  } else {
    object.*parameter->one = value[0];
  }
  return true;
}

template <class Object>
Values get(Context& context, std::span<const Parameter<Object>> parameters, const Object& object, GLenum pname) {
  const Parameter<Object>* parameter = find(parameters, pname);
  if (parameter == nullptr) {
    context.fail(GL_INVALID_ENUM);
    return {};
  }
  const auto values = [&](const auto& numbers) { return Values{parameter->kind, {numbers.begin(), numbers.end()}}; };
  if (parameter->four != nullptr) return values(object.*parameter->four);
  if (parameter->three != nullptr) return values(object.*parameter->three);
  return {parameter->kind, {object.*parameter->one}};
}

/// A value that names something; 0, which is never allowed, for one that is no enumerator.
GLenum enum_of(const Params& params) {
  const double value = params.value[0];
  return value >= 0 && value <= 0xffff ? static_cast<GLenum>(value) : 0;
}

/// Front and back, of which `face` is one or both; false and GL_INVALID_ENUM for an unknown face.
bool faces_of(Context& context, GLenum face, std::array<bool, 2>& faces) {
  faces = {face != GL_BACK, face != GL_FRONT};
  if (face == GL_FRONT || face == GL_BACK || face == GL_FRONT_AND_BACK) return true;
  context.fail(GL_INVALID_ENUM);
  return false;
}

/// The light of `name`; null and GL_INVALID_ENUM for an unknown name.
Light* light_of(Context& context, GLenum name) {
  if (name >= GL_LIGHT0 && name < GL_LIGHT0 + kLights) return &context.state.lighting.light[name - GL_LIGHT0];
  context.fail(GL_INVALID_ENUM);
  return nullptr;
}

/// The coefficient of attenuation that `pname` is; -1: none.
int attenuation_of(GLenum pname) {
  return pname >= GL_CONSTANT_ATTENUATION && pname <= GL_QUADRATIC_ATTENUATION
             ? static_cast<int>(pname - GL_CONSTANT_ATTENUATION)
             : -1;
}

}  // namespace

Vec4 color_of(const Params& params) {
  Vec4 color = params.value;
  if (params.is_integer)
    for (double& value : color) value = (2 * value + 1) / 4294967295.0;
  return color;
}

int param_count(GLenum pname) {
  switch (pname) {
    case GL_AMBIENT:
    case GL_DIFFUSE:
    case GL_SPECULAR:
    case GL_EMISSION:
    case GL_AMBIENT_AND_DIFFUSE:
    case GL_POSITION:
    case GL_LIGHT_MODEL_AMBIENT:
    case GL_FOG_COLOR:
    case GL_TEXTURE_ENV_COLOR:
    case GL_TEXTURE_BORDER_COLOR:
    case GL_OBJECT_PLANE:
    case GL_EYE_PLANE: return 4;
    case GL_SPOT_DIRECTION:
    case GL_COLOR_INDEXES:
    case GL_POINT_DISTANCE_ATTENUATION: return 3;
    default: return 1;
  }
}

void light(Context& context, GLenum name, GLenum pname, Params params) {
  Light* light = light_of(context, name);
  if (light == nullptr) return;
  if (const int i = attenuation_of(pname); i >= 0) {
    if (!(params.value[0] >= 0)) return context.fail(GL_INVALID_VALUE);
    light->attenuation[static_cast<std::size_t>(i)] = params.value[0];
    return;
  }
  if (!set<Light>(context, kLightParameters, *light, pname, params)) return;
  const Mat4& to_eye = context.modelview.back();
  if (pname == GL_POSITION) light->position = transformed(to_eye, light->position);
  if (pname == GL_SPOT_DIRECTION) {
    const Vec3& direction = light->spot_direction;
    const Vec4 eye = transformed(to_eye, {direction[0], direction[1], direction[2], 0});
    light->spot_direction = {eye[0], eye[1], eye[2]};
  }
}

Values get_light(Context& context, GLenum name, GLenum pname) {
  const Light* light = light_of(context, name);
  if (light == nullptr) return {};
  if (const int i = attenuation_of(pname); i >= 0)
    return {ValueKind::real, {light->attenuation[static_cast<std::size_t>(i)]}};
  return get<Light>(context, kLightParameters, *light, pname);
}

void light_model(Context& context, GLenum pname, Params params) {
  LightingState& lighting = context.state.lighting;
  switch (pname) {
    case GL_LIGHT_MODEL_LOCAL_VIEWER: lighting.local_viewer = params.value[0] != 0; return;
    case GL_LIGHT_MODEL_TWO_SIDE: lighting.two_side = params.value[0] != 0; return;
    case GL_LIGHT_MODEL_COLOR_CONTROL:
      return set_enum(context, lighting.color_control, enum_of(params), {GL_SINGLE_COLOR, GL_SEPARATE_SPECULAR_COLOR});
    case GL_LIGHT_MODEL_AMBIENT: lighting.model_ambient = color_of(params); return;
    default: context.fail(GL_INVALID_ENUM);
  }
}

void material(Context& context, GLenum face, GLenum pname, Params params) {
  std::array<bool, 2> faces;
  if (!faces_of(context, face, faces)) return;
  const bool is_both = pname == GL_AMBIENT_AND_DIFFUSE;
  for (std::size_t i = 0; i < 2; ++i) {
    if (!faces[i]) continue;
    Material& material = context.state.lighting.material[i];
    if (!set<Material>(context, kMaterialParameters, material, is_both ? GL_AMBIENT : pname, params)) return;
    if (is_both) material.diffuse = material.ambient;
  }
  forget_lit(context);
  track_color(context);
}

Values get_material(Context& context, GLenum face, GLenum pname) {
  if (face != GL_FRONT && face != GL_BACK) {
    context.fail(GL_INVALID_ENUM);
    return {};
  }
  return get<Material>(context, kMaterialParameters, context.state.lighting.material[face == GL_FRONT ? 0 : 1], pname);
}

void color_material(Context& context, GLenum face, GLenum mode) {
  std::array<bool, 2> faces;
  LightingState& lighting = context.state.lighting;
  GLenum checked = 0;
  set_enum(context, checked, mode, {GL_EMISSION, GL_AMBIENT, GL_DIFFUSE, GL_SPECULAR, GL_AMBIENT_AND_DIFFUSE});
  if (!faces_of(context, face, faces) || checked == 0) return;
  lighting.color_material_face = face;
  lighting.color_material_mode = mode;
  track_color(context);
}

void track_color(Context& context) {
  LightingState& lighting = context.state.lighting;
  if (!lighting.color_material) return;
  forget_lit(context);
  const Vec4& color = context.state.current.color;
  const GLenum face = lighting.color_material_face, mode = lighting.color_material_mode;
  for (std::size_t i = 0; i < 2; ++i) {
    if (face == (i == 0 ? GL_BACK : GL_FRONT)) continue;
    Material& material = lighting.material[i];
    if (mode == GL_AMBIENT || mode == GL_AMBIENT_AND_DIFFUSE) material.ambient = color;
    if (mode == GL_DIFFUSE || mode == GL_AMBIENT_AND_DIFFUSE) material.diffuse = color;
    if (mode == GL_SPECULAR) material.specular = color;
    if (mode == GL_EMISSION) material.emission = color;
  }
}

void fog(Context& context, GLenum pname, Params params) {
  FogState& fog = context.state.fog;
  if (pname == GL_FOG_MODE) return set_enum(context, fog.mode, enum_of(params), {GL_EXP, GL_EXP2, GL_LINEAR});
  if (pname == GL_FOG_COORDINATE_SOURCE)
    return set_enum(context, fog.coord_source, enum_of(params), {GL_FRAGMENT_DEPTH, GL_FOG_COORDINATE});
  set<FogState>(context, kFogParameters, fog, pname, params);
}

}  // namespace halfplane::gl
