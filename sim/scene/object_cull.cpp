#include "sim/scene/object_cull.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "model/config.hpp"
#include "model/host/clip.hpp"
#include "model/host/primitive_assembly.hpp"
#include "model/host/viewport.hpp"
#include "sim/scene/text_cursor.hpp"

namespace halfplane {
namespace {

constexpr std::array<std::pair<std::string_view, CullObjects>, 4> kNames{{{"none", CullObjects::none},
                                                                          {"sphere", CullObjects::sphere},
                                                                          {"box", CullObjects::box},
                                                                          {"both", CullObjects::both}}};

constexpr double kRoundingMargin = 1e-12;  // relative to the sum of a distance's terms

/// One bit per plane that has the vertex outside by more than rounding: the scene may later be restated in another
/// convention, with different rounding.
unsigned clearly_outside(const ClipPlanes& planes, const Vertex& v) {
  const double margin = kRoundingMargin * (std::abs(v.x) + std::abs(v.y) + std::abs(v.z) + std::abs(v.w));
  unsigned code = 0;
  for (std::size_t i = 0; i < planes.size(); ++i) code |= (distance(planes[i], v) < -margin ? 1U : 0U) << i;
  return code;
}

/// Whether everything that the draw covers lies outside one common plane.
bool is_outside(const Scene& scene, const Draw& draw) {
  const State& state = scene.states[draw.state];
  if (state.space == Space::window || draw.count == 0) return false;
  const ClipPlanes planes = view_volume_planes(state.clip_z, effective_viewport(state, scene.width, scene.height), 1);
  const bool is_filled =
      primitive_type(draw.topology) == PrimitiveType::triangle && state.polygon_mode == PolygonMode::fill;
  unsigned common = is_filled ? 0x3fU : 0x3U;  // near and far are the first two
  for (std::size_t i = draw.first; i < draw.first + draw.count && common != 0; ++i) {
    const std::uint32_t index = scene.indices[i];
    if (index != kRestart) common &= clearly_outside(planes, scene.vertices[index]);
  }
  return common != 0;
}

/// Signed distances of bounds from one plane of the view volume, in any one unit: below 0 is outside.
struct Side {
  double sphere, box;  ///< of the part farthest inside
  double far_corner;   ///< of the box's part farthest outside
  double margin;       ///< far above the rounding of these
};

template <class Visit>
void for_each_side(const ObjectBounds& bounds, const Mat4& to_clip, Visit&& visit) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const double sign : {1.0, -1.0}) {
      Vec4 plane{};  // inside: plane . (p, 1) >= 0, which says w + x >= 0 or w - x >= 0
      for (std::size_t i = 0; i < 4; ++i) plane[i] = to_clip[3][i] + sign * to_clip[axis][i];
      const Vec3 normal{plane[0], plane[1], plane[2]};
      Vec3 near{}, far{}, size{};  // the corner farthest inside, the opposite one, and bounds of coordinates
      for (std::size_t i = 0; i < 3; ++i) {
        near[i] = normal[i] > 0 ? bounds.high[i] : bounds.low[i];
        far[i] = normal[i] > 0 ? bounds.low[i] : bounds.high[i];
        size[i] = (std::abs(to_clip[3][i]) + std::abs(to_clip[axis][i])) *
                  std::max(std::abs(bounds.low[i]), std::abs(bounds.high[i]));
      }
      const double margin =
          kRoundingMargin * (size[0] + size[1] + size[2] + std::abs(to_clip[3][3]) + std::abs(to_clip[axis][3]));
      visit(Side{dot(normal, bounds.center) + plane[3] + bounds.radius * length(normal), dot(normal, near) + plane[3],
                 dot(normal, far) + plane[3], margin});
    }
  }
}

template <class Visit>
void for_each_draw(Scene& scene, Visit&& visit) {
  for (Command& command : scene.commands)
    if (auto* draw = std::get_if<Draw>(&command)) visit(*draw);
}

}  // namespace

CullObjects parse_cull_objects(std::string_view text) {
  for (const auto& [name, tests] : kNames)
    if (name == text) return tests;
  throw InputError("--cull-objects: no value " + in_quotes(text) + "; give none, sphere, box or both");
}

std::vector<ObjectBounds> object_bounds(const Mesh& mesh) {
  std::vector<ObjectBounds> bounds(mesh.objects.size());
  const auto for_each_vertex = [&mesh](auto&& visit) {
    for (const MeshPart& part : mesh.parts) {
      if (part.topology != Topology::triangles) continue;  // their draws are never left out
      for (std::size_t t = part.first; t < part.first + part.count; ++t)
        for (const std::uint32_t index : mesh.triangles[t]) visit(part.object, mesh.vertices[index].position);
    }
  };
  for_each_vertex([&bounds](std::uint32_t object, const Vec3& p) {
    ObjectBounds& b = bounds[object];
    const bool is_first = b.radius < 0;
    for (std::size_t i = 0; i < 3; ++i) {
      b.low[i] = is_first ? p[i] : std::min(b.low[i], p[i]);
      b.high[i] = is_first ? p[i] : std::max(b.high[i], p[i]);
    }
    b.radius = 0;
  });
  for (ObjectBounds& b : bounds) b.center = scaled(add(b.low, b.high), 0.5);
  for_each_vertex([&bounds](std::uint32_t object, const Vec3& p) {  // no squares yet: coordinates reach 1e30
    const Vec3 offset = subtract(p, bounds[object].center);
    bounds[object].radius = std::max(bounds[object].radius, dot(offset, offset));
  });
  for (ObjectBounds& b : bounds)
    if (b.radius > 0) b.radius = std::sqrt(b.radius);
  return bounds;
}

std::uint8_t outside_view(const ObjectBounds& bounds, const Mat4& to_clip) {
  std::uint8_t outside = 0;
  if (bounds.radius < 0) return outside;
  for_each_side(bounds, to_clip, [&outside](const Side& side) {
    if (side.sphere < -side.margin) outside |= kSphereOutside;
    if (side.box < -side.margin) outside |= kBoxOutside;
  });
  return outside;
}

NodeView node_view(const ObjectBounds& bounds, const Mat4& to_clip) {
  NodeView view{0, true};
  for_each_side(bounds, to_clip, [&view](const Side& side) {
    if (side.sphere < -2 * side.margin) view.outside |= kSphereOutside;
    if (side.box < -2 * side.margin) view.outside |= kBoxOutside;
    view.is_inside &= side.far_corner > side.margin;
  });
  return view;
}

std::uint8_t bits_of(CullObjects tests) {
  switch (tests) {
    case CullObjects::none: return 0;
    case CullObjects::sphere: return kSphereOutside;
    case CullObjects::box: return kBoxOutside;
    case CullObjects::both: break;
  }
  return kSphereOutside | kBoxOutside;
}

void mark_outside_objects(Scene& scene) {
  std::vector<bool> is_seen(scene.objects.size(), false);
  for_each_draw(scene, [&](const Draw& draw) {
    if (!is_seen[draw.object] && !is_outside(scene, draw)) is_seen[draw.object] = true;
  });
  for_each_draw(scene, [&is_seen](Draw& draw) { draw.outside = is_seen[draw.object] ? 0 : kBoxOutside; });
}

ObjectCounts select_object_culling(Scene& scene, CullObjects tests) {
  constexpr std::uint8_t kDrawn = 4;  // besides the two tests' bits
  std::vector<std::uint8_t> found(scene.objects.size(), 0);
  ObjectCounts counts;
  for_each_draw(scene, [&](Draw& draw) {
    draw.outside &= bits_of(tests);
    found[draw.object] |= static_cast<std::uint8_t>(draw.outside | kDrawn);
    if (draw.outside != 0) counts.primitives_skipped += primitive_count(scene, draw);
  });
  for (const std::uint8_t bits : found) {
    counts.in += (bits & kDrawn) != 0 ? 1 : 0;
    counts.culled_sphere += (bits & kSphereOutside) != 0 ? 1 : 0;
    counts.culled_box += (bits & kBoxOutside) != 0 ? 1 : 0;
  }
  return counts;
}

}  // namespace halfplane
