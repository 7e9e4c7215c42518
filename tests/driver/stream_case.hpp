// A random frame twice: as a scene for the model's --transform s15.16, and as calls of the driver.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "../scene_builder.hpp"
#include "driver/halfplane.h"
#include "model/config.hpp"
#include "model/scene.hpp"

namespace halfplane::test {

/// The configuration that the linked driver is compiled for.
[[nodiscard]] const Config& driver_config();

/// A target of the driver with all its buffers at 0.
[[nodiscard]] hp_target target_of(int width, int height);

/// A frame, and the words and texture memory that the driver makes of it.
struct StreamCase {
  Scene scene;
  std::vector<std::uint32_t> words;
  std::vector<std::uint8_t> textures;
  hp_counts counts{};
  std::uint32_t status = 0;
};

/// `primitives`: their approximate number. Vertices, states, clears and topologies at random.
[[nodiscard]] StreamCase random_case(std::uint32_t seed, int primitives);

}  // namespace halfplane::test
