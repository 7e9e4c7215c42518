// Lights, materials and fog as state (OpenGL 1.5, 2.14 and 3.10). Their effect on a vertex: shade.cpp.
#include "matrix.hpp"
#include "parameter.hpp"
#include "shading.hpp"

namespace halfplane::gl {
namespace {

Place color_place(Vec4& color) { return {&color, {}, ValueKind::color}; }

/// Front and back, of which `face` is one or both; false and GL_INVALID_ENUM for an unknown face.
bool faces_of(Context& context, GLenum face, std::array<bool, 2>& faces) {
  faces = {face != GL_BACK, face != GL_FRONT};
  if (face == GL_FRONT || face == GL_BACK || face == GL_FRONT_AND_BACK) return true;
  return context.fail(GL_INVALID_ENUM), false;
}

/// The light of `name`; null and GL_INVALID_ENUM for an unknown name.
Light* light_of(Context& context, GLenum name) {
  if (name >= GL_LIGHT0 && name < GL_LIGHT0 + kLights) return &context.state.lighting.light[name - GL_LIGHT0];
  return context.fail(GL_INVALID_ENUM), nullptr;
}

}  // namespace

std::optional<Place> light_place(Light& light, GLenum pname) {
  if (pname - GL_CONSTANT_ATTENUATION < 3)
    return Place{.where = &light.attenuation[pname - GL_CONSTANT_ATTENUATION], .low = 0};
  switch (pname) {
    case GL_AMBIENT: return color_place(light.ambient);
    case GL_DIFFUSE: return color_place(light.diffuse);
    case GL_SPECULAR: return color_place(light.specular);
    case GL_POSITION: return Place{&light.position};
    case GL_SPOT_DIRECTION: return Place{&light.spot_direction};
    case GL_SPOT_EXPONENT: return Place{.where = &light.spot_exponent, .low = 0, .high = 128};
    case GL_SPOT_CUTOFF: return Place{.where = &light.spot_cutoff, .low = 0, .high = 90, .also = 180};
    default: return std::nullopt;
  }
}

std::optional<Place> material_place(Material& material, GLenum pname) {
  switch (pname) {
    case GL_AMBIENT:
    case GL_AMBIENT_AND_DIFFUSE: return color_place(material.ambient);
    case GL_DIFFUSE: return color_place(material.diffuse);
    case GL_SPECULAR: return color_place(material.specular);
    case GL_EMISSION: return color_place(material.emission);
    case GL_SHININESS: return Place{.where = &material.shininess, .low = 0, .high = 128};
    case GL_COLOR_INDEXES: return Place{&material.indexes};
    default: return std::nullopt;
  }
}

Vec4 color_of(const Params& params) {
  Vec4 color = params.value;
  if (params.is_integer)
    for (double& value : color) value = (2 * value + 1) / 4294967295.0;
  return color;
}

void light(Context& context, GLenum name, GLenum pname, Params params) {
  Light* light = light_of(context, name);
  if (light == nullptr || !set_parameter(context, light_place(*light, pname), params)) return;
  const Mat4& to_eye = context.modelview.back();
  if (pname == GL_POSITION) light->position = transformed(to_eye, light->position);
  if (pname == GL_SPOT_DIRECTION) {
    const Vec3& direction = light->spot_direction;
    const Vec4 eye = transformed(to_eye, {direction[0], direction[1], direction[2], 0});
    light->spot_direction = {eye[0], eye[1], eye[2]};
  }
}

Values get_light(Context& context, GLenum name, GLenum pname) {
  Light* light = light_of(context, name);
  return light == nullptr ? Values{} : parameter(context, light_place(*light, pname));
}

std::optional<Place> light_model_place(LightingState& lighting, GLenum pname) {
  static constexpr std::array<GLenum, 2> kControls{GL_SINGLE_COLOR, GL_SEPARATE_SPECULAR_COLOR};
  switch (pname) {
    case GL_LIGHT_MODEL_LOCAL_VIEWER: return Place{&lighting.local_viewer};
    case GL_LIGHT_MODEL_TWO_SIDE: return Place{&lighting.two_side};
    case GL_LIGHT_MODEL_COLOR_CONTROL: return Place{&lighting.color_control, kControls};
    case GL_LIGHT_MODEL_AMBIENT: return color_place(lighting.model_ambient);
    default: return std::nullopt;
  }
}

void light_model(Context& context, GLenum pname, Params params) {
  set_parameter(context, light_model_place(context.state.lighting, pname), params);
}

void material(Context& context, GLenum face, GLenum pname, Params params) {
  std::array<bool, 2> faces;
  if (!faces_of(context, face, faces)) return;
  if (context.inside_begin()) shade_pending(context);
  for (std::size_t i = 0; i < 2; ++i) {
    if (!faces[i]) continue;
    Material& material = context.state.lighting.material[i];
    if (!set_parameter(context, material_place(material, pname), params)) return;
    if (pname == GL_AMBIENT_AND_DIFFUSE) material.diffuse = material.ambient;
  }
  track_color(context);
}

Values get_material(Context& context, GLenum face, GLenum pname) {
  if ((face != GL_FRONT && face != GL_BACK) || pname == GL_AMBIENT_AND_DIFFUSE)
    return context.fail(GL_INVALID_ENUM), Values{};
  return parameter(context, material_place(context.state.lighting.material[face == GL_FRONT ? 0 : 1], pname));
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

std::optional<Place> fog_place(FogState& fog, GLenum pname) {
  static constexpr std::array<GLenum, 3> kModes{GL_EXP, GL_EXP2, GL_LINEAR};
  static constexpr std::array<GLenum, 2> kSources{GL_FRAGMENT_DEPTH, GL_FOG_COORDINATE};
  const auto number = [](double& where, double low) { return Place{.where = &where, .low = low, .high = kFinite}; };
  switch (pname) {
    case GL_FOG_MODE: return Place{&fog.mode, kModes};
    case GL_FOG_COORDINATE_SOURCE: return Place{&fog.coord_source, kSources};
    case GL_FOG_COLOR: return color_place(fog.color);
    case GL_FOG_DENSITY: return number(fog.density, 0);
    case GL_FOG_START: return number(fog.start, -kFinite);
    case GL_FOG_END: return number(fog.end, -kFinite);
    case GL_FOG_INDEX: return number(fog.index, -kFinite);
    default: return std::nullopt;
  }
}

void fog(Context& context, GLenum pname, Params params) {
  set_parameter(context, fog_place(context.state.fog, pname), params);
}

}  // namespace halfplane::gl
