#include "sim/scene/bench_scenes.hpp"

#include <algorithm>
#include <map>
#include <numbers>
#include <string>

#include "sim/scene/mesh_scene.hpp"
#include "sim/scene/random.hpp"

namespace halfplane {
namespace {

constexpr double kFullTurn = 2 * std::numbers::pi;

// A colour of the colour circle at `turn` in 0...1; `light` in 0...1 scales it.
std::array<double, 4> tint(double turn, double light) {
  std::array<double, 4> rgba{0, 0, 0, 255};
  for (std::size_t c = 0; c < 3; ++c)
    rgba[c] = light * (150 + 105 * std::cos(kFullTurn * (turn - static_cast<double>(c) / 3)));
  return rgba;
}

std::array<double, 4> random_color(Random& random) {
  return {random.uniform(30, 255), random.uniform(30, 255), random.uniform(30, 255), 255};
}

// One draw of all vertices' indices, as one object.
void draw_indices(Scene& scene, const char* object, Topology topology) {
  scene.objects.emplace_back(object);
  scene.commands.push_back(Draw{0, 1, topology, 0, scene.indices.size(), 0});
}

// Half-screen triangles, lower left and upper right alternating. Each is tilted by less than a quarter of the distance
// to the next, so that no two intersect.
Scene layers_scene(int width, int height, int layers, bool is_front_first) {
  Scene scene = cleared_scene(width, height);
  const double spacing = 1.8 / layers;  // of normalised device z
  for (int i = 0; i < layers; ++i) {
    const int rank = is_front_first ? i : layers - 1 - i;  // 0 is the nearest
    const double z = -0.9 + spacing * (rank + 0.5), side = rank % 2 == 0 ? 1 : -1;
    for (int corner = 0; corner < 3; ++corner) {
      const double turn = std::fmod(0.381966 * rank + corner / 3.0, 1);  // the golden angle: neighbours differ
      const double x = corner == 1 ? side : -side, y = corner == 2 ? side : -side;
      scene.indices.push_back(static_cast<std::uint32_t>(scene.vertices.size()));
      scene.vertices.push_back({x, y, z + spacing * 0.2 * std::sin(kFullTurn * turn), 1, tint(turn, 0.9), 0, 0});
    }
  }
  draw_indices(scene, "layers", Topology::triangles);
  return scene;
}

// A texture of lines for all draws.
void add_grid(Scene& scene, int side, bool is_linear) {
  scene.textures.push_back(
      make_texture("grid", pattern_image(TexturePattern::grid, side, side), TextureFormat::rgba8888, Mips::none));
  for (State& state : scene.states) {
    state.texture = 0;
    state.texture_min = is_linear ? TextureMin::linear : TextureMin::nearest;
    state.texture_mag = is_linear ? TextureMag::linear : TextureMag::nearest;
  }
}

// The layers with a texture, seen in perspective: w is 1, 2 and 4 at their corners, and a texel is about the size of a
// pixel.
Scene textured_layers_scene(int width, int height, int layers, bool is_front_first, bool is_linear) {
  constexpr int kSide = 256;  // texels
  Scene scene = layers_scene(width, height, layers, is_front_first);
  for (std::size_t i = 0; i < scene.vertices.size(); ++i) {
    Vertex& v = scene.vertices[i];
    v.u = (v.x + 1) / 2 * width / kSide;
    v.v = (1 - v.y) / 2 * height / kSide;
    const double w = static_cast<double>(1 << (i + i / 3) % 3);
    v = {v.x * w, v.y * w, v.z * w, w, v.rgba, v.u, v.v};
  }
  add_grid(scene, kSide, is_linear);
  return scene;
}

// The layers as coloured glass: each passes a third to two thirds of the light from behind.
Scene glass_scene(int width, int height, int layers) {
  Scene scene = layers_scene(width, height, layers, false);
  for (std::size_t i = 0; i < scene.vertices.size(); ++i)
    scene.vertices[i].rgba[3] = 85 + static_cast<double>(i * 37 % 86);
  State& state = scene.states[0];
  state.blend = BlendFactors{BlendFactor::src_alpha, BlendFactor::one_minus_src_alpha, BlendFactor::one,
                             BlendFactor::one_minus_src_alpha};
  state.depth_write = false;
  return scene;
}

// The layers with holes: chequer texels, every other one transparent.
Scene leaves_scene(int width, int height, int layers) {
  constexpr int kSide = 256;  // texels
  Scene scene = textured_layers_scene(width, height, layers, false, true);
  TexelImage image = pattern_image(TexturePattern::chequer, kSide, kSide);
  for (Texel& texel : image.texel) texel[3] = texel[0];
  scene.textures[0] = make_texture("leaves", image, TextureFormat::rgba8888, Mips::none);
  scene.states[0].alpha_test = {DepthFunc::gequal, 128};
  return scene;
}

// 40 to 80 pixels long, for any target size; ends may lie outside it.
Scene scratches_scene(int width, int height, int count, std::uint64_t seed) {
  Scene scene = cleared_scene(width, height);
  Random random(seed);
  for (int i = 0; i < count; ++i) {
    const double x = random.uniform(-1, 1), y = random.uniform(-1, 1);
    const double angle = random.uniform(0, kFullTurn), half = random.uniform(20, 40);
    for (const double sign : {-1.0, 1.0}) {
      const double dx = sign * half * std::cos(angle) * 2 / width, dy = sign * half * std::sin(angle) * 2 / height;
      const double z = random.uniform(-0.95, 0.95);
      scene.indices.push_back(static_cast<std::uint32_t>(scene.vertices.size()));
      scene.vertices.push_back({x + dx, y + dy, z, 1, random_color(random), 0, 0});
    }
  }
  draw_indices(scene, "scratches", Topology::lines);
  return scene;
}

// A grid over the whole screen. Inner vertices are moved by less than a quarter of a cell, so that no triangle is
// reversed and every pixel is covered once.
Scene dust_scene(int width, int height, int triangles, std::uint64_t seed) {
  constexpr double kJitter = 0.24;
  Scene scene = cleared_scene(width, height);
  Random random(seed);
  const double cells = std::max(1.0, triangles / 2.0), aspect = static_cast<double>(width) / height;
  const auto columns = static_cast<std::uint32_t>(std::clamp(std::round(std::sqrt(cells * aspect)), 1.0, cells));
  const auto rows = static_cast<std::uint32_t>(std::max(1.0, std::round(cells / columns)));
  const auto place = [&random](std::uint32_t i, std::uint32_t count) {
    const double offset = random.uniform(-kJitter, kJitter);
    return 2 * (i + (i == 0 || i == count ? 0 : offset)) / count - 1;
  };
  for (std::uint32_t j = 0; j <= rows; ++j)
    for (std::uint32_t i = 0; i <= columns; ++i) {
      const double x = place(i, columns), y = place(j, rows), z = random.uniform(-0.95, 0.95);
      scene.vertices.push_back({x, y, z, 1, random_color(random), 0, 0});
    }
  for (std::uint32_t j = 0; j < rows; ++j)
    for (std::uint32_t i = 0; i < columns; ++i) {
      const std::uint32_t a = j * (columns + 1) + i, b = a + 1, c = b + columns, d = c + 1;
      scene.indices.insert(scene.indices.end(), {a, b, d, a, d, c});
    }
  draw_indices(scene, "dust", Topology::triangles);
  return scene;
}

// Makes all triangles since the last part an object of their own.
void close_object(Mesh& mesh, const std::string& name, bool is_two_sided) {
  const std::size_t first = mesh.parts.empty() ? 0 : mesh.parts.back().first + mesh.parts.back().count;
  mesh.parts.push_back({static_cast<std::uint32_t>(mesh.objects.size()), first, mesh.triangles.size() - first, 0,
                        is_two_sided, Topology::triangles});
  mesh.objects.push_back(name);
}

// A part of the unit sphere round `center`: `rings` rings of `segments` quads, from `top` to `bottom` (angles from +y).
void add_sphere(Mesh& mesh, const Vec3& center, int rings, int segments, double top, double bottom) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  const auto across = static_cast<std::uint32_t>(segments);
  for (int j = 0; j <= rings; ++j)
    for (int i = 0; i < segments; ++i) {
      const double down = top + (bottom - top) * j / rings, turn = static_cast<double>(i) / segments;
      const double r = j == rings && bottom == std::numbers::pi ? 0 : std::sin(down);  // the pole is one point
      const Vec3 normal{r * std::cos(kFullTurn * turn), std::cos(down), -r * std::sin(kFullTurn * turn)};
      const double wave = 0.75 + 0.25 * std::sin(9 * down + 5 * kFullTurn * turn);
      mesh.vertices.push_back({add(center, normal), normal, tint(turn + 0.1 * down, wave), 0, 0});
    }
  for (std::uint32_t j = 0; j < static_cast<std::uint32_t>(rings); ++j)
    for (std::uint32_t i = 0; i < across; ++i) {
      const std::uint32_t a = first + j * across + i, b = first + j * across + (i + 1) % across;
      mesh.triangles.push_back({a, a + across, b + across});
      mesh.triangles.push_back({a, b + across, b});
    }
}

Mesh ball_mesh(int rings) {
  Mesh mesh;
  mesh.lit = false;
  add_sphere(mesh, {}, rings, 2 * rings, 0, std::numbers::pi);
  close_object(mesh, "ball", true);
  return mesh;
}

// The ball with a texture, eight times around it and four times from pole to pole.
Mesh textured_ball_mesh(int rings) {
  Mesh mesh = ball_mesh(rings);
  const std::size_t around = 2 * static_cast<std::size_t>(rings);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    mesh.vertices[i].u = 8.0 * static_cast<double>(i % around) / static_cast<double>(around);
    mesh.vertices[i].v = 4.0 * static_cast<double>(i / around) / rings;
  }
  return mesh;
}

// Two open bowls: the left one two-sided, the right one with its back faces culled, so that its inside is missing.
Mesh shell_mesh(int rings) {
  Mesh mesh;
  for (const bool is_right : {false, true}) {
    add_sphere(mesh, {is_right ? 1.15 : -1.15, 0, 0}, rings, 4 * rings, 0.5 * std::numbers::pi, std::numbers::pi);
    close_object(mesh, is_right ? "culled" : "two-sided", !is_right);
  }
  return mesh;
}

CameraRequest straight_on(const Vec3& eye, const Vec3& target, double fov) {
  CameraRequest camera;
  camera.eye = eye;
  camera.target = target;
  camera.fov = fov;
  return camera;
}

// A box with a different colour at each of its eight corners: dark at the foot.
void add_box(Mesh& mesh, const Vec3& low, const Vec3& high, double turn) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (std::uint32_t corner = 0; corner < 8; ++corner) {
    Vec3 at{};
    for (std::size_t axis = 0; axis < 3; ++axis) at[axis] = (corner >> axis & 1U) != 0 ? high[axis] : low[axis];
    const double light = ((corner & 2U) != 0 ? 0.8 : 0.35) + ((corner & 1U) != 0 ? 0.15 : 0);
    mesh.vertices.push_back({at, {}, tint(turn + ((corner & 4U) != 0 ? 0.12 : 0), light), 0, 0});
  }
  // Each side counter-clockwise from outside; bits of a corner: x, y, z.
  constexpr std::array<std::array<std::uint32_t, 4>, 6> kSides{
      {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};
  for (const auto& side : kSides) {
    mesh.triangles.push_back({first + side[0], first + side[1], first + side[2]});
    mesh.triangles.push_back({first + side[0], first + side[2], first + side[3]});
  }
}

// Boxes on a square of 60 units, nearest to the eye first.
Mesh blocks_mesh(int boxes, std::uint64_t seed, const Vec3& eye) {
  struct Block {
    Vec3 low, high;
    double turn, distance;
  };
  std::vector<Block> blocks;
  Random random(seed);
  const int side = static_cast<int>(std::ceil(std::sqrt(boxes)));
  const double lot = 60.0 / side;
  for (int i = 0; i < boxes; ++i) {
    const double x = lot * (i % side) - 30, z = lot * std::floor(static_cast<double>(i) / side) - 30;
    const double inset = lot * random.uniform(0.05, 0.2), tall = random.uniform(0, 1);
    const Vec3 low{x + inset, 0, z + inset}, high{x + lot - inset, 1 + 7 * tall * tall, z + lot - inset};
    const double turn = random.uniform(0, 1);
    blocks.push_back({low, high, turn, length(subtract(scaled(add(low, high), 0.5), eye))});
  }
  std::ranges::stable_sort(blocks, {}, &Block::distance);
  Mesh mesh;
  mesh.lit = false;
  for (const Block& block : blocks) {
    add_box(mesh, block.low, block.high, block.turn);
    close_object(mesh, "block " + std::to_string(mesh.objects.size()), true);
  }
  return mesh;
}

// Points on the unit sphere over an octahedron whose edges are cut into `cuts`: 8 cuts^2 triangles.
struct Pebble {
  explicit Pebble(int cuts);
  std::vector<Vec3> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

Pebble::Pebble(int cuts) {
  std::map<std::array<int, 3>, std::uint32_t> numbers;
  const auto number = [&](std::array<int, 3> at, const std::array<int, 3>& sign) {
    for (std::size_t axis = 0; axis < 3; ++axis) at[axis] *= sign[axis];
    const auto [entry, is_new] = numbers.try_emplace(at, static_cast<std::uint32_t>(points.size()));
    if (is_new)
      points.push_back(
          normalized({static_cast<double>(at[0]), static_cast<double>(at[1]), static_cast<double>(at[2])}));
    return entry->second;
  };
  for (int octant = 0; octant < 8; ++octant) {
    const std::array<int, 3> sign{octant % 2 * 2 - 1, octant / 2 % 2 * 2 - 1, octant / 4 * 2 - 1};
    const bool is_mirrored = sign[0] * sign[1] * sign[2] < 0;
    const auto face = [&](const std::array<int, 3>& a, const std::array<int, 3>& b, const std::array<int, 3>& c) {
      const std::uint32_t first = number(a, sign), second = number(b, sign), third = number(c, sign);
      triangles.push_back({first, is_mirrored ? third : second, is_mirrored ? second : third});
    };
    for (int i = 0; i < cuts; ++i)
      for (int j = 0; i + j < cuts; ++j) {
        const int k = cuts - 1 - i - j;
        face({i + 1, j, k}, {i, j + 1, k}, {i, j, k + 1});
        if (k > 0) face({i, j + 1, k}, {i + 1, j, k}, {i + 1, j + 1, k - 1});
      }
  }
}

void add_pebble(Mesh& mesh, const Pebble& pebble, const Vec3& center, double radius, double turn) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Vec3& p : pebble.points) {
    const double light = 0.65 + 0.3 * dot(p, {0.36, 0.8, 0.48});
    mesh.vertices.push_back({add(center, scaled(p, radius)), p, tint(turn + 0.08 * p[0] + 0.05 * p[2], light), 0, 0});
  }
  for (const auto& t : pebble.triangles) mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
}

// A flat field of pebbles around the origin, where the eye is.
Mesh objects_mesh(int count, std::uint64_t seed) {
  Mesh mesh;
  mesh.lit = false;
  Random random(seed);
  const Pebble pebble(4);
  for (int i = 0; i < count; ++i) {
    const double angle = random.uniform(0, kFullTurn), distance = 100 * std::sqrt(random.uniform(0.003, 1));
    const double radius = random.uniform(0.25, 0.8), y = random.uniform(-0.14, 0.14) * distance;
    const Vec3 center{distance * std::sin(angle), y, -distance * std::cos(angle)};
    add_pebble(mesh, pebble, center, radius, random.uniform(0, 1));
    close_object(mesh, "object " + std::to_string(i), true);
  }
  return mesh;
}

// The vertical field of view, degrees, for `degrees` across.
double fov_across(double degrees, double aspect) {
  return std::atan(std::tan(degrees * std::numbers::pi / 360) / aspect) * 360 / std::numbers::pi;
}

// 56 degrees across: 5/6 of the surroundings of the eye are outside, apart from objects across the edge.
CameraRequest objects_camera(double aspect) {
  CameraRequest camera = straight_on({0, 0, 0}, {0, 0, -1}, fov_across(56, aspect));
  camera.near = 1;
  camera.far = 110;
  return camera;
}

constexpr double kHiddenFov = 40;  // degrees

// A wall at distance 2, slightly larger than the view, and pebbles behind it.
Mesh hidden_mesh(int count, std::uint64_t seed, double aspect) {
  Mesh mesh;
  mesh.lit = false;
  const double slope_y = std::tan(kHiddenFov * std::numbers::pi / 360), slope_x = slope_y * aspect;
  for (std::uint32_t corner = 0; corner < 4; ++corner) {
    const double x = corner % 2 == 0 ? -2.002 : 2.002, y = corner < 2 ? -2.002 : 2.002;
    mesh.vertices.push_back({{x * slope_x, y * slope_y, -2}, {}, tint(0.23 * corner, 0.8), 0, 0});
  }
  mesh.triangles = {{0, 1, 3}, {0, 3, 2}};
  close_object(mesh, "wall", true);
  Random random(seed);
  const Pebble pebble(11);
  for (int i = 0; i < count; ++i) {
    const double distance = random.uniform(5, 19), x = random.uniform(-0.85, 0.85), y = random.uniform(-0.85, 0.85);
    const Vec3 center{x * slope_x * distance, y * slope_y * distance, -distance};
    add_pebble(mesh, pebble, center, 0.03 * distance, random.uniform(0, 1));
    close_object(mesh, "hidden " + std::to_string(i), true);
  }
  return mesh;
}

CameraRequest hidden_camera() {
  CameraRequest camera = straight_on({0, 0, 0}, {0, 0, -1}, kHiddenFov);
  camera.near = 1;
  camera.far = 20;
  return camera;
}

}  // namespace

Scene make_work_scene(std::string_view name, int size, int width, int height, const CameraRequest& camera,
                      std::uint64_t seed, const MeshOptions& options) {
  const double aspect = static_cast<double>(width) / height;
  const auto view = [&](auto&& make, const CameraRequest& own, Cull cull) {
    return kept_mesh_scene(make, merged(camera, own), width, height, cull, options);
  };
  if (name == "layers" || name == "layers_front") return layers_scene(width, height, size, name == "layers_front");
  if (name == "layers_nearest" || name == "layers_nearest_front")
    return textured_layers_scene(width, height, size, name == "layers_nearest_front", false);
  if (name == "layers_linear" || name == "layers_linear_front")
    return textured_layers_scene(width, height, size, name == "layers_linear_front", true);
  if (name == "layers_glass") return glass_scene(width, height, size);
  if (name == "layers_leaves") return leaves_scene(width, height, size);
  if (name == "scratches") return scratches_scene(width, height, size, seed);
  if (name == "dust") return dust_scene(width, height, size, seed);
  if (name == "objects") return view([&] { return objects_mesh(size, seed); }, objects_camera(aspect), Cull::back);
  if (name == "hidden") return view([&] { return hidden_mesh(size, seed, aspect); }, hidden_camera(), Cull::back);
  if (name == "blocks" || name == "blocks_depth") {
    const CameraRequest own = straight_on({2, 13, 38}, {0, 0, 6}, 50);
    Scene scene = view([&] { return blocks_mesh(size, seed, camera.eye.value_or(*own.eye)); }, own, Cull::back);
    for (State& state : scene.states) state.color_write = name == "blocks";
    return scene;
  }
  if (name == "ball" || name == "ball_nearest" || name == "ball_linear") {
    CameraRequest own;
    own.fov = 20;  // nearly half of the ball faces the eye
    if (name == "ball") return view([&] { return ball_mesh(size); }, own, Cull::back);
    Scene scene = view([&] { return textured_ball_mesh(size); }, own, Cull::back);
    add_grid(scene, 256, name == "ball_linear");
    return scene;
  }
  const double fov = std::max(22.0, fov_across(47, aspect));  // both bowls, at any aspect
  return view([&] { return shell_mesh(size); }, straight_on({0, 3.2, 5}, {0, -0.45, 0}, fov), Cull::none);
}

}  // namespace halfplane
