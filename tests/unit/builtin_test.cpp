// The built-in scenes, and their loading.
#include "sim/scene/builtin.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "model/capture/capture.hpp"
#include "model/config.hpp"
#include "sim/scene/builtin_meshes.hpp"
#include "sim/scene/load.hpp"
#include "sim/scene/random.hpp"

namespace halfplane::builtin_test {
namespace {

// The edges of a mesh by place, each in the direction in which its triangle runs along it.
using Edges = std::map<std::pair<Vec3, Vec3>, int>;

Edges edges_of(const Mesh& mesh) {
  Edges edges;
  for (const auto& t : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      ++edges[{mesh.vertices[t[i]].position, mesh.vertices[t[(i + 1) % 3]].position}];
    }
  }
  return edges;
}

// Edges with no partner in the other direction, as a way from point to point.
std::map<Vec3, Vec3> open_edges(const Edges& edges) {
  std::map<Vec3, Vec3> open;
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1) << "two triangles run the same way along one edge";
    if (edges.count({edge.second, edge.first}) == 0) open.insert(edge);
  }
  return open;
}

double volume(const Mesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangles) {
    const auto at = [&](std::size_t i) { return mesh.vertices[t[i]].position; };
    sum += dot(at(0), cross(at(1), at(2))) / 6;
  }
  return sum;
}

std::string message_of(const SceneRequest& request) {
  std::vector<std::string> warnings;
  try {
    (void)load_scene(request, warnings);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Teapot, ItHasTheKnownCountOfTrianglesAndSize) {
  for (const int n : {1, 2, 10, 37}) {
    const Mesh mesh = teapot_mesh(n);
    EXPECT_EQ(mesh.triangles.size(), static_cast<std::size_t>(64 * n * n - 8 * n)) << n;
  }
  Vec3 low{9, 9, 9}, high{-9, -9, -9};
  for (const MeshVertex& vertex : teapot_mesh(40).vertices) {
    for (std::size_t i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], vertex.position[i]);
      high[i] = std::max(high[i], vertex.position[i]);
    }
  }
  // Handle to spout; the top of the knob; as wide as the belly. Bezier curves stay inside their control points: the
  // belly's radius is 2 at its control points and 1.98 or so on the surface.
  EXPECT_NEAR(low[0], -3, 1e-9);
  EXPECT_NEAR(high[0], 3.434, 2e-3);
  EXPECT_NEAR(low[1], 0, 1e-9);
  EXPECT_NEAR(high[1], 3.15, 1e-9);
  EXPECT_NEAR(high[2], 2, 0.03);
  EXPECT_NEAR(low[2], -high[2], 1e-9);
}

// Newell's pot is not sealed: the lid lies loose on the rim, and handle and spout are stuck into the body.
TEST(Teapot, ItIsClosedButForItsSixKnownRims) {
  for (const int n : {3, 10, 23}) {
    std::map<Vec3, Vec3> open = open_edges(edges_of(teapot_mesh(n)));
    std::multiset<std::size_t> loops;
    while (!open.empty()) {
      std::size_t length = 0;
      for (auto at = open.begin(); at != open.end(); ++length) {
        const Vec3 next = at->second;
        open.erase(at);
        at = open.find(next);
      }
      loops.insert(length);
    }
    const std::size_t half = static_cast<std::size_t>(2 * n), full = static_cast<std::size_t>(4 * n);
    EXPECT_EQ(loops, (std::multiset<std::size_t>{half, half, half, half, full, full})) << n;
  }
}

TEST(Teapot, NormalsPointOutwardsAndAgreeWithTheTriangles) {
  const Mesh mesh = teapot_mesh(24);
  EXPECT_GT(volume(mesh), 25);
  for (const auto& t : mesh.triangles) {
    const MeshVertex &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const Vec3 facing = normalized(cross(subtract(b.position, a.position), subtract(c.position, a.position)));
    for (const MeshVertex* vertex : {&a, &b, &c}) {
      EXPECT_NEAR(length(vertex->normal), 1, 1e-12);
      EXPECT_GT(dot(vertex->normal, facing), 0.8);
    }
  }
}

TEST(Teapot, TheNormalsAtItsTwoPolesAreVertical) {
  int poles = 0;
  for (const MeshVertex& vertex : teapot_mesh(10).vertices) {
    if (vertex.position[0] != 0 || vertex.position[2] != 0) continue;
    ++poles;
    EXPECT_NEAR(vertex.normal[1], vertex.position[1] > 1 ? 1 : -1, 1e-9) << vertex.position[1];
  }
  EXPECT_EQ(poles, 2);
}

TEST(Knot, TheTubeIsClosedAndItsFrontIsOutside) {
  const Mesh mesh = knot_mesh(64);
  EXPECT_TRUE(open_edges(edges_of(mesh)).empty());
  EXPECT_NEAR(volume(mesh), 16, 0.5);  // pi * 0.42^2 * the line's length of 29, minus the facets' loss
}

TEST(City, EveryBoxIsClosedAndSeenFromOutside) {
  const Mesh mesh = city_mesh(50, 3);
  EXPECT_EQ(mesh.triangles.size(), 50u * 12 + 2);
  EXPECT_EQ(open_edges(edges_of(mesh)).size(), 4u);  // the ground's
  EXPECT_EQ(mesh.objects.size(), 51u);
  EXPECT_GT(volume(mesh), 0);
}

TEST(Walk, TheCorridorIsClosedAndSeenFromInside) {
  const Mesh mesh = corridor_mesh();
  EXPECT_TRUE(open_edges(edges_of(mesh)).empty());
  EXPECT_NEAR(volume(mesh), -4 * 3 * 40, 1e-9);
}

TEST(Walk, TrianglesCrossAllSixPlanesOfTheFrustum) {
  const Scene scene = make_builtin("walk", 640, 480, {}, 1);
  std::array<int, 6> crossing{};
  for (std::size_t i = 0; i < scene.indices.size(); i += 3) {
    for (std::size_t plane = 0; plane < 6; ++plane) {
      int inside = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const Vertex& v = scene.vertices[scene.indices[i + k]];
        const double value = std::array<double, 3>{v.x, v.y, v.z}[plane / 2];
        inside += (plane % 2 == 0 ? value : -value) <= v.w ? 1 : 0;
      }
      crossing[plane] += inside == 1 || inside == 2 ? 1 : 0;
    }
  }
  for (const int count : crossing) EXPECT_GT(count, 0);
}

// Whether the ray through (x, y) of the screen, -1...1, hits the triangle between the near and the far plane.
bool ray_hits(const Vertex& a, const Vertex& b, const Vertex& c, double x, double y) {
  const auto side = [&](const Vertex& p,
                        const Vertex& q) {  // homogeneous edge function: the triple product (x y 1) p q
    return x * (p.y * q.w - p.w * q.y) + y * (p.w * q.x - p.x * q.w) + (p.x * q.y - p.y * q.x);
  };
  double u = side(b, c), v = side(c, a), w = side(a, b);
  const double sum = u * a.w + v * b.w + w * c.w, z = u * a.z + v * b.z + w * c.z;
  if (sum < 0) {
    u = -u;
    v = -v;
    w = -w;
  }
  return u >= 0 && v >= 0 && w >= 0 && std::abs(z) <= std::abs(sum);
}

TEST(Walk, EveryPixelSeesTheShellExactlyOnceAtEveryAspect) {
  Random random(11);
  for (const auto& [width, height] : {std::pair{640, 480}, {1920, 1080}, {2560, 1080}, {300, 900}}) {
    const Scene scene = make_builtin("walk", width, height, {}, 1);
    for (int ray = 0; ray < 300; ++ray) {
      const double x = random.uniform(-1, 1), y = random.uniform(-1, 1);
      int hits = 0;
      for (std::size_t i = 0; i < scene.indices.size(); i += 3) {
        const auto at = [&](std::size_t k) { return scene.vertices[scene.indices[i + k]]; };
        hits += ray_hits(at(0), at(1), at(2), x, y) ? 1 : 0;
      }
      ASSERT_EQ(hits, 1) << width << "x" << height << " at " << x << ", " << y;
    }
  }
}

TEST(Builtin, EverySceneKeepsTheInvariantsAndIsTheSameEachTime) {
  for (const Builtin& builtin : builtin_scenes()) {
    const Scene scene = make_builtin(builtin.name, 320, 200, {}, 5);
    EXPECT_EQ(scene.name, builtin.name);
    EXPECT_EQ(scene.width, 320);
    EXPECT_FALSE(scene.indices.empty());
    for (const std::uint32_t index : scene.indices) ASSERT_TRUE(index < scene.vertices.size() || index == kRestart);
    for (const Vertex& v : scene.vertices) {
      ASSERT_TRUE(std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z) && std::isfinite(v.w));
      for (const double channel : v.rgba) ASSERT_TRUE(channel >= 0 && channel <= 255);
    }
    EXPECT_TRUE(same_scene(scene, make_builtin(builtin.name, 320, 200, {}, 5))) << builtin.name;
    const bool seeded = builtin.name == "city" || builtin.name == "slivers";
    EXPECT_EQ(same_scene(scene, make_builtin(builtin.name, 320, 200, {}, 6)), !seeded) << builtin.name;
  }
}

TEST(Builtin, ACaptureOfAnySceneReadsBackTheSame) {
  for (const Builtin& builtin : builtin_scenes()) {
    const Scene scene = make_builtin(builtin.name, 320, 200, {}, 5);
    std::ostringstream text;
    write_capture(scene, text);
    EXPECT_TRUE(same_scene(scene, read_capture(text.str(), "scene.hpt"))) << builtin.name;
  }
}

TEST(Builtin, SizesAreCheckedAgainstTheirRange) {
  EXPECT_EQ(make_builtin("slivers:7", 64, 64, {}, 1).indices.size(), 21u);
  for (const char* name : {"teapot:0", "teapot:129", "teapot:", "teapot:x", "teapot:4x", "walk:3", "city:-1"}) {
    EXPECT_THROW((void)make_builtin(name, 64, 64, {}, 1), InputError) << name;
  }
}

TEST(Load, UnknownNamesAreListedAndTheNearestSuggested) {
  const std::string message = message_of({.name = "taepot:4"});
  EXPECT_NE(message.find("did you mean teapot?"), std::string::npos) << message;
  for (const Builtin& builtin : all_builtin_scenes()) EXPECT_NE(message.find(builtin.name), std::string::npos);
  EXPECT_EQ(message_of({.name = "model.stl"}).find("did you mean"), std::string::npos);
}

TEST(Load, WhatIsNotInThisVersionOrMakesNoSenseIsSaid) {
  EXPECT_NE(message_of({.name = "a.glb"}).find("a.glb: cannot be read"), std::string::npos);
  EXPECT_NE(message_of({.name = "a.glb", .camera = "fob=3"}).find("unknown part"), std::string::npos);
  EXPECT_NE(message_of({.name = "a.hpt", .camera = "fov=3"}).find("is a capture"), std::string::npos);
  EXPECT_NE(message_of({.name = "triangle", .camera = "fov=3"}).find("clip space"), std::string::npos);
  EXPECT_NE(message_of({.name = "teapot", .width = 640}).find("--size"), std::string::npos);
  EXPECT_NE(message_of({.name = "teapot", .camera = "name=x"}).find("no cameras"), std::string::npos);
  EXPECT_NE(message_of({.name = "no such.obj"}).find("no such.obj"), std::string::npos);
}

TEST(Load, SizesApplyToMeshesAndToClipSpaceCapturesOnly) {
  std::vector<std::string> warnings;
  const auto file = [](const std::string& name, const std::string& text) {
    const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / name;
    std::ofstream(path) << text;
    return path.string();
  };
  const std::string start = "halfplane 1\ntarget 32 16\nspace ", end = "\nv 0 0 0 1\nv 1 0 0 1\nv 0 1 0 1\nt 0 1 2\n";
  const std::string clip = file("clip.hpt", start + "clip" + end), window = file("window.hpt", start + "window" + end);
  const std::string mesh = file("mesh.OBJ", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_EQ(load_scene({.name = clip}, warnings).width, 32);
  EXPECT_EQ(load_scene({.name = clip, .width = 64, .height = 48}, warnings).height, 48);
  EXPECT_EQ(load_scene({.name = window, .width = 32, .height = 16}, warnings).width, 32);
  EXPECT_NE(message_of({.name = window, .width = 64, .height = 48}).find("window-space"), std::string::npos);
  EXPECT_EQ(load_scene({.name = mesh}, warnings).width, 640);
  EXPECT_EQ(load_scene({.name = mesh, .width = 64, .height = 48}, warnings).width, 64);
  EXPECT_TRUE(warnings.empty());
}

}  // namespace
}  // namespace halfplane::builtin_test
