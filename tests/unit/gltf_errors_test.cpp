// The glTF reader on files that it must refuse: one line, with the file, the place in it and the mend.
#include <gtest/gtest.h>

#include <limits>

#include "model/config.hpp"
#include "sim/scene/gltf.hpp"
#include "tests/gltf_builder.hpp"

namespace halfplane::gltf_errors_test {
namespace {

using test::GltfBuilder;
using Json = GltfBuilder::Json;

// The message with which a file is refused; empty if it is taken.
std::string refusal(const std::string& bytes, std::size_t most_triangles = kMostGltfTriangles) {
  std::vector<std::string> warnings;
  const auto none = [](const std::string&) { return std::optional<std::string>(); };
  try {
    (void)parse_gltf(bytes, "bad.gltf", none, warnings, most_triangles);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

void expect_refusal(const std::string& bytes, const std::string& part) {
  const std::string message = refusal(bytes);
  EXPECT_EQ(message.find("bad.gltf:"), 0u) << "wanted: " << part << "; got: " << message;
  EXPECT_NE(message.find(part), std::string::npos) << "wanted: " << part << "; got: " << message;
  EXPECT_NE(message.find("; "), std::string::npos) << "no mend in: " << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

// A triangle with indices, colours, a camera and a sparse accessor: all is well until `damage` is done to it.
GltfBuilder good() {
  GltfBuilder b = test::one_triangle();
  Json& primitive = b.json["meshes"][0]["primitives"][0];
  primitive["indices"] = b.accessor(GltfBuilder::u8, 1, {0, 1, 2});                                   // accessor 1
  primitive["attributes"]["COLOR_0"] = b.accessor(GltfBuilder::u8, 3, std::vector<double>(9), true);  // 2
  primitive["material"] = 0;
  b.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 1}}}}}};
  b.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}}};
  b.root({{"camera", 0}});
  const std::size_t indices = b.view(GltfBuilder::packed(GltfBuilder::u8, {0, 2}));
  const std::size_t values = b.view(GltfBuilder::packed(GltfBuilder::f32, {0, 0, 1, 0, 1, 1}));
  b.json["accessors"][0]["sparse"] = {{"count", 2},
                                      {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
                                      {"values", {{"bufferView", values}}}};
  return b;
}

struct Damage {
  const char* pointer;  ///< a JSON pointer
  const char* value;    ///< JSON to put there; empty: the member is removed
  const char* message;  ///< part of the message
};

const Damage kDamages[] = {
    {"/asset", "", "no asset"},
    {"/asset/version", "\"1.0\"", "glTF of version '1.0'"},
    {"/asset/minVersion", "\"2.1\"", "glTF of version '2.1'"},
    {"/asset/version", "2", "asset.version: not a string"},
    {"/extensionsRequired", "[\"KHR_meshopt_compression\"]", "extensionsRequired[0]: the file needs 'KHR_meshopt"},
    {"/extensionsRequired", "[\"KHR_meshopt_compression\"]", "unpack it with `gltfpack -noq -i IN.glb -o OUT.glb`"},
    {"/extensionsRequired", "[\"KHR_texture_transform\", \"EXT_other_geometry\"]", "extensionsRequired[1]"},
    {"/extensionsRequired", "[\"EXT_other_geometry\"]", "export it without that extension"},
    {"/extensionsRequired", "[\"KHR_materials_pbrSpecularGlossiness\"]", "export it without that extension"},
    {"/extensionsRequired", "{}", "not a list"},
    {"/scene", "1", "index 1 of 1 scenes"},
    {"/scenes/0/nodes", "[0, 9]", "scenes[0].nodes[1]: index 9 of 2 nodes"},
    {"/scenes/0/nodes", "[]", "nothing in its scene that could be drawn"},
    {"/nodes/0/mesh", "-1", "nodes[0].mesh: not a whole number"},
    {"/nodes/0/mesh", "0.5", "not a whole number"},
    {"/nodes/0/mesh", "\"0\"", "not a number"},
    {"/nodes/0/mesh", "1", "index 1 of 1 meshes"},
    {"/nodes/0/children", "[0]", "the child of two nodes, or its own ancestor"},
    {"/nodes/0/children", "[1]", "the child of two nodes, or its own ancestor"},
    {"/nodes/0/rotation", "[0, 0, 0, 0]", "length 0"},
    {"/nodes/0/rotation", "[0, 0, 1]", "3 numbers; write 4"},
    {"/nodes/0/scale", "[1, 1e200, 1]", "nodes[0].scale[1]: beyond"},
    {"/nodes/0/matrix", "[1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,2]", "a last row"},
    {"/nodes/0", "{\"mesh\": 0, \"matrix\": [1], \"scale\": [1, 1, 1]}", "a matrix besides"},
    {"/nodes/0/translation", "[1e30, 1e30, 1e30]", ""},  // within the range: taken
    {"/nodes/0/name", "3", "nodes[0].name: not a string"},
    {"/nodes/1/scale", "[1, 0, 1]", "axes are scaled to 0"},
    {"/nodes/1/camera", "3", "index 3 of 1 cameras"},
    {"/cameras/0/type", "\"fisheye\"", "type 'fisheye'"},
    {"/cameras/0/perspective", "", "no perspective"},
    {"/cameras/0/perspective/yfov", "3.2", "not below pi"},
    {"/cameras/0/perspective/znear", "0", "not a number above 0"},
    {"/cameras/0/perspective/zfar", "1", "znear is not nearer"},
    {"/meshes/0/primitives/0/mode", "1", "corners make no whole lines"},
    {"/meshes/0/primitives/0/mode", "7", "not a whole number of 0...6"},
    {"/meshes/0/primitives/0/attributes", "", "no attributes"},
    {"/meshes/0/primitives/0/attributes/POSITION", "1", "1 numbers an element; use VEC3"},
    {"/meshes/0/primitives/0/attributes/POSITION", "7", "index 7 of 3 accessors"},
    {"/meshes/0/primitives/0/indices", "0", "3 numbers an element; use SCALAR"},
    {"/meshes/0/primitives/0/material", "5", "index 5 of 1 materials"},
    {"/materials/0/doubleSided", "1", "neither true nor false"},
    {"/materials/0/pbrMetallicRoughness/baseColorFactor", "[1]", "1 numbers; write 4"},
    {"/accessors/0/count", "0", "no elements"},
    {"/accessors/0/count", "1e18", "not a whole number of 0...4294967295"},
    {"/accessors/0/count", "4", "4 elements need 48 bytes of a buffer view of 36"},
    {"/accessors/0/byteOffset", "4", "3 elements need 40 bytes"},
    {"/accessors/0/type", "\"MAT3\"", "type 'MAT3'"},
    {"/accessors/0/type", "\"VEC9\"", "type 'VEC9'"},
    {"/accessors/0/componentType", "5124", "component type 5124"},
    {"/accessors/0/bufferView", "99", "index 99 of 5 bufferViews"},
    {"/accessors/1/componentType", "5120", "indices that are no unsigned whole numbers"},
    {"/accessors/1/normalized", "true", "indices that are no unsigned whole numbers"},
    {"/accessors/1/count", "2", "2 corners make no whole triangles"},
    {"/accessors/2/normalized", "false", "not normalized"},
    {"/accessors/2/count", "2", "2 elements for 3 positions"},
    {"/accessors/0/sparse/count", "4", "not a whole number of 0...3"},
    {"/accessors/0/sparse/count", "3", "3 elements need 3 bytes of a buffer view of 2"},
    {"/accessors/0/sparse/indices", "", "accessors[0].sparse: no indices"},
    {"/accessors/0/sparse/indices/componentType", "5126", "not unsigned"},
    {"/accessors/0/sparse/indices/bufferView", "0", "do not ascend"},
    {"/bufferViews/0/byteStride", "8", "byteStride 8 below the 12 bytes"},
    {"/bufferViews/0/byteStride", "999", "not a whole number of 0...252"},
    {"/bufferViews/0/byteStride", "16", "3 elements need 44 bytes"},
    {"/bufferViews/0/byteLength", "999", "bytes 0...999 of a buffer of"},
    {"/bufferViews/0/byteOffset", "1e12", "of a buffer of"},
    {"/bufferViews/0/buffer", "1", "index 1 of 1 buffers"},
    {"/buffers/0/byteLength", "9999", "byteLength 9999, but there are"},
    {"/buffers/0/uri", "\"data:application/octet-stream;base64,A*\"", "not base64"},
    {"/buffers/0/uri", "\"data:,plain\"", "not base64"},
    {"/buffers/0/uri", "\"/etc/some.bin\"", "no file beside this one"},
    {"/buffers/0/uri", "\"https://example.org/a.bin\"", "no file beside this one"},
    {"/buffers/0/uri", "\"not%20there.bin\"", "'not there.bin' cannot be read"},
    {"/buffers/0/uri", "", "no uri"},
};

TEST(GltfErrors, WhatIsDamagedIsTakenWholeWithoutTheDamage) {
  EXPECT_EQ(refusal(good().text()), "");
  EXPECT_EQ(refusal(good().glb()), "");
}

TEST(GltfErrors, EveryDamageIsRefusedWithItsPlace) {
  for (const Damage& damage : kDamages) {
    SCOPED_TRACE(std::string(damage.pointer) + " = " + damage.value);
    Json json = Json::parse(good().text());
    const Json::json_pointer pointer(damage.pointer);
    if (*damage.value != '\0') {
      json[pointer] = Json::parse(damage.value);
    } else {
      json[pointer.parent_pointer()].erase(pointer.back());
    }
    if (*damage.message != '\0') {
      expect_refusal(json.dump(), damage.message);
    } else {
      EXPECT_EQ(refusal(json.dump()).find('\n'), std::string::npos);
    }
  }
}

TEST(GltfErrors, NumbersThatAreNoneAreRefusedWithTheirElement) {
  for (const double value : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    GltfBuilder b;
    b.mesh(b.accessor(GltfBuilder::f32, 3, {0, 0, 0, 1, value, 0, 0, 1, 0}));
    expect_refusal(b.text(), "accessors[0]: element 1 is not a finite number");
  }
  GltfBuilder b;
  b.mesh(b.accessor(GltfBuilder::f32, 3, {0, 0, 0, 3e38, 0, 0, 0, 1, 0}));
  expect_refusal(b.text(), "nodes[0]: vertex 1 of what is drawn there is beyond 1e30");
}

TEST(GltfErrors, AnIndexPastTheVerticesIsRefusedWithItsPlace) {
  GltfBuilder b = test::one_triangle();
  b.json["meshes"][0]["primitives"][0]["indices"] = b.accessor(GltfBuilder::u32, 1, {0, 1, 4294967294.0});
  expect_refusal(b.text(), "accessors[1]: element 2 is vertex 4294967294 of 3");
}

TEST(GltfErrors, TextThatIsNotJsonIsRefusedWithItsLine) {
  expect_refusal("", "1: not JSON");
  expect_refusal("{\n\"asset\": {\n]", "3: not JSON");
  expect_refusal("{\"asset\": {\"version\": \"2.0\"}, \"x\": 1e999}", "beyond binary64");
  expect_refusal("[]", "not an object");
  expect_refusal(std::string(300000, '['), "not JSON");
}

TEST(GltfErrors, DeepNestingIsNoDanger) {
  std::string text = test::one_triangle().text();
  text.insert(text.size() - 1, ",\"extras\":" + std::string(300000, '[') + std::string(300000, ']'));
  EXPECT_EQ(refusal(text), "");
  GltfBuilder chain = test::one_triangle();
  chain.json["scenes"][0]["nodes"] = {1};
  for (int i = 1; i < 20000; ++i) chain.json["nodes"].push_back({{"children", {i + 1}}});
  chain.json["nodes"].push_back({{"children", {0}}});
  EXPECT_EQ(refusal(chain.text()), "");
}

TEST(GltfErrors, AGlbCutOffAnywhereIsRefused) {
  const std::string whole = good().glb();
  for (std::size_t length = 0; length < whole.size(); ++length) {
    EXPECT_NE(refusal(whole.substr(0, length)), "") << length << " bytes of " << whole.size();
  }
  std::string bad = whole;
  bad[4] = 1;
  expect_refusal(bad, "a .glb of version 1");
  bad = whole;
  bad[16] = 'B';
  expect_refusal(bad, "the first chunk of the .glb is not JSON");
  bad = whole;
  bad[15] = 0x7f;
  expect_refusal(bad, "chunk 0 goes past the end");
}

TEST(GltfErrors, AFewBytesThatAskForBillionsOfTrianglesAreRefused) {
  GltfBuilder zeros = test::one_triangle();
  zeros.json["accessors"][0].erase("bufferView");  // all zero, however many
  zeros.json["accessors"][0]["count"] = 4294967295.0;
  expect_refusal(zeros.text(), "more triangles than are read here");
  GltfBuilder many = test::one_triangle();
  for (int i = 0; i < 9; ++i) many.root({{"mesh", 0}});
  EXPECT_EQ(refusal(many.text(), 20), "");  // ten triangles in ten primitives
  EXPECT_NE(refusal(many.text(), 19), "");
}

}  // namespace
}  // namespace halfplane::gltf_errors_test
