// Random and stressful triangles of eight families, for every test that holds coverage against the oracle.
#pragma once

#include "scene_builder.hpp"
#include "sim/study/stress/triangle_families.hpp"

namespace halfplane::test {

struct Generator : stress::TriangleFamilies<Random> {
  Generator(const Config& config, int width, int height, std::uint32_t seed)
      : TriangleFamilies(config, width, height, Random(seed)) {}
};

}  // namespace halfplane::test
