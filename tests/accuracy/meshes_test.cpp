// Meshes without gaps or overlaps: every pixel is covered exactly once, in the model and in the golden.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "../scene_builder.hpp"
#include "model/engines/functional.hpp"
#include "sim/study/compare/compare.hpp"
#include "sim/study/stress/delaunay.hpp"

namespace halfplane::meshes_test {
namespace {

using test::at;
using test::clip_at;
using test::Random;
using test::SceneBuilder;

using stress::Corner;
using stress::delaunay;
using stress::Point;

/// Draws a mesh in shuffled order with mixed windings; coordinates in units of 2^-bits pixel.
Scene mesh_scene(stress::Mesh mesh, int size, int bits, Random& random) {
  for (std::size_t i = mesh.size(); i > 1; --i)
    std::swap(mesh[i - 1], mesh[static_cast<std::size_t>(random.index(static_cast<int>(i)))]);
  SceneBuilder builder(size, size);
  const auto vertex = [&](Point p) {
    return at(std::ldexp(static_cast<double>(p.x), -bits), std::ldexp(static_cast<double>(p.y), -bits), random.unit());
  };
  for (const Corner& t : mesh) {
    const bool turned = random.index(2) == 0;
    builder.triangle(vertex(t[0]), vertex(t[turned ? 2 : 1]), vertex(t[turned ? 1 : 2]));
  }
  return builder.scene;
}

void expect_exactly_once(const Comparison& c) {
  EXPECT_EQ(std::count(c.rendering.count.begin(), c.rendering.count.end(), 1u),
            static_cast<std::ptrdiff_t>(c.rendering.count.size()));
  EXPECT_EQ(std::count(c.golden.count.begin(), c.golden.count.end(), 1u),
            static_cast<std::ptrdiff_t>(c.golden.count.size()));
  EXPECT_EQ(c.oracle.mismatches, 0u);
  EXPECT_EQ(c.coverage.missing + c.coverage.extra, 0u);
}

std::int64_t total_area(const stress::Mesh& mesh) {
  std::int64_t sum = 0;
  for (const Corner& t : mesh) sum += stress::doubled_area(t[0], t[1], t[2]);
  return sum;
}

/// `bits`: fraction bits of the points' grid. 1 puts every second coordinate on a pixel centre.
void check_delaunay(const Config& config, int size, int bits, int count, std::uint32_t seed) {
  SCOPED_TRACE(config.preset + ", grid bits " + std::to_string(bits) + ", seed " + std::to_string(seed));
  Random random(seed);
  const std::int64_t border = std::int64_t{2} << bits, end = (std::int64_t{size} << bits) + border;
  std::set<Point> points;
  for (int i = 0; i < count; ++i) {
    const auto coordinate = [&] { return 1 - border + random.index(static_cast<int>(end + border) - 1); };
    const std::int64_t x = coordinate();
    points.insert({x, coordinate()});
  }
  const auto mesh = delaunay({-border, -border}, {end, end}, points);
  ASSERT_EQ(total_area(mesh), 2 * (end + border) * (end + border));
  EXPECT_EQ(mesh.size(), 2 * points.size() + 2);
  expect_exactly_once(compare(mesh_scene(mesh, size, bits, random), config));
}

TEST(Meshes, DelaunayMeshesCoverEveryPixelExactlyOnce) {
  for (std::uint32_t seed = 1; seed <= 3; ++seed) {
    check_delaunay(preset("tiny"), 16, 2, 200, seed);
    check_delaunay(preset("embedded"), 96, 4, 700, seed);
    check_delaunay(preset("full"), 96, 8, 700, seed);
  }
}

TEST(Meshes, DelaunayMeshesOnTheHalfPixelGridCoverEveryPixelExactlyOnce) {
  for (std::uint32_t seed = 11; seed <= 13; ++seed) {
    check_delaunay(preset("tiny"), 16, 1, 200, seed);
    check_delaunay(preset("embedded"), 48, 1, 900, seed);
    check_delaunay(preset("full"), 48, 1, 900, seed);
  }
}

TEST(Meshes, JitteredGridOfTenThousandTrianglesCoversEveryPixelExactlyOnce) {
  const Config config = preset("embedded");
  constexpr int kCells = 72, kSize = 256;
  Random random(21);
  SCOPED_TRACE("seed 21");
  const double pitch = (kSize + 8.0) / kCells;
  std::vector<Vertex> grid;
  for (int j = 0; j <= kCells; ++j) {
    for (int i = 0; i <= kCells; ++i) {
      const bool is_border = i == 0 || j == 0 || i == kCells || j == kCells;
      const auto jitter = [&] { return is_border ? 0 : random.between(-0.3, 0.3) * pitch; };
      const double x = i * pitch - 4 + jitter(), y = j * pitch - 4 + jitter();
      grid.push_back(at(x, y, random.unit()));
    }
  }
  SceneBuilder builder(kSize, kSize);
  for (int j = 0; j < kCells; ++j) {
    for (int i = 0; i < kCells; ++i) {
      const auto corner = [&](int dx, int dy) {
        return grid[static_cast<std::size_t>((j + dy) * (kCells + 1) + i + dx)];
      };
      builder.triangle(corner(0, 0), corner(1, 0), corner(0, 1)).triangle(corner(0, 1), corner(1, 0), corner(1, 1));
    }
  }
  const Comparison c = compare(builder.scene, config);
  EXPECT_EQ(std::count(c.rendering.count.begin(), c.rendering.count.end(), 1u), kSize * kSize);
  EXPECT_EQ(std::count(c.golden.count.begin(), c.golden.count.end(), 1u), kSize * kSize);
  EXPECT_TRUE(broken_bounds(c, config).empty());
}

TEST(Meshes, FansOfThreeToSixtyFourTrianglesAroundACentreACornerAndAnEdgePointCoverOnce) {
  const Config config = preset("embedded");
  for (const auto& hub : {std::array{16.5, 16.5}, {16.0, 16.0}, {16.5, 16.0}}) {
    for (int blades = 3; blades <= 64; ++blades) {
      SCOPED_TRACE("hub " + std::to_string(hub[0]) + ", " + std::to_string(hub[1]) + ", " + std::to_string(blades));
      SceneBuilder builder(32, 32);
      const auto rim = [&](int i) {
        const double angle = 2 * 3.14159265358979323846 * (i % blades) / blades;
        return at(hub[0] + 80 * std::cos(angle), hub[1] + 80 * std::sin(angle));
      };
      for (int i = 0; i < blades; ++i) builder.triangle(at(hub[0], hub[1]), rim(i), rim(i + 1));
      const Comparison c = compare(builder.scene, config);
      EXPECT_EQ(std::count(c.rendering.count.begin(), c.rendering.count.end(), 1u), 32 * 32);
      EXPECT_EQ(c.oracle.mismatches, 0u);
    }
  }
}

TEST(Meshes, ClosedBoxThatCrossesNearAndSidePlanesCoversEveryPixelOnce) {
  // The eye is inside a box that extends behind it and far beyond the guard band: every pixel sees one inner wall.
  const Config config = preset("embedded");
  State state;
  state.depth_test = DepthFunc::always;
  for (const double turn : {0.0, 0.3, 0.77, 1.9}) {
    SCOPED_TRACE("turn " + std::to_string(turn));
    SceneBuilder builder(64, 48, state);
    const auto corner = [&](int k) {
      const double x0 = (k & 1 ? 7 : -5), y = (k & 2 ? 3 : -4), z0 = (k & 4 ? 6 : -8);
      const double x = x0 * std::cos(turn) + z0 * std::sin(turn), z = z0 * std::cos(turn) - x0 * std::sin(turn);
      return clip_at(1.1 * x, 1.3 * y, (101.0 * z - 20.0) / 99.0, z);  // eye depth z; near 0.1, far 10 and beyond
    };
    for (const auto& face :
         {std::array{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}}) {
      builder.triangle(corner(face[0]), corner(face[1]), corner(face[2]));
      builder.triangle(corner(face[0]), corner(face[2]), corner(face[3]));
    }
    const Comparison c = compare(builder.scene, config);
    EXPECT_EQ(std::count(c.rendering.count.begin(), c.rendering.count.end(), 1u), 64 * 48);
    EXPECT_EQ(std::count(c.golden.count.begin(), c.golden.count.end(), 1u), 64 * 48);
    EXPECT_EQ(c.oracle.mismatches, 0u);
    EXPECT_GT(c.rendering.counters.clipped, 0u);
    EXPECT_EQ(c.coverage.near_edge, c.coverage.missing + c.coverage.extra);
  }
}

TEST(Meshes, AllSixVertexOrdersOfAClippedTriangleGiveEqualBuffers) {
  const Config config = preset("embedded");
  Random random(41);
  std::uint64_t clipped = 0;
  for (int n = 0; n < 200; ++n) {
    SCOPED_TRACE("seed 41, triangle " + std::to_string(n));
    State state;
    state.depth_test = DepthFunc::always;
    std::array<Vertex, 3> v;
    for (Vertex& vertex : v) {
      const double w = random.between(-1, 3), x = random.between(-90, 90), y = random.between(-90, 90);
      vertex = clip_at(x, y, random.between(-1.2, 1.2) * w, w);
      for (double& channel : vertex.rgba) channel = random.index(256);
    }
    std::array<int, 3> order{0, 1, 2};
    Rendering first;
    do {
      SceneBuilder builder(48, 40, state);
      builder.triangle(v[static_cast<std::size_t>(order[0])], v[static_cast<std::size_t>(order[1])],
                       v[static_cast<std::size_t>(order[2])]);
      Rendering rendering = render_functional(builder.scene, config);
      if (first.frame.width == 0)
        first = std::move(rendering);
      else {
        EXPECT_EQ(rendering.frame.depth, first.frame.depth);
        EXPECT_EQ(rendering.frame.color, first.frame.color);
      }
    } while (std::next_permutation(order.begin(), order.end()));
    clipped += first.counters.written > 0 ? first.counters.clipped : 0;
  }
  EXPECT_GT(clipped, 30u);
}

/// A mesh of 2 * cells^2 triangles in random order over the whole target, on a grid of 2^-bits pixels.
Scene shuffled_mesh(int cells, int pitch, int bits, std::uint32_t seed) {
  Random random(seed);
  const auto at_grid = [&](int i) { return (std::int64_t{i} * pitch << bits) - (std::int64_t{pitch} << bits); };
  std::vector<Point> grid;
  for (int j = 0; j <= cells; ++j)
    for (int i = 0; i <= cells; ++i) {
      const int reach = (pitch << bits) / 5;  // less than a quarter of a cell: no triangle is reversed
      const std::int64_t dx = random.index(2 * reach + 1) - reach;
      grid.push_back({at_grid(i) + dx, at_grid(j) + random.index(2 * reach + 1) - reach});
    }
  stress::Mesh mesh;
  for (int j = 0; j < cells; ++j)
    for (int i = 0; i < cells; ++i) {
      const auto corner = [&](int dx, int dy) {
        return grid[static_cast<std::size_t>((j + dy) * (cells + 1) + i + dx)];
      };
      if (random.index(2) == 0) {
        mesh.push_back({corner(0, 0), corner(1, 0), corner(0, 1)});
        mesh.push_back({corner(0, 1), corner(1, 0), corner(1, 1)});
      } else {
        mesh.push_back({corner(0, 0), corner(1, 0), corner(1, 1)});
        mesh.push_back({corner(0, 0), corner(1, 1), corner(0, 1)});
      }
    }
  return mesh_scene(mesh, (cells - 3) * pitch, bits, random);
}

TEST(StressMeshes, HundredThousandShuffledTrianglesCoverEveryPixelExactlyOnce) {
  // On the half-pixel grid ties are everywhere; on the subpixel grid ties are rare, and triangles thinner.
  for (const int bits : {1, 4}) {
    SCOPED_TRACE("grid bits " + std::to_string(bits) + ", seed 31");
    const Scene scene = shuffled_mesh(224, 4, bits, 31);
    RenderOptions options;
    options.want_count = true;
    const Rendering r = render_functional(scene, preset("embedded"), options);
    EXPECT_EQ(r.counters.primitives_in, 100352u);
    EXPECT_EQ(std::count(r.count.begin(), r.count.end(), 1u), static_cast<std::ptrdiff_t>(r.count.size()));
  }
}

}  // namespace
}  // namespace halfplane::meshes_test
