#include "sim/study/compare/transform_errors.hpp"

#include <cmath>

#include "model/stages/clip.hpp"
#include "model/stages/viewport.hpp"

namespace halfplane {

TransformErrors transform_errors(const Scene& made, const Scene& exact, const Config& config) {
  const State& state = exact.states.front();
  const Viewport viewport = effective_viewport(state, exact.width, exact.height);
  const auto planes = view_volume_planes(state.clip_z);
  const auto is_in_view = [&planes](const Vertex& v) { return v.w > 0 && outcode(planes, v) == 0; };
  const double lsb = std::ldexp(1.0, config.depth_bits) - 1;
  MomentSet pixels, depth;
  for (std::size_t i = 0; i < exact.vertices.size(); ++i) {
    if (!is_in_view(exact.vertices[i]) || !is_in_view(made.vertices[i])) continue;
    const WindowPosition a = to_window(made.vertices[i], state, viewport),
                         b = to_window(exact.vertices[i], state, viewport);
    pixels.add(std::hypot(a.x - b.x, a.y - b.y));
    depth.add((a.z - b.z) * lsb);
  }
  return {pixels.stats(), depth.stats()};
}

}  // namespace halfplane
