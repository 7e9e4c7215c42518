// The glTF reader: the meshes of good files. The messages for bad files are in gltf_errors_test.cpp.
#include "sim/scene/gltf.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "model/capture/capture.hpp"
#include "model/config.hpp"
#include "model/engines/functional.hpp"
#include "sim/scene/load.hpp"
#include "sim/scene/mesh_scene.hpp"
#include "sim/scene/obj.hpp"
#include "sim/show/image/framebuffer_files.hpp"
#include "tests/gltf_builder.hpp"

namespace halfplane::gltf_test {
namespace {

using test::GltfBuilder;
using Json = GltfBuilder::Json;
constexpr auto kF32 = GltfBuilder::f32;

struct Parsed {
  GltfModel model;
  std::vector<std::string> warnings;
};

Parsed parse(const std::string& bytes) {
  Parsed result;
  const auto none = [](const std::string&) { return std::optional<std::string>(); };
  result.model = parse_gltf(bytes, "test.gltf", none, result.warnings);
  return result;
}

Mesh mesh_of(const GltfBuilder& builder) { return parse(builder.text()).model.mesh; }

// The three places of every triangle, in order: independent of the numbering of vertices.
std::vector<std::array<Vec3, 3>> places(const Mesh& mesh) {
  std::vector<std::array<Vec3, 3>> result;
  for (const auto& t : mesh.triangles) {
    result.push_back({mesh.vertices[t[0]].position, mesh.vertices[t[1]].position, mesh.vertices[t[2]].position});
  }
  return result;
}

std::array<std::string, 2> hashes(const Scene& scene) {
  const Config config = preset("embedded");
  const Rendering rendering = render_functional(scene, config);
  EXPECT_GT(rendering.counters.covered, 0u);
  return {color_hash(rendering.frame, config.color_format), depth_hash(rendering.frame)};
}

// An octahedron: closed, counter-clockwise from outside, six corners that all binary32 hold.
const std::vector<double> kCorners{1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1};
const std::vector<double> kFaces{0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};

GltfBuilder octahedron(const Json& node = Json::object()) {
  GltfBuilder builder;
  Json& primitive = builder.mesh(builder.accessor(kF32, 3, kCorners), node);
  primitive["indices"] = builder.accessor(GltfBuilder::u16, 1, kFaces);
  return builder;
}

// The same as OBJ, one flat normal a face; `color` is Kd.
Mesh octahedron_obj(const std::string& color) {
  std::ostringstream text;
  text << "mtllib m\nusemtl m\ns off\n";
  for (std::size_t i = 0; i < kCorners.size(); i += 3) {
    text << "v " << kCorners[i] << ' ' << kCorners[i + 1] << ' ' << kCorners[i + 2] << '\n';
  }
  for (std::size_t i = 0; i < kFaces.size(); i += 3) {
    text << "f " << kFaces[i] + 1 << ' ' << kFaces[i + 1] + 1 << ' ' << kFaces[i + 2] + 1 << '\n';
  }
  std::vector<std::string> warnings;
  const auto library = [&color](const std::string&) { return std::optional("newmtl m\nKd " + color + "\n"); };
  return parse_obj(text.str(), "test.obj", library, warnings);
}

TEST(Gltf, BothContainersGiveThePictureOfTheSameMeshAsObj) {
  const GltfBuilder builder = octahedron();
  const auto obj = hashes(mesh_scene(octahedron_obj("1"), {}, 160, 120, Cull::back));
  EXPECT_EQ(hashes(mesh_scene(parse(builder.text()).model.mesh, {}, 160, 120)), obj);
  EXPECT_EQ(hashes(mesh_scene(parse(builder.glb()).model.mesh, {}, 160, 120)), obj);
  EXPECT_NE(hashes(mesh_scene(octahedron_obj("0.5"), {}, 160, 120, Cull::back)), obj);  // so the hashes can tell
}

TEST(Gltf, ATriangleOfThreeColoursIsThePictureOfACapture) {
  GltfBuilder builder;
  Json& primitive = builder.mesh(builder.accessor(kF32, 3, {-0.5, -0.5, 0, 0.75, -0.5, 0, 0, 0.5, 0}));
  primitive["attributes"]["COLOR_0"] =
      builder.accessor(GltfBuilder::u8, 4, {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255}, true);
  const Mesh mesh = mesh_of(builder);
  // An orthographic view of height 2 from z = 2: clip x, y = world x, y in a square target; z = 0 is in the middle.
  const CameraRequest camera = parse_camera("eye=0,0,2;target=0,0,0;ortho=2;near=1;far=3");
  const std::string capture =
      "halfplane 1\ntarget 96 96\nclear color 20 20 30 255 depth 1\nspace clip\nstate cull back\n"
      "v -0.5 -0.5 0 1 255 0 0 255\nv 0.75 -0.5 0 1 0 255 0 255\nv 0 0.5 0 1 0 0 255 255\nt 0 1 2\n";
  EXPECT_EQ(hashes(mesh_scene(mesh, camera, 96, 96)), hashes(read_capture(capture, "test.hpt")));
}

TEST(Gltf, EveryIndexTypeAndNoIndexGiveTheSameTriangles) {
  const auto expected = places(mesh_of(octahedron()));
  ASSERT_EQ(expected.size(), 8u);
  for (const auto component : {GltfBuilder::u8, GltfBuilder::u16, GltfBuilder::u32}) {
    GltfBuilder builder;
    Json& primitive = builder.mesh(builder.accessor(kF32, 3, kCorners));
    primitive["indices"] = builder.accessor(component, 1, kFaces);
    EXPECT_EQ(places(mesh_of(builder)), expected) << component;
  }
  std::vector<double> corners;
  for (const double index : kFaces) {
    for (std::size_t k = 0; k < 3; ++k) corners.push_back(kCorners[static_cast<std::size_t>(index) * 3 + k]);
  }
  GltfBuilder plain;
  plain.mesh(plain.accessor(kF32, 3, corners));
  EXPECT_EQ(places(mesh_of(plain)), expected);
}

TEST(Gltf, StripsAndFansKeepTheWindingOfTheirTriangles) {
  const std::vector<double> zigzag{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0},
      rim{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
  const auto signed_areas = [](const std::vector<double>& corners, int mode) {
    GltfBuilder builder;
    builder.mesh(builder.accessor(kF32, 3, corners))["mode"] = mode;
    std::vector<double> result;
    for (const auto& [a, b, c] : places(mesh_of(builder))) {
      result.push_back(cross(subtract(b, a), subtract(c, a))[2] / 2);
    }
    return result;
  };
  EXPECT_EQ(signed_areas(zigzag, 5), (std::vector<double>{0.5, 0.5, 0.5}));
  EXPECT_EQ(signed_areas(rim, 6), (std::vector<double>{0.5, 0.5}));
}

/// Six indices, the fourth of which ends a strip, fan or loop: the graphics APIs' result.
TEST(Gltf, TheLargestIndexStartsPrimitivesAnew) {
  const std::vector<double> corners{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 2, 1, 0, 2, 2, 0};
  const auto drawn = [&](GltfBuilder::Component component, double largest, int mode, std::vector<double> indices) {
    GltfBuilder b;
    Json& primitive = b.mesh(b.accessor(kF32, 3, corners));
    for (double& index : indices)
      if (index < 0) index = largest;
    primitive["indices"] = b.accessor(component, 1, indices);
    primitive["mode"] = mode;
    const Parsed parsed = parse(b.text());
    EXPECT_EQ(parsed.warnings.size(), 1u);
    EXPECT_NE(parsed.warnings.front().find(std::to_string(static_cast<std::uint64_t>(largest)) + " start"),
              std::string::npos)
        << parsed.warnings.front();
    return parsed.model.mesh;
  };
  const auto corner = [&](std::size_t i) { return Vec3{corners[3 * i], corners[3 * i + 1], corners[3 * i + 2]}; };
  const auto triangle = [&](std::size_t a, std::size_t b, std::size_t c) {
    return std::array{corner(a), corner(b), corner(c)};
  };
  using Triangles = std::vector<std::array<Vec3, 3>>;
  for (const auto& [component, largest] :
       {std::pair{GltfBuilder::u8, 255.0}, {GltfBuilder::u16, 65535.0}, {GltfBuilder::u32, 4294967295.0}}) {
    // Strips 0 1 2 3 and 3 4 5, whose second begins with the winding of a first one.
    EXPECT_EQ(places(drawn(component, largest, 5, {0, 1, 2, 3, -1, 3, 4, 5})),
              (Triangles{triangle(0, 1, 2), triangle(1, 3, 2), triangle(3, 4, 5)}));
    // Fans 0 1 3 2 and 3 4 5; a corner too few makes none.
    EXPECT_EQ(places(drawn(component, largest, 6, {0, 1, 3, 2, -1, 0, 1, -1, 3, 4, 5})),
              (Triangles{triangle(1, 3, 0), triangle(3, 2, 0), triangle(4, 5, 3)}));
    // An incomplete primitive of a list is dropped.
    EXPECT_EQ(places(drawn(component, largest, 4, {0, 1, 2, 3, 4, -1, 3, 4, 5})),
              (Triangles{triangle(0, 1, 2), triangle(3, 4, 5)}));
    const Mesh lines = drawn(component, largest, 3, {0, 1, 3, -1, 5, -1, 4, 5});
    std::vector<std::size_t> counts;
    for (const MeshPart& part : lines.parts) counts.push_back(part.count);
    EXPECT_EQ(counts, (std::vector<std::size_t>{3, 2})) << "line strips";
    EXPECT_EQ(lines.vertices[lines.indices.back()].position, corner(5));
  }
}

TEST(Gltf, PointsAndLinesOfEveryModeAreDrawn) {
  const std::vector<double> rim{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
  const auto drawn = [&rim](int mode) {
    GltfBuilder builder;
    builder.mesh(builder.accessor(kF32, 3, rim))["mode"] = mode;
    const Mesh mesh = mesh_of(builder);
    EXPECT_TRUE(mesh.triangles.empty());
    EXPECT_EQ(mesh.vertices.size(), 4u);
    const Scene scene = mesh_scene(mesh, {}, 160, 120);
    const auto& draw = std::get<Draw>(scene.commands.at(1));
    return std::pair{draw.topology, render_functional(scene, preset("embedded")).counters.drawn};
  };
  EXPECT_EQ(drawn(0), (std::pair{Topology::points, std::uint64_t{4}}));
  EXPECT_EQ(drawn(1), (std::pair{Topology::lines, std::uint64_t{2}}));
  EXPECT_EQ(drawn(2), (std::pair{Topology::line_loop, std::uint64_t{4}}));
  EXPECT_EQ(drawn(3), (std::pair{Topology::line_strip, std::uint64_t{3}}));
}

TEST(Gltf, ColoursAreLinearAndBecomeDisplayCodes) {
  EXPECT_EQ(display_code(0), 0);
  EXPECT_EQ(display_code(1), 255);
  EXPECT_EQ(display_code(2), 255);
  EXPECT_EQ(display_code(-1), 0);
  EXPECT_NEAR(display_code(0.5), 187.516, 1e-3);                // the curve's power part
  EXPECT_NEAR(display_code(0.002), 0.002 * 12.92 * 255, 1e-9);  // and its straight part
  const std::vector<double> corners{0, 0, 0, 1, 0, 0, 0, 1, 0};
  struct Case {
    GltfBuilder::Component component;
    std::size_t width;
    double one;
  };
  for (const Case& c :
       {Case{kF32, 3, 1}, Case{kF32, 4, 1}, Case{GltfBuilder::u8, 3, 255}, Case{GltfBuilder::u8, 4, 255},
        Case{GltfBuilder::u16, 3, 65535}, Case{GltfBuilder::u16, 4, 65535}}) {
    GltfBuilder builder;
    Json& primitive = builder.mesh(builder.accessor(kF32, 3, corners));
    std::vector<double> colors;
    for (int i = 0; i < 3; ++i) {
      colors.insert(colors.end(), {c.one, 0, c.one / 5});
      if (c.width == 4) colors.push_back(c.one);
    }
    primitive["attributes"]["COLOR_0"] = builder.accessor(c.component, c.width, colors, c.component != kF32);
    const std::array<double, 4> rgba = mesh_of(builder).vertices[1].rgba;
    EXPECT_EQ(rgba[0], 255) << c.component;
    EXPECT_EQ(rgba[1], 0) << c.component;
    EXPECT_NEAR(rgba[2], 123.555, 1e-3) << c.component;  // 0.2 encoded
    EXPECT_EQ(rgba[3], 255) << c.component;
  }
}

TEST(Gltf, ABaseColourTimesAVertexColourIsMultipliedBeforeItIsEncoded) {
  GltfBuilder builder = test::one_triangle();
  builder.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 1, 0.25, 0.5}}}}}};
  Json& primitive = builder.json["meshes"][0]["primitives"][0];
  primitive["material"] = 0;
  const auto base = mesh_of(builder).vertices[0].rgba;
  EXPECT_EQ(base[0], display_code(0.5));
  EXPECT_EQ(base[3], 127.5);
  primitive["attributes"]["COLOR_0"] = builder.accessor(kF32, 3, std::vector<double>(9, 0.5));
  const Mesh mesh = mesh_of(builder);
  EXPECT_EQ(mesh.vertices[0].rgba,
            (std::array<double, 4>{display_code(0.25), display_code(0.5), display_code(0.125), 127.5}));
  EXPECT_EQ(mesh.vertices[0].normal, Vec3{});  // coloured vertices are shown as they are: no light
}

TEST(Gltf, APrimitiveWithoutMaterialIsWhiteAndItsBackIsNotSeen) {
  GltfBuilder builder = test::one_triangle();
  const Mesh mesh = mesh_of(builder);
  EXPECT_EQ(mesh.vertices[0].rgba, (std::array<double, 4>{255, 255, 255, 255}));
  EXPECT_EQ(mesh.vertices[0].normal, (Vec3{0, 0, 1}));
  const auto covered = [](const Mesh& m, const char* camera) {
    return render_functional(mesh_scene(m, parse_camera(camera), 64, 64), preset("embedded")).counters.covered;
  };
  const char* const front = "eye=0.3,0.3,3;target=0.3,0.3,0";
  const char* const back = "eye=0.3,0.3,-3;target=0.3,0.3,0";
  EXPECT_GT(covered(mesh, front), 0u);
  EXPECT_EQ(covered(mesh, back), 0u);
  builder.json["materials"] = {{{"doubleSided", true}}};
  builder.json["meshes"][0]["primitives"][0]["material"] = 0;
  EXPECT_GT(covered(mesh_of(builder), back), 0u);
}

TEST(Gltf, AMirroredNodeShowsItsFrontAllTheSame) {
  const auto counters = [](const Json& node) {
    return render_functional(mesh_scene(mesh_of(octahedron(node)), {}, 64, 64), preset("embedded")).counters;
  };
  const Counters plain = counters(Json::object()), mirrored = counters({{"scale", {1, 1, -1}}});
  EXPECT_EQ(plain.culled, mirrored.culled);  // an octahedron is its own mirror image
  EXPECT_EQ(plain.covered, mirrored.covered);
  EXPECT_GT(plain.culled, 0u);
}

TEST(Gltf, NodesPlaceTheirMeshesThroughTheHierarchy) {
  GltfBuilder builder = test::one_triangle();
  // Child: twice as large, then a quarter turn about z, then to x = 5. Parent (a matrix, by columns): to y = 7.
  builder.json["nodes"][0].update(
      {{"translation", {5, 0, 0}}, {"rotation", {0, 0, std::sqrt(0.5), std::sqrt(0.5)}}, {"scale", {2, 2, 2}}});
  builder.json["nodes"].push_back(
      {{"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 7, 0, 1}}, {"children", {0}}, {"name", "parent"}});
  builder.json["scenes"] = {{{"nodes", {1}}}};
  const auto corners = places(mesh_of(builder))[0];
  const std::array<Vec3, 3> expected{Vec3{5, 7, 0}, Vec3{5, 9, 0}, Vec3{3, 7, 0}};
  for (std::size_t i = 0; i < 3; ++i) EXPECT_LT(length(subtract(corners[i], expected[i])), 1e-14) << i;
}

TEST(Gltf, NormalsStandOnStretchedFaces) {
  // A plane that rises 45 degrees along x; stretched by 2 in x, its normal leans half as much.
  GltfBuilder builder;
  Json& primitive = builder.mesh(builder.accessor(kF32, 3, {0, 0, 0, 1, 0, 1, 0, 1, 0}), {{"scale", {2, 1, -1}}});
  primitive["attributes"]["NORMAL"] = builder.accessor(kF32, 3, {-1, 0, 1, -1, 0, 1, -1, 0, 1});
  const Vec3 normal = mesh_of(builder).vertices[0].normal;
  EXPECT_NEAR(std::abs(dot(normal, normalized({1, 0, 2}))), 1, 1e-12);
}

TEST(Gltf, SparseAccessorsReplaceElementsOfAViewOrOfZeros) {
  for (const bool has_view : {true, false}) {
    GltfBuilder builder = test::one_triangle();
    Json& accessor = builder.json["accessors"][0];
    if (!has_view) accessor.erase("bufferView");
    const std::size_t indices = builder.view(GltfBuilder::packed(GltfBuilder::u16, {1, 2}));
    const std::size_t values = builder.view(GltfBuilder::packed(kF32, {4, 0, 0, 0, 6, 0}));
    accessor["sparse"] = {{"count", 2},
                          {"indices", {{"bufferView", indices}, {"componentType", 5123}}},
                          {"values", {{"bufferView", values}}}};
    EXPECT_EQ(places(mesh_of(builder))[0], (std::array<Vec3, 3>{Vec3{0, 0, 0}, Vec3{4, 0, 0}, Vec3{0, 6, 0}}));
  }
}

TEST(Gltf, StridesAndOffsetsAreFollowed) {
  GltfBuilder builder = test::one_triangle();
  // Places and other data, interleaved, after four unused bytes.
  const std::vector<double> mixed{9, 0, 0, 0, 8, 8, 3, 0, 0, 8, 8, 0, 3, 0, 8, 8};
  const std::size_t view = builder.view(GltfBuilder::packed(kF32, mixed));
  builder.json["bufferViews"][view]["byteStride"] = 20;
  builder.json["accessors"][0].update({{"bufferView", view}, {"byteOffset", 4}});
  EXPECT_EQ(places(mesh_of(builder))[0], (std::array<Vec3, 3>{Vec3{0, 0, 0}, Vec3{3, 0, 0}, Vec3{0, 3, 0}}));
}

TEST(Gltf, QuantizedPlacesAreReadAsTheirComponentsSay) {
  GltfBuilder builder;
  builder.json["extensionsRequired"] = {"KHR_mesh_quantization"};
  builder.mesh(builder.accessor(GltfBuilder::i8, 3, {0, 0, -128, 127, 0, 0, 0, 127, 0}, true));
  EXPECT_EQ(places(mesh_of(builder))[0], (std::array<Vec3, 3>{Vec3{0, 0, -1}, Vec3{1, 0, 0}, Vec3{0, 1, 0}}));
}

TEST(Gltf, HiddenNodesAndWhatIsBelowThemAreNotDrawn) {
  GltfBuilder builder = test::one_triangle();
  builder.json["nodes"][0].update({{"extensions", {{"KHR_node_visibility", {{"visible", false}}}}}, {"children", {1}}});
  builder.json["nodes"].push_back({{"mesh", 0}, {"translation", {0, 0, 1}}});
  builder.mesh(builder.accessor(kF32, 3, {0, 0, 5, 1, 0, 5, 0, 1, 5}),
               {{"extensions", {{"KHR_node_visibility", {{"visible", true}}}}}});
  for (const char* list : {"extensionsUsed", "extensionsRequired"}) {
    builder.json[list] = {"KHR_node_visibility"};
    const Parsed read = parse(builder.text());
    EXPECT_TRUE(read.warnings.empty());
    ASSERT_EQ(read.model.mesh.triangles.size(), 1u);
    EXPECT_EQ(places(read.model.mesh)[0][0][2], 5);
  }
}

TEST(Gltf, InstancesAreTheMeshAtEachPlace) {
  GltfBuilder builder = test::one_triangle();
  const std::size_t translation = builder.accessor(kF32, 3, {0, 0, 0, 5, 0, 0}),
                    rotation = builder.accessor(GltfBuilder::i8, 4, {0, 0, 0, 127, 0, 0, 127, 0}, true),
                    scale = builder.accessor(kF32, 3, {1, 1, 1, 2, 2, 2});
  builder.json["nodes"][0].update(
      {{"translation", {0, 0, 3}},
       {"extensions",
        {{"EXT_mesh_gpu_instancing",
          {{"attributes", {{"TRANSLATION", translation}, {"ROTATION", rotation}, {"SCALE", scale}}}}}}}});
  builder.json["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
  const auto corners = places(mesh_of(builder));
  ASSERT_EQ(corners.size(), 2u);
  EXPECT_EQ(corners[0], (std::array<Vec3, 3>{Vec3{0, 0, 3}, Vec3{1, 0, 3}, Vec3{0, 1, 3}}));
  const std::array<Vec3, 3> turned{Vec3{5, 0, 3}, Vec3{3, 0, 3}, Vec3{5, -2, 3}};  // by half a turn, twice as large
  for (std::size_t i = 0; i < 3; ++i) EXPECT_LT(length(subtract(corners[1][i], turned[i])), 1e-12) << i;
}

TEST(Gltf, AnExtensionOfWhatIsDrawnThatIsNotReadIsNamed) {
  GltfBuilder builder = test::one_triangle();
  builder.json["extensionsUsed"] = {"EXT_other_geometry", "KHR_xmp"};
  EXPECT_EQ(parse(builder.text()).warnings,
            std::vector<std::string>{
                "test.gltf: 'EXT_other_geometry' is used and not read here; what it changes is not seen"});
}

TEST(Gltf, TheDefaultSceneIsReadAndSeveralAreMentioned) {
  GltfBuilder builder = test::one_triangle();
  builder.mesh(builder.accessor(kF32, 3, {0, 0, 5, 1, 0, 5, 0, 1, 5}));
  builder.json["scenes"] = {{{"nodes", {0}}}, {{"nodes", {1}}}};
  const Parsed first = parse(builder.text());
  EXPECT_EQ(first.warnings, std::vector<std::string>{"test.gltf: scene 0 of 2 is drawn, the file's default"});
  EXPECT_EQ(places(first.model.mesh)[0][0][2], 0);
  builder.json["scene"] = 1;
  EXPECT_EQ(places(mesh_of(builder))[0][0][2], 5);
  builder.json.erase("scenes");
  builder.json.erase("scene");
  EXPECT_EQ(mesh_of(builder).triangles.size(), 2u);  // no scenes: every root
}

TEST(Gltf, OnlyVerticesThatAreUsedAreFramed) {
  GltfBuilder builder;
  Json& primitive = builder.mesh(builder.accessor(kF32, 3, {0, 0, 0, 1e9, 0, 0, 1, 0, 0, 0, 1, 0}));
  primitive["attributes"]["NORMAL"] = builder.accessor(kF32, 3, {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1});
  primitive["indices"] = builder.accessor(GltfBuilder::u8, 1, {0, 2, 3, 3, 2, 0});
  const Mesh mesh = mesh_of(builder);
  EXPECT_EQ(mesh.vertices.size(), 3u);
  EXPECT_EQ(mesh.triangles.size(), 2u);
}

TEST(Gltf, WhatIsLeftOutIsSaidOnceForTheWholeFile) {
  GltfBuilder builder = test::one_triangle();
  builder.json["materials"] = {{{"alphaMode", "GLASS"},
                                {"normalTexture", {{"index", 0}}},
                                {"pbrMetallicRoughness", {{"metallicRoughnessTexture", {{"index", 0}}}}}}};
  Json& primitive = builder.json["meshes"][0]["primitives"][0];
  primitive["material"] = 0;
  builder.root({{"mesh", 0}});
  const std::vector<std::string> warnings = parse(builder.text()).warnings;
  ASSERT_EQ(warnings.size(), 2u);
  for (const char* part : {"alphaMode 'GLASS'", "of the textures"}) {
    EXPECT_EQ(std::count_if(warnings.begin(), warnings.end(),
                            [part](const std::string& w) { return w.find(part) != std::string::npos; }),
              1)
        << part;
  }
}

TEST(Gltf, WhatATextureSaysShinesDoesNotShineAllOver) {
  GltfBuilder builder = test::one_triangle();
  builder.json["materials"] = {{{"emissiveFactor", {1, 0.5, 0}}}};
  builder.json["meshes"][0]["primitives"][0]["material"] = 0;
  EXPECT_EQ(mesh_of(builder).materials.at(0).emission, (std::array<double, 3>{1, 0.5, 0}));
  builder.json["materials"][0]["emissiveTexture"] = {{"index", 0}};
  EXPECT_EQ(mesh_of(builder).materials.at(0).emission, (std::array<double, 3>{}));
}

TEST(Gltf, UnlitMaterialsKeepTheirColourAtEveryAngle) {
  GltfBuilder builder = test::one_triangle();
  builder.json["extensionsRequired"] = {"KHR_materials_unlit"};
  builder.json["materials"] = {{{"extensions", {{"KHR_materials_unlit", Json::object()}}}}};
  builder.json["meshes"][0]["primitives"][0]["material"] = 0;
  EXPECT_EQ(mesh_of(builder).vertices[0].normal, Vec3{});
}

TEST(Gltf, RequiredExtensionsOfWhatIsNotReadAreNoReasonToRefuse) {
  GltfBuilder builder = test::one_triangle();
  builder.json["extensionsRequired"] = {"KHR_texture_transform",     "KHR_texture_basisu", "EXT_texture_webp",
                                        "KHR_materials_clearcoat",   "MSFT_texture_dds",   "KHR_lights_punctual",
                                        "KHR_materials_variants",    "KHR_xmp_json_ld",    "EXT_lights_image_based",
                                        "KHR_materials_transmission"};
  EXPECT_EQ(mesh_of(builder).triangles.size(), 1u);
}

GltfBuilder with_cameras() {
  GltfBuilder builder = test::one_triangle();
  builder.json["cameras"] = {
      {{"type", "perspective"}, {"name", "wide"}, {"perspective", {{"yfov", 1.5}, {"znear", 0.5}, {"zfar", 20}}}},
      {{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.25}}}},
      {{"type", "orthographic"},
       {"name", "flat"},
       {"orthographic", {{"xmag", 3}, {"ymag", 2}, {"znear", 0}, {"zfar", 10}}}}};
  builder.root({{"camera", 0}, {"translation", {0.3, 0.3, 4}}, {"scale", {3, 3, 3}}});
  builder.root({{"camera", 1}, {"translation", {0.3, 0.3, 4}}, {"name", "endless"}});
  builder.root({{"camera", 2}, {"rotation", {0, 1, 0, 0}}, {"translation", {0, 0, -5}}});  // half a turn: looks to +z
  return builder;
}

TEST(Gltf, CamerasOfBothKindsAreFoundWithTheirPlaces) {
  const std::vector<GltfCamera> cameras = parse(with_cameras().text()).model.cameras;
  ASSERT_EQ(cameras.size(), 3u);
  const CameraRequest first = choose_camera(cameras, {});
  EXPECT_EQ(first.eye, (Vec3{0.3, 0.3, 4}));
  EXPECT_NEAR(*first.fov, 1.5 * 180 / 3.14159265358979, 1e-9);
  EXPECT_EQ(first.near, 0.5);
  EXPECT_EQ(first.far, 20);
  EXPECT_LT(normalized(subtract(*first.target, *first.eye))[2], -0.999);
  EXPECT_EQ(choose_camera(cameras, parse_camera("name=wide")), first);
  EXPECT_EQ(choose_camera(cameras, parse_camera("name=endless;near=1")).near, 1);
  EXPECT_TRUE(std::isinf(*choose_camera(cameras, parse_camera("name=1")).far));
  const CameraRequest flat = choose_camera(cameras, parse_camera("name=flat"));
  EXPECT_EQ(flat.ortho, 4);
  EXPECT_EQ(flat.near, 0);
  EXPECT_GT(normalized(subtract(*flat.target, *flat.eye))[2], 0.999);
  EXPECT_EQ(choose_camera(cameras, parse_camera("fov=30")), parse_camera("fov=30"));  // the default framing, narrower
  EXPECT_EQ(choose_camera({}, {}), CameraRequest());
  try {
    (void)choose_camera(cameras, parse_camera("name=nobody"));
    ADD_FAILURE() << "a camera that is not there was found";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "--camera: no camera 'nobody' in this scene; there are wide, endless, flat");
  }
}

TEST(Gltf, AnInfiniteFarPlaneIsTheLimitOfFarOnes) {
  const Parsed parsed = parse(with_cameras().text());
  const CameraRequest endless = choose_camera(parsed.model.cameras, parse_camera("name=endless"));
  CameraRequest distant = endless;
  distant.far = 1e15;
  const Scene a = mesh_scene(parsed.model.mesh, endless, 96, 64), b = mesh_scene(parsed.model.mesh, distant, 96, 64);
  for (std::size_t i = 0; i < a.vertices.size(); ++i) EXPECT_NEAR(a.vertices[i].z, b.vertices[i].z, 1e-12);
  EXPECT_EQ(hashes(a), hashes(b));
  // An orthographic view of the same camera has to have an end: it is framed.
  const CameraRequest flat = choose_camera(parsed.model.cameras, parse_camera("name=endless;ortho=2"));
  EXPECT_FALSE(flat.far);
  EXPECT_NE(hashes(mesh_scene(parsed.model.mesh, flat, 96, 64)), hashes(a));
}

TEST(Gltf, FilesFindTheirBuffersBesideThem) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "gltf files";
  std::filesystem::create_directories(folder / "sub folder");
  const GltfBuilder builder = octahedron();
  std::ofstream(folder / "a.gltf", std::ios::binary) << builder.with_uri("sub%20folder/a.bin");
  std::ofstream(folder / "sub folder" / "a.bin", std::ios::binary) << builder.bytes << "more than is asked for";
  std::ofstream(folder / "B.GLB", std::ios::binary) << builder.glb();
  std::vector<std::string> warnings;
  const Scene a = load_scene({.name = (folder / "a.gltf").string(), .width = 64, .height = 48}, warnings);
  const Scene b = load_scene({.name = (folder / "B.GLB").string(), .width = 64, .height = 48}, warnings);
  EXPECT_EQ(hashes(a), hashes(b));
  EXPECT_EQ(a.states.back().cull, Cull::back);
  EXPECT_TRUE(warnings.empty());
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace halfplane::gltf_test
