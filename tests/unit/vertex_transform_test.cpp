// Vertices in the numbers of smaller hosts: by hand, and their cost.
#include "sim/scene/vertex_transform.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "model/config.hpp"
#include "sim/scene/builtin.hpp"
#include "sim/study/compare/transform_errors.hpp"

namespace halfplane::vertex_transform_test {
namespace {

constexpr Mat4 kIdentity{Vec4{1, 0, 0, 0}, Vec4{0, 1, 0, 0}, Vec4{0, 0, 1, 0}, Vec4{0, 0, 0, 1}};

TEST(VertexTransform, FixedPointRoundsOnceAStep) {
  const double unit = std::ldexp(1, -16);
  Mat4 third = kIdentity;
  third[0] = {1.0 / 3, 0, 0, 0};
  const VertexTransform transform(third, kIdentity, TransformNumbers::s15_16);
  // 1/3 is 21845 units, rounded; times 3 units it is 0.99995 of one.
  EXPECT_EQ(transform.clip({3 * unit, 0, 0})[0], unit);
  EXPECT_EQ(transform.clip({1, 0, 0})[0], 21845 * unit);
  EXPECT_EQ(transform.clip({0, 0.4 * unit, 0.6 * unit}), (Vec4{0, 0, unit, 1}));
  EXPECT_EQ(transform.clip({-1.5 * unit, 0, 0})[0], 0) << "halves go up";
}

TEST(VertexTransform, Binary32IsTheMachinesFloat) {
  Mat4 view = kIdentity;
  view[1] = {0.1, 0.7, -0.3, 5.2};
  const VertexTransform transform(view, kIdentity, TransformNumbers::binary32);
  const Vec3 p{1.1, -2.2, 3.3};
  float expected = 0.1F * 1.1F;
  expected += 0.7F * -2.2F;
  expected += -0.3F * 3.3F;
  expected += 5.2F;
  EXPECT_NEAR(transform.clip(p)[1], expected, 1e-6);
  EXPECT_EQ(transform.clip(p)[1], static_cast<float>(transform.clip(p)[1]));
  EXPECT_NE(transform.clip(p)[0], 1.1);
}

TEST(VertexTransform, WhatFixedPointCannotHoldIsRefused) {
  const VertexTransform transform(kIdentity, kIdentity, TransformNumbers::s15_16);
  EXPECT_NO_THROW((void)transform.clip({32767, -32768, 0}));
  for (const double far : {32768.0, -32769.0, 1e30}) EXPECT_THROW((void)transform.clip({far, 0, 0}), InputError) << far;
  EXPECT_THROW((void)parse_transform("fixed"), InputError);
}

Scene teapot(TransformNumbers numbers) {
  MeshOptions options;
  options.transform = numbers;
  return make_builtin("teapot", 640, 480, {}, 1, options);
}

TransformErrors errors_of(TransformNumbers numbers, const Config& config) {
  return transform_errors(teapot(numbers), teapot(TransformNumbers::binary64), numbers, config);
}

TEST(TransformErrors, TheSmallerTheNumbersTheLargerTheErrorsOfEachStep) {
  const Config config = preset("full");
  const TransformErrors single = errors_of(TransformNumbers::binary32, config);
  const TransformErrors fixed = errors_of(TransformNumbers::s15_16, config);
  for (const auto step : {&TransformErrors::whole, &TransformErrors::transform, &TransformErrors::divide}) {
    EXPECT_GT((single.*step).pixels.count, 1000U);
    EXPECT_GT((single.*step).pixels.max, 0);
    EXPECT_LT((single.*step).pixels.max, 0.001);
  }
  EXPECT_GT(fixed.whole.pixels.max, 4 * single.whole.pixels.max);
  EXPECT_LT(fixed.whole.pixels.max, 0.1);
  EXPECT_LT(fixed.divide.pixels.max, std::hypot(0x1p-17, 0x1p-17) + 1e-9) << "one rounding of 16 bits along each axis";
  EXPECT_GT(fixed.whole.depth_lsb.max, single.whole.depth_lsb.max);
  EXPECT_EQ(fixed.clip.pixels.count, 0U) << "nothing is cut";
  EXPECT_EQ(fixed.without_w, 0U);
}

}  // namespace
}  // namespace halfplane::vertex_transform_test
