// The built-in scenes that are work: how much of it there is, and of which kind.
#include "sim/scene/bench_scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <sstream>
#include <string>

#include "model/capture/capture.hpp"
#include "model/config.hpp"
#include "model/engines/functional.hpp"
#include "model/host/primitive_assembly.hpp"
#include "sim/scene/builtin.hpp"
#include "sim/scene/object_cull.hpp"

namespace halfplane::bench_scenes_test {
namespace {

Scene work(const std::string& name, int width = 320, int height = 180, std::uint64_t seed = 1) {
  return make_builtin(name, width, height, {}, seed);
}

Rendering counted(const Scene& scene) {
  RenderOptions options;
  options.skip = skip_none();
  options.want_count = true;
  return render_functional(scene, preset("full"), options);
}

std::size_t primitives_of(const Scene& scene) {
  std::size_t count = 0;
  for (const Command& command : scene.commands)
    if (const auto* draw = std::get_if<Draw>(&command)) count += primitive_count(scene, *draw);
  return count;
}

double covered_per_pixel(const Rendering& rendering) {
  return static_cast<double>(rendering.counters.covered) / static_cast<double>(rendering.count.size());
}

// Every work scene with a size that renders in milliseconds.
std::string small(const Builtin& builtin) {
  const int size = builtin.name == "dust" ? 2000 : builtin.name == "scratches" ? 500 : std::max(builtin.min_size, 12);
  return std::string(builtin.name) + ":" + std::to_string(size);
}

TEST(WorkScenes, EachKeepsTheInvariantsIsTheSameEachTimeAndReadsBackFromACapture) {
  const std::set<std::string_view> unseeded{
      "layers",       "layers_front",  "layers_nearest", "layers_nearest_front", "layers_linear", "layers_linear_front",
      "layers_glass", "layers_leaves", "ball",           "ball_nearest",         "ball_linear",   "shell"};
  for (const Builtin& builtin : work_scenes()) {
    const std::string name = small(builtin);
    SCOPED_TRACE(name);
    const Scene scene = work(name, 320, 180, 5);
    EXPECT_EQ(scene.name, name);
    for (const std::uint32_t index : scene.indices) ASSERT_LT(index, scene.vertices.size());
    for (const Vertex& v : scene.vertices) {
      ASSERT_TRUE(std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z) && std::isfinite(v.w));
      for (const double channel : v.rgba) ASSERT_TRUE(channel >= 0 && channel <= 255);
    }
    for (const State& state : scene.states) EXPECT_EQ(state.depth_test, DepthFunc::less);
    EXPECT_TRUE(same_scene(scene, work(name, 320, 180, 5)));
    EXPECT_EQ(same_scene(scene, work(name, 320, 180, 6)), unseeded.contains(builtin.name));
    std::ostringstream text;
    write_capture(scene, text);
    EXPECT_TRUE(same_scene(scene, read_capture(text.str(), "scene.hpt")));
    EXPECT_GT(counted(scene).counters.written, 0u);
  }
}

TEST(WorkScenes, NoTwoVerticesOfAPrimitiveHaveTheSameColour) {
  for (const Builtin& builtin : work_scenes()) {
    const Scene scene = work(small(builtin));
    for (const Command& command : scene.commands) {
      const auto* draw = std::get_if<Draw>(&command);
      if (draw == nullptr) continue;
      const std::size_t corners = draw->topology == Topology::lines ? 2 : 3;
      for (std::size_t i = draw->first; i < draw->first + draw->count; i += corners)
        for (std::size_t k = 0; k < corners; ++k)
          ASSERT_NE(scene.vertices[scene.indices[i + k]].rgba,
                    scene.vertices[scene.indices[i + (k + 1) % corners]].rgba)
              << builtin.name << " primitive " << (i - draw->first) / corners;
    }
  }
}

TEST(WorkScenes, LayersCoverEveryPixelByHalfOfThemAndLookTheSameInBothOrders) {
  const Rendering back = counted(work("layers:16")), front = counted(work("layers_front:16"));
  for (const std::uint32_t count : back.count) ASSERT_EQ(count, 8u);
  EXPECT_EQ(back.counters.covered, 320u * 180 * 8);
  EXPECT_EQ(back.counters.depth_passed, back.counters.covered);
  EXPECT_EQ(front.counters.covered, back.counters.covered);
  EXPECT_EQ(front.counters.depth_passed, 320u * 180);
  EXPECT_EQ(front.frame.color, back.frame.color);
  EXPECT_EQ(front.frame.depth, back.frame.depth);
}

// Layers that crossed would let some, not all, of a layer's pixels pass.
TEST(WorkScenes, EvenTheMostLayersAreApartInSixteenBitsOfDepth) {
  Config config = preset("embedded");
  RenderOptions options;
  options.skip = skip_none();
  const Rendering front = render_functional(work("layers_front:2048", 64, 36), config, options);
  EXPECT_EQ(front.counters.depth_passed, 64u * 36);
}

TEST(WorkScenes, TheBallIsClosedAndItsSeenTrianglesHaveEightPixelsAtFullSize) {
  const Scene scene = work("ball:40", 320, 180);  // a quarter of the default in both: the same pixels a triangle
  EXPECT_EQ(primitives_of(scene), 4u * 40 * 40);
  EXPECT_EQ(scene.vertices.size(), 80u * 41);
  const Rendering rendering = counted(scene);
  const double pixels = static_cast<double>(rendering.counters.covered) / static_cast<double>(rendering.counters.drawn);
  EXPECT_GT(pixels, 7);
  EXPECT_LT(pixels, 10);
  for (const std::uint32_t count : rendering.count) ASSERT_LE(count, 1u);
  const double diameter = 2 * std::sqrt(static_cast<double>(rendering.counters.covered) / 3.14159);
  EXPECT_GT(diameter, 0.9 * 180);
}

TEST(WorkScenes, BlocksAreObjectsThatHideEachOtherAndCoverMostOfTheScreen) {
  const Scene scene = work("blocks:2000");
  EXPECT_EQ(primitives_of(scene), 12u * 2000);
  EXPECT_EQ(scene.objects.size(), 2001u);
  const Rendering rendering = counted(scene);
  EXPECT_GT(covered_per_pixel(rendering), 3);
  EXPECT_LT(covered_per_pixel(rendering), 5);
  const auto empty = std::ranges::count(rendering.count, 0u);
  EXPECT_LT(empty, 320 * 180 / 4);
  EXPECT_LT(rendering.counters.depth_passed, 320u * 180 * 11 / 10);  // front to back
}

TEST(WorkScenes, ScratchesAreLinesOfAboutSixtyPixels) {
  const Scene scene = work("scratches:400", 640, 360);
  EXPECT_EQ(primitives_of(scene), 400u);
  double sum = 0;
  for (std::size_t i = 0; i < scene.indices.size(); i += 2) {
    const Vertex &a = scene.vertices[scene.indices[i]], &b = scene.vertices[scene.indices[i + 1]];
    const double length = std::hypot((b.x - a.x) * 320, (b.y - a.y) * 180);
    EXPECT_GT(length, 39.9);
    EXPECT_LT(length, 80.1);
    sum += length;
  }
  EXPECT_NEAR(sum / 400, 60, 3);
}

TEST(WorkScenes, DustCoversEveryPixelOnceWithTrianglesOfAboutAPixel) {
  const int wanted = 320 * 180;
  const Scene scene = work("dust:" + std::to_string(wanted));
  const auto triangles = static_cast<double>(primitives_of(scene));
  EXPECT_NEAR(triangles, wanted, 0.01 * wanted);
  EXPECT_LT(static_cast<double>(scene.vertices.size()), 0.52 * triangles);  // shared
  const Rendering rendering = counted(scene);
  for (const std::uint32_t count : rendering.count) ASSERT_EQ(count, 1u);
}

TEST(WorkScenes, FiveInSixObjectsLieOutsideTheView) {
  for (const auto& [width, height] : {std::pair{1280, 720}, {640, 480}}) {
    Scene scene = work("objects:1500", width, height);
    EXPECT_EQ(primitives_of(scene), 1500u * 128);
    const ObjectCounts counts = select_object_culling(scene, CullObjects::box);
    EXPECT_EQ(counts.in, 1500u);
    EXPECT_NEAR(static_cast<double>(counts.culled_box) / 1500, 5.0 / 6, 0.03) << width << "x" << height;
  }
}

TEST(WorkScenes, NothingOfTheHiddenObjectsIsSeenAtAnyAspect) {
  for (const auto& [width, height] : {std::pair{320, 180}, {160, 120}, {90, 200}}) {
    const Scene scene = work("hidden:20", width, height);
    EXPECT_EQ(primitives_of(scene), 2 + 20u * 968);
    EXPECT_EQ(scene.commands.size(), 1 + 1 + 20u);  // the clear, the wall and a draw each
    const Rendering rendering = counted(scene);
    const auto pixels = static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
    EXPECT_EQ(rendering.counters.depth_passed, pixels);
    EXPECT_GT(rendering.counters.covered, pixels + 200);
    for (const Command& command : scene.commands) {
      const auto* draw = std::get_if<Draw>(&command);
      EXPECT_TRUE(draw == nullptr || draw->outside == 0);
    }
  }
}

TEST(WorkScenes, CullingBackFacesTakesTheInsideOfTheRightShell) {
  const Scene scene = work("shell");
  ASSERT_EQ(scene.states.size(), 2u);
  EXPECT_EQ(scene.states[1].cull, Cull::back);
  const Rendering rendering = counted(scene);
  std::array<int, 2> seen{};  // pixels in the left and the right half
  for (std::size_t i = 0; i < rendering.count.size(); ++i)
    seen[i % 320 < 160 ? 0 : 1] += rendering.count[i] > 0 ? 1 : 0;
  EXPECT_GT(seen[0], 2000);
  EXPECT_GT(seen[1], 500);
  EXPECT_LT(seen[1], seen[0] * 2 / 3);
}

TEST(WorkScenes, SizesAreCheckedAndClipSpaceTakesNoCamera) {
  for (const char* name : {"layers:0", "ball:1", "dust:1", "hidden:x", "objects:99999999"})
    EXPECT_THROW((void)work(name), InputError) << name;
  CameraRequest camera;
  camera.fov = 30;
  for (const char* name : {"layers", "scratches:5", "dust:8", "hidden:1"})
    EXPECT_THROW((void)make_builtin(name, 64, 36, camera, 1), InputError) << name;
  EXPECT_NO_THROW((void)make_builtin("blocks:4", 64, 36, camera, 1));
}

}  // namespace
}  // namespace halfplane::bench_scenes_test
