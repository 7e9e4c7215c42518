// Whole-object culling: something is culled, and never a pixel changes.
#include "sim/scene/object_cull.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>

#include "../random_camera.hpp"
#include "model/capture/capture.hpp"
#include "model/engines/functional.hpp"
#include "model/golden/golden.hpp"
#include "model/host/primitive_stream.hpp"
#include "model/packets/packet_words.hpp"
#include "sim/scene/builtin.hpp"
#include "sim/scene/builtin_meshes.hpp"
#include "sim/scene/mesh_scene.hpp"
#include "sim/scene/random.hpp"

namespace halfplane::object_cull_test {
namespace {

Rendering draw(const Scene& scene) {
  RenderOptions options;
  options.want_ids = true;
  options.want_count = true;
  return render_functional(scene, preset("embedded"), options);
}

void expect_same_picture(const Rendering& a, const Rendering& b, const std::string& what) {
  EXPECT_EQ(a.frame.color, b.frame.color) << what;
  EXPECT_EQ(a.frame.depth, b.frame.depth) << what;
  EXPECT_EQ(a.ids, b.ids) << what;
  EXPECT_EQ(a.count, b.count) << what;
  EXPECT_EQ(a.counters.primitives_in, b.counters.primitives_in) << what;
  EXPECT_EQ(a.counters.culled, b.counters.culled) << what;
}

/// Eye and target anywhere in and round the scene: inside of objects, behind them, beside them.
TEST(ObjectCull, NoTestChangesAPixelOfAnyBuiltinSceneFromAnyCamera) {
  ObjectCounts all;
  std::size_t in_sphere = 0, in_box = 0;
  for (const Builtin& builtin : builtin_scenes()) {
    for (std::uint64_t seed = 1; seed <= (builtin.has_camera ? 25 : 1); ++seed) {
      Random random(seed);
      const std::string name = builtin.name == "city"   ? "city:120"
                               : builtin.name == "knot" ? "knot:32"
                                                        : std::string(builtin.name);
      const CameraRequest camera = builtin.has_camera ? test::random_camera(random, 12, 0, 1, 20) : CameraRequest{};
      const Scene marked = make_builtin(name, 120, 90, camera, 1);
      Scene none = marked;
      EXPECT_EQ(select_object_culling(none, CullObjects::none).primitives_skipped, 0u);
      const Rendering expected = draw(none);
      for (const CullObjects tests : {CullObjects::sphere, CullObjects::box, CullObjects::both}) {
        Scene scene = marked;
        const ObjectCounts counts = select_object_culling(scene, tests);
        expect_same_picture(expected, draw(scene), name + ", camera of seed " + std::to_string(seed));
        if (tests == CullObjects::both) {
          all.in += counts.in;
          in_sphere += counts.culled_sphere;
          in_box += counts.culled_box;
          all.primitives_skipped += counts.primitives_skipped;
        }
      }
    }
  }
  std::printf("objects %zu, outside by sphere %zu, by box %zu, primitives skipped %zu\n", all.in, in_sphere, in_box,
              all.primitives_skipped);
  EXPECT_GT(in_sphere, all.in / 4);
  EXPECT_GT(in_box, in_sphere);  // a box is the tighter hull of a box
}

TEST(ObjectCull, TheHostOfTheHardwareNumbersWhatItLeavesOut) {
  CameraRequest camera;
  camera.eye = Vec3{0, 2, 0};
  camera.target = Vec3{10, 1, 0};
  const Config config = preset("embedded");
  Scene marked = make_builtin("city:60", 64, 64, camera, 1), none = marked;
  EXPECT_GT(select_object_culling(marked, CullObjects::box).primitives_skipped, 100u);
  (void)select_object_culling(none, CullObjects::none);
  HostStream a(marked, config), b(none, config);
  const Widths widths = derive_widths(config);
  while (true) {
    const auto from_a = a.next(), from_b = b.next();
    ASSERT_EQ(from_a.has_value(), from_b.has_value());
    if (!from_a) break;
    ASSERT_EQ(from_a->primitive, from_b->primitive);
    ASSERT_EQ(packed(from_a->packet, widths), packed(from_b->packet, widths));
  }
  EXPECT_EQ(a.counters().primitives_in, b.counters().primitives_in);
  EXPECT_EQ(a.counters().culled, b.counters().culled);
}

TEST(ObjectCull, ABallBesideAPlaneIsOutsideExactlyFromItsRadiusOn) {
  Camera camera;
  camera.eye = {0, 0, 0};
  camera.target = {0, 0, -1};
  camera.fov = 90;
  camera.near = 1;
  camera.far = 10;
  const Mat4 to_clip = product(projection_matrix(camera, 1), view_matrix(camera));
  const auto at = [&](const Vec3& p) {
    return outside_view({add(p, {-1, -1, -1}), add(p, {1, 1, 1}), p, std::sqrt(3.0)}, to_clip);
  };
  EXPECT_EQ(at({0, 0, -5}), 0);
  EXPECT_EQ(at({0, 0, 0.5}), kBoxOutside);  // near: z from -0.5; the ball reaches to z = -1.23
  EXPECT_EQ(at({0, 0, 1}), kSphereOutside | kBoxOutside);
  EXPECT_EQ(at({0, 0, -11.5}), kBoxOutside);
  EXPECT_EQ(at({0, 0, -11}), 0);  // touches
  EXPECT_EQ(at({0, 0, -11.8}), kSphereOutside | kBoxOutside);
  // Right: x = -z is the plane. The box's nearest corner is (x - 1, ., z - 1), the ball's distance (x + z) / sqrt 2.
  EXPECT_EQ(at({7.4, 0, -5}), kBoxOutside);
  EXPECT_EQ(at({7.5, 0, -5}), kSphereOutside | kBoxOutside);
  EXPECT_EQ(at({6.9, 0, -5}), 0);
  EXPECT_EQ(at({0, 0, 50}), kSphereOutside | kBoxOutside);  // behind the eye, where w < 0
}

TEST(ObjectCull, CapturesAreCulledByTheirVerticesAndOnlyAsWholeObjects) {
  const std::string text =
      "halfplane 1\ntarget 16 16\n"
      "v 2 0 0 1\nv 3 0 0 1\nv 2 1 0 1\n"        // right of the view
      "v -1 -1 0 1\nv 1 -1 0 1\nv 0 1 0 1\n"     // inside
      "v 0 0 -2 -1\nv 1 0 -2 -1\nv 0 1 -2 -1\n"  // behind the eye
      "object away\nt 0 1 2\n"
      "object half\nt 0 1 2\nt 3 4 5\n"
      "object behind\nt 6 7 8\n";
  Scene scene = read_capture(text, "objects.hpt");
  mark_outside_objects(scene);
  std::vector<std::uint8_t> marks;
  for (const Command& command : scene.commands)
    if (const auto* draw = std::get_if<Draw>(&command)) marks.push_back(draw->outside);
  EXPECT_EQ(marks, (std::vector<std::uint8_t>{kBoxOutside, 0, kBoxOutside}));
  const ObjectCounts counts = select_object_culling(scene, CullObjects::box);
  EXPECT_EQ(counts.in, 3u);
  EXPECT_EQ(counts.culled_box, 2u);
  EXPECT_EQ(counts.culled_sphere, 0u);
  EXPECT_EQ(counts.primitives_skipped, 2u);
}

TEST(ObjectCull, AnObjectWithinRoundingOfAPlaneIsKeptForAnyConvention) {
  Scene scene = read_capture(
      "halfplane 1\ntarget 8 8\nspace clip\nstate clip_z zero_one\n"
      "v -1 -1 -1e-17\nv 1 -1 -1e-17\nv -1 1 -1e-17\nt 0 1 2\n",
      "near.hpt");
  mark_outside_objects(scene);
  EXPECT_EQ(std::get<Draw>(scene.commands[0]).outside, 0);
  for (Vertex& v : scene.vertices) v.z = -1e-9;
  mark_outside_objects(scene);
  EXPECT_NE(std::get<Draw>(scene.commands[0]).outside, 0);
}

TEST(ObjectCull, LinesAndPointsAreAskedForNearAndFarOnly) {
  Scene scene;
  scene.vertices = {
      {1.001, 0, 0, 1, {}, 0, 0}, {1.001, 1, 0, 1, {}, 0, 0}, {0, 0, 2, 1, {}, 0, 0}, {0, 1, 2, 1, {}, 0, 0}};
  scene.indices = {0, 1, 2, 3};
  scene.states.push_back({});
  scene.objects = {"", "beside", "beyond"};
  scene.commands = {Draw{0, 1, Topology::lines, 0, 2, 0}, Draw{0, 2, Topology::points, 2, 2, 0}};
  mark_outside_objects(scene);
  EXPECT_EQ(std::get<Draw>(scene.commands[0]).outside, 0);
  EXPECT_EQ(std::get<Draw>(scene.commands[1]).outside, kBoxOutside);
}

TEST(ObjectCull, AWordThatIsNoneIsRefused) {
  EXPECT_THROW((void)parse_cull_objects("spheres"), InputError);
  EXPECT_EQ(parse_cull_objects("both"), CullObjects::both);
}

}  // namespace
}  // namespace halfplane::object_cull_test
