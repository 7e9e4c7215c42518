#include "sim/study/compare/transform_errors.hpp"

#include <cmath>
#include <vector>

#include "model/host/clip.hpp"
#include "model/host/primitive_assembly.hpp"
#include "model/host/viewport.hpp"
#include "sim/scene/host_geometry.hpp"

namespace halfplane {
namespace {

class HostErrorSet {
 public:
  explicit HostErrorSet(const Config& config) : lsb_(std::ldexp(1.0, config.depth_bits) - 1) {}
  void add(const WindowPosition& a, const WindowPosition& b) {
    pixels_.add(std::hypot(a.x - b.x, a.y - b.y));
    depth_.add((a.z - b.z) * lsb_);
  }
  [[nodiscard]] HostErrors errors() const { return {pixels_.stats(), depth_.stats()}; }

 private:
  double lsb_;
  MomentSet pixels_, depth_;
};

bool is_same_place(const Vertex& a, const Vertex& b) { return a.x == b.x && a.y == b.y && a.z == b.z && a.w == b.w; }

}  // namespace

TransformErrors transform_errors(const Scene& made, const Scene& exact, TransformNumbers numbers,
                                 const Config& config) {
  const State& state = exact.states.front();
  const Viewport viewport = effective_viewport(state, exact.width, exact.height);
  const HostGeometry host(numbers, state, exact.width, exact.height, config);
  const auto planes = view_volume_planes(state.clip_z);
  const auto is_in_view = [&planes](const Vertex& v) { return v.w > 0 && outcode(planes, v) == 0; };
  const auto divided = [&](const Vertex& v) { return to_window(v, state, viewport); };
  TransformErrors errors;
  HostErrorSet whole(config), transform(config), divide(config), clipped(config);
  std::vector<HostVertex> vertices;
  for (std::size_t i = 0; i < exact.vertices.size(); ++i) {
    const Vertex& v = vertices.emplace_back(host.rounded({made.vertices[i], {}})).vertex;
    errors.without_w += host.outcode(v) == 0 && !(v.w > 0) ? 1 : 0;
    if (!is_in_view(exact.vertices[i]) || !is_in_view(v)) continue;
    const WindowPosition in_binary64 = divided(v), right = divided(exact.vertices[i]), shown = host.window(v).at;
    whole.add(shown, right);
    transform.add(in_binary64, right);
    divide.add(shown, in_binary64);
  }
  const auto compare_cut = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const HostVertex &first = vertices[a], &second = vertices[b], &third = vertices[c];
    const unsigned codes[]{host.outcode(first.vertex), host.outcode(second.vertex), host.outcode(third.vertex)};
    if ((codes[0] | codes[1] | codes[2]) == 0 || (codes[0] & codes[1] & codes[2]) != 0) return;
    const std::vector<HostVertex> polygon = host.clip(first, second, third);
    const ClipPolygon right = clip(host.planes(), first.vertex, second.vertex, third.vertex);
    if (polygon.empty() && right.size == 0) return;
    ++errors.cut;
    const bool is_same = polygon.size() == static_cast<std::size_t>(right.size);
    errors.cut_otherwise += is_same ? 0 : 1;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vertex& corner = polygon[i].vertex;
      const bool is_new = !is_same_place(corner, first.vertex) && !is_same_place(corner, second.vertex) &&
                          !is_same_place(corner, third.vertex);
      if (!is_new) continue;
      if (!(corner.w > 0))
        ++errors.without_w;
      else if (is_same)
        clipped.add(divided(corner), divided(right.v[i]));
    }
  };
  for (const Command& command : made.commands) {
    const auto* draw = std::get_if<Draw>(&command);
    if (draw == nullptr || draw->outside != 0 || primitive_type(draw->topology) != PrimitiveType::triangle) continue;
    for_each_triangle(made, *draw, made.states[draw->state].provoking, compare_cut);
  }
  errors.whole = whole.errors();
  errors.transform = transform.errors();
  errors.divide = divide.errors();
  errors.clip = clipped.errors();
  return errors;
}

}  // namespace halfplane
