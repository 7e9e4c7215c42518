// The level of detail at a pixel against OpenGL's: the logarithm of the longer of two exact derivatives.
#include "model/stages/level_of_detail.hpp"

#include <gtest/gtest.h>

#include <cstdio>

#include "../perspective_case.hpp"

namespace halfplane::level_of_detail_test {
namespace {

using test::OverWRandom;
using test::OverWTriangle;
using test::perspective_design;
using test::PerspectiveDesign;

/// A triangle with two coordinates.
struct TexturedTriangle {
  OverWTriangle u;
  std::array<std::int64_t, 3> v{};  ///< 1/16 texel
};

/// The exact level of detail: derivatives of both quotients from the gradients of their numerators and denominator.
double exact_lod(const TexturedTriangle& t, int x, int y, int grid_bits) {
  const auto weight = test::vertex_weights(t.u.v, x, y, grid_bits);
  const auto& at = t.u.v;
  std::array<std::array<long double, 2>, 3> slope{};  // of each weight, a pixel
  for (std::size_t i = 0; i < 3; ++i) {
    const SnappedVertex &a = at[(i + 1) % 3], &b = at[(i + 2) % 3];
    slope[i] = {std::ldexp(static_cast<long double>(a.y - b.y), grid_bits),
                std::ldexp(static_cast<long double>(b.x - a.x), grid_bits)};
  }
  long double q = 0;
  std::array<long double, 2> q_slope{}, p{};
  std::array<std::array<long double, 2>, 2> p_slope{};
  for (std::size_t i = 0; i < 3; ++i) {
    const long double over_w = 1.0L / static_cast<long double>(t.u.w[i]);
    const std::array<long double, 2> texel{static_cast<long double>(t.u.value[i]) / 16,
                                           static_cast<long double>(t.v[i]) / 16};
    q += static_cast<long double>(weight[i]) * over_w;
    for (std::size_t axis = 0; axis < 2; ++axis) {
      q_slope[axis] += slope[i][axis] * over_w;
      p[axis] += static_cast<long double>(weight[i]) * over_w * texel[axis];
      for (std::size_t c = 0; c < 2; ++c) p_slope[c][axis] += slope[i][axis] * over_w * texel[c];
    }
  }
  std::array<long double, 2> length{};
  for (std::size_t axis = 0; axis < 2; ++axis)
    length[axis] = std::hypot((p_slope[0][axis] * q - p[0] * q_slope[axis]) / (q * q),
                              (p_slope[1][axis] * q - p[1] * q_slope[axis]) / (q * q));
  return static_cast<double>(std::log2(std::max(length[0], length[1])));
}

struct Errors {
  double worst = 0, sum = 0;
  std::uint64_t pixels = 0;
};

/// `is_changed`: called with the setup before it is used.
template <class Change>
Errors lod_errors(const PerspectiveDesign& design, std::int64_t largest_ratio, std::uint64_t seed, int triangles,
                  Change&& change) {
  OverWRandom random(seed);
  Errors errors;
  for (int n = 0; n < triangles; ++n) {
    TexturedTriangle t;
    t.u = random.triangle(design, random.between(1, largest_ratio), random.between(1, 1024));
    const std::int64_t extent = 16 * random.between(1, 1024), start = random.between(-8192, 8192);
    t.v = {start, start + extent, start + random.between(0, extent)};
    random.shuffle(t.v);
    const test::OverWRun run(t.u, design, design.format.coordinate);
    const auto order = canonical_order(t.u.v, t.u.area());
    std::array<std::array<double, 3>, 2> uv{};
    for (std::size_t i = 0; i < 3; ++i) {
      uv[0][i] = t.u.values()[order[i]];
      uv[1][i] = std::ldexp(t.v[order[i]], -4);
    }
    LodSetup setup = setup_lod(run.canonical_vertices(), std::abs(t.u.area()), run.q_codes(), uv,
                               design.format.guard_bits, design.widths.grid_bits);
    change(setup);
    test::for_some_pixels(t.u, run.setup(), design, 12, random, [&](int x, int y, const auto&) {
      const double lod = std::ldexp(level_of_detail(setup, run.q(x, y), x, y), -kLodFraction);
      const double error = std::abs(lod - exact_lod(t, x, y, design.widths.grid_bits));
      errors.worst = std::max(errors.worst, error);
      errors.sum += error;
      ++errors.pixels;
    });
  }
  return errors;
}

TEST(LevelOfDetail, IsWithinATenthOfALevelOfTheExactOne) {
  for (const auto& [name, format] : {std::pair{"embedded", kEmbeddedPerspective}, {"full", kFullPerspective}})
    for (const std::int64_t ratio : {1, 64, 4096}) {
      const PerspectiveDesign design = perspective_design(name, format);
      const Errors errors = lod_errors(design, ratio, 1, 20000, [](LodSetup&) {});
      std::printf("%-8s w ratio up to %4lld: worst %.4f levels, mean %.4f, %llu pixels\n", name,
                  static_cast<long long>(ratio), errors.worst, errors.sum / static_cast<double>(errors.pixels),
                  static_cast<unsigned long long>(errors.pixels));
      EXPECT_LE(errors.worst, 0.1) << name << " " << ratio;
      EXPECT_LE(errors.sum, 0.025 * static_cast<double>(errors.pixels)) << name << " " << ratio;
      EXPECT_GT(errors.pixels, 100000U);
    }
}

TEST(LevelOfDetailMustFail, ALineOfAnotherRowIsNoticed) {
  const PerspectiveDesign design = perspective_design("embedded", kEmbeddedPerspective);
  EXPECT_GT(
      lod_errors(design, 16, 1, 2000, [](LodSetup& setup) { setup.along_y[0].at_zero += setup.along_y[0].step; }).worst,
      0.1);
}

TEST(LevelOfDetail, AnImageAtItsOwnSizeHasLevelZeroToTheBit) {
  const PerspectiveDesign design = perspective_design("embedded", kEmbeddedPerspective);
  TexturedTriangle t;
  t.u.v[1].x = 256 << 4;
  t.u.v[2].y = 256 << 4;
  t.u.w.fill(1024);
  t.u.value = {0, 256 * 16, 0};
  const test::OverWRun run(t.u, design, design.format.coordinate);
  const LodSetup setup =
      setup_lod(run.canonical_vertices(), t.u.area(), run.q_codes(), {{{0, 256, 0}, {0, 0, 256}}}, 4, 4);
  for (int y = 0; y < 256; ++y)
    for (int x = 0; x < 256 - y; ++x) ASSERT_EQ(level_of_detail(setup, run.q(x, y), x, y), 0) << x << " " << y;
}

TEST(LevelOfDetail, OneTexelAllOverIsTheSharpestLevel) {
  const PerspectiveDesign design = perspective_design("embedded", kEmbeddedPerspective);
  OverWRandom random(1);
  const OverWTriangle t = random.triangle(design, 4, 0);
  const LodSetup setup =
      setup_lod(t.v, std::abs(t.area()), {1U << 21, 1U << 21, 1U << 19}, {{{5, 5, 5}, {1.5, 1.5, 1.5}}}, 4, 4);
  EXPECT_LT(level_of_detail(setup, 1U << 25, 3, 3), -32 * 256);
}

TEST(LevelOfDetail, LogarithmAndLengthAreAsCloseAsSaid) {
  EXPECT_EQ(log2_code(0), 0);
  EXPECT_EQ(log2_code(1), 0);
  EXPECT_EQ(log2_code(3), 256 + 128 + 23);
  EXPECT_EQ(log2_code(std::uint64_t{1} << 40), 40 * 256);
  for (std::uint64_t value = 1; value < 1U << 18; ++value)
    EXPECT_NEAR(std::ldexp(log2_code(value), -8), std::log2(static_cast<double>(value)), 1.0 / 64);
  for (std::uint32_t b = 0; b <= 4096; ++b) {
    const double exact = std::hypot(4096.0, b), octagon = octagon_length(4096, b);
    EXPECT_GE(octagon, exact * 0.970) << b;
    EXPECT_LE(octagon, exact * 1.008) << b;
    EXPECT_EQ(octagon_length(b, 4096), octagon_length(4096, b));
  }
}

TEST(LevelOfDetail, LevelsAreChosenAsOpenGLSays) {
  EXPECT_EQ(nearest_level(-1000, 4), 0);
  EXPECT_EQ(nearest_level(128, 4), 0) << "ceil(0.5 + 0.5) - 1";
  EXPECT_EQ(nearest_level(129, 4), 1);
  EXPECT_EQ(nearest_level(384, 4), 1);
  EXPECT_EQ(nearest_level(385, 4), 2);
  EXPECT_EQ(nearest_level(99999, 4), 4);
  const auto is = [](const LevelPair& pair, int lower, int upper, std::uint32_t part) {
    return pair.lower == lower && pair.upper == upper && pair.part == part;
  };
  EXPECT_TRUE(is(levels_around(256 + 77, 4), 1, 2, 77));
  EXPECT_TRUE(is(levels_around(4 * 256 + 77, 4), 4, 4, 77)) << "beyond the last level both are that";
  EXPECT_TRUE(is(levels_around(-1, 4), 0, 0, 255));
}

}  // namespace
}  // namespace halfplane::level_of_detail_test
