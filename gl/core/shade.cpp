// Transformation, lighting, texture coordinates and fog of one vertex (OpenGL 1.5, 2.11 to 2.14, 3.3, 3.10).
#include "shade.hpp"

#include <cmath>
#include <numbers>
#include <numeric>

#include "matrix.hpp"
#include "shading.hpp"

namespace halfplane::gl {
namespace {

constexpr double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
constexpr Vec3 scaled(const Vec3& a, double factor) { return {a[0] * factor, a[1] * factor, a[2] * factor}; }
constexpr Vec3 sum(const Vec3& a, const Vec3& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
constexpr Vec3 difference(const Vec3& a, const Vec3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
constexpr Vec3 xyz(const Vec4& v) { return {v[0], v[1], v[2]}; }
/// Zero stays zero.
Vec3 unit(const Vec3& a) {
  const double square = dot(a, a);
  return square > 0 ? scaled(a, 1 / std::sqrt(square)) : a;
}
/// The point of homogeneous coordinates; the direction of one at infinity.
constexpr Vec3 point_of(const Vec4& v) {
  return v[3] == 1 || v[3] == 0 ? xyz(v) : Vec3{v[0] / v[3], v[1] / v[3], v[2] / v[3]};
}

constexpr Vec3 kTowardsViewer{0, 0, 1};  // for a viewer at infinity

/// base^exponent for an exponent of at most 128, most often an integer: by squaring.
double power(double base, double exponent) {
  const auto whole = static_cast<unsigned>(exponent);
  if (whole != exponent) return std::pow(base, exponent);
  double result = 1;
  for (unsigned bits = whole; bits != 0; bits >>= 1, base *= base)
    if ((bits & 1) != 0) result *= base;
  return result;
}

LightConstants constants_of(const Light& light) {
  LightConstants constants{
      .ambient = xyz(light.ambient), .diffuse = xyz(light.diffuse), .specular = xyz(light.specular)};
  constants.is_positional = light.position[3] != 0;
  constants.position = constants.is_positional ? point_of(light.position) : unit(xyz(light.position));
  constants.half = unit(sum(constants.position, kTowardsViewer));
  constants.is_spot = light.spot_cutoff != 180;
  constants.spot_direction = unit(light.spot_direction);
  constants.spot_cosine = std::cos(light.spot_cutoff * std::numbers::pi / 180);
  constants.spot_exponent = light.spot_exponent;
  constants.attenuation = light.attenuation;
  constants.is_attenuated = constants.is_positional && light.attenuation != Vec3{1, 0, 0};
  return constants;
}

/// How much of a light arrives at a side of a surface, before its material.
struct Arrived {
  Vec3 diffuse{}, specular{};
};

/// The colours of a vertex (OpenGL 1.5, 2.14.1). `normal` in eye space.
void light_vertex(const Context& context, const Vec3& normal, ShadedVertex& vertex) {
  ShadingConstants& constants = *context.shading;
  ShadingConstants::Lit& lit = constants.lit;
  if (lit.is_known && lit.normal == normal) {
    vertex.color = lit.color;
    vertex.secondary = lit.secondary;
    return;
  }
  const LightingState& state = context.state.lighting;
  const std::size_t sides = state.two_side ? 2 : 1;
  const Vec3 eye = point_of(vertex.eye);
  const bool is_far = vertex.eye[3] == 0;  // a direction
  const Vec3 to_viewer = state.local_viewer ? unit(scaled(eye, -1)) : kTowardsViewer;
  Vec3 ambient = constants.scene_ambient;
  std::array<Arrived, 2> arrived{};
  for (const LightConstants& light : constants.lights) {
    Vec3 to_light = light.position;
    double strength = 1;
    if (light.is_positional) {
      to_light = is_far ? scaled(eye, -1) : difference(light.position, eye);
      const double distance = std::sqrt(dot(to_light, to_light));
      if (distance > 0) to_light = scaled(to_light, 1 / distance);
      if (light.is_attenuated) {
        const Vec3& k = light.attenuation;
        strength = 1 / (k[0] + distance * (k[1] + distance * k[2]));
      }
    }
    if (light.is_spot) {
      const double cosine = -dot(to_light, light.spot_direction);
      if (!(cosine >= light.spot_cosine)) continue;
      strength *= power(std::max(cosine, 0.0), light.spot_exponent);
    }
    ambient = sum(ambient, scaled(light.ambient, strength));
    const double front = dot(normal, to_light);
    const std::size_t side = front > 0 ? 0 : 1;
    if (side >= sides || front == 0) continue;
    const double sign = side == 0 ? 1 : -1;
    arrived[side].diffuse = sum(arrived[side].diffuse, scaled(light.diffuse, strength * sign * front));
    const Material& material = state.material[side];
    if (material.specular[0] == 0 && material.specular[1] == 0 && material.specular[2] == 0) continue;
    const Vec3 half = state.local_viewer || light.is_positional ? unit(sum(to_light, to_viewer)) : light.half;
    const double shine = power(std::max(sign * dot(normal, half), 0.0), material.shininess);
    arrived[side].specular = sum(arrived[side].specular, scaled(light.specular, strength * shine));
  }
  const bool separate = state.color_control == GL_SEPARATE_SPECULAR_COLOR;
  // Number by number to all places: a copy would load pairs of numbers that were stored one by one, and stall.
  const auto put = [&](std::size_t side, std::size_t i, double color, double secondary) {
    for (std::size_t to = side; to < (sides == 1 ? 2 : side + 1); ++to) {
      vertex.color[to][i] = lit.color[to][i] = color;
      vertex.secondary[to][i] = lit.secondary[to][i] = secondary;
    }
  };
  for (std::size_t side = 0; side < sides; ++side) {
    const Material& material = state.material[side];
    for (std::size_t i = 0; i < 3; ++i) {
      const double shine = material.specular[i] * arrived[side].specular[i];
      const double color = material.emission[i] + material.ambient[i] * ambient[i] +
                           material.diffuse[i] * arrived[side].diffuse[i] + (separate ? 0 : shine);
      put(side, i, held(color), separate ? held(shine) : 0);
    }
    put(side, 3, held(material.diffuse[3]), 0);
  }
  lit.is_known = constants.depends_on_normal_alone;
  lit.normal = normal;
}

/// Coordinates as glTexGen makes them (OpenGL 1.5, 2.11.4).
Vec4 generated(const TextureUnit& unit_state, const Vec4& given, const Vec4& object, const Vec4& eye,
               const Vec3& normal) {
  const Vec3 to_vertex = unit(point_of(eye));
  const Vec3 reflection = difference(to_vertex, scaled(normal, 2 * dot(normal, to_vertex)));
  const double sphere = 2 * std::sqrt(dot(reflection, reflection) + 2 * reflection[2] + 1);
  const auto product4 = [](const Vec4& a, const Vec4& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
  };
  Vec4 result = given;
  for (std::size_t i = 0; i < 4; ++i) {
    const TexGen& gen = unit_state.gen[i];
    if (!gen.enabled) continue;
    switch (gen.mode) {
      case GL_OBJECT_LINEAR: result[i] = product4(gen.object, object); break;
      case GL_EYE_LINEAR: result[i] = product4(gen.eye, eye); break;
      case GL_SPHERE_MAP: result[i] = sphere > 0 && i < 2 ? reflection[i] / sphere + 0.5 : 0.5; break;
      case GL_NORMAL_MAP: result[i] = i < 3 ? normal[i] : 0; break;
      default: result[i] = i < 3 ? reflection[i] : 0;
    }
  }
  return result;
}

template <class Attributes>
void shade_vertex(const Context& context, const Vec4& position, const Attributes& given, ShadedVertex& vertex,
                  bool all_textures) {
  const ShadingConstants& constants = *context.shading;
  const State& state = context.state;
  vertex.eye = transformed(context.modelview.back(), position);
  vertex.clip = transformed(constants.to_clip, position);
  vertex.edge_flag = given.edge_flag;
  vertex.fog_distance = state.fog.coord_source == GL_FOG_COORDINATE
                            ? given.fog_coord
                            : std::abs(vertex.eye[3] == 1 ? vertex.eye[2] : point_of(vertex.eye)[2]);

  Vec3 normal{};
  if (constants.needs_normal || all_textures) {
    for (std::size_t i = 0; i < 3; ++i) normal[i] = dot(given.normal, constants.normal_rows[i]);
    if (state.transform.normalize) normal = unit(normal);
  }
  if (state.lighting.enabled) {
    light_vertex(context, normal, vertex);
  } else {
    vertex.color[0] = vertex.color[1] = held_color(given.color);
    Vec4 secondary{};
    if (state.fog.color_sum)
      for (std::size_t i = 0; i < 3; ++i) secondary[i] = held(given.secondary[i]);
    vertex.secondary[0] = vertex.secondary[1] = secondary;
  }

  for (std::size_t i = 0; i < kTextureUnits; ++i) {
    Vec4& coordinates = vertex.tex_coord[i];
    coordinates = given.tex_coord[i];
    if (!constants.has_texture[i] && !all_textures) continue;
    if (constants.has_texgen[i])
      coordinates = generated(state.texture.unit[i], coordinates, position, vertex.eye, normal);
    if (constants.has_texture_matrix[i]) coordinates = transformed(context.texture_matrix[i].back(), coordinates);
  }

  const PointState& point = state.point;
  double size = point.size;
  if (constants.is_attenuated) {
    const Vec3 eye = point_of(vertex.eye);
    const double distance = std::sqrt(dot(eye, eye));
    const Vec3& k = point.attenuation;
    size /= std::sqrt(k[0] + distance * (k[1] + distance * k[2]));
  }
  vertex.point_size = size > point.least ? std::min(size, point.largest) : point.least;
}

}  // namespace

void ShadingConstantsDeleter::operator()(ShadingConstants* constants) const { delete constants; }

void update_shading(Context& context) {
  if (!context.shading) context.shading.reset(new ShadingConstants);
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
  constants.depends_on_normal_alone =
      !state.lighting.local_viewer && std::ranges::none_of(constants.lights, &LightConstants::is_positional);
  constants.lit.is_known = false;
  constants.is_attenuated = state.point.attenuation != Vec3{1, 0, 0};
}

void shade_current(const Context& context, const Vec4& position, ShadedVertex& vertex, bool all_textures) {
  shade_vertex(context, position, context.state.current, vertex, all_textures);
}

ShadedVertex shade(Context& context, const InputVertex& vertex) {
  update_shading(context);
  ShadedVertex shaded;
  shade_vertex(context, vertex.position, vertex, shaded, false);
  return shaded;
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
