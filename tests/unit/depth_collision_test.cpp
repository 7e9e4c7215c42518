// Places that depth codes do not separate are found, and the suggested settings separate them.
#include "sim/scene/depth_collision.hpp"

#include <gtest/gtest.h>

#include "../scene_builder.hpp"
#include "sim/scene/builtin.hpp"

namespace halfplane::depth_collision_test {
namespace {

/// Two squares before the eye, at two distances, as a camera with these planes projects them.
Scene squares(double near, double far, double first, double second) {
  test::SceneBuilder builder(64, 64, State());
  for (const double w : {first, second}) {
    const double z = w * (far + near) / (far - near) - 2 * far * near / (far - near);
    const auto corner = [&](double x, double y) { return test::clip_at(x * w, y * w, z, w); };
    builder.triangle(corner(-0.5, -0.5), corner(0.5, -0.5), corner(0.5, 0.5));
  }
  builder.scene.planes = {near, far};
  return builder.scene;
}

TEST(DepthCollision, WhatIsAdvisedTellsThePlacesApart) {
  Config config = preset("embedded");
  const auto found = depth_collision(squares(0.05, 1e6, 1500, 1800), config);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->nearer, 1500);
  EXPECT_EQ(found->farther, 1800);
  EXPECT_EQ(found->bits, 16);
  EXPECT_EQ(text(*found).rfind("distances 1500 and 1800 have one depth code of 16 bits: ", 0), 0u) << text(*found);
  ASSERT_TRUE(found->near_enough && found->enough_bits);
  EXPECT_FALSE(depth_collision(squares(*found->near_enough, 1e6, 1500, 1800), config));
  config.depth_bits = *found->enough_bits;
  EXPECT_FALSE(depth_collision(squares(0.05, 1e6, 1500, 1800), config));
  config.depth_bits -= 3;
  EXPECT_TRUE(depth_collision(squares(0.05, 1e6, 1500, 1800), config)) << "fewer would not";
}

TEST(DepthCollision, NeighboursAndWhatIsNotOrderedByDepthAreNone) {
  const Config config = preset("embedded");
  EXPECT_FALSE(depth_collision(squares(0.05, 1e6, 1500, 1510), config)) << "within a twentieth";
  Scene scene = squares(0.05, 1e6, 1500, 1800);
  scene.states[0].depth_test = DepthFunc::always;
  EXPECT_FALSE(depth_collision(scene, config));
  for (const Builtin& builtin : all_builtin_scenes())
    EXPECT_FALSE(depth_collision(make_builtin(std::string(builtin.name), 320, 240, {}, 1), config)) << builtin.name;
}

}  // namespace
}  // namespace halfplane::depth_collision_test
