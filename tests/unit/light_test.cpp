// Lighting in fixed point against real arithmetic, and against properties that need neither.
#include "model/light.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "model/golden/light.hpp"
#include "sim/scene/random.hpp"

namespace halfplane::light_test {
namespace {

using golden::Real3;

Real3 random_direction(Random& random) {
  for (;;) {
    Real3 v{};
    for (double& c : v) c = random.uniform(-1, 1);
    const double length = std::hypot(v[0], v[1], v[2]);
    if (length > 0.1 && length < 1) return {v[0] / length, v[1] / length, v[2] / length};
  }
}

TEST(Light, TheSquareRootOfAnIntegerIsItsFloor) {
  for (const std::uint64_t v : {0ULL, 1ULL, 2ULL, 3ULL, 4ULL, 99ULL, 1ULL << 40, (1ULL << 62) - 1, ~0ULL}) {
    const std::uint64_t root = integer_sqrt(v);
    EXPECT_LE(uint128{root} * root, v);
    EXPECT_GT(uint128{root + 1} * (root + 1), v);
  }
  EXPECT_EQ(integer_sqrt(~uint128{0}), ~0ULL);
}

TEST(Light, DirectionsHaveLengthOneWhateverTheVector) {
  Random random(1);
  for (int i = 0; i < 2000; ++i) {
    const Real3 d = random_direction(random);
    const double size = std::exp2(random.uniform(0, 33));
    std::array<std::int64_t, 3> v{};
    for (std::size_t k = 0; k < 3; ++k) v[k] = static_cast<std::int64_t>(d[k] * size);
    const FixedDirection u = fixed_direction(v);
    const double length = std::hypot(static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2]));
    if (length == 0) continue;
    for (std::size_t k = 0; k < 3; ++k)
      ASSERT_NEAR(std::ldexp(u[k], -kDirectionBits), static_cast<double>(v[k]) / length, std::ldexp(1.0, -29));
  }
  EXPECT_EQ(fixed_direction(std::array<std::int64_t, 3>{}), FixedDirection{});
  EXPECT_EQ(fixed_direction(std::array<double, 3>{0, -1e-300, 0}), (FixedDirection{0, -(1 << 30), 0}));
}

TEST(Light, PowersAreThoseOfRealArithmeticWithinTheirBound) {
  Random random(2);
  double worst = 0;
  for (int i = 0; i < 20000; ++i) {
    const auto x = static_cast<std::uint32_t>(std::ldexp(1 - std::exp2(random.uniform(-20, -0.01)), 30));
    const auto n = static_cast<std::uint32_t>(65536 * std::exp2(random.uniform(0, 11)));
    const double real = std::pow(std::ldexp(x, -30), n / 65536.0);
    worst = std::max(worst, std::abs(std::ldexp(fixed_power(x, n), -30) - real));
  }
  // 2047 log2 off by (1/512)^2 / 8 / ln 2 = 7e-7, times ln 2 and x^n |ln x^n| / |log2 x| at its largest: 2.5e-4 there.
  EXPECT_LT(worst, 4e-4);
  RecordProperty("worst", std::to_string(worst));
  EXPECT_EQ(fixed_power(1 << 30, 5000), 1U << 30);
  EXPECT_EQ(fixed_power(0, 65536), 0U);
  EXPECT_EQ(fixed_power(12345, 0), 1U << 30);
  EXPECT_NEAR(fixed_power(1 << 29, 65536), 1 << 29, 2);
}

struct Case {
  Lighting lighting;
  Material material;
  Real3 eye{}, normal{};
};

Case random_case(Random& random, double size) {
  Case c;
  const auto color = [&](std::array<double, 3>& to, double most) {
    for (double& v : to) v = random.uniform(0, most);
  };
  const auto place = [&] {
    const Real3 d = random_direction(random);
    const double far = size * random.uniform(0.05, 1);
    return Real3{d[0] * far, d[1] * far, d[2] * far};
  };
  color(c.lighting.ambient, 0.3);
  c.lighting.has_local_viewer = random.uniform(0, 1) < 0.7;
  for (int i = 0, count = 1 + static_cast<int>(random.next() % 4); i < count; ++i) {
    Light& light = c.lighting.lights.emplace_back();
    const bool is_somewhere = random.uniform(0, 1) < 0.5;
    const Real3 at = is_somewhere ? place() : random_direction(random);
    light.position = {at[0], at[1], at[2], is_somewhere ? 1.0 : 0.0};
    color(light.ambient, 0.2);
    color(light.diffuse, 1);
    color(light.specular, 1);
    if (is_somewhere && random.uniform(0, 1) < 0.7) {
      light.attenuation = {random.uniform(0.1, 1), random.uniform(0, 1) / size, random.uniform(0, 4) / (size * size)};
      if (random.uniform(0, 1) < 0.5) light.range = size * random.uniform(0.3, 2);
    }
    if (is_somewhere && random.uniform(0, 1) < 0.4) {
      light.spot_direction = random_direction(random);
      light.spot_scale = random.uniform(1, 8);
      light.spot_offset = random.uniform(-4, 0);
    }
  }
  color(c.material.ambient, 1);
  color(c.material.diffuse, 1);
  color(c.material.specular, 1);
  if (random.uniform(0, 1) < 0.3) color(c.material.emission, 0.3);
  c.material.shininess = std::exp2(random.uniform(0, 7));
  c.eye = place();
  c.normal = random_direction(random);
  return c;
}

double difference(const Case& c, const Material& material) {
  const FixedLighting fixed(c.lighting, std::max({std::abs(c.eye[0]), std::abs(c.eye[1]), std::abs(c.eye[2])}));
  const auto code = fixed.color(fixed.place(c.eye), fixed_direction(c.normal), material);
  const Real3 real = golden::light_color(c.lighting, c.eye, c.normal, c.material);
  double worst = 0;
  for (std::size_t k = 0; k < 3; ++k) worst = std::max(worst, std::abs(code[k] / 256.0 - real[k]));
  return worst;
}

TEST(Light, ColoursOfVerticesAreWithinAHundredthOfACodeOfRealArithmetic) {
  Random random(3);
  double worst = 0;
  for (int i = 0; i < 100'000; ++i) {
    const Case c = random_case(random, std::exp2(random.uniform(-10, 15)));
    worst = std::max(worst, difference(c, c.material));
    ASSERT_LT(worst, 0.01) << "case " << i;
  }
  RecordProperty("worst_lsb", std::to_string(worst));
  EXPECT_GT(worst, 1.0 / 512);  // a code has 8 fraction bits: the comparison sees its rounding
}

TEST(LightMustFail, AnotherShininessIsSeen) {
  Random random(4);
  int seen = 0;
  for (int i = 0; i < 1000; ++i) {
    const Case c = random_case(random, 10);
    Material other = c.material;
    other.shininess = c.material.shininess * 1.05;
    seen += difference(c, other) > 0.01 ? 1 : 0;
  }
  EXPECT_GT(seen, 200);
}

TEST(Light, WhatIsKnownWithoutArithmetic) {
  Lighting lighting;
  lighting.ambient = {};
  lighting.lights.push_back({});  // along +z, white
  Material material;
  material.diffuse = {1, 0.5, 0};
  const FixedLighting fixed(lighting, 1);
  const auto at = [&](const Real3& normal) {
    return fixed.color(fixed.place({0, 0, -1}), fixed_direction(normal), material);
  };
  EXPECT_EQ(at({0, 0, 1}), (std::array<std::uint16_t, 3>{255 * 256, 255 * 128, 0}));
  EXPECT_EQ(at({0, 0, -1}), (std::array<std::uint16_t, 3>{}));  // turned away
  EXPECT_EQ(at({1, 0, 0}), (std::array<std::uint16_t, 3>{}));
  EXPECT_NEAR(at({std::sqrt(0.75), 0, 0.5})[0], 255 * 128, 1);  // 60 degrees
  material.emission = {1, 1, 1};
  EXPECT_EQ(at({0, 0, 1}), (std::array<std::uint16_t, 3>{255 * 256, 255 * 256, 255 * 256}));  // no more than full
}

}  // namespace
}  // namespace halfplane::light_test
