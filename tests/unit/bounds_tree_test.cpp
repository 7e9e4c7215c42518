// Objects under a tree, and the computation skipped for objects outside: every bit equals the result without a tree.
#include "sim/scene/bounds_tree.hpp"

#include <gtest/gtest.h>

#include <array>
#include <iostream>
#include <string>
#include <vector>

#include "../random_camera.hpp"
#include "model/config.hpp"
#include "model/engines/functional.hpp"
#include "model/engines/scalar.hpp"
#include "sim/scene/builtin.hpp"
#include "sim/scene/convention.hpp"
#include "sim/scene/gltf.hpp"
#include "sim/scene/host_geometry.hpp"
#include "sim/scene/load.hpp"
#include "sim/scene/mesh_scene.hpp"
#include "sim/scene/random.hpp"

#include "halfplane_paths.hpp"

namespace halfplane::bounds_tree_test {
namespace {

constexpr std::array kTests{CullObjects::sphere, CullObjects::box, CullObjects::both};

Mat4 matrix_of(const CameraRequest& request) {
  Mesh point;
  point.vertices.emplace_back();
  const Camera camera = frame(request, point, 1.3);
  return product(projection_matrix(camera, 1.3), view_matrix(camera));
}

/// Boxes of all sizes, whole numbers now and then, so that faces lie in one plane; every tenth object is empty.
std::vector<ObjectBounds> random_bounds(Random& random, int count, double shrunk = 1) {
  std::vector<ObjectBounds> bounds;
  for (int i = 0; i < count; ++i) {
    ObjectBounds& b = bounds.emplace_back();
    const bool is_whole = random.uniform(0, 3) < 1, is_empty = random.uniform(0, 10) < 1;
    Vec3 half{};
    const double size = std::exp2(random.uniform(-6, 2));
    for (std::size_t k = 0; k < 3; ++k) {
      b.center[k] = random.uniform(-20, 20);
      half[k] = size * random.uniform(0, 1);
      if (is_whole) {
        b.center[k] = std::floor(b.center[k]);
        half[k] = std::ceil(half[k]);
      }
      half[k] *= shrunk;
      b.low[k] = b.center[k] - half[k];
      b.high[k] = b.center[k] + half[k];
    }
    if (!is_empty) b.radius = length(half) * random.uniform(0.6, 1);
  }
  return bounds;
}

std::vector<std::uint8_t> one_by_one(const std::vector<ObjectBounds>& bounds, const Mat4& to_clip, std::uint8_t tests) {
  std::vector<std::uint8_t> outside;
  for (const ObjectBounds& of : bounds) outside.push_back(outside_view(of, to_clip) & tests);
  return outside;
}

TEST(BoundsTree, SaysOfEachObjectWhatItsOwnTestSays) {
  std::size_t outside = 0, differences_of_shrunk = 0, by_node = 0, inside = 0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    Random random(seed);
    const int count = static_cast<int>(random.uniform(0, 200));
    const Random same = random;
    const std::vector<ObjectBounds> bounds = random_bounds(random, count);
    const BoundsTree tree(bounds);
    // A tree over bounds that are too small is detected.
    Random again = same;
    const BoundsTree wrong(random_bounds(again, count, 0.5));
    for (int view = 0; view < 20; ++view) {
      CameraRequest camera = test::random_camera(random, 20, -0.3, 0.5, 10);
      if (view % 4 == 0) {  // planes through whole numbers
        camera = {};
        camera.eye = Vec3{0, 0, std::floor(random.uniform(-10, 10))};
        camera.target = Vec3{0, 0, (*camera.eye)[2] - 1};
        camera.near = 1;
        camera.far = 9;
        camera.ortho = 2 * std::ceil(random.uniform(1, 10));
      }
      const Mat4 to_clip = matrix_of(camera);
      for (const CullObjects tests : kTests) {
        BoundsWork work, ignored;
        const std::uint8_t bits = bits_of(tests);
        const std::vector<std::uint8_t> expected = one_by_one(bounds, to_clip, bits);
        ASSERT_EQ(tree.outside_view(to_clip, bits, work), expected) << "seed " << seed << ", view " << view;
        differences_of_shrunk += wrong.outside_view(to_clip, bits, ignored) != expected ? 1 : 0;
        for (const std::uint8_t found : expected) outside += found != 0 ? 1 : 0;
        by_node += work.nodes_outside;
        inside += work.nodes_inside;
      }
    }
  }
  EXPECT_GT(outside, 100000U);
  EXPECT_GT(by_node, 10000U);
  EXPECT_GT(inside, 1000U);
  EXPECT_GT(differences_of_shrunk, 1000U);
}

TEST(BoundsTree, OfManyObjectsFewAreAsked) {
  Random random(5);
  const std::vector<ObjectBounds> bounds = random_bounds(random, 10000);
  const BoundsTree tree(bounds);
  CameraRequest camera;
  camera.eye = Vec3{0, 0, 0};
  camera.target = Vec3{0, 0, -1};
  camera.near = 0.1;
  camera.far = 100;
  camera.fov = 20;
  BoundsWork work;
  (void)tree.outside_view(matrix_of(camera), kBoxOutside, work);
  EXPECT_LT(work.tests, 2500U);
  EXPECT_GT(work.nodes_outside, 50U);
}

void expect_same(const Rendering& a, const Rendering& b, const std::string& what) {
  EXPECT_EQ(a.frame.color, b.frame.color) << what;
  EXPECT_EQ(a.frame.depth, b.frame.depth) << what;
  EXPECT_EQ(a.ids, b.ids) << what;
  EXPECT_EQ(a.count, b.count) << what;
  const Counters &x = a.counters, &y = b.counters;
  EXPECT_EQ(x.primitives_in, y.primitives_in) << what;
  EXPECT_EQ(x.culled, y.culled) << what;
  EXPECT_EQ(x.drawn, y.drawn) << what;
  EXPECT_EQ(x.clipped, y.clipped) << what;
  EXPECT_EQ(x.covered, y.covered) << what;
  EXPECT_EQ(x.depth_passed, y.depth_passed) << what;
  EXPECT_EQ(x.written, y.written) << what;
  EXPECT_EQ(x.tiles_visited, y.tiles_visited) << what;
  for (const SkipName& skip : kSkipNames)
    EXPECT_EQ(x.skipped.*skip.counter, y.skipped.*skip.counter) << what << ": " << skip.name;
}

Rendering draw(const Scene& scene) {
  RenderOptions options;
  options.want_ids = true;
  options.want_count = true;
  return render_functional(scene, preset("embedded"), options);
}

/// Draws `make` with all objects and with only the visible ones. Returns the skipped vertices.
template <class Make>
std::size_t expect_nothing_is_missed(const Make& make, const std::string& what,
                                     TransformNumbers numbers = TransformNumbers::binary64) {
  const auto finished = [numbers](const Scene& scene) { return in_host_numbers(scene, numbers, preset("embedded")); };
  std::size_t skipped = 0;
  std::optional<PlacedMesh> kept;
  for (const CullObjects tests : kTests) {
    MeshWork work;
    MeshOptions options;
    options.has_tree = false;
    Scene whole = make(options);
    const ObjectCounts expected = select_object_culling(whole, tests);
    options = {};
    options.leaves_out = tests;
    options.work = &work;
    options.kept = &kept;
    Scene seen = make(options);
    const ObjectCounts counts = select_object_culling(seen, tests);
    EXPECT_EQ(counts.in, expected.in) << what;
    EXPECT_EQ(counts.culled_sphere, expected.culled_sphere) << what;
    EXPECT_EQ(counts.culled_box, expected.culled_box) << what;
    EXPECT_EQ(counts.primitives_skipped, expected.primitives_skipped) << what;
    EXPECT_NO_THROW(validate(seen)) << what;
    expect_same(draw(finished(whole)), draw(finished(seen)), what);
    const auto turned = [&finished](const Scene& scene) {
      return finished(in_convention(scene, parse_convention("fcg")));
    };
    expect_same(draw(turned(whole)), draw(turned(seen)), what + ", turned");
    skipped += work.vertices_skipped;
  }
  return skipped;
}

TEST(BoundsTree, LeavingVerticesOutChangesNoPixelIdOrCounter) {
  const std::array<std::vector<std::string>, 4> lights{
      {{}, {"from=1,2,3", "ambient=0.2,0.2,0.2"}, {"at=1,2,3;range=9"}, {"phong", "from=1,2,3"}}};
  std::size_t skipped = 0;
  for (const char* name : {"city:60", "objects:200", "teapot:2", "wires", "wireframe:2", "walk"}) {
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
      Random random(seed);
      const CameraRequest camera = test::random_camera(random, 12, -0.3, 0.5, 10);
      const auto make = [&](MeshOptions options) {
        options.light = parse_lights(lights[seed % lights.size()]);
        return make_builtin(name, 120, 90, camera, 1, options);
      };
      skipped += expect_nothing_is_missed(make, std::string(name) + ", camera of seed " + std::to_string(seed));
    }
  }
  EXPECT_GT(skipped, 100000U);
}

TEST(BoundsTree, SmallerNumbersOfTheHostTakeWhatIsLeft) {
  for (const TransformNumbers numbers : {TransformNumbers::binary32, TransformNumbers::s15_16}) {
    Random random(3);
    for (int i = 0; i < 5; ++i) {
      const CameraRequest camera = test::random_camera(random, 12, -0.3, 0.5, 10);
      const auto make = [&](MeshOptions options) {
        options.transform = numbers;
        return make_builtin("city:60", 120, 90, camera, 1, options);
      };
      (void)expect_nothing_is_missed(make, "view " + std::to_string(i), numbers);
    }
  }
}

/// A chain of triangles, of several objects, that bends with the time, like a skin or morph target: its bounds are the
/// bounds of the moved vertices.
Mesh bent_chain(double time, int links) {
  Mesh mesh;
  mesh.materials.resize(2);
  mesh.materials[1].is_two_sided = false;
  for (int i = 0; i < links; ++i) {
    const double turn = 0.13 * i + time, reach = 0.3 * i;
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const double along : {0.0, 0.5, 1.0}) {
      MeshVertex& v = mesh.vertices.emplace_back();
      v.position = {reach * std::cos(turn + along * 0.1), along + std::sin(turn), reach * std::sin(turn + along)};
      v.normal = normalized({0.1, 1, along});
      v.rgba = {255 * along, 200 - 10.0 * (i % 20), 100, 200};
      v.material = static_cast<std::uint32_t>(i % 2);
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
    MeshPart part{static_cast<std::uint32_t>(mesh.objects.size()), static_cast<std::size_t>(i), 1};
    if (i % 3 == 0) part.alpha = AlphaMode::blend;
    mesh.parts.push_back(part);
    mesh.objects.push_back("link " + std::to_string(i));
  }
  return mesh;
}

TEST(BoundsTree, WhatBendsIsAskedWhereItIsNow) {
  std::size_t skipped = 0;
  for (int frame = 0; frame < 12; ++frame) {
    const Mesh mesh = bent_chain(0.5 * frame, 60);
    Random random(static_cast<std::uint64_t>(frame) + 1);
    const CameraRequest camera = test::random_camera(random, 8, -0.3, 0.5, 10);
    const MeshPlaces places(mesh);
    const auto make = [&](MeshOptions options) {
      options.places = frame % 2 == 0 ? &places : nullptr;
      return mesh_scene(mesh, camera, 120, 90, Cull::none, options);
    };
    skipped += expect_nothing_is_missed(make, "frame " + std::to_string(frame));
  }
  EXPECT_GT(skipped, 1000U);
}

TEST(BoundsTree, PlacesThatAreTooSmallAreSeenInThePicture) {
  // The seeded fault: the places of half the mesh, about the middle of each object.
  std::size_t different = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Mesh mesh = bent_chain(0.3, 60);
    Random random(seed);
    const CameraRequest camera = test::random_camera(random, 8, -0.3, 0.5, 10);
    MeshPlaces wrong(mesh);
    for (ObjectBounds& of : wrong.bounds) {
      of.radius *= 0.1;
      for (std::size_t i = 0; i < 3; ++i) {
        of.low[i] = of.center[i] + 0.1 * (of.low[i] - of.center[i]);
        of.high[i] = of.center[i] + 0.1 * (of.high[i] - of.center[i]);
      }
    }
    wrong.tree = BoundsTree(wrong.bounds);
    MeshOptions options;
    const Rendering expected = draw(mesh_scene(mesh, camera, 120, 90, Cull::none, options));
    options.leaves_out = CullObjects::box;
    options.places = &wrong;
    different += draw(mesh_scene(mesh, camera, 120, 90, Cull::none, options)).ids != expected.ids ? 1 : 0;
  }
  EXPECT_GT(different, 2U);
}

TEST(BoundsTree, FramesOfAMovingFileAreThoseWithout) {
  for (const char* file : {"skinned.gltf", "full.gltf"}) {
    SceneRequest request{HALFPLANE_TEST_DATA "/../fuzz/corpus/gltf/" + std::string(file), 120, 90, "orbit"};
    std::vector<std::string> warnings;
    const MovingScene whole = open_scene(request, warnings);
    request.leaves_out = CullObjects::both;
    const MovingScene seen = open_scene(request, warnings);
    const std::optional<double> end = whole.end();
    for (int i = 0; i < 8; ++i) {
      Moment moment{std::nullopt, i / 8.0};
      if (end) moment.time = *end * i / 8;
      Scene a = whole.at(moment), b = seen.at(moment);
      (void)select_object_culling(a, CullObjects::both);
      (void)select_object_culling(b, CullObjects::both);
      expect_same(draw(a), draw(b), std::string(file) + ", frame " + std::to_string(i));
    }
  }
}

TEST(BoundsTree, TheMeshOfABuiltInSceneIsMadeOnceAndIsTheSame) {
  SceneRequest request{"city:30", 120, 90, "orbit"};
  request.leaves_out = CullObjects::box;
  std::vector<std::string> warnings;
  const MovingScene source = open_scene(request, warnings);
  for (const double turn : {0.0, 0.3, 0.6, 0.3}) {
    CameraRequest camera = parse_camera("orbit");
    *camera.orbit *= turn;
    Scene scene = source.at({std::nullopt, turn});
    (void)select_object_culling(scene, CullObjects::box);
    Scene alone = make_builtin("city:30", 120, 90, camera, 1, {});
    (void)select_object_culling(alone, CullObjects::box);
    expect_same(draw(scene), draw(alone), "turn " + std::to_string(turn));
  }
  ASSERT_TRUE(source.work);
  EXPECT_GT(source.work->bounds.tests, 0U);
}

}  // namespace
}  // namespace halfplane::bounds_tree_test
