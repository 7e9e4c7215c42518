// Animations of glTF files: values between keyframes, and the scene at a time.
#include "sim/scene/gltf_animation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "model/config.hpp"
#include "sim/scene/gltf.hpp"
#include "tests/gltf_builder.hpp"

namespace halfplane::gltf_animation_test {
namespace {

using test::GltfBuilder;
using Json = GltfBuilder::Json;
using Values = std::array<double, 4>;

/// A triangle whose node is moved along `path` by one sampler.
GltfBuilder moved(const std::string& path, const std::string& interpolation, const std::vector<double>& times,
                  const std::vector<double>& values, const Json& node = Json::object()) {
  GltfBuilder builder;
  builder.mesh(builder.accessor(GltfBuilder::f32, 3, {0, 0, 0, 1, 0, 0, 0, 1, 0}), node);
  const std::size_t input = builder.accessor(GltfBuilder::f32, 1, times);
  const std::size_t output = builder.accessor(GltfBuilder::f32, path == "rotation" ? 4 : 3, values);
  builder.json["animations"] = {
      {{"name", "move"},
       {"samplers", {{{"input", input}, {"output", output}, {"interpolation", interpolation}}}},
       {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", path}}}}}}}};
  return builder;
}

GltfWorld world_of(const GltfBuilder& builder) {
  std::vector<std::string> warnings;
  const auto none = [](const std::string&) { return std::optional<std::string>(); };
  return parse_gltf_world(builder.text(), "test.gltf", none, warnings);
}

GltfAnimation animation_of(const GltfBuilder& builder) { return read_animation(*world_of(builder).file, 0); }

/// The place of the triangle's corner `i` at a time.
Vec3 corner_at(const GltfBuilder& builder, double time, std::size_t i) {
  const GltfWorld world = world_of(builder);
  const GltfAnimation animation = read_animation(*world.file, 0);
  return posed(world, &animation, time).mesh.vertices[i].position;
}

void expect_near(const Vec3& got, const Vec3& wanted) {
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(got[i], wanted[i], 1e-6) << i;
}

TEST(GltfAnimation, LinearTranslationGoesStraightAndStaysAtItsEnds) {
  const GltfBuilder b = moved("translation", "LINEAR", {1, 2, 4}, {0, 0, 0, 8, 0, 0, 8, 4, 0});
  for (const auto& [time, wanted] : std::vector<std::pair<double, Vec3>>{
           {0, {0, 0, 0}}, {1, {0, 0, 0}}, {1.25, {2, 0, 0}}, {2, {8, 0, 0}}, {3, {8, 2, 0}}, {9, {8, 4, 0}}}) {
    SCOPED_TRACE(time);
    expect_near(corner_at(b, time, 0), wanted);
  }
  EXPECT_EQ(animation_of(b).end, 4);
}

TEST(GltfAnimation, TheNumberThatAnExporterWritesForLinearIsTaken) {
  GltfBuilder b = moved("translation", "LINEAR", {0, 1}, {0, 0, 0, 8, 0, 0});
  b.json["animations"][0]["samplers"][0]["interpolation"] = 0;
  expect_near(corner_at(b, 0.25, 0), {2, 0, 0});
  b.json["animations"][0]["samplers"][0]["interpolation"] = 1;
  EXPECT_THROW((void)animation_of(b), InputError);
}

TEST(GltfAnimation, StepsChangeAtTheirKeyframeAndNotBefore) {
  const GltfBuilder b = moved("scale", "STEP", {0, 1}, {1, 1, 1, 3, 3, 3});
  expect_near(corner_at(b, std::nextafter(1.0, 0.0), 1), {1, 0, 0});
  expect_near(corner_at(b, 1, 1), {3, 0, 0});
}

TEST(GltfAnimation, LinearRotationTurnsAtConstantSpeedAlongTheShorterArc) {
  const double half = std::sqrt(0.5);
  // 0 to 90 degrees about z; the second keyframe as q and as -q, which is the same rotation.
  for (const double sign : {1.0, -1.0}) {
    const GltfBuilder b = moved("rotation", "LINEAR", {0, 3}, {0, 0, 0, 1, 0, 0, sign * half, sign * half});
    for (const double time : {0.0, 1.0, 1.5, 2.0, 3.0}) {
      SCOPED_TRACE(time);
      const double angle = time / 3 * std::numbers::pi / 2;
      expect_near(corner_at(b, time, 1), {std::cos(angle), std::sin(angle), 0});
    }
  }
}

TEST(GltfAnimation, ACubicSplineIsHermitesPolynomial) {
  // In-tangent, value, out-tangent of two keyframes 2 s apart; x alone. p(t) with p0 = 1, m0 = 3, p1 = 5, m1 = -2.
  const GltfBuilder b =
      moved("translation", "CUBICSPLINE", {1, 3}, {9, 0, 0, 1, 0, 0, 3, 0, 0, -2, 0, 0, 5, 0, 0, 9, 0, 0});
  for (const double s : {0.0, 0.25, 0.5, 0.8, 1.0}) {
    SCOPED_TRACE(s);
    const double x = (1 + 2 * s) * (1 - s) * (1 - s) * 1 + s * (1 - s) * (1 - s) * 2 * 3 + s * s * (3 - 2 * s) * 5 +
                     s * s * (s - 1) * 2 * -2;
    expect_near(corner_at(b, 1 + 2 * s, 0), {x, 0, 0});
  }
}

TEST(GltfAnimation, ASplineOfRotationsHasLengthOne) {
  const GltfBuilder b = moved("rotation", "CUBICSPLINE", {0, 1},
                              {0, 0, 0, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0});
  const GltfAnimation animation = animation_of(b);
  for (const double time : {0.1, 0.5, 0.9}) {
    const Values q = value_at(animation.tracks[0], time);
    EXPECT_NEAR(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3], 1, 1e-12);
  }
}

TEST(GltfAnimation, ChildrenMoveWithTheirParent) {
  GltfBuilder b = moved("translation", "LINEAR", {0, 1}, {0, 0, 0, 10, 0, 0});
  b.json["nodes"].push_back({{"mesh", 0}, {"translation", {0, 5, 0}}});
  b.json["nodes"][0]["children"] = {1};
  expect_near(corner_at(b, 0.5, 3), {5, 5, 0});  // the child's first corner
}

TEST(GltfAnimation, ANodeThatTurnsInsideOutKeepsItsFrontInFront) {
  const GltfBuilder b = moved("scale", "LINEAR", {0, 1}, {1, 1, 1, -1, 1, 1});
  const GltfWorld world = world_of(b);
  const GltfAnimation animation = read_animation(*world.file, 0);
  for (const double time : {0.0, 1.0}) {
    const Mesh mesh = posed(world, &animation, time).mesh;
    const auto& t = mesh.triangles[0];
    const Vec3 a = subtract(mesh.vertices[t[1]].position, mesh.vertices[t[0]].position);
    const Vec3 c = subtract(mesh.vertices[t[2]].position, mesh.vertices[t[0]].position);
    EXPECT_GT(cross(a, c)[2], 0) << time;
  }
}

TEST(GltfAnimation, AtRestNothingOfTheAnimationIsSeen) {
  const GltfBuilder b = moved("translation", "LINEAR", {0, 1}, {7, 7, 7, 9, 9, 9});
  expect_near(posed(world_of(b)).mesh.vertices[0].position, {0, 0, 0});
}

TEST(GltfAnimation, AreChosenByNameOrNumber) {
  GltfBuilder b = moved("translation", "LINEAR", {0, 1}, {0, 0, 0, 1, 1, 1});
  b.json["animations"].push_back(b.json["animations"][0]);
  b.json["animations"][1]["name"] = "other";
  const GltfWorld world = world_of(b);
  EXPECT_EQ(choose_animation(*world.file, ""), 0u);
  EXPECT_EQ(choose_animation(*world.file, "other"), 1u);
  EXPECT_EQ(choose_animation(*world.file, "1"), 1u);
  EXPECT_THROW((void)choose_animation(*world.file, "none"), InputError);
  EXPECT_THROW((void)choose_animation(*world.file, "2"), InputError);
}

std::string refusal(const GltfBuilder& builder) {
  try {
    (void)animation_of(builder);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(GltfAnimation, WhatIsNoneIsRefusedWithItsPlace) {
  const auto expect_refusal = [](const GltfBuilder& b, const std::string& part) {
    EXPECT_NE(refusal(b).find(part), std::string::npos) << refusal(b);
    EXPECT_EQ(refusal(b).find('\n'), std::string::npos);
  };
  expect_refusal(moved("translation", "LINEAR", {0, 0}, {0, 0, 0, 1, 1, 1}), "keyframe 1 is not later");
  expect_refusal(moved("translation", "LINEAR", {-1, 0}, {0, 0, 0, 1, 1, 1}), "keyframe 0 is not later");
  expect_refusal(moved("translation", "LINEAR", {0, 1}, {0, 0, 0}), "1 elements where keyframes need 2");
  expect_refusal(moved("translation", "CUBICSPLINE", {0, 1}, {0, 0, 0, 1, 1, 1}), "2 elements where keyframes need 6");
  expect_refusal(moved("translation", "SMOOTH", {0, 1}, {0, 0, 0, 1, 1, 1}), "interpolation 'SMOOTH'");
  expect_refusal(moved("rotation", "LINEAR", {0}, {0, 0, 0, 0}), "a rotation of length 0");
  const Json still = {{"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}};
  expect_refusal(moved("translation", "LINEAR", {0}, {0, 0, 0}, still), "moves a node that has a matrix");
  GltfBuilder nowhere = moved("translation", "LINEAR", {0}, {0, 0, 0});
  nowhere.json["animations"][0]["channels"][0]["target"]["node"] = 4;
  expect_refusal(nowhere, "animations[0].channels[0].target.node");
}

}  // namespace
}  // namespace halfplane::gltf_animation_test
