// Cycles of the RTL, pipelined setup, stamp 2x2: from the first primitive taken to the last write into the on-chip blocks,
// memory included. Targets of up to 64x64 pixels stay on the chip. Cycles are exact, so these bounds are no timings.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>

#include "sim/cosim/dut.hpp"
#include "sim/cosim/session.hpp"
#include "sim/scene/random.hpp"

namespace halfplane::cycles_test {
namespace {

using Triangle = std::array<std::array<double, 2>, 3>;  // pixels
using Line = std::array<std::array<double, 2>, 2>;      // likewise

struct Cycles {
  double each = 0;       ///< per primitive
  double per_pixel = 0;  ///< per covered sample
};

template <class Primitive>
Scene scene_of(int width, int height, const std::vector<Primitive>& primitives) {
  Scene scene;
  scene.name = "cycles";
  scene.width = width;
  scene.height = height;
  State state;
  state.space = Space::window;
  state.depth_test = DepthFunc::always;  // every covered sample is written
  scene.states.push_back(state);
  scene.commands.push_back(Clear{0, std::array<double, 4>{0, 0, 0, 255}, 1.0});
  Random random(2);
  for (const Primitive& primitive : primitives)
    for (const auto& corner : primitive) {
      Vertex v;
      v.x = corner[0];
      v.y = corner[1];
      v.z = random.uniform(0, 1);
      for (double& c : v.rgba) c = std::floor(random.uniform(0, 256));
      scene.indices.push_back(static_cast<std::uint32_t>(scene.vertices.size()));
      scene.vertices.push_back(v);
    }
  scene.commands.push_back(Draw{0, 0, std::tuple_size_v<Primitive> == 2 ? Topology::lines : Topology::triangles, 0,
                                scene.indices.size(), 0});
  return scene;
}

Cycles measure(const Scene& scene, const char* name) {
  const DutFactory& factory = find_dut(preset("embedded"));
  const auto dut = make_dut(factory);
  LockstepOptions options;
  options.drains_clears = true;
  const LockstepResult r = run_session(*dut, factory.config, options, single_scene(scene)).result;
  EXPECT_FALSE(r.mismatch.has_value());
  const auto counters = render_hardware(scene, factory.config).counters;
  const auto primitives = static_cast<double>(r.primitives());
  const auto cycles = static_cast<double>(r.raster_cycles);
  const Cycles result{cycles / primitives, cycles / static_cast<double>(counters.covered)};
  std::printf("%s: %.2f cycles each, %.3f a pixel (%llu primitives, %llu cycles)\n", name, result.each,
              result.per_pixel, static_cast<unsigned long long>(r.primitives()),
              static_cast<unsigned long long>(r.raster_cycles));
  return result;
}

std::vector<Triangle> random_in_boxes(double size, int width, int height, std::size_t count) {
  Random random(3);
  std::vector<Triangle> triangles(count);
  for (Triangle& t : triangles) {
    double area = 0;
    do {
      const double x = random.uniform(0, width - size), y = random.uniform(0, height - size);
      for (auto& corner : t) corner = {x + random.uniform(0, size), y + random.uniform(0, size)};
      area = (t[1][0] - t[0][0]) * (t[2][1] - t[0][1]) - (t[1][1] - t[0][1]) * (t[2][0] - t[0][0]);
    } while (std::abs(area) < 0.5);
  }
  return triangles;
}

Triangle two_by_two(double x, double y) { return {{{x, y}, {x + 2.5, y}, {x, y + 2.5}}}; }

TEST(Cycles, AnIsolatedTriangleOfTwoByTwoPixelsTakesAtMost64) {
  EXPECT_LE(measure(scene_of<Triangle>(32, 32, {two_by_two(4, 4)}), "isolated").each, 64);
}

TEST(Cycles, AStreamOfTrianglesOfOnePixelTakesAtMostFourAndAHalfEach) {
  Random random(1);
  std::vector<Triangle> triangles(2000);
  for (Triangle& t : triangles) {
    const double x = std::floor(random.uniform(0, 30)) + 0.25, y = std::floor(random.uniform(0, 30)) + 0.25;
    t = {{{x, y}, {x + 0.75, y}, {x, y + 0.75}}};
  }
  EXPECT_LE(measure(scene_of(32, 32, triangles), "1 px stream").each, 4.5);
}

TEST(Cycles, TrianglesThatCoverNoSampleTakeNothingBehindCull) {
  Random random(1);
  std::vector<Triangle> triangles(2000);
  for (Triangle& t : triangles) {  // they miss the one sample in their box; the last one is drawn
    const double x = std::floor(random.uniform(0, 29)), y = std::floor(random.uniform(0, 29));
    t = {{{x + 0.75, y + 0.25}, {x + 1.75, y + 1.25}, {x + 1.25, y + 1}}};
  }
  triangles.back() = two_by_two(4, 4);
  const Scene scene = scene_of(32, 32, triangles);
  EXPECT_EQ(render_hardware(scene, preset("embedded")).counters.skipped.no_sample, 1999u);
  EXPECT_LE(measure(scene, "no sample").each, 4.1);
}

TEST(Cycles, AStreamOfThemTakesAtMostFourAndAHalfEach) {
  Random random(1);
  std::vector<Triangle> triangles(2000);
  for (Triangle& t : triangles) t = two_by_two(std::floor(random.uniform(0, 29)), std::floor(random.uniform(0, 29)));
  // One latency in all: the last of 2000 leaves 50 cycles after the first could have.
  EXPECT_LE(measure(scene_of(32, 32, triangles), "stream").each, 4.5);
}

TEST(Cycles, RandomTrianglesInBoxesOf8PixelsTakeAtMost5EachAndFromMemory16) {
  EXPECT_LE(measure(scene_of(640, 480, random_in_boxes(8, 640, 480, 2000)), "8 px boxes, 640x480").each, 16);
  EXPECT_LE(measure(scene_of(32, 32, random_in_boxes(8, 32, 32, 2000)), "8 px boxes, 32x32").each, 5);
}

TEST(Cycles, RandomTrianglesInBoxesOf32PixelsTakeAtMost65HundredthsPerPixelAndFromMemoryOne) {
  EXPECT_LE(measure(scene_of(640, 480, random_in_boxes(32, 640, 480, 2000)), "32 px boxes, 640x480").per_pixel, 1.0);
  EXPECT_LE(measure(scene_of(32, 32, random_in_boxes(32, 32, 32, 2000)), "32 px boxes, 32x32").per_pixel, 0.65);
}

TEST(Cycles, ATriangleOf64By64TakesAtMost28HundredthsPerPixel) {
  // Ten times: one latency in all.
  const std::vector<Triangle> straight(10, {{{0, 0}, {64, 0}, {0, 64}}}),
      askew(10, {{{1.3, 0.1}, {63.2, 5.7}, {20.4, 63}}});
  EXPECT_LE(measure(scene_of(64, 64, straight), "64x64").per_pixel, 0.28);
  EXPECT_LE(measure(scene_of(64, 64, askew), "64x64 askew").per_pixel, 0.28);
}

TEST(Cycles, ATriangleOf128By128TakesAtMost4TenthsPerPixelWithItsEvictions) {
  EXPECT_LE(measure(scene_of<Triangle>(128, 128, {{{{0, 0}, {128, 0}, {0, 128}}}}), "128x128").per_pixel, 0.4);
  EXPECT_LE(measure(scene_of<Triangle>(640, 480, {{{{100.3, 50.1}, {228.2, 60.7}, {140.4, 178}}}}), "128x128 askew")
                .per_pixel,
            0.4);
}

/// Cycles of `hidden` triangles with legs of `size` pixels behind a wall, and of a last one in front of it.
double behind_a_wall(std::size_t hidden, double size) {
  constexpr int kWidth = 640, kHeight = 480;
  const Triangle wall{{{0, 0}, {2 * kWidth, 0}, {0, 2 * kHeight}}};
  std::vector<Triangle> triangles{wall, wall};  // the second wall's visits make the first wall's updates visible
  Random random(5);
  for (std::size_t i = 0; i < hidden; ++i) {
    const double x = random.uniform(0, kWidth - size), y = random.uniform(0, kHeight - size);
    triangles.push_back({{{x, y}, {x + size, y}, {x, y + size}}});
  }
  triangles.push_back(two_by_two(4, 4));
  Scene scene = scene_of(kWidth, kHeight, triangles);
  scene.states[0].depth_test = DepthFunc::lequal;
  for (std::size_t i = 0; i < scene.vertices.size(); ++i)
    scene.vertices[i].z = i < 6 ? 0.5 : i + 3 < scene.vertices.size() ? 0.75 : 0.25;
  const auto tiles = render_hardware(scene, preset("embedded")).counters;
  EXPECT_EQ(tiles.written, 2u * kWidth * kHeight + 3);
  const std::string name = std::to_string(hidden) + " hidden ones of " + std::to_string(static_cast<int>(size)) + " px";
  return measure(scene, name.c_str()).each * static_cast<double>(hidden + 3);
}

TEST(Cycles, AHiddenTriangleOf64PixelsTakesAtMost60) {
  const double each = (behind_a_wall(101, 64) - behind_a_wall(1, 64)) / 100;
  std::printf("hidden, 64 px: %.2f cycles each\n", each);
  EXPECT_LE(each, 60);
}

TEST(Cycles, AHiddenTriangleOf256PixelsTakesAtMost650) {
  const double each = (behind_a_wall(21, 256) - behind_a_wall(1, 256)) / 20;
  std::printf("hidden, 256 px: %.2f cycles each\n", each);
  EXPECT_LE(each, 650);
}

/// Lines of `length` pixels in all directions. Diamond exit: as many pixels as the longer side has.
std::vector<Line> random_lines(double length, int width, int height, std::size_t count) {
  Random random(4);
  std::vector<Line> lines(count);
  for (Line& line : lines) {
    const double other = random.uniform(-length, length), sign = random.uniform(-1, 1) < 0 ? -1 : 1;
    const bool is_x_major = random.uniform(-1, 1) < 0;
    const double dx = is_x_major ? sign * length : other, dy = is_x_major ? other : sign * length;
    const double x = random.uniform(std::max(0.0, -dx), width - std::max(0.0, dx));
    const double y = random.uniform(std::max(0.0, -dy), height - std::max(0.0, dy));
    line = {{{x, y}, {x + dx, y + dy}}};
  }
  return lines;
}

TEST(Cycles, StreamedLinesOf16PixelsAndMoreTake101HundredthsPerPixelAnd2PerLine) {
  for (const int length : {16, 24, 60}) {
    const std::string name = "lines of " + std::to_string(length) + " px";
    EXPECT_LE(measure(scene_of(64, 64, random_lines(length, 64, 64, 2000)), name.c_str()).each, 1.01 * length + 2);
  }
}

TEST(Cycles, ShorterLinesTakeAtMost4MoreThanTheirPixels) {
  for (const int length : {1, 2, 4, 8, 12}) {
    const std::string name = "lines of " + std::to_string(length) + " px";
    EXPECT_LE(measure(scene_of(32, 32, random_lines(length, 32, 32, 2000)), name.c_str()).each, length + 4);
  }
}

}  // namespace
}  // namespace halfplane::cycles_test
