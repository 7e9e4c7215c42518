// Skins and morph targets of glTF files: where their vertices are, at rest and at a time.
#include "sim/scene/gltf_deform.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "model/config.hpp"
#include "sim/scene/gltf.hpp"
#include "tests/gltf_builder.hpp"

namespace halfplane::gltf_deform_test {
namespace {

using test::GltfBuilder;
using Json = GltfBuilder::Json;
constexpr GltfBuilder::Component kF32 = GltfBuilder::f32;

GltfWorld world_of(const GltfBuilder& builder, std::vector<std::string>* said = nullptr) {
  std::vector<std::string> warnings;
  const auto none = [](const std::string&) { return std::optional<std::string>(); };
  GltfWorld world = parse_gltf_world(builder.text(), "test.gltf", none, warnings);
  if (said != nullptr) *said = warnings;
  return world;
}

Mesh mesh_at(const GltfBuilder& builder, double time) {
  const GltfWorld world = world_of(builder);
  const GltfAnimation animation = read_animation(*world.file, 0);
  return posed(world, &animation, time).mesh;
}

void expect_near(const Vec3& got, const Vec3& wanted) {
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(got[i], wanted[i], 1e-6) << i;
}

void animate(GltfBuilder& builder, std::size_t node, const char* path, const std::vector<double>& times,
             std::size_t output, const char* interpolation = "LINEAR") {
  const std::size_t input = builder.accessor(kF32, 1, times);
  builder.json["animations"] = {
      {{"samplers", {{{"input", input}, {"output", output}, {"interpolation", interpolation}}}},
       {"channels", {{{"sampler", 0}, {"target", {{"node", node}, {"path", path}}}}}}}};
}

/// A triangle 0 0 0, 1 0 0, 0 1 0 with the normal of z, at node 0, which is 50 along x; its corners hang on the joints
/// `of_corner`, which are node 1 at 0 0 1 and its child node 2 at 1 0 0 from there.
GltfBuilder skinned(const std::vector<double>& joint_of_corner, const std::vector<double>& weights) {
  GltfBuilder builder;
  Json& primitive =
      builder.mesh(builder.accessor(kF32, 3, {0, 0, 0, 1, 0, 0, 0, 1, 0}), {{"skin", 0}, {"translation", {50, 0, 0}}});
  primitive["attributes"]["NORMAL"] = builder.accessor(kF32, 3, {0, 0, 1, 0, 0, 1, 0, 0, 1});
  primitive["attributes"]["JOINTS_0"] = builder.accessor(GltfBuilder::u8, 4, joint_of_corner);
  primitive["attributes"]["WEIGHTS_0"] = builder.accessor(kF32, 4, weights);
  builder.root({{"translation", {0, 0, 1}}, {"children", {2}}});
  builder.json["nodes"].push_back({{"translation", {1, 0, 0}}});
  builder.json["skins"] = {{{"joints", {1, 2}}}};
  return builder;
}

void add_inverses(GltfBuilder& builder, const std::vector<double>& matrices) {
  const std::size_t view = builder.view(GltfBuilder::packed(kF32, matrices));
  builder.json["accessors"].push_back(
      {{"bufferView", view}, {"componentType", kF32}, {"count", matrices.size() / 16}, {"type", "MAT4"}});
  builder.json["skins"][0]["inverseBindMatrices"] = builder.json["accessors"].size() - 1;
}

// Column by column: the inverses of the joints' rest transforms.
const std::vector<double> kInverses{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0,  0, -1, 1,   // joint 0
                                    1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, 0, -1, 1};  // joint 1
const std::vector<double> kOneJointEach{0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0};
const std::vector<double> kWhole{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};

TEST(GltfSkin, AtRestAMeshIsWhereItsJointsHaveIt) {
  GltfBuilder builder = skinned(kOneJointEach, kWhole);
  const Mesh without = posed(world_of(builder)).mesh;
  expect_near(without.vertices[0].position, {0, 0, 1});  // joint 0, not the mesh's node
  expect_near(without.vertices[1].position, {2, 0, 1});  // joint 1 below joint 0
  expect_near(without.vertices[2].position, {0, 1, 1});
  add_inverses(builder, kInverses);
  std::vector<std::string> warnings;
  const Mesh bound = posed(world_of(builder, &warnings)).mesh;
  expect_near(bound.vertices[0].position, {0, 0, 0});
  expect_near(bound.vertices[1].position, {1, 0, 0});
  EXPECT_TRUE(warnings.empty());
}

TEST(GltfSkin, AJointThatTurnsTakesItsVerticesAndTheirNormalsAlong) {
  GltfBuilder builder = skinned(kOneJointEach, kWhole);
  add_inverses(builder, kInverses);
  const double half = std::sqrt(0.5);  // joint 1 by 90 degrees about x
  animate(builder, 2, "rotation", {0, 1}, builder.accessor(kF32, 4, {0, 0, 0, 1, half, 0, 0, half}));
  // Corner 1 is 1 behind the joint, which is at 1 0 1.
  const Mesh mesh = mesh_at(builder, 1);
  expect_near(mesh.vertices[1].position, {1, 1, 1});
  expect_near(mesh.vertices[1].normal, {0, -1, 0});
  expect_near(mesh.vertices[0].normal, {0, 0, 1});
  animate(builder, 1, "rotation", {0, 1}, builder.accessor(kF32, 4, {0, 0, 0, 1, 0, 0, half, half}));
  expect_near(mesh_at(builder, 1).vertices[1].position, {0, 1, 0});  // about z, with its parent
  const double eighth = std::numbers::pi / 4;
  expect_near(mesh_at(builder, 0.5).vertices[1].position, {std::cos(eighth), std::sin(eighth), 0});
}

TEST(GltfSkin, WeightsShareAVertexAndAddUpToOne) {
  // Corner 1 hangs on both joints, by weights that are three times too large; the third, without weight, names none.
  std::vector<double> joints = kOneJointEach, weights = kWhole;
  for (const auto& [k, joint, weight] : {std::tuple{4, 0, 0.75}, {5, 1, 2.25}, {6, 9, 0.0}}) {
    joints[static_cast<std::size_t>(k)] = joint;
    weights[static_cast<std::size_t>(k)] = weight;
  }
  GltfBuilder builder = skinned(joints, weights);
  add_inverses(builder, kInverses);
  animate(builder, 2, "translation", {0, 1}, builder.accessor(kF32, 3, {1, 0, 0, 1, 8, 0}));
  expect_near(mesh_at(builder, 1).vertices[1].position, {1, 6, 0});
  expect_near(mesh_at(builder, 1).vertices[0].position, {0, 0, 0});
}

TEST(GltfSkin, EightJointsOfAVertexCount) {
  GltfBuilder builder = skinned(kOneJointEach, kWhole);
  add_inverses(builder, kInverses);
  Json& attributes = builder.json["meshes"][0]["primitives"][0]["attributes"];
  attributes["JOINTS_1"] = builder.accessor(GltfBuilder::u16, 4, {1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
  attributes["WEIGHTS_1"] = builder.accessor(kF32, 4, {1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
  animate(builder, 2, "translation", {0, 1}, builder.accessor(kF32, 3, {1, 0, 0, 1, 0, 4}));
  expect_near(mesh_at(builder, 1).vertices[0].position, {0, 0, 2});  // half of joint 1
}

TEST(GltfSkin, JointsThatMirrorTurnTrianglesRound) {
  GltfBuilder builder = skinned(kOneJointEach, kWhole);
  builder.json["nodes"][1]["scale"] = {1, 1, -1};
  const Mesh mesh = posed(world_of(builder)).mesh;
  EXPECT_EQ(mesh.triangles[0], (std::array<std::uint32_t, 3>{0, 2, 1}));
  builder.json["nodes"][1].erase("scale");
  builder.json["nodes"][0]["scale"] = {1, 1, -1};  // the mesh's own node has no effect
  EXPECT_EQ(posed(world_of(builder)).mesh.triangles[0], (std::array<std::uint32_t, 3>{0, 1, 2}));
}

TEST(GltfSkin, WithoutJointsInTheSceneAMeshIsWhereItsNodeIs) {
  GltfBuilder builder = skinned(kOneJointEach, kWhole);
  builder.json["scenes"][0]["nodes"] = Json::array({0});
  std::vector<std::string> warnings;
  expect_near(posed(world_of(builder, &warnings)).mesh.vertices[1].position, {51, 0, 0});
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].find("skins with joints outside of the scene"), std::string::npos);
  // Nor does a primitive without joints care for the skin of its node.
  GltfBuilder bare = skinned(kOneJointEach, kWhole);
  bare.json["meshes"][0]["primitives"][0]["attributes"].erase("JOINTS_0");
  expect_near(posed(world_of(bare)).mesh.vertices[1].position, {51, 0, 0});
}

TEST(GltfSkin, WhatIsNoneIsRefusedWithItsPlace) {
  const auto message = [](const GltfBuilder& builder) -> std::string {
    try {
      (void)world_of(builder);
    } catch (const InputError& error) {
      return error.what();
    }
    return "nothing";
  };
  std::vector<double> joints = kOneJointEach;
  joints[4] = 2;
  EXPECT_NE(message(skinned(joints, kWhole)).find("element 1 is a joint of 2 that is not there"), std::string::npos);
  GltfBuilder builder = skinned(kOneJointEach, kWhole);
  builder.json["nodes"][0]["skin"] = 1;
  EXPECT_NE(message(builder).find("nodes[0].skin"), std::string::npos);
  builder = skinned(kOneJointEach, kWhole);
  builder.json["skins"][0]["joints"] = Json::array();
  EXPECT_NE(message(builder).find("skins[0].joints: no joints"), std::string::npos);
  builder = skinned(kOneJointEach, kWhole);
  add_inverses(builder, std::vector<double>(kInverses.begin(), kInverses.begin() + 16));
  EXPECT_NE(message(builder).find("1 elements where 2 are needed"), std::string::npos);
  builder.json["skins"][0]["inverseBindMatrices"] = 0;
  EXPECT_NE(message(builder).find("use MAT4"), std::string::npos);
  builder = skinned(kOneJointEach, {1, 0, 0, 0});
  EXPECT_NE(message(builder).find("1 elements where 3 are needed"), std::string::npos);
}

// ---- morph targets

/// A triangle 0 0 0, 1 0 0, 0 1 0 with two targets: z of corner 0 by 1, and corner 1 along x by 2 with the normal of x.
GltfBuilder morphed() {
  GltfBuilder builder;
  Json& primitive = builder.mesh(builder.accessor(kF32, 3, {0, 0, 0, 1, 0, 0, 0, 1, 0}));
  primitive["attributes"]["NORMAL"] = builder.accessor(kF32, 3, {0, 0, 1, 0, 0, 1, 0, 0, 1});
  primitive["targets"] = {{{"POSITION", builder.accessor(kF32, 3, {0, 0, 1, 0, 0, 0, 0, 0, 0})}},
                          {{"POSITION", builder.accessor(kF32, 3, {0, 0, 0, 2, 0, 0, 0, 0, 0})},
                           {"NORMAL", builder.accessor(kF32, 3, {0, 0, 0, 1, 0, -1, 0, 0, 0})}}};
  return builder;
}

TEST(GltfMorph, WeightsAtRestAreTheMeshsOrItsNodes) {
  GltfBuilder builder = morphed();
  expect_near(posed(world_of(builder)).mesh.vertices[0].position, {0, 0, 0});
  builder.json["meshes"][0]["weights"] = {0.5, 1};
  Mesh mesh = posed(world_of(builder)).mesh;
  expect_near(mesh.vertices[0].position, {0, 0, 0.5});
  expect_near(mesh.vertices[1].position, {3, 0, 0});
  expect_near(mesh.vertices[1].normal, {1, 0, 0});
  builder.json["nodes"][0]["weights"] = {-2, 0};
  mesh = posed(world_of(builder)).mesh;
  expect_near(mesh.vertices[0].position, {0, 0, -2});
  expect_near(mesh.vertices[1].position, {1, 0, 0});
}

TEST(GltfMorph, AnAnimationMovesEachWeight) {
  GltfBuilder builder = morphed();
  builder.json["nodes"][0]["scale"] = {10, 10, 10};  // after the targets
  animate(builder, 0, "weights", {0, 2}, builder.accessor(kF32, 1, {0, 1, 1, 0}));
  const Mesh mesh = mesh_at(builder, 0.5);
  expect_near(mesh.vertices[0].position, {0, 0, 2.5});
  expect_near(mesh.vertices[1].position, {25, 0, 0});
  // Hermite: 0 with a slope of 2 a second, to 0 with none; half way along one second.
  animate(builder, 0, "weights", {0, 1}, builder.accessor(kF32, 1, {0, 0, 0, 1, 2, 0, 0, 0, 0, 1, 0, 0}),
          "CUBICSPLINE");
  expect_near(mesh_at(builder, 0.5).vertices[0].position, {0, 0, 10 * 0.25});
  expect_near(mesh_at(builder, 0.5).vertices[1].position, {30, 0, 0});
}

TEST(GltfMorph, ASkinCarriesWhatTheTargetsMade) {
  GltfBuilder builder = skinned(kOneJointEach, kWhole);
  builder.json["meshes"][0]["primitives"][0]["targets"] = {
      {{"POSITION", builder.accessor(kF32, 3, {0, 0, 0, 0, 3, 0, 0, 0, 0})}}};
  builder.json["meshes"][0]["weights"] = {1};
  builder.json["nodes"][2]["scale"] = {2, 2, 2};
  expect_near(posed(world_of(builder)).mesh.vertices[1].position, {3, 6, 1});
}

TEST(GltfMorph, FacesWithoutNormalsAreFlatAsTheyAreNow) {
  GltfBuilder builder = test::one_triangle();
  builder.json["meshes"][0]["primitives"][0]["targets"] = {
      {{"POSITION", builder.accessor(kF32, 3, {0, 0, 0, 0, 0, 0, 0, -1, 1})}}};
  builder.json["meshes"][0]["weights"] = {1};
  expect_near(posed(world_of(builder)).mesh.vertices[0].normal, {0, -1, 0});
}

TEST(GltfMorph, WhatIsNoneIsRefusedWithItsPlace) {
  GltfBuilder builder = morphed();
  animate(builder, 0, "weights", {0, 2}, builder.accessor(kF32, 1, {0, 1, 1}));
  const GltfWorld world = world_of(builder);
  EXPECT_THROW((void)read_animation(*world.file, 0), InputError);
  builder = morphed();
  builder.json["meshes"][0]["primitives"][0]["targets"][0]["POSITION"] = builder.accessor(kF32, 3, {0, 0, 1});
  EXPECT_THROW((void)world_of(builder), InputError);
  builder = morphed();
  builder.json["meshes"][0]["weights"] = {1e31, 0};
  EXPECT_THROW((void)world_of(builder), InputError);
}

}  // namespace
}  // namespace halfplane::gltf_deform_test
