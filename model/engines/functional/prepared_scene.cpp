#include "prepared_scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "../../host/primitives.hpp"
#include "../../known_textures.hpp"
#include "../../stages/surface.hpp"

namespace halfplane {

namespace {

/// The box of a clip-space draw's triangles, for whole-object tests: only worth it for draws with many triangles.
void find_box(PreparedScene::DrawChunks& draw, const PreparedScene& prepared, std::size_t first) {
  constexpr std::size_t kFew = 64;
  if (draw.primitives < kFew) return;
  draw.low.fill(std::numeric_limits<double>::infinity());
  draw.high.fill(-std::numeric_limits<double>::infinity());
  const auto take = [&](std::size_t v) {
    for (const double c : {prepared.x[v], prepared.y[v], prepared.z[v], prepared.w[v]})
      if (!(std::abs(c) <= 1e300)) return false;
    if (!(prepared.w[v] > 0)) return false;
    const std::array<double, 3> at{prepared.x[v] / prepared.w[v], prepared.y[v] / prepared.w[v],
                                   prepared.z[v] / prepared.w[v]};
    for (std::size_t i = 0; i < 3; ++i) {
      draw.low[i] = std::min(draw.low[i], at[i]);
      draw.high[i] = std::max(draw.high[i], at[i]);
    }
    return true;
  };
  // Each vertex of their range once, where these are fewer than the corners.
  const auto chunks = std::span(prepared.chunks).subspan(draw.first, draw.count);
  const std::uint32_t low = std::ranges::min(chunks, {}, &PreparedScene::Chunk::low_index).low_index,
                      high = std::ranges::max(chunks, {}, &PreparedScene::Chunk::high_index).high_index;
  if (high - low < 3 * draw.primitives) {
    for (std::size_t v = low; v <= high; ++v)
      if (!take(v)) return;
  } else {
    for (const auto& corner : prepared.index)
      for (std::size_t t = first; t < first + draw.primitives; ++t)
        if (!take(corner[t])) return;
  }
  draw.has_box = true;
}

/// Finds the attributes over w of the vertices, if a state needs them.
void find_surface(PreparedScene& prepared, std::size_t spare) {
  const Scene& scene = prepared.scene();
  if (std::ranges::none_of(scene.states, [](const State& s) { return has_surface(s); })) return;
  prepared.surface.resize(scene.vertices.size() + spare);
  for (std::size_t i = 0; i < scene.vertices.size(); ++i) {
    const Vertex& v = scene.vertices[i];
    prepared.surface[i] = surface_row(v.w, v.u, v.v);
  }
  if (std::ranges::none_of(scene.states, [](const State& s) { return s.shade == Shade::phong; })) return;
  prepared.normals.resize(prepared.surface.size());
  for (std::size_t i = 0; i < scene.vertices.size(); ++i)
    prepared.normals[i] = normal_codes(unit_normal(scene.normal(i)));
}

/// Whether a texture's filter mixes neighbouring texels.
bool is_linear(const State& state) {
  return state.texture_mag == TextureMag::linear || state.texture_min == TextureMin::linear ||
         state.texture_min == TextureMin::linear_mipmap_nearest ||
         state.texture_min == TextureMin::linear_mipmap_linear;
}

}  // namespace

PreparedScene::PreparedScene(const Scene& scene, std::vector<TexelBlocks> known, Footprints footprints)
    : draws(scene.commands.size()), textures(std::move(known)), scene_(&scene) {
  const std::size_t known_textures = textures.size();
  validate(scene, known_textures);
  for (std::size_t i = known_textures; i < scene.textures.size(); ++i) textures.emplace_back(scene.textures[i]);
  for (const State& state : scene.states)
    if (state.texture) {
      const bool is_seen_again = footprints == Footprints::at_once || *state.texture < known_textures;
      const bool tests_alpha = state.alpha_test.func != DepthFunc::always;
      TexelBlocks& texels = textures[*state.texture];
      if (is_linear(state) && is_seen_again) texels.add_quads(state.texture_wrap);
      if (tests_alpha || (state.blend && is_seen_again && !texels.is_opaque)) texels.add_alpha_ranges();
      if (tests_alpha) texels.add_alpha_quads();
    }
  constexpr std::size_t kSpare = 16;
  const std::size_t vertices = scene.vertices.size();
  for (auto* attribute : {&x, &y, &z, &w}) attribute->resize(vertices + kSpare);
  rgba.resize(vertices + kSpare);
  for (std::size_t i = 0; i < vertices; ++i) {
    const Vertex& v = scene.vertices[i];
    x[i] = v.x;
    y[i] = v.y;
    z[i] = v.z;
    w[i] = v.w;
    // As snap_color() of each channel, which is within its bounds: half of what rounds down from 2 c + 1.
    std::uint32_t code = 0;
    for (std::size_t c = 0; c < 4; ++c)
      code |= ((static_cast<std::uint32_t>(static_cast<int>(2 * v.rgba[c])) + 1) >> 1) << 8 * c;
    rgba[i] = code;
  }
  find_surface(*this, kSpare);
  for (std::size_t i = 0; i < scene.commands.size(); ++i) {
    const auto* draw = std::get_if<Draw>(&scene.commands[i]);
    if (draw == nullptr) continue;
    const State& state = scene.states[draw->state];
    const PrimitiveType type = primitive_type(draw->topology);
    if (drawn_as(state, draw->topology) != type) continue;
    DrawChunks& of_draw = draws[i];
    of_draw.first = chunks.size();
    if (draw->outside != 0) {  // numbered, but not drawn
      of_draw.primitives = primitive_count(scene, *draw);
      continue;
    }
    const std::size_t first = index[0].size();
    std::size_t last = first;
    for (auto& corner : index) corner.resize(first + draw->count);  // an index makes at most one primitive
    const auto add = [this, &last](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      index[0][last] = a;
      index[1][last] = b;
      index[2][last++] = c;
    };
    if (type == PrimitiveType::triangle)
      for_each_triangle(scene, *draw, state.provoking, add);
    else if (type == PrimitiveType::point)
      for_each_point(scene, *draw, [&](std::uint32_t at) { add(at, at, at); });
    else
      for_each_line(scene, *draw, [&](std::uint32_t start, std::uint32_t end) {
        add(start, end, state.provoking == Provoking::last ? end : start);
      });
    for (auto& corner : index) corner.resize(last);
    of_draw.primitives = last - first;
    for (std::size_t at = first; at < index[0].size(); at += kChunk) {
      Chunk chunk{at, std::min(kChunk, index[0].size() - at), ~0U, 0};
      for (const auto& corner : index)
        for (std::size_t t = at; t < at + chunk.count; ++t) {
          chunk.low_index = std::min(chunk.low_index, corner[t]);
          chunk.high_index = std::max(chunk.high_index, corner[t]);
        }
      chunks.push_back(chunk);
    }
    of_draw.count = chunks.size() - of_draw.first;
    if (type == PrimitiveType::triangle && state.space == Space::clip) find_box(of_draw, *this, first);
  }
  for (auto& corner : index) corner.resize(corner.size() + kSpare);
}

}  // namespace halfplane
