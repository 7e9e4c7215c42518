// Scenes made from a mesh's materials: states, and the order of blended parts.
#include "sim/scene/mesh_scene.hpp"

#include <gtest/gtest.h>

namespace halfplane::mesh_scene_test {
namespace {

/// Squares that face the camera, one object each, at these distances along z.
Mesh squares(std::initializer_list<std::pair<double, AlphaMode>> parts) {
  Mesh mesh;
  for (const auto& [z, alpha] : parts) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const auto& [x, y] : {std::pair{-1.0, -1.0}, {1.0, -1.0}, {1.0, 1.0}})
      mesh.vertices.push_back({{x, y, z}, {0, 0, 1}, {255, 255, 255, 128}, 0, 0});
    MeshPart part;
    part.object = static_cast<std::uint32_t>(mesh.objects.size());
    part.first = mesh.triangles.size();
    part.count = 1;
    part.alpha = alpha;
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.objects.push_back("z" + std::to_string(mesh.objects.size()));
    mesh.parts.push_back(part);
  }
  return mesh;
}

CameraRequest front_camera(double ortho) {
  CameraRequest request;
  request.eye = Vec3{0, 0, 10};
  request.target = Vec3{0, 0, 0};
  if (ortho > 0) request.ortho = ortho;
  return request;
}

TEST(MeshScene, WhatBlendsIsDrawnBehindAllOthersFarthestFirst) {
  using enum AlphaMode;
  const Mesh mesh = squares({{1, blend}, {-2, blend}, {0, opaque}, {3, mask}, {-1, blend}});
  for (const double ortho : {0.0, 8.0}) {
    const Scene scene = mesh_scene(mesh, front_camera(ortho), 32, 32, Cull::none);
    std::string order;
    for (const Command& command : scene.commands)
      if (const auto* draw = std::get_if<Draw>(&command)) order += scene.objects[draw->object].substr(1);
    EXPECT_EQ(order, "23140") << ortho;
  }
}

TEST(MeshScene, OpacityBecomesAlphaTestAndBlending) {
  Mesh mesh = squares({{0, AlphaMode::mask}, {0, AlphaMode::blend}, {0, AlphaMode::opaque}});
  mesh.parts[0].alpha_cutoff = 0.25;
  const Scene scene = mesh_scene(mesh, front_camera(0), 32, 32, Cull::none);
  std::vector<State> states;
  for (const Command& command : scene.commands)
    if (const auto* draw = std::get_if<Draw>(&command)) states.push_back(scene.states[draw->state]);
  ASSERT_EQ(states.size(), 3u);
  EXPECT_EQ(states[0].alpha_test, (AlphaTest{DepthFunc::gequal, 64}));
  EXPECT_FALSE(states[0].blend);
  EXPECT_EQ(states[1].alpha_test, AlphaTest{}) << "the opaque one comes before the one that blends";
  EXPECT_TRUE(states[1].depth_write);
  ASSERT_TRUE(states[2].blend);
  EXPECT_EQ(states[2].blend->src, BlendFactor::src_alpha);
  EXPECT_EQ(states[2].blend->dst, BlendFactor::one_minus_src_alpha);
  EXPECT_FALSE(states[2].depth_write);
}

}  // namespace
}  // namespace halfplane::mesh_scene_test
