#include "sim/study/depth/eye_planes.hpp"

#include "model/host/primitives.hpp"

namespace halfplane {
namespace {

using Wide = long double;  // slivers cancel digits of the determinant

EyePlane plane_of(const Viewport& vp, const Vertex& v0, const Vertex& v1, const Vertex& v2) {
  // Each vertex at (X, Y) = (x w, y w) in pixels times w solves a X + b Y + c W = 1.
  Wide m[3][3];
  const Vertex* const vertices[3] = {&v0, &v1, &v2};
  for (int i = 0; i < 3; ++i) {
    const Vertex& v = *vertices[i];
    m[i][0] = vp.x * static_cast<Wide>(v.w) + (static_cast<Wide>(v.x) + v.w) / 2 * vp.width;
    m[i][1] = vp.y * static_cast<Wide>(v.w) + (static_cast<Wide>(v.w) - v.y) / 2 * vp.height;
    m[i][2] = v.w;
  }
  Wide cofactor[3][3];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const int r = (i + 1) % 3, s = (i + 2) % 3, p = (j + 1) % 3, q = (j + 2) % 3;
      cofactor[i][j] = m[r][p] * m[s][q] - m[r][q] * m[s][p];
    }
  const Wide determinant = m[0][0] * cofactor[0][0] + m[0][1] * cofactor[0][1] + m[0][2] * cofactor[0][2];
  if (determinant == 0) return {};
  Wide sum[3];
  for (int j = 0; j < 3; ++j) sum[j] = (cofactor[0][j] + cofactor[1][j] + cofactor[2][j]) / determinant;
  return {static_cast<double>(sum[0]), static_cast<double>(sum[1]), static_cast<double>(sum[2])};
}

}  // namespace

std::vector<EyePlane> eye_planes(const Scene& scene) {
  std::vector<EyePlane> planes;
  bool has_ended = false;
  for (const Command& command : scene.commands) {
    const auto* clear = std::get_if<Clear>(&command);
    if (!planes.empty() && (std::holds_alternative<EndFrame>(command) || (clear != nullptr && clear->depth)))
      has_ended = true;
    const auto* draw = std::get_if<Draw>(&command);
    if (draw == nullptr) continue;
    if (has_ended)
      throw InputError(place_of_draw(scene.name, draw->line) +
                       ": depth is measured on one frame with one clear of depth before it; leave the rest out");
    const State& state = scene.states[draw->state];
    if (drawn_as(state, draw->topology) != PrimitiveType::triangle) {
      planes.resize(planes.size() + primitive_count(scene, *draw));
      continue;
    }
    if (state.space != Space::clip || state.depth_range != std::array{0.0, 1.0} ||
        state.polygon_offset != std::array{0.0, 0.0})
      throw InputError(place_of_draw(scene.name, draw->line) +
                       ": depth is measured on clip-space triangles without depth_range and polygon_offset, whose eye "
                       "depth is their w; leave the state out");
    const Viewport viewport = effective_viewport(state, scene.width, scene.height);
    for_each_triangle(scene, *draw, state.provoking, [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      planes.push_back(plane_of(viewport, scene.vertices[a], scene.vertices[b], scene.vertices[c]));
    });
  }
  return planes;
}

}  // namespace halfplane
