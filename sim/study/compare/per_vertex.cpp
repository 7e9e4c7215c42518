#include "per_vertex.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <unordered_map>

#include "model/golden/phong.hpp"
#include "model/host/primitives.hpp"
#include "model/stages/cull.hpp"
#include "sim/show/report/hardware.hpp"
#include "sim/study/compare/per_vertex.hpp"

namespace halfplane {
namespace {

bool lights_fragments(const Scene& scene, const Draw& draw) {
  const State& state = scene.states[draw.state];
  return state.shade == Shade::phong && drawn_as(state, draw.topology) == PrimitiveType::triangle;
}

/// The number of a size class: 0 below a pixel, k from 2^(k-1) pixels on.
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

namespace {

/// `part` of 3: number of the run.
std::uint64_t cycles_of_frame(const Scene& scene, const Config& config, int part,
                              const std::function<void(double)>& progress) {
  RenderOptions options;
  if (progress) options.progress = [&progress, part](double fraction) { progress((part + fraction) / 3); };
  return run_cycles(scene, {config, {}, {}}, options).run.cycles;
}

}  // namespace

PerVertexCycles per_vertex_cycles(const Scene& scene, const Config& config,
                                  const std::function<void(double)>& progress) {
  PerVertexCycles result;
  const Scene at_vertices = lit_at_vertices(scene);
  std::vector<std::string_view> units{""};  // settings to try; more than nearest texels only if the scene needs them
  if (config.texture_unit == TextureUnitKind::off) units = {"nearest", "bilinear", "trilinear"};
  for (const std::string_view unit : units) {
    Config with = config;
    result.set.clear();
    const auto set_also = [&](std::string_view key, std::string_view value) {
      set(with, key, value);
      result.set.push_back(std::string(key) + "=" + std::string(value));
    };
    if (!unit.empty()) set_also("texture.unit", unit);
    if (config.shade_units == 0) set_also("shade.unit", "1");
    Config without = with;
    without.shade_units = 0;
    try {
      result.fragments = cycles_of_frame(scene, with, 0, progress);
      result.vertices = cycles_of_frame(at_vertices, with, 1, progress);
      result.without_unit = cycles_of_frame(at_vertices, without, 2, progress);
      result.refused.clear();
      return result;
    } catch (const InputError& error) {
      result = {};
      result.refused = error.what();
    }
  }
  return result;
}

}  // namespace halfplane
