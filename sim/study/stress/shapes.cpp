#include "sim/study/stress/shapes.hpp"

#include <algorithm>
#include <cmath>

namespace halfplane::stress {

double depth_of(const Config& config, std::uint32_t code) {
  return static_cast<double>(code) / static_cast<double>(max_depth(config));
}

std::uint32_t max_depth(const Config& config) {
  return static_cast<std::uint32_t>((std::uint64_t{1} << config.depth_bits) - 1);
}

Vertex vertex_at(const Unit& unit, Point p, std::uint32_t z) {
  const int bits = -unit.config.subpixel_bits;
  return at(std::ldexp(static_cast<double>(p.x), bits), std::ldexp(static_cast<double>(p.y), bits),
            depth_of(unit.config, z));
}

std::uint32_t random_depth(Unit& unit) {
  const std::uint32_t max = max_depth(unit.config);
  if (unit.random.index(4) == 0) return unit.random.coin() ? max : 0;
  return static_cast<std::uint32_t>(unit.random.integer(0, max));
}

std::array<double, 4> random_color(Random& random) {
  std::array<double, 4> rgba{};
  for (double& c : rgba) c = random.index(4) == 0 ? 255.0 * random.index(2) : random.index(256);
  return rgba;
}

Vertex random_vertex_at(Unit& unit, Point p) {
  Vertex v = vertex_at(unit, p, random_depth(unit));
  v.rgba = random_color(unit.random);
  return v;
}

std::int64_t lowest(const Unit& unit) { return -(std::int64_t{unit.config.guard_band} << unit.config.subpixel_bits); }
std::int64_t highest(const Unit& unit) { return -lowest(unit) - 1; }

Point random_point(Unit& unit, int width, int height, int margin) {
  const auto coordinate = [&](int size) {
    const std::int64_t pixel = unit.pixel();
    return std::clamp(unit.random.integer(-margin * pixel, (size + margin) * pixel), lowest(unit), highest(unit));
  };
  const std::int64_t x = coordinate(width);
  return {x, coordinate(height)};
}

Point random_guard_point(Unit& unit) {
  const std::int64_t x = unit.random.integer(lowest(unit), highest(unit));
  return {x, unit.random.integer(lowest(unit), highest(unit))};
}

Scene mesh_scene(Unit& unit, Mesh mesh, int width, int height) {
  Random& random = unit.random;
  for (std::size_t i = mesh.size(); i > 1; --i)
    std::swap(mesh[i - 1], mesh[static_cast<std::size_t>(random.index(static_cast<int>(i)))]);
  SceneBuilder builder(width, height);
  for (const Corner& t : mesh) {
    const bool is_turned = random.coin();
    const Vertex a = random_vertex_at(unit, t[0]), b = random_vertex_at(unit, t[is_turned ? 2 : 1]),
                 c = random_vertex_at(unit, t[is_turned ? 1 : 2]);
    builder.triangle(a, b, c);
  }
  return std::move(builder.scene);
}

void check_mesh(Unit& unit, const Mesh& mesh, int width, int height, std::span<const Point> outline) {
  const Scene scene = mesh_scene(unit, mesh, width, height);
  expect_once(unit, scene, check_scene(unit, scene), outline);
}

bool triangle_covers(Corner t, int x, int y, int subpixel_bits) {
  const std::int64_t area = doubled_area(t[0], t[1], t[2]);
  if (area < 0) std::swap(t[1], t[2]);
  return area != 0 && polygon_covers(t, x, y, subpixel_bits);
}

Scene single(int width, int height, const std::array<Vertex, 3>& v, const State& state) {
  return std::move(SceneBuilder(width, height, state).triangle(v[0], v[1], v[2]).scene);
}

}  // namespace halfplane::stress
