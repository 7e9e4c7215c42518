// Cameras: parsing, default framing, matrices.
#include "sim/scene/camera.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "model/config.hpp"
#include "sim/scene/mesh_scene.hpp"
#include "sim/scene/random.hpp"

namespace halfplane::camera_test {
namespace {

// A cloud of points in a box; one triangle, so that it can be a mesh.
Mesh cloud(const Vec3& low, const Vec3& high) {
  Mesh mesh;
  Random random(3);
  for (int i = 0; i < 200; ++i) {
    Vec3 p{};
    for (std::size_t k = 0; k < 3; ++k) p[k] = random.uniform(low[k], high[k]);
    mesh.vertices.push_back({p, {}, {255, 255, 255, 255}, 0, 0});
  }
  mesh.triangles = {{0, 1, 2}};
  mesh.objects = {""};
  mesh.parts = {{0, 0, 1, 0}};
  return mesh;
}

Vec3 normalized_device(const Camera& camera, double aspect, const Vec3& p) {
  const Vec4 clip = transform(projection_matrix(camera, aspect), transform(view_matrix(camera), {p[0], p[1], p[2], 1}));
  return {clip[0] / clip[3], clip[1] / clip[3], clip[2] / clip[3]};
}

void expect_near(const Vec3& actual, const Vec3& expected) {
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(actual[i], expected[i], 1e-12) << "component " << i;
}

std::string refusal(const std::string& text) {
  try {
    (void)frame(parse_camera(text), cloud({-1, -1, -1}, {1, 1, 1}), 1);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Camera, EveryPartIsRead) {
  const CameraRequest r = parse_camera("eye=0,1,3; target=-1e1,.5,+2;up=0,0,1;fov=45;near=.1;far=100;");
  EXPECT_EQ(r.eye, (Vec3{0, 1, 3}));
  EXPECT_EQ(r.target, (Vec3{-10, 0.5, 2}));
  EXPECT_EQ(r.up, (Vec3{0, 0, 1}));
  EXPECT_EQ(r.fov, 45);
  EXPECT_EQ(r.near, 0.1);
  EXPECT_EQ(r.far, 100);
  EXPECT_EQ(parse_camera("ortho=2").ortho, 2);
  EXPECT_EQ(parse_camera(""), CameraRequest());
}

TEST(Camera, BadPartsAreRefusedByName) {
  const std::vector<std::array<const char*, 2>> cases{{"eye=0,1", "eye=0,1 is not three numbers"},
                                                      {"eye=0,1,2,3", "eye=0,1,2,3 is not three numbers"},
                                                      {"eye=0,nan,1", "eye=nan is not a finite"},
                                                      {"fov=180", "not below 180"},
                                                      {"fov=0", "not above 0"},
                                                      {"near=-1", "near=-1 is not above 0"},
                                                      {"near=2;far=1", "not nearer than"},
                                                      {"near=2;far=2", "not nearer than"},
                                                      {"eye=1,1,1;target=1,1,1", "the same point"},
                                                      {"up=0,0,0", "no direction"},
                                                      {"fob=3", "unknown part 'fob'"},
                                                      {"fov", "no = in 'fov'"},
                                                      {"fov=40;fov=50", "'fov' is given twice"},
                                                      {"fov=40;ortho=2", "fov and ortho together"},
                                                      {"name=Main", "no cameras of its own"},
                                                      {"name=", "without a name"},
                                                      {"far=1e31", "beyond"},
                                                      {"ortho=0", "not above 0"}};
  for (const auto& [text, part] : cases) {
    const std::string message = refusal(text);
    EXPECT_NE(message.find(part), std::string::npos) << text << ": " << message;
    EXPECT_EQ(message.find("--camera: "), 0u) << message;
    EXPECT_NE(message.find("; "), std::string::npos) << message;
  }
}

TEST(Camera, MatricesPutAxesAndPlanesWhereOpenGlHasThem) {
  Camera camera;
  camera.eye = {0, 0, 5};
  camera.fov = 90;
  camera.near = 1;
  camera.far = 9;
  expect_near(normalized_device(camera, 2, {0, 0, 4}), {0, 0, -1});  // near plane
  expect_near(normalized_device(camera, 2, {0, 0, -4}), {0, 0, 1});  // far plane
  expect_near(normalized_device(camera, 2, {10, 5, 0}), {1, 1, normalized_device(camera, 2, {0, 0, 0})[2]});
  camera.ortho = 4;
  expect_near(normalized_device(camera, 2, {4, -2, 4}), {1, -1, -1});
  expect_near(normalized_device(camera, 2, {-4, 2, -4}), {-1, 1, 1});
}

TEST(Camera, ViewMatrixIsARotationThatKeepsDistances) {
  Camera camera;
  camera.eye = {3, -2, 7};
  camera.target = {-1, 4, 2};
  camera.up = {0.3, 1, 0.1};
  const Mat4 view = view_matrix(camera);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const double product = view[i][0] * view[j][0] + view[i][1] * view[j][1] + view[i][2] * view[j][2];
      EXPECT_NEAR(product, i == j ? 1 : 0, 1e-12);
    }
  }
  const Vec4 target = transform(view, {-1, 4, 2, 1});
  expect_near({target[0], target[1], target[2]}, {0, 0, -length(subtract(camera.eye, camera.target))});
}

TEST(Camera, DefaultFramingHoldsTheMeshAndFillsTheView) {
  for (const double aspect : {0.3, 1.0, 4.0 / 3, 3.0}) {
    for (const double size : {1e-20, 1e-3, 1.0, 1e6, 1e25}) {
      for (const char* text : {"", "fov=10", "fov=120", "up=0,0,1", "target=0,0,0"}) {
        const Mesh mesh = cloud({-2 * size, 0, -size}, {2 * size, size, 3 * size});
        const Camera camera = frame(parse_camera(text), mesh, aspect);
        double widest = 0;
        for (const MeshVertex& vertex : mesh.vertices) {
          const Vec3 p = normalized_device(camera, aspect, vertex.position);
          widest = std::max({widest, std::abs(p[0]), std::abs(p[1])});
          EXPECT_LT(std::abs(p[2]), 1) << text;
        }
        EXPECT_LT(widest, 1) << text << " aspect " << aspect << " size " << size;
        EXPECT_GT(widest, 0.75) << text << " aspect " << aspect << " size " << size;
      }
    }
  }
}

TEST(Camera, APointMeshAndOneFarFromTheOriginCanBeFramed) {
  for (const Vec3& place : {Vec3{0, 0, 0}, Vec3{1e30, 1e30, -1e30}, Vec3{1e-300, 0, 0}}) {
    const Camera camera = frame({}, cloud(place, place), 1);
    EXPECT_LT(camera.near, camera.far);
    for (const MeshVertex& vertex : cloud(place, place).vertices) {
      EXPECT_LT(length(normalized_device(camera, 1, vertex.position)), 2);
    }
  }
}

TEST(Camera, UpAlongTheViewIsReplaced) {
  for (const char* text : {"eye=0,5,0;target=0,0,0", "eye=0,-5,0;target=0,0,0", "eye=0,0,5;target=0,0,0;up=0,0,-2"}) {
    const Camera camera = frame(parse_camera(text), cloud({-1, -1, -1}, {1, 1, 1}), 1);
    const Vec3 forward = normalized(subtract(camera.target, camera.eye));
    EXPECT_GT(length(cross(forward, camera.up)), 0.5) << text;
  }
}

TEST(Camera, AnEyeInsideTheMeshKeepsNearInFrontOfIt) {
  const Camera camera = frame(parse_camera("eye=0,0,0.1;target=0,0,0"), cloud({-1, -1, -1}, {1, 1, 1}), 1);
  EXPECT_GT(camera.near, 0);
  EXPECT_LT(camera.near, 0.01);
  const Camera away = frame(parse_camera("eye=0,0,5;target=0,0,9"), cloud({-1, -1, -1}, {1, 1, 1}), 1);
  EXPECT_LT(away.near, away.far);  // all of the mesh is behind the eye
}

TEST(MeshScene, ALitFaceIsBrightestWhenItFacesTheEyeAndLitFromBothSides) {
  Mesh mesh = cloud({-1, -1, -1}, {1, 1, 1});
  const auto red = [&mesh](const Vec3& normal) {
    for (MeshVertex& vertex : mesh.vertices) vertex = {{0, 0, 0}, normal, {200, 100, 50, 255}, 0, 0};
    return mesh_scene(mesh, parse_camera("eye=0,0,5;target=0,0,0"), 64, 64).vertices[0].rgba[0];
  };
  EXPECT_NEAR(red({0, 0, 1}), 200, 1e-9);
  EXPECT_NEAR(red({0, 0, -1}), 200, 1e-9);
  EXPECT_LT(red({1, 0, 0}), 100);
  EXPECT_GT(red({1, 0, 0}), 20);
  mesh.lit = false;
  EXPECT_EQ(red({1, 0, 0}), 200);
}

TEST(MeshScene, ACameraThatThrowsVerticesOutOfBinary64IsRefused) {
  const Mesh mesh = cloud({-1e30, -1e30, -1e30}, {1e30, 1e30, 1e30});
  EXPECT_THROW((void)mesh_scene(mesh, parse_camera("eye=0,0,5;target=0,0,0;fov=1e-300"), 64, 64), InputError);
}

}  // namespace
}  // namespace halfplane::camera_test
