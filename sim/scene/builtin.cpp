#include "sim/scene/builtin.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "model/as_number.hpp"
#include "model/config.hpp"
#include "sim/scene/bench_scenes.hpp"
#include "sim/scene/builtin_meshes.hpp"
#include "sim/scene/mesh_scene.hpp"
#include "sim/scene/random.hpp"
#include "sim/scene/text_cursor.hpp"

namespace halfplane {
namespace {

constexpr std::size_t kPictures = 10;  // the others are workloads
constexpr std::array<Builtin, kPictures + 18> kBuiltins{{
    {"teapot", "the Utah teapot from its 32 Bezier patches", "segments along a patch side", 10, 1, 128, true},
    {"city", "boxes of random height, back faces culled", "boxes", 400, 1, 65536, true},
    {"knot", "a torus knot in all hues", "segments along the tube", 256, 16, 4096, true},
    {"coplanar", "two planes that cross at a third of a degree: z-fighting", "", 0, 0, 0, true},
    {"slivers", "a fan of long triangles, pixels to fractions of a pixel thin", "triangles", 600, 1, 1000000, false},
    {"walk", "a chequered corridor round the eye: crosses the near and all other planes", "", 0, 0, 0, true},
    {"star", "spokes of a star by either rule, with points at their tips", "spokes", 48, 1, 65536, false},
    {"wires", "a surface drawn as polylines along both axes", "polylines along an axis", 40, 2, 1024, true},
    {"wireframe", "the teapot with hidden lines removed: polygon offset and polygon mode line", "segments", 6, 1, 64,
     true},
    {"triangle", "one triangle with red, green and blue corners", "", 0, 0, 0, false},
    {"layers", "triangles of half the screen, back to front", "triangles", 64, 1, 8192, false},
    {"layers_front", "the same, front to back", "triangles", 64, 1, 8192, false},
    {"layers_nearest", "layers with a texture in perspective, nearest texels", "triangles", 64, 1, 8192, false},
    {"layers_nearest_front", "the same, front to back", "triangles", 64, 1, 8192, false},
    {"layers_linear", "layers with a texture in perspective, linear filter", "triangles", 64, 1, 8192, false},
    {"layers_linear_front", "the same, front to back", "triangles", 64, 1, 8192, false},
    {"layers_glass", "layers that are blended over each other", "triangles", 64, 1, 8192, false},
    {"layers_leaves", "layers with a texture, of which an alpha test drops half", "triangles", 64, 1, 8192, false},
    {"ball", "a sphere of small triangles, back faces culled", "rings", 160, 2, 1024, true},
    {"ball_nearest", "the same with a texture, nearest texels", "rings", 160, 2, 1024, true},
    {"ball_linear", "the same, linear filter", "rings", 160, 2, 1024, true},
    {"blocks", "boxes that hide each other, front to back, back faces culled", "boxes", 2000, 1, 65536, true},
    {"blocks_depth", "the same without colour: depth only", "boxes", 2000, 1, 65536, true},
    {"scratches", "lines of about 60 pixels", "lines", 50000, 1, 4000000, false},
    {"dust", "a jittered grid of triangles over the whole screen", "triangles", 1000000, 2, 10000000, false},
    {"objects", "small objects all round the eye: five in six lie outside the view", "objects", 4096, 1, 32768, true},
    {"hidden", "a wall, and behind it objects of which nothing is seen", "objects", 1000, 1, 8192, false},
    {"shell", "an open bowl without and with culled back faces: the second has holes", "rings", 24, 2, 512, true},
}};

std::string_view base_name(std::string_view name) { return name.substr(0, name.find(':')); }

// N of "name:N", or the default.
int size_of(const Builtin& builtin, std::string_view name) {
  const std::size_t colon = name.find(':');
  if (colon == std::string_view::npos) return builtin.default_size;
  const std::string base(builtin.name);
  if (builtin.size.empty()) throw InputError("scene " + in_quotes(name) + ": has no sizes; write " + base);
  const auto value = as_number<int>(name.substr(colon + 1));
  if (!value || *value < builtin.min_size || *value > builtin.max_size) {
    throw InputError("scene " + in_quotes(name) + ": N counts the " + std::string(builtin.size) + "; write " + base +
                     ":" + std::to_string(builtin.min_size) + " to " + base + ":" + std::to_string(builtin.max_size));
  }
  return *value;
}

void add_draw(Scene& scene, const std::string& object) {
  for (std::size_t i = 0; i < scene.vertices.size(); ++i) scene.indices.push_back(static_cast<std::uint32_t>(i));
  scene.objects.push_back(object);
  scene.commands.push_back(Draw{0, 1, Topology::triangles, 0, scene.indices.size(), 0});
}

Scene triangle_scene(int width, int height) {
  Scene scene = cleared_scene(width, height);
  scene.vertices = {{-0.8, -0.7, 0, 1, {255, 0, 0, 255}, 0, 0},
                    {0.8, -0.7, 0, 1, {0, 255, 0, 255}, 1, 0},
                    {0, 0.8, 0, 1, {0, 0, 255, 255}, 0.5, 1}};
  add_draw(scene, "triangle");
  return scene;
}

// A hue of the colour circle, `turn` in 0...1.
std::array<double, 4> hue(double turn) {
  std::array<double, 4> rgba{0, 0, 0, 255};
  for (std::size_t c = 0; c < 3; ++c)
    rgba[c] = 150 + 105 * std::cos(2 * std::numbers::pi * (turn - static_cast<double>(c) / 3));
  return rgba;
}

// Left the midpoint rule, between pixel centres; right diamond exit, with ends anywhere.
Scene star_scene(int width, int height, int spokes) {
  Scene scene = cleared_scene(width, height);
  scene.objects.emplace_back("star");
  const double reach = std::min(width / 2.0, static_cast<double>(height)) * 0.46;  // pixels
  State state;
  state.space = Space::window;
  state.point_size = std::max(1.0, std::floor(reach / 40));
  for (const LineRule rule : {LineRule::midpoint, LineRule::diamond}) {
    state.line_rule = rule;
    const auto number = static_cast<std::uint32_t>(scene.states.size());
    scene.states.push_back(state);
    const double x = width * (rule == LineRule::midpoint ? 0.25 : 0.75), y = height * 0.5;
    const auto first = static_cast<std::uint32_t>(scene.vertices.size());
    const auto count = static_cast<std::uint32_t>(spokes);
    for (std::uint32_t i = 0; i < count; ++i) {
      const double turn = static_cast<double>(i) / spokes, angle = 2 * std::numbers::pi * turn;
      scene.vertices.push_back({x, y, 0.5, 1, {255, 255, 255, 255}, 0, 0});
      scene.vertices.push_back({x + reach * std::cos(angle), y + reach * std::sin(angle), 0.25, 1, hue(turn), 0, 0});
    }
    scene.commands.push_back(Draw{number, 1, Topology::lines, scene.indices.size(), 2 * std::size_t{count}, 0});
    for (std::uint32_t i = 0; i < 2 * count; ++i) scene.indices.push_back(first + i);
    scene.commands.push_back(Draw{number, 1, Topology::points, scene.indices.size(), count, 0});
    for (std::uint32_t i = 0; i < count; ++i) scene.indices.push_back(first + 2 * i + 1);
  }
  return scene;
}

// The surface as polylines: no triangles.
Mesh wires_mesh(int lines) {
  Mesh mesh;
  mesh.lit = false;
  mesh.objects.emplace_back("wires");
  const auto side = static_cast<std::uint32_t>(lines);
  for (std::uint32_t j = 0; j < side; ++j)
    for (std::uint32_t i = 0; i < side; ++i) {
      const double x = 4.0 * i / (side - 1) - 2, z = 4.0 * j / (side - 1) - 2, r = std::hypot(x, z) * 3;
      const double y = r == 0 ? 1 : std::sin(r) / r;
      MeshVertex vertex;
      vertex.position = {x, y, z};
      vertex.rgba = hue(y * 0.6);
      mesh.vertices.push_back(vertex);
    }
  for (const bool is_across : {true, false})
    for (std::uint32_t j = 0; j < side; ++j) {
      if (!mesh.indices.empty()) mesh.indices.push_back(kRestart);
      for (std::uint32_t i = 0; i < side; ++i) mesh.indices.push_back(is_across ? j * side + i : i * side + j);
    }
  mesh.parts.push_back({0, 0, mesh.indices.size(), 0, true, Topology::line_strip});
  return mesh;
}

// Every draw twice: filled with the background's colour and moved back, then as lines.
Scene with_hidden_lines_removed(Scene scene) {
  const std::vector<Command> draws = scene.commands;
  scene.commands.clear();
  const std::vector<State> states = scene.states;
  for (const Command& command : draws) {
    const auto* draw = std::get_if<Draw>(&command);
    if (draw == nullptr) {
      scene.commands.push_back(command);
      continue;
    }
    for (const PolygonMode mode : {PolygonMode::fill, PolygonMode::line}) {
      State state = states[draw->state];
      state.polygon_mode = mode;
      state.color_write = mode == PolygonMode::line;
      state.depth_test = DepthFunc::lequal;
      if (mode == PolygonMode::fill) state.polygon_offset = {1, 1};
      Draw next = *draw;
      if (mode == PolygonMode::line) next.outside = 0;  // a line slightly outside can still have a pixel inside
      const auto known = std::ranges::find(scene.states, state);
      next.state = static_cast<std::uint32_t>(known - scene.states.begin());
      if (known == scene.states.end()) scene.states.push_back(state);
      scene.commands.push_back(next);
    }
  }
  return scene;
}

// From one corner of the screen across it, each slightly rotated, at random depths. A third is thinner than a pixel.
Scene slivers_scene(int width, int height, int count, std::uint64_t seed) {
  Scene scene = cleared_scene(width, height);
  Random random(seed);
  for (int i = 0; i < count; ++i) {
    const double angle = std::numbers::pi / 2 * (i + random.uniform(0, 1)) / count;
    const double reach = random.uniform(1.2, 1.98);
    const double pixels = std::exp2(random.uniform(-3, 6));  // width at the far end
    const double along_x = std::cos(angle), along_y = std::sin(angle);
    const double from = random.uniform(0, 0.25);
    const auto at = [&](double distance, double side) {  // 2 / width and 2 / height: clip units of a pixel
      Vertex vertex{-0.99 + distance * along_x - side * along_y * 2 / width,
                    -0.99 + distance * along_y + side * along_x * 2 / height,
                    random.uniform(-0.95, 0.95),
                    1,
                    {},
                    0,
                    0};
      for (double& channel : vertex.rgba) channel = random.uniform(40, 255);
      vertex.rgba[3] = 255;
      return vertex;
    };
    scene.vertices.push_back(at(from, 0));
    scene.vertices.push_back(at(reach, -pixels / 2));
    scene.vertices.push_back(at(reach, pixels / 2));
  }
  add_draw(scene, "slivers");
  return scene;
}

// Obliquely down the corridor: its distant parts lie beyond the far plane, but only outside the view, so that every
// pixel sees the shell once. This requires 90 degrees across, which wide targets keep.
CameraRequest walk_camera(int width, int height) {
  const double aspect = static_cast<double>(width) / height;
  CameraRequest camera;
  camera.eye = Vec3{1.2, 1.6, 0.3};
  camera.target = Vec3{1.2 - std::sin(std::numbers::pi / 3), 1.45, 0.3 - std::cos(std::numbers::pi / 3)};
  camera.fov = std::min(75.0, std::atan(1 / aspect) * 360 / std::numbers::pi);
  camera.near = 0.1;
  camera.far = 12.5;
  return camera;
}

CameraRequest coplanar_camera() {
  CameraRequest camera;
  camera.eye = Vec3{4, 6, 24};
  camera.target = Vec3{0, 0, 0};
  camera.near = 0.3;  // a 16-bit depth step is 0.03 units there, the surfaces are up to 0.05 apart
  camera.far = 100;
  return camera;
}

}  // namespace

std::span<const Builtin> all_builtin_scenes() { return kBuiltins; }
std::span<const Builtin> builtin_scenes() { return all_builtin_scenes().first(kPictures); }
std::span<const Builtin> work_scenes() { return all_builtin_scenes().subspan(kPictures); }

const Builtin* find_builtin(std::string_view name) {
  for (const Builtin& builtin : kBuiltins) {
    if (builtin.name == base_name(name)) return &builtin;
  }
  return nullptr;
}

Scene make_builtin(std::string_view name, int width, int height, const CameraRequest& camera, std::uint64_t seed,
                   const MeshOptions& options) {
  const Builtin* builtin = find_builtin(name);
  if (builtin == nullptr) throw InputError("no built-in scene " + in_quotes(name) + "; see halfplane scenes");
  const int size = size_of(*builtin, name);
  if (!builtin->has_camera && camera != CameraRequest()) {
    throw InputError("--camera: the scene " + in_quotes(name) + " is made in clip space; leave the camera out");
  }
  if (!builtin->has_camera && options.light.is_given())
    throw InputError("--light: the scene " + in_quotes(name) +
                     " is made with the colours that it has; leave the light out");
  if (!builtin->has_camera && options.transform != TransformNumbers::binary64)
    throw InputError("--transform: the scene " + in_quotes(name) + " is made in clip space; leave the transform out");
  const std::string_view base = builtin->name;
  MeshOptions own_options = options;
  if (base == "wireframe") own_options.leaves_out = CullObjects::none;  // its lines may reach into the view
  const auto view = [&](auto&& make, const CameraRequest& own, Cull cull) {
    return kept_mesh_scene(make, merged(camera, own), width, height, cull, own_options);
  };
  const bool is_work = builtin - kBuiltins.data() >= static_cast<std::ptrdiff_t>(kPictures);
  Scene scene = is_work              ? make_work_scene(base, size, width, height, camera, seed, options)
                : base == "teapot"   ? view([&] { return teapot_mesh(size); }, {}, Cull::none)
                : base == "city"     ? view([&] { return city_mesh(size, seed); }, {}, Cull::back)
                : base == "knot"     ? view([&] { return knot_mesh(size); }, {}, Cull::back)
                : base == "coplanar" ? view([&] { return coplanar_mesh(); }, coplanar_camera(), Cull::none)
                : base == "walk"     ? view([&] { return corridor_mesh(); }, walk_camera(width, height), Cull::none)
                : base == "star"     ? star_scene(width, height, size)
                : base == "wires"    ? view([&] { return wires_mesh(size); }, {}, Cull::none)
                : base == "wireframe"
                    ? with_hidden_lines_removed(view([&] { return teapot_mesh(size); }, {}, Cull::none))
                : base == "slivers" ? slivers_scene(width, height, size, seed)
                                    : triangle_scene(width, height);
  scene.name = std::string(name);
  return scene;
}

}  // namespace halfplane
