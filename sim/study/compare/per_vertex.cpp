#include "per_vertex.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <unordered_map>

#include "model/golden/phong.hpp"
#include "model/host/primitives.hpp"
#include "model/stages/cull.hpp"

namespace halfplane {
namespace {

bool lights_fragments(const Scene& scene, const Draw& draw) {
  const State& state = scene.states[draw.state];
  return state.shade == Shade::phong && drawn_as(state, draw.topology) == PrimitiveType::triangle;
}

/// The number of its size: 0 below a pixel, k from 2^(k-1) pixels on.
int size_class(double area) { return area < 1 ? 0 : std::ilogb(area) + 1; }

}  // namespace

bool has_light_of_fragments(const Scene& scene) {
  return std::ranges::any_of(scene.commands, [&scene](const Command& command) {
    const auto* draw = std::get_if<Draw>(&command);
    return draw != nullptr && lights_fragments(scene, *draw);
  });
}

Scene lit_at_vertices(const Scene& scene) {
  Scene lit = scene;
  for (Command& command : lit.commands) {
    auto* draw = std::get_if<Draw>(&command);
    if (draw == nullptr || !lights_fragments(scene, *draw)) continue;
    const State& state = scene.states[draw->state];
    std::unordered_map<std::uint32_t, std::uint32_t> copies;  // of this draw's vertices
    const std::size_t first = lit.indices.size();             // other draws may share the indices
    for (std::size_t i = draw->first; i < draw->first + draw->count; ++i) {
      const std::uint32_t index = scene.indices[i];
      if (index == kRestart) {
        lit.indices.push_back(index);
        continue;
      }
      const auto [copy, is_new] = copies.try_emplace(index, static_cast<std::uint32_t>(lit.vertices.size()));
      if (is_new) {
        Vertex v = scene.vertices[index];
        v.rgba = golden::in_light(state, v.rgba, golden::light_factors(state, scene.normal(index)));
        lit.vertices.push_back(v);
      }
      lit.indices.push_back(copy->second);
    }
    draw->first = first;
    State smooth = state;
    smooth.shade = Shade::smooth;
    lit.states.push_back(smooth);
    draw->state = static_cast<std::uint32_t>(lit.states.size() - 1);
  }
  return lit;
}

std::vector<PerVertexRow> per_vertex_rows(const Scene& scene, const Config& config, const Rendering& rendering,
                                          const golden::Image& fragments, const golden::Image& vertices) {
  const double unit = std::ldexp(1.0, 2 * coordinate_grid_bits(config) + 1);
  std::map<std::int32_t, double> area;  // of each lit primitive, all of its pieces
  for (const Triangle& t : rendering.triangles)
    if (lights_fragments(scene, std::get<Draw>(scene.commands[t.draw])))
      area[static_cast<std::int32_t>(t.primitive)] +=
          static_cast<double>(std::abs(signed_area(t.v[0], t.v[1], t.v[2]))) / unit;
  std::map<int, PerVertexRow> rows;
  std::map<int, std::set<std::int32_t>> seen;
  for (std::size_t p = 0; p < fragments.ids.size(); ++p) {
    const std::int32_t id = fragments.ids[p];
    const auto of = area.find(id);
    if (of == area.end() || vertices.ids[p] != id) continue;
    const int size = size_class(of->second);
    PerVertexRow& row = rows[size];
    row.area = size == 0 ? 0 : std::ldexp(1.0, size - 1);
    seen[size].insert(id);
    ++row.pixels;
    for (std::size_t c = 0; c < 3; ++c) {
      const double error = std::abs(vertices.color[p][c] - fragments.color[p][c]);
      row.max = std::max(row.max, error);
      row.rms += error * error;
    }
  }
  std::vector<PerVertexRow> result;
  for (auto& [size, row] : rows) {
    row.rms = std::sqrt(row.rms / static_cast<double>(3 * row.pixels));
    row.triangles = seen[size].size();
    result.push_back(row);
  }
  return result;
}

}  // namespace halfplane
