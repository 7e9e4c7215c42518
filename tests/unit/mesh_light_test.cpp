// Light on meshes: --light, glTF's punctual lights, materials of both formats; against the golden's arithmetic.
#include "sim/scene/mesh_light.hpp"

#include <gtest/gtest.h>

#include "../gltf_builder.hpp"
#include "model/config.hpp"
#include "model/golden/light.hpp"
#include "sim/scene/gltf.hpp"
#include "sim/scene/gltf_materials.hpp"
#include "sim/scene/mesh_scene.hpp"
#include "sim/scene/obj.hpp"
#include "sim/scene/random.hpp"

namespace halfplane::mesh_light_test {
namespace {

using Rgba = std::array<double, 4>;

LightRequest lights(std::initializer_list<std::string> texts) {
  const std::vector<std::string> list(texts);
  return parse_lights(list);
}

TEST(LightOption, EveryPartIsRead) {
  const LightRequest request = lights(
      {"from=0,3,4; color=1,0.5,0", "at=1,2,3;range=9;attenuation=1,0,0.5", "eye;color=2,2,2", "ambient=0,0,0.5"});
  ASSERT_EQ(request.lights.size(), 2u);
  EXPECT_EQ(request.lights[0].position, (std::array<double, 4>{0, 0.6, 0.8, 0}));
  EXPECT_EQ(request.lights[0].diffuse, (std::array<double, 3>{1, 0.5, 0}));
  EXPECT_EQ(request.lights[0].specular, request.lights[0].diffuse);
  EXPECT_EQ(request.lights[1].position, (std::array<double, 4>{1, 2, 3, 1}));
  EXPECT_EQ(request.lights[1].range, 9);
  EXPECT_EQ(request.lights[1].attenuation, (std::array<double, 3>{1, 0, 0.5}));
  ASSERT_EQ(request.at_eye.size(), 1u);
  EXPECT_EQ(request.at_eye[0].diffuse, (std::array<double, 3>{2, 2, 2}));
  EXPECT_EQ(request.ambient, (Vec3{0, 0, 0.5}));
  EXPECT_TRUE(lights({"off"}).is_off);
  EXPECT_FALSE(lights({}).is_given());
}

TEST(LightOption, WhatIsNoLightIsRefusedByName) {
  for (const char* text :
       {"", "sun", "from", "from=1,2", "from=0,0,0", "from=1,2,nan", "at=1,2,1e31", "eye=1", "off;color=1,1,1",
        "ambient=2,0,0", "ambient=0,0,0;color=1,1,1", "from=1,0,0;range=3", "at=0,0,0;range=0", "at=0,0,0;range",
        "at=0,0,0;attenuation=0,0,0", "at=0,0,0;attenuation=1,-1,0", "eye;color=-1,0,0", "from=1,0,0;spot=1,0,0"}) {
    try {
      (void)lights({text});
      ADD_FAILURE() << text;
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).substr(0, 9), "--light: ") << error.what();
      EXPECT_NE(std::string(error.what()).find("; "), std::string::npos) << "a mend";
    }
  }
  EXPECT_THROW((void)lights({"off", "eye"}), InputError);
}

Vec3 random_direction(Random& random) {
  return normalized({random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
}

TEST(MeshLight, ColoursAreTheGoldensInCodesAndInLinearLight) {
  constexpr std::uint64_t kSeed = 5;
  Random random(kSeed);
  double worst = 0, worst_linear = 0;
  for (int n = 0; n < 200; ++n) {
    SCOPED_TRACE("seed " + std::to_string(kSeed) + ", mesh " + std::to_string(n));
    Mesh mesh;
    mesh.is_linear = n % 2 == 1;
    mesh.materials = {{.specular = {0.9, 0.5, 0.1}, .emission = {0, 0.1, 0}, .shininess = 20, .is_two_sided = false},
                      {.diffuse = 0.5, .ambient = std::array{0.3, 0.2, 0.1}}};
    for (int i = 0; i < 20; ++i) {
      MeshVertex v{{random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(-3, 3)}, random_direction(random)};
      for (std::size_t c = 0; c < 3; ++c) v.rgba[c] = random.uniform(0, 255);
      v.material = static_cast<std::uint32_t>(i % 2);
      mesh.vertices.push_back(v);
    }
    const LightRequest request = lights({"from=1,2,1;color=0.6,0.7,0.8", "at=2,0,5;attenuation=0.2,0.3,0.1;range=40"});
    const Mat4 view = view_matrix({.eye = {1, 2, 9}, .target = {0, 0, 0}});
    const std::vector<Rgba> colors = lit_colors(mesh, request, view, false);
    Lighting lighting;
    lighting.ambient.fill(mesh.is_linear ? 0.03 : 0.2);
    lighting.lights = request.lights;
    for (Light& light : lighting.lights)
      light.position = transform(view, {light.position[0], light.position[1], light.position[2], light.position[3]});
    for (std::size_t i = 0; i < colors.size(); ++i) {
      const MeshVertex& v = mesh.vertices[i];
      const Vec4 p = transform(view, {v.position[0], v.position[1], v.position[2], 1});
      const Vec4 n4 = transform(view, {v.normal[0], v.normal[1], v.normal[2], 0});
      const Vec3 eye{p[0], p[1], p[2]};
      Vec3 normal{n4[0], n4[1], n4[2]};
      if (v.material == 1 && dot(normal, eye) > 0) normal = scaled(normal, -1);
      const MeshMaterial& of = mesh.materials[v.material];
      Material material{.specular = of.specular, .emission = of.emission, .shininess = of.shininess};
      for (std::size_t c = 0; c < 3; ++c) {
        const double code = v.rgba[c] / 255;
        const double color = !mesh.is_linear   ? code
                             : code <= 0.04045 ? code / 12.92
                                               : std::pow((code + 0.055) / 1.055, 2.4);
        material.diffuse[c] = of.diffuse * color;
        material.ambient[c] = of.ambient ? (*of.ambient)[c] : color;
      }
      const auto expected = golden::light_color(lighting, eye, normal, material);
      for (std::size_t c = 0; c < 3; ++c) {
        if (mesh.is_linear)
          worst_linear = std::max(worst_linear, std::abs(linear_component(colors[i][c]) * 255 - expected[c]));
        else
          worst = std::max(worst, std::abs(colors[i][c] - expected[c]));
      }
      EXPECT_EQ(colors[i][3], v.rgba[3]);
    }
  }
  RecordProperty("worst", std::to_string(worst));
  EXPECT_LT(worst, 0.01);
  EXPECT_LT(worst_linear, 0.01);
  EXPECT_GT(worst, 0);
}

TEST(MeshLight, DisplayCodesAndLinearComponentsAreInverse) {
  for (int code = 0; code <= 255; ++code) EXPECT_NEAR(display_code(linear_component(code)), code, 1e-4) << code;
  EXPECT_EQ(linear_component(-3), 0);
  EXPECT_EQ(linear_component(300), 1);
}

TEST(MeshLight, OffShowsColoursAsTheyAreAndNothingIsTheLightAtTheEye) {
  Mesh mesh;
  mesh.vertices.push_back({{0, 0, 0}, normalized({1, 0, 1}), {200, 100, 50, 255}, 0, 0});
  const Mat4 view = view_matrix({.eye = {0, 0, 5}});
  EXPECT_EQ(lit_colors(mesh, lights({"off"}), view, false)[0], (Rgba{200, 100, 50, 255}));
  const double header = lit_colors(mesh, {}, view, false)[0][0];
  EXPECT_NEAR(header, 200 * (0.18 + 0.82 * (std::sqrt(0.5) + 0.25) / 1.25), 1e-9);
  // Blinn-Phong from the eye: a fifth from everywhere, the rest by the cosine.
  EXPECT_NEAR(lit_colors(mesh, lights({"eye"}), view, false)[0][1], 100 * (0.2 + std::sqrt(0.5)), 0.01);
  mesh.vertices[0].normal = normalized({1, 0, -1});  // its back: two-sided
  EXPECT_NEAR(lit_colors(mesh, lights({"eye"}), view, true)[0][1], 100 * (0.2 + std::sqrt(0.5)), 0.01);
  mesh.materials[0].is_two_sided = false;
  EXPECT_NEAR(lit_colors(mesh, lights({"eye"}), view, false)[0][1], 20, 0.01);
  EXPECT_NEAR(lit_colors(mesh, lights({"ambient=1,1,0.5"}), view, false)[0][2], 25, 0.01);
}

TEST(MeshLight, MaterialsOfObjFilesHaveAllTheirColours) {
  std::vector<std::string> warnings;
  const auto library = [](const std::string&) {
    return std::optional<std::string>("newmtl m\nKa 0.5 0 0\nKd 0 1 0\nKs 1\nKe 0 0 0.25\nNs 10\nnewmtl plain\nKd 1\n");
  };
  const Mesh mesh = parse_obj(
      "mtllib m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nusemtl m\nf 1//1 2//1 3//1\nusemtl plain\nf 1//1 2//1 3//1\n",
      "test.obj", library, warnings);
  const MeshMaterial& m = mesh.materials[mesh.vertices[0].material];
  EXPECT_EQ(m.ambient, (std::array<double, 3>{0.5, 0, 0}));
  EXPECT_EQ(m.specular, (std::array<double, 3>{1, 1, 1}));
  EXPECT_EQ(m.emission, (std::array<double, 3>{0, 0, 0.25}));
  EXPECT_EQ(m.shininess, 10);
  EXPECT_EQ(mesh.materials[mesh.vertices[3].material], MeshMaterial{});
  const Mat4 view = view_matrix({.eye = {0, 0, 5}});
  const auto colors = lit_colors(mesh, lights({"from=0,0,1"}), view, true);
  // Ambient a fifth of Ka, diffuse Kd, and the whole highlight, as the light comes along the view.
  EXPECT_NEAR(colors[0][0], 255, 0.01);
  EXPECT_NEAR(colors[3][0], 255, 0.01);
  const auto aside = lit_colors(mesh, lights({"from=1,0,0"}), view, true);  // along the face
  EXPECT_NEAR(aside[0][0], 25.5, 0.01);
  EXPECT_NEAR(aside[0][1], 0, 0.01);
  EXPECT_NEAR(aside[0][2], 63.75, 0.01);
  EXPECT_NEAR(aside[3][1], 51, 0.01);
}

using Json = nlohmann::json;
using test::GltfBuilder;

/// Two triangles that face +z, at z = 0 and at z = -4, and lights at nodes.
GltfBuilder lit_gltf(const Json& lights_of_file, const std::vector<Json>& nodes) {
  GltfBuilder builder;
  const std::vector<double> corners{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, -4, 1, 0, -4, 0, 1, -4};
  Json& primitive = builder.mesh(builder.accessor(GltfBuilder::f32, 3, corners));
  primitive["material"] = 0;
  builder.json["materials"] = {{{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 1}}}}};
  builder.json["extensionsUsed"] = {"KHR_lights_punctual"};
  builder.json["extensions"]["KHR_lights_punctual"]["lights"] = lights_of_file;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    Json node = nodes[i];
    node["extensions"]["KHR_lights_punctual"]["light"] = i;
    builder.root(node);
  }
  return builder;
}

GltfModel read(const GltfBuilder& builder) {
  std::vector<std::string> warnings;
  GltfModel model = parse_gltf(
      builder.glb(), "test.glb", [](const std::string&) { return std::nullopt; }, warnings);
  EXPECT_TRUE(warnings.empty());
  return model;
}

TEST(GltfLight, LightsStandAndShineAsTheirNodesDo) {
  const double half = std::sqrt(0.5);
  const GltfModel model =
      read(lit_gltf({{{"type", "directional"}, {"color", {1, 0.5, 0.25}}, {"intensity", 100}},
                     {{"type", "point"}, {"range", 7}},
                     {{"type", "spot"}, {"spot", {{"innerConeAngle", 0.2}, {"outerConeAngle", 0.5}}}}},
                    {Json{{"rotation", {half, 0, 0, half}}},  // a quarter about x: -z becomes +y
                     Json{{"translation", {1, 2, 3}}, {"scale", {9, 9, 9}}}, Json{{"translation", {0, 0, 1}}}}));
  const std::vector<Light>& lights = model.mesh.lights;
  ASSERT_EQ(lights.size(), 3u);
  EXPECT_NEAR(lights[0].position[1], -1, 1e-12) << "it shines up, so it comes from below";
  EXPECT_EQ(lights[0].position[3], 0);
  EXPECT_NEAR(lights[0].diffuse[1], lights[0].diffuse[0] / 2, 1e-12);
  EXPECT_NEAR(lights[0].diffuse[0], 100 * lights[1].diffuse[0], 1e-9);
  EXPECT_EQ(lights[1].position, (std::array<double, 4>{1, 2, 3, 1}));
  EXPECT_EQ(lights[1].range, 7);
  EXPECT_EQ(lights[1].attenuation, (std::array<double, 3>{0, 0, 1}));
  EXPECT_EQ(lights[2].spot_direction, (std::array<double, 3>{0, 0, -1}));
  const auto cone = [&](double angle) {
    return std::clamp(std::cos(angle) * lights[2].spot_scale + lights[2].spot_offset, 0.0, 1.0);
  };
  EXPECT_NEAR(cone(0.2), 1, 1e-12);
  EXPECT_NEAR(cone(0.5), 0, 1e-12);
}

TEST(GltfLight, AWhiteSurfaceInFullLightIsWhiteWhateverTheUnits) {
  for (const double intensity : {0.01, 1.0, 54000.0}) {
    const GltfModel model = read(lit_gltf({{{"type", "directional"}, {"intensity", intensity}}}, {Json::object()}));
    const auto colors = lit_colors(model.mesh, {}, view_matrix({.eye = {0, 0, 5}}), true);
    for (const Rgba& color : colors) EXPECT_NEAR(color[0], 255, 0.1) << intensity;
    EXPECT_EQ(lit_colors(model.mesh, lights({"off"}), view_matrix({.eye = {0, 0, 5}}), true)[0][0], 255);
  }
}

TEST(GltfLight, APointLightFallsWithTheSquareOfTheDistance) {
  const GltfModel model = read(lit_gltf({{{"type", "point"}, {"intensity", 9}}}, {Json{{"translation", {0, 0, 40}}}}));
  const auto colors = lit_colors(model.mesh, lights({}), view_matrix({.eye = {0, 0, 50}}), true);
  const double near = linear_component(colors[0][0]), far = linear_component(colors[3][0]);
  // 0.03 of everywhere beside it; the two at (0, 0) are 40 and 44 away, and the nearer ones of all are white.
  EXPECT_NEAR((far - 0.03) * 1936 / 1600, 1, 0.002);
  EXPECT_GT(near, far);
}

TEST(GltfLight, ColouredVerticesAreLitWhereAFileHasLights) {
  GltfBuilder builder = lit_gltf({{{"type", "directional"}}}, {Json{{"rotation", {1, 0, 0, 0}}}});  // from behind
  builder.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] =
      builder.accessor(GltfBuilder::f32, 3, std::vector<double>(18, 0.5));
  const GltfModel model = read(builder);
  const Mat4 view = view_matrix({.eye = {0, 0, 5}});
  EXPECT_LT(lit_colors(model.mesh, {}, view, true)[0][0], 64) << "unlit but for what comes from everywhere";
  builder.json.erase("extensions");
  for (Json& node : builder.json["nodes"]) node.erase("extensions");
  const GltfModel unlit = read(builder);
  EXPECT_NEAR(lit_colors(unlit.mesh, {}, view, true)[0][0], display_code(0.5), 1e-9);
}

TEST(GltfLight, MetalAndRoughnessBecomeBlinnPhong) {
  GltfMaterial material;
  material.base = {1, 0.5, 0.25, 1};
  material.metallic = 0;
  material.roughness = 1;
  const MeshMaterial rough = surface_of(material);
  EXPECT_EQ(rough.shininess, 0);
  EXPECT_EQ(rough.specular[0], 0) << "no flat disc of light";
  EXPECT_EQ(rough.diffuse, 1);
  material.metallic = 1;
  material.roughness = 0.5;
  const MeshMaterial metal = surface_of(material);
  EXPECT_NEAR(metal.shininess, 30, 1e-9);
  EXPECT_EQ(metal.diffuse, 0.5);
  EXPECT_EQ(metal.specular[0], 0);
  EXPECT_NEAR(metal.mirrored, 38.0 / 8 * 30 / 32, 1e-9);
  material.roughness = 0;
  EXPECT_EQ(surface_of(material).shininess, kMostShininess);
}

TEST(GltfLight, AMirroredNodeIsLitFromTheSameSide) {
  for (const Json& node : {Json::object(), Json{{"scale", {-1, 1, 1}}}, Json{{"scale", {-1, -1, 1}}}}) {
    GltfBuilder builder = lit_gltf({{{"type", "directional"}}}, {Json::object()});
    builder.json["nodes"][0].update(node);
    builder.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
        builder.accessor(GltfBuilder::f32, 3, {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1});
    const GltfModel model = read(builder);
    EXPECT_EQ(model.mesh.vertices[0].normal, (Vec3{0, 0, 1})) << node;
    EXPECT_NEAR(lit_colors(model.mesh, {}, view_matrix({.eye = {0, 0, 5}}), true)[0][0], 255, 0.1) << node;
  }
}

TEST(GltfLight, AMetalMirrorsTheColoursOfItsVertices) {
  GltfBuilder builder = lit_gltf({{{"type", "directional"}}}, {Json::object()});
  builder.json["materials"] = {{{"pbrMetallicRoughness", {{"roughnessFactor", 0.5}}}}};
  std::vector<double> red;
  for (int i = 0; i < 6; ++i) red.insert(red.end(), {1, 0, 0});
  builder.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = builder.accessor(GltfBuilder::f32, 3, red);
  const Rgba color = lit_colors(read(builder).mesh, {}, view_matrix({.eye = {0, 0, 5}}), true)[0];
  EXPECT_NEAR(color[0], 255, 0.1);
  EXPECT_EQ(color[1], 0);
}

TEST(GltfLight, TheUnitsOfASceneDoNotShow) {
  // The same scene, light included, in other units; and a light as bright here from ever farther away.
  std::vector<double> small, large;
  for (const double unit : {1e-6, 1e-3, 1.0, 1e3, 1e6}) {
    GltfBuilder builder =
        lit_gltf({{{"type", "point"}, {"intensity", 5}}}, {Json{{"translation", {unit, unit, 2 * unit}}}});
    builder.json["nodes"][0]["scale"] = {unit, unit, unit};
    const GltfModel model = read(builder);
    const auto colors = lit_colors(model.mesh, {}, view_matrix({.eye = {0, 0, 50 * unit}}), true);
    (unit < 1 ? small : large).push_back(colors[5][0]);
  }
  for (const double code : small) EXPECT_NEAR(code, large[0], 0.05);
  for (const double code : large) EXPECT_NEAR(code, large[0], 0.05);
  double before = 0;
  for (const double distance : {1e3, 1e5, 1e7, 1e9}) {
    const GltfModel model =
        read(lit_gltf({{{"type", "point"}, {"intensity", 5}}}, {Json{{"translation", {0, 0, distance}}}}));
    const double code = lit_colors(model.mesh, {}, view_matrix({.eye = {0, 0, 5}}), true)[3][0];
    EXPECT_GT(code, before - 0.01);
    before = code;
  }
  EXPECT_NEAR(before, 255, 0.1);
}

TEST(GltfLight, HardAndWideSpotsAreTaken) {
  for (const auto& [inner, outer] : {std::pair{0.5, 0.5}, {0.8, 0.7853981633974483}, {0.0, 1.5707963705062866}}) {
    const GltfModel model =
        read(lit_gltf({{{"type", "spot"}, {"spot", {{"innerConeAngle", inner}, {"outerConeAngle", outer}}}}},
                      {Json{{"translation", {0, 0, 2}}}}));
    EXPECT_GT(model.mesh.lights[0].spot_scale, 0);
  }
}

TEST(GltfLight, BrokenLightsAreRefusedWithTheirPlace) {
  const auto refused = [](const Json& light, const std::string& what) {
    try {
      (void)read(lit_gltf(Json::array({light}), {Json::object()}));
      ADD_FAILURE() << light;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(what), std::string::npos) << error.what();
    }
  };
  refused({{"type", "area"}}, "directional, point or spot");
  refused(Json::object(), "type");
  refused({{"type", "point"}, {"intensity", -1}}, "choose 0 or more");
  refused({{"type", "point"}, {"color", {1, 2}}}, "write 3");
  refused({{"type", "point"}, {"intensity", 1e38}}, "beyond 1e30");
  refused({{"type", "spot"}, {"spot", {{"innerConeAngle", -0.5}}}}, "an angle below 0");
  GltfBuilder builder = lit_gltf({{{"type", "point"}}}, {Json::object()});
  builder.json["nodes"].back()["extensions"]["KHR_lights_punctual"]["light"] = 4;
  EXPECT_THROW((void)read(builder), InputError);
  builder.json.erase("extensions");
  EXPECT_THROW((void)read(builder), InputError);
}

}  // namespace
}  // namespace halfplane::mesh_light_test
