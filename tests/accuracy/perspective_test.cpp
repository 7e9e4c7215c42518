// The error of attributes over w: a search for the worst triangle and pixel, checked against the derived bound.
//
// HALFPLANE_SOAK=SECONDS searches each cell for that time, with another seed in every run.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>

#include "../perspective_case.hpp"

namespace halfplane::perspective_test {
namespace {

using test::OverWRandom;
using test::OverWRun;
using test::OverWTriangle;
using test::perspective_design;
using test::PerspectiveDesign;

/// The searched case: an attribute of a design, its extent in texels or LSB, and the ratio of the largest w to the
/// smallest.
struct Cell {
  PerspectiveDesign design;
  OverWFormat attribute;
  std::int64_t extent, ratio;
  bool is_canonical_base = false;

  [[nodiscard]] double bound() const {
    return coordinate_error_bound(static_cast<double>(extent), static_cast<double>(ratio), design.format, attribute,
                                  design.config.tile_size);
  }
};

/// The largest error of a triangle, over some of its pixels.
double error_of(const OverWTriangle& t, const Cell& cell, OverWRandom& random) {
  const OverWRun run(t, cell.design, cell.attribute, cell.is_canonical_base);
  double worst = 0;
  test::for_some_pixels(t, run.setup(), cell.design, 12, random, [&](int x, int y, const auto& weight) {
    std::int64_t value = run.value(x, y);
    if (!cell.attribute.is_centred) {  // a colour
      const auto [low, high] = std::minmax({t.value[0] / 16, t.value[1] / 16, t.value[2] / 16});
      value = color_over_q(value, static_cast<std::uint32_t>(low), static_cast<std::uint32_t>(high));
    }
    worst = std::max(worst, std::abs(test::over_w_error(t, weight, value, cell.attribute.fraction_bits)));
  });
  return worst;
}

OverWTriangle random_triangle(const Cell& cell, OverWRandom& random) {
  OverWTriangle t = random.triangle(cell.design, cell.ratio, cell.extent);
  if (!cell.attribute.is_centred) {  // codes
    const std::int64_t last = 255 - cell.extent;
    t.value = {16 * last, std::int64_t{16} * 255, 16 * random.between(last, 255)};
    random.shuffle(t.value);
  }
  return t;
}

/// One small change: a vertex moves, or the middle one of three w or values changes.
OverWTriangle changed(OverWTriangle t, const Cell& cell, OverWRandom& random) {
  const auto middle = [&random](std::array<std::int64_t, 3>& of, std::int64_t unit) {
    const auto [low, high] = std::minmax({of[0], of[1], of[2]});
    for (std::int64_t& value : of)
      if (value != low && value != high) value = random.between(low / unit, high / unit) * unit;
  };
  switch (random.between(0, 3)) {
    case 0: middle(t.w, 1); break;
    case 1: middle(t.value, cell.attribute.is_centred ? 1 : 16); break;
    default: {
      SnappedVertex& v = t.v[static_cast<std::size_t>(random.between(0, 2))];
      const std::int64_t reach = std::int64_t{1} << random.between(0, cell.design.widths.grid_bits + 6);
      v.x = std::max(0, v.x + static_cast<std::int32_t>(random.between(-reach, reach)));
      v.y = std::max(0, v.y + static_cast<std::int32_t>(random.between(-reach, reach)));
      v.x = std::min(v.x, cell.design.config.target_width << cell.design.widths.grid_bits);
      v.y = std::min(v.y, cell.design.config.target_height << cell.design.widths.grid_bits);
    }
  }
  return t;
}

/// Hill climbing from random triangles. Returns the largest error found.
double worst_error(const Cell& cell) {
  const char* soak = std::getenv("HALFPLANE_SOAK");
  const std::uint64_t seed =
      soak == nullptr ? 1 : static_cast<std::uint64_t>(std::chrono::system_clock::now().time_since_epoch().count());
  const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(soak == nullptr ? 0 : std::atoi(soak));
  OverWRandom random(seed);
  double worst = 0;
  for (int climb = 0; climb < 100 || std::chrono::steady_clock::now() < until; ++climb) {
    OverWTriangle best = random_triangle(cell, random);
    double height = error_of(best, cell, random);
    for (int step = 0; step < 100; ++step) {
      const OverWTriangle next = changed(best, cell, random);
      if (next.area() == 0) continue;
      const double error = error_of(next, cell, random);
      if (error < height) continue;
      best = next;
      height = error;
    }
    worst = std::max(worst, height);
  }
  std::printf("%-8s extent %4lld, w ratio %4lld: worst %.4f, bound %.4f (seed %llu)\n", cell.design.name.c_str(),
              static_cast<long long>(cell.extent), static_cast<long long>(cell.ratio), worst, cell.bound(),
              static_cast<unsigned long long>(seed));
  return worst;
}

void search(const std::string& preset, const PerspectiveFormat& format, std::int64_t extent) {
  for (const std::int64_t ratio : {16, 64, 256, 1024}) {
    const Cell cell{perspective_design(preset, format), format.coordinate, extent, ratio};
    const double worst = worst_error(cell);
    EXPECT_LE(worst, cell.bound()) << preset << " " << extent << " " << ratio;
    EXPECT_GT(worst, cell.bound() / 8) << "a search that finds nothing says nothing";
  }
}

TEST(PerspectiveAccuracy, TextureCoordinatesOfTinyKeepTheirBound) { search("tiny", kTinyPerspective, 256); }
TEST(PerspectiveAccuracy, TextureCoordinatesOfEmbeddedKeepTheirBound) {
  search("embedded", kEmbeddedPerspective, 256);
  search("embedded", kEmbeddedPerspective, 1024);
}
TEST(PerspectiveAccuracy, TextureCoordinatesOfFullKeepTheirBound) {
  search("full", kFullPerspective, 256);
  search("full", kFullPerspective, 1024);
  search("full", kFull4096Perspective, 4096);
}

TEST(PerspectiveAccuracy, ColorsAreTwoLsbOffAtMost) {
  for (const auto& [preset, format] : {std::pair{"embedded", kEmbeddedPerspective}, {"full", kFullPerspective}})
    for (const std::int64_t ratio : {16, 64, 256, 1024}) {
      const Cell cell{perspective_design(preset, format), format.color, 255, ratio};
      const double worst = worst_error(cell);
      EXPECT_LE(worst, std::min(2.0, cell.bound())) << preset << " " << ratio;
    }
}

TEST(PerspectiveAccuracy, ASixteenthOfATexelIsKeptWhereTheBoundSaysSo) {
  EXPECT_LE(coordinate_error_bound(1024, 64, kEmbeddedPerspective, 8), 1.0 / 16);
  EXPECT_GT(coordinate_error_bound(1024, 128, kEmbeddedPerspective, 8), 1.0 / 16);
  EXPECT_LE(coordinate_error_bound(1024, 1024, kFullPerspective, 8), 1.0 / 16);
  EXPECT_NEAR(coordinate_error_bound(256, 16, kEmbeddedPerspective, 8), 0.0080, 0.0001);
  EXPECT_NEAR(coordinate_error_bound(256, 1024, kEmbeddedPerspective, 8), 0.159, 0.002);
  EXPECT_NEAR(coordinate_error_bound(1024, 1024, kEmbeddedPerspective, 8), 0.627, 0.002);
  EXPECT_NEAR(coordinate_error_bound(4096, 1024, kFull4096Perspective, 8), 0.168, 0.001);
}

TEST(PerspectiveAccuracyMustFail, PlanesFromTheCanonicalVertexBreakTheBound) {
  const Cell cell{perspective_design("embedded", kEmbeddedPerspective), kEmbeddedPerspective.coordinate, 1024, 1024,
                  true};
  EXPECT_GT(worst_error(cell), cell.bound());
}

TEST(PerspectiveAccuracyMustFail, ACoordinateFromZeroNeedsMoreBits) {
  // Without its own centre, an extent of 64 texels from 16 x 1024 has the error of an extent of 32,768.
  PerspectiveFormat format = kEmbeddedPerspective;
  format.coordinate.is_centred = false;
  Cell cell{perspective_design("embedded", format), format.coordinate, 64, 16};
  cell.attribute.is_centred = true;  // for drawing: texels, not codes
  OverWRandom random(1);
  double worst = 0;
  for (int n = 0; n < 1000; ++n) {
    OverWTriangle t = random.triangle(cell.design, cell.ratio, cell.extent);
    for (std::int64_t& value : t.value) value += std::int64_t{16} * 16384;
    const OverWRun run(t, cell.design, format.coordinate);
    test::for_some_pixels(t, run.setup(), cell.design, 12, random, [&](int x, int y, const auto& weight) {
      worst = std::max(worst, std::abs(test::over_w_error(t, weight, run.value(x, y), 8)));
    });
  }
  EXPECT_GT(worst, cell.bound());
}

}  // namespace
}  // namespace halfplane::perspective_test
