#include "sim/scene/mesh_light.hpp"

#include <algorithm>
#include <cmath>

#include "model/golden/light.hpp"
#include "sim/scene/option_parts.hpp"

namespace halfplane {
namespace {

// --- the light at the eye ---------------------------------------------------------------------------------------------

constexpr double kHeaderAmbient = 0.18;  // brightness of a face seen edge-on
constexpr double kWrap = 0.25;           // light beyond the terminator, so that the dark side keeps its shape

// 0...1 for a unit normal (or none) in eye space and the direction to the light.
double brightness(const Vec3& normal, const Vec3& to_light) {
  if (normal == Vec3{}) return 1;
  const double facing = std::min(std::abs(dot(normal, to_light)), 1.0);  // two-sided
  return kHeaderAmbient + (1 - kHeaderAmbient) * (facing + kWrap) / (1 + kWrap);
}

// --- lights ----------------------------------------------------------------------------------------------------------

/// Default ambient light: OpenGL's for display codes; for linear colours the value that looks equally dark.
constexpr double kAmbientOfCodes = 0.2, kLinearAmbient = 0.03;

constexpr OptionParts kLightParts{"--light",
                                  "write for example --light 'from=1,2,3;color=1,0.9,0.8', --light eye or --light off"};

Vec3 turned(const Mat4& view, const Vec3& v) {
  const Vec4 eye = transform(view, {v[0], v[1], v[2], 0});
  return {eye[0], eye[1], eye[2]};
}

/// A light of the world in eye space.
Light in_eye_space(Light light, const Mat4& view) {
  const auto& p = light.position;
  light.position = transform(view, {p[0], p[1], p[2], p[3]});
  light.spot_direction = turned(view, light.spot_direction);
  return light;
}

/// All lights, in eye space.
Lighting lighting_of(const Mesh& mesh, const LightRequest& request, const Mat4& view, bool is_ortho) {
  Lighting lighting;
  const double ambient = mesh.is_linear ? kLinearAmbient : kAmbientOfCodes;
  lighting.ambient = request.ambient.value_or(Vec3{ambient, ambient, ambient});
  lighting.has_local_viewer = !is_ortho;
  for (const Light& light : request.is_given() ? request.lights : mesh.lights)
    lighting.lights.push_back(in_eye_space(light, view));
  for (Light light : request.at_eye) {
    light.position = is_ortho ? Vec4{0, 0, 1, 0} : Vec4{0, 0, 0, 1};
    lighting.lights.push_back(light);
  }
  return lighting;
}

/// The material at a vertex: its colour is the diffuse one.
Material material_at(const MeshVertex& vertex, const Mesh& mesh) {
  const MeshMaterial& of = mesh.materials[vertex.material];
  Material material;
  for (std::size_t c = 0; c < 3; ++c) {
    const double color = mesh.is_linear ? linear_component(vertex.rgba[c]) : std::clamp(vertex.rgba[c] / 255, 0.0, 1.0);
    material.diffuse[c] = of.diffuse * color;
    material.ambient[c] = of.ambient ? (*of.ambient)[c] : color;
    material.specular[c] = std::min(of.specular[c] + of.mirrored * color, 1.0);
  }
  material.emission = of.emission;
  material.shininess = of.shininess;
  return material;
}

void scale_colors(Light& light, double factor) {
  for (auto* color : {&light.ambient, &light.diffuse, &light.specular})
    for (double& c : *color) c *= factor;
}

/// Scales a light with a place for integer arithmetic: its intensity at the vertices is at most 1, for any unit of
/// length; a light at more than 2^14 times the mesh's size becomes infinitely distant.
void fit_to_places(Light& light, const std::vector<Vec3>& places, const Vec3& middle, double reach) {
  Light unbounded = light;  // no range, no cone: only the divisor
  unbounded.range = unbounded.spot_scale = 0;
  const Vec3 at{light.position[0], light.position[1], light.position[2]};
  if (length(subtract(at, middle)) > 0x1p14 * reach) {
    const golden::LightAt from = golden::light_at(light, middle);
    light.position = {from.direction[0], from.direction[1], from.direction[2], 0};
    return scale_colors(light, from.strength);
  }
  double strongest = 0;
  for (const Vec3& place : places) {
    const double strength = golden::light_at(unbounded, place).strength;
    if (std::isfinite(strength)) strongest = std::max(strongest, strength);
  }
  if (strongest == 0) return;
  for (double& a : light.attenuation) a *= strongest;
  scale_colors(light, strongest);
}

void light_vertices(const Mesh& mesh, const LightRequest& request, const Mat4& view, bool is_ortho,
                    std::vector<std::array<double, 4>>& colors) {
  std::vector<Vec3> places;  // in eye space
  for (const MeshVertex& vertex : mesh.vertices) {
    const Vec4 p = transform(view, {vertex.position[0], vertex.position[1], vertex.position[2], 1});
    places.push_back({p[0], p[1], p[2]});
  }
  Vec3 low = places.front(), high = low;
  double extent = 1e-30;  // bound on coordinates of places and lights
  const auto add_extent = [&extent](double x) { extent = std::max(extent, std::abs(x)); };
  for (const Vec3& place : places)
    for (std::size_t i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], place[i]);
      high[i] = std::max(high[i], place[i]);
      add_extent(place[i]);
    }
  Lighting lighting = lighting_of(mesh, request, view, is_ortho);
  for (Light& light : lighting.lights) {
    if (light.position[3] == 0) continue;
    fit_to_places(light, places, scaled(add(low, high), 0.5), std::max(length(subtract(high, low)), 1e-30));
    for (std::size_t i = 0; i < 3 && light.position[3] != 0; ++i) add_extent(light.position[i]);
  }
  const FixedLighting fixed(lighting, extent);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const MeshVertex& vertex = mesh.vertices[i];
    if (vertex.normal == Vec3{}) continue;
    Vec3 normal = turned(view, vertex.normal);
    const Vec3 to_eye = is_ortho ? Vec3{0, 0, 1} : scaled(places[i], -1);
    if (mesh.materials[vertex.material].is_two_sided && dot(normal, to_eye) < 0) normal = scaled(normal, -1);
    const auto lit = fixed.color(fixed.place(places[i]), fixed_direction(normal), material_at(vertex, mesh));
    for (std::size_t c = 0; c < 3; ++c) {
      const double code = lit[c] / 256.0;
      colors[i][c] = mesh.is_linear ? display_code(code / 255) : code;
    }
  }
}

void light_from_the_eye(const Mesh& mesh, const Mat4& view, bool is_ortho, std::vector<std::array<double, 4>>& colors) {
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const MeshVertex& vertex = mesh.vertices[i];
    if (!mesh.materials[vertex.material].has_header_light) continue;
    const Vec4 eye = transform(view, {vertex.position[0], vertex.position[1], vertex.position[2], 1});
    const Vec3 to_light = is_ortho ? Vec3{0, 0, 1} : normalized({-eye[0], -eye[1], -eye[2]});
    const double light = brightness(turned(view, vertex.normal), to_light);
    for (std::size_t c = 0; c < 3; ++c) colors[i][c] *= light;
  }
}

void read_part(std::string_view key, std::string_view value, Light& light) {
  const bool is_somewhere = light.position[3] != 0;
  if (key == "color") {
    const Vec3 color = kLightParts.vector(key, value);
    if (std::ranges::any_of(color, [](double c) { return c < 0 || c > 1e6; }))
      kLightParts.fail("color=" + printable(value) + " is not of 0 to 1e6", "1,1,1 is full white");
    light.diffuse = light.specular = color;
  } else if (key == "range" && is_somewhere) {
    light.range = kLightParts.positive(key, value);
  } else if (key == "attenuation" && is_somewhere) {
    light.attenuation = kLightParts.vector(key, value);
    const bool is_none = light.attenuation == std::array<double, 3>{};
    if (is_none || std::ranges::any_of(light.attenuation, [](double a) { return a < 0; }))
      kLightParts.fail("attenuation=" + printable(value) + " divides by 0 or less", "write attenuation=1,0,0 for none");
  } else {
    kLightParts.fail(
        in_quotes(key) + " is no part of this light",
        is_somewhere ? "the parts are color=R,G,B, range=R and attenuation=C,L,Q" : "it has color=R,G,B alone");
  }
}

/// The first part of a light, KEY=VALUE or KEY alone, then the rest.
void read_light(std::string_view text, LightRequest& request) {
  const std::string_view first = OptionParts::cut(text, ';');
  const std::size_t equals = std::min(first.find('='), first.size());
  const std::string_view key = OptionParts::trimmed(first.substr(0, equals));
  const std::string_view value = OptionParts::trimmed(first.substr(std::min(equals + 1, first.size())));
  Light light;
  std::vector<Light>* list = nullptr;
  if (first == "phong") {
    request.is_phong = true;
  } else if (first == "off") {
    request.is_off = true;
  } else if (first == "eye") {
    list = &request.at_eye;
  } else if (key == "ambient" && equals < first.size()) {
    request.ambient = kLightParts.vector(key, value);
    if (std::ranges::any_of(*request.ambient, [](double c) { return c < 0 || c > 1; }))
      kLightParts.fail("ambient=" + printable(value) + " is not of 0 to 1", "0.2,0.2,0.2 is usual");
  } else if ((key == "from" || key == "at") && equals < first.size()) {
    const Vec3 v = kLightParts.vector(key, value);
    if (key == "from" && length(v) == 0) kLightParts.fail("from=0,0,0 has no direction", "write from=0,1,0 for above");
    const Vec3 p = key == "from" ? normalized(v) : v;
    light.position = {p[0], p[1], p[2], key == "at" ? 1.0 : 0.0};
    list = &request.lights;
  } else {
    kLightParts.fail("unknown light " + in_quotes(first), kLightParts.example);
  }
  while (!text.empty()) {
    const std::string_view part = OptionParts::cut(text, ';');
    if (part.empty()) continue;
    const std::size_t at = part.find('=');
    if (list == nullptr)
      kLightParts.fail(in_quotes(part) + " behind " + printable(key), "leave it out, or say --light again");
    if (at == std::string_view::npos) kLightParts.fail("no = in " + in_quotes(part), "write for example color=1,1,1");
    read_part(OptionParts::trimmed(part.substr(0, at)), OptionParts::trimmed(part.substr(at + 1)), light);
  }
  if (list != nullptr) list->push_back(light);
}

}  // namespace

LightRequest parse_lights(std::span<const std::string> texts) {
  LightRequest request;
  for (const std::string& text : texts) read_light(text, request);
  if (request.is_off && texts.size() > 1) kLightParts.fail("off beside other lights", "leave one of them out");
  return request;
}

std::vector<std::array<double, 4>> lit_colors(const Mesh& mesh, const LightRequest& request, const Mat4& view,
                                              bool is_ortho) {
  std::vector<std::array<double, 4>> colors;
  colors.reserve(mesh.vertices.size());
  for (const MeshVertex& vertex : mesh.vertices) colors.push_back(vertex.rgba);
  if (request.is_off || request.is_phong) return colors;
  if (mesh.vertices.empty()) return colors;
  if (request.is_given() || !mesh.lights.empty())
    light_vertices(mesh, request, view, is_ortho, colors);
  else if (mesh.lit)
    light_from_the_eye(mesh, view, is_ortho, colors);
  return colors;
}

State phong_state(State state, const Mesh& mesh, const MeshMaterial& material, const LightRequest& request,
                  const Mat4& view) {
  constexpr Vec3 kToEye{0, 0, 1};
  const bool is_asked_for = !request.lights.empty() || !request.at_eye.empty();
  const std::vector<Light>& lights = is_asked_for ? request.lights : mesh.lights;
  const std::size_t count = lights.size() + request.at_eye.size();
  if (count > 1 || (!lights.empty() && lights[0].position[3] != 0))
    kLightParts.fail("phong has one light from infinitely far, and " +
                         (count > 1 ? "there are " + std::to_string(count) : "this one has a place"),
                     "write for example --light phong --light from=1,2,3, or --light phong alone for one from the eye");
  const Light light = !lights.empty()           ? in_eye_space(lights[0], view)
                      : !request.at_eye.empty() ? request.at_eye[0]
                                                : Light{};
  const Vec3 direction =
      lights.empty() ? kToEye : normalized({light.position[0], light.position[1], light.position[2]});
  const auto code = [](double part) {
    return static_cast<std::uint8_t>(std::floor(255 * std::clamp(part, 0.0, 1.0) + 0.5));
  };
  state.shade = Shade::phong;
  state.light_direction = direction;
  state.light_half = normalized(add(direction, kToEye));
  state.light_shininess = std::clamp(material.shininess, 1.0, 128.0);
  for (std::size_t c = 0; c < 3; ++c) {
    state.light_ambient[c] = code(request.ambient ? (*request.ambient)[c] : kAmbientOfCodes);
    state.light_diffuse[c] = code(light.diffuse[c] * material.diffuse);
    state.light_specular[c] = code(light.specular[c] * (material.specular[c] + material.mirrored));
  }
  return state;
}

double exposure_of(const Mesh& mesh) {
  std::vector<double> brightest;  // brightness of a white surface at each vertex
  for (const MeshVertex& vertex : mesh.vertices) {
    if (vertex.normal == Vec3{}) continue;
    Vec3 sum{};
    for (const Light& light : mesh.lights) {
      const golden::LightAt at = golden::light_at(light, vertex.position);
      const double facing = std::max(0.0, dot(vertex.normal, at.direction)) * at.strength;
      if (std::isfinite(facing)) sum = add(sum, scaled(light.diffuse, facing));
    }
    brightest.push_back(*std::ranges::max_element(sum));
  }
  if (brightest.empty()) return 1;
  const auto at = brightest.begin() + static_cast<std::ptrdiff_t>(brightest.size() - 1 - brightest.size() / 20);
  std::ranges::nth_element(brightest, at);
  const double found = *at > 0 ? *at : *std::ranges::max_element(brightest);
  return found > 0 ? 1 / found : 1;
}

double linear_component(double code) {
  const double v = std::clamp(code / 255, 0.0, 1.0);
  return v <= 12.92 * 0.0031308 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

double display_code(double linear) {
  if (!(linear > 0)) return 0;
  if (linear >= 1) return 255;  // the curve's own end is off by one unit in the last place
  return 255 * (linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055);
}

}  // namespace halfplane
