// A camera anywhere, perspective or not, for tests that hold something for all of them.
#pragma once

#include "sim/scene/camera.hpp"
#include "sim/scene/random.hpp"
#include "sim/scene/vec3.hpp"

namespace halfplane::test {

/// Eye and target in -size...size along x and z, in low_y...high_y times that along y; the angle of view from `least_fov`
/// degrees to 120.
inline CameraRequest random_camera(halfplane::Random& random, double size, double low_y, double high_y,
                                   double least_fov) {
  const auto point = [&] {
    return Vec3{random.uniform(-size, size), random.uniform(low_y, high_y) * size, random.uniform(-size, size)};
  };
  CameraRequest camera;
  camera.eye = point();
  camera.target = point();
  camera.near = random.uniform(0.05, 1);
  camera.far = random.uniform(2, 3 * size);
  if (random.uniform(0, 4) < 1)
    camera.ortho = random.uniform(1, size);
  else
    camera.fov = random.uniform(least_fov, 120);
  return camera;
}

}  // namespace halfplane::test
