#include "sim/scene/convention.hpp"

#include <array>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include "model/config.hpp"
#include "model/host/primitive_assembly.hpp"
#include "sim/scene/text_cursor.hpp"

namespace halfplane {
namespace {

constexpr std::array<Convention, 4> kConventions{{
    {"gl", PixelCenter::half, Origin::top_left, ClipZ::minus_one_one, FrontFace::ccw, false},
    {"d3d", PixelCenter::half, Origin::top_left, ClipZ::zero_one, FrontFace::cw, false},
    {"mit3dcg", PixelCenter::integer, Origin::bottom_left, ClipZ::minus_one_one, FrontFace::ccw, false},
    {"fcg", PixelCenter::integer, Origin::bottom_left, ClipZ::minus_one_one, FrontFace::ccw, true},
}};

DepthFunc mirrored(DepthFunc function) {
  switch (function) {
    case DepthFunc::less: return DepthFunc::greater;
    case DepthFunc::lequal: return DepthFunc::gequal;
    case DepthFunc::greater: return DepthFunc::less;
    case DepthFunc::gequal: return DepthFunc::lequal;
    default: return function;
  }
}

/// The position of the outer corner of the first pixel.
double first_edge(PixelCenter center) { return center == PixelCenter::half ? 0.0 : -0.5; }

/// Restates a scene, state by state and vertex by vertex.
class Restater {
 public:
  Restater(Scene scene, const Convention& to)
      : given_(scene.vertices), scene_(std::move(scene)), to_(to), owner_(given_.size(), kNone) {}

  Scene run() {
    const std::vector<State> from = scene_.states;
    for (State& state : scene_.states) state = restated(state);
    std::vector<std::uint32_t> indices;
    for (Command& command : scene_.commands) {
      auto* clear = std::get_if<Clear>(&command);
      if (clear != nullptr && clear->depth && to_.has_reversed_z) clear->depth = 1 - *clear->depth;
      if (auto* draw = std::get_if<Draw>(&command)) restate(*draw, from[draw->state], indices);
    }
    scene_.indices = std::move(indices);
    // Before a scene's first command a target holds the code of window depth 1.
    if (to_.has_reversed_z) {
      scene_.commands.insert(scene_.commands.begin(), Clear{static_cast<std::uint32_t>(scene_.states.size()), {}, 0.0});
      scene_.states.emplace_back();
    }
    return std::move(scene_);
  }

 private:
  /// The state's members that decide how a vertex is restated.
  using Terms = std::tuple<Space, ClipZ, PixelCenter, Origin>;
  static Terms terms_of(const State& state) {
    const bool is_clip = state.space == Space::clip;
    return {state.space, is_clip ? state.clip_z : ClipZ(), is_clip ? PixelCenter() : state.pixel_center,
            is_clip ? Origin() : state.origin};
  }

  State restated(const State& from) const;
  void restate(Draw& draw, const State& from, std::vector<std::uint32_t>& indices);
  Vertex restated(Vertex v, const State& from) const;
  std::uint32_t vertex(std::uint32_t index, const State& from);

  /// A window y, or the near edge of something `size` high, converted to the target's origin.
  [[nodiscard]] double turned(double y, double size, PixelCenter center, Origin from) const {
    const double above_edge = y - first_edge(center);
    return (from == to_.origin ? above_edge : scene_.height - above_edge - size) + first_edge(to_.pixel_center);
  }

  static constexpr std::uint32_t kNone = ~0U;

  std::vector<Vertex> given_;
  Scene scene_;
  Convention to_;
  std::map<Terms, std::uint32_t> numbers_;  ///< of the terms so far
  std::vector<std::uint32_t> owner_;        ///< the terms for which a vertex was restated in place
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> copies_;  ///< {vertex, other terms}: its copy
};

State Restater::restated(const State& from) const {
  State state = from;
  state.pixel_center = to_.pixel_center;
  state.origin = to_.origin;
  state.clip_z = to_.clip_z;
  if (state.scissor && from.origin != to_.origin) {
    // Within +-2^21 of the target: captures have no larger ones.
    const auto [x, y, width, height] = *from.scissor;
    state.scissor = Rect{x, scene_.height - y - height, width, height};
  }
  if (state.viewport) {
    state.viewport->x += first_edge(to_.pixel_center) - first_edge(from.pixel_center);
    state.viewport->y = turned(from.viewport->y, from.viewport->height, from.pixel_center, from.origin);
  }
  // An outline is drawn in the triangle's order, so facing must not reverse it.
  if (to_.front == FrontFace::cw && from.polygon_mode == PolygonMode::fill && from.front == FrontFace::ccw) {
    state.front = FrontFace::cw;
  }
  if (!to_.has_reversed_z) return state;
  state.depth_test = mirrored(from.depth_test);
  state.depth_range = {1 - from.depth_range[1], 1 - from.depth_range[0]};
  for (double& offset : state.polygon_offset) offset = 0 - offset;
  return state;
}

void Restater::restate(Draw& draw, const State& from, std::vector<std::uint32_t>& indices) {
  const Draw given = draw;
  const bool is_turned = scene_.states[draw.state].front != from.front;
  draw.first = indices.size();
  if (is_turned && primitive_type(draw.topology) == PrimitiveType::triangle) {
    draw.topology = Topology::triangles;
    const bool is_first = from.provoking == Provoking::first;  // the provoking vertex comes first or last in a list
    for_each_triangle(scene_, given, from.provoking, [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      for (const std::uint32_t index : is_first ? std::array{a, c, b} : std::array{c, b, a})
        indices.push_back(vertex(index, from));
    });
  } else {
    for (std::size_t i = given.first; i < given.first + given.count; ++i) {
      const std::uint32_t index = scene_.indices[i];
      indices.push_back(index == kRestart ? index : vertex(index, from));
    }
  }
  draw.count = indices.size() - draw.first;
}

Vertex Restater::restated(Vertex v, const State& from) const {
  const bool is_reversed = to_.has_reversed_z;
  if (from.space == Space::window) {
    v.x += first_edge(to_.pixel_center) - first_edge(from.pixel_center);
    v.y = turned(v.y, 0, from.pixel_center, from.origin);
    if (is_reversed) v.z = 1 - v.z;
    return v;
  }
  const bool is_from_zero = from.clip_z == ClipZ::zero_one, is_to_zero = to_.clip_z == ClipZ::zero_one;
  if (is_from_zero && is_to_zero) {
    if (is_reversed) v.z = v.w - v.z;
    return v;
  }
  if (is_from_zero) v.z = 2 * v.z - v.w;
  if (is_reversed) v.z = -v.z;
  if (is_to_zero) v.z = v.z / 2 + v.w / 2;
  return v;
}

std::uint32_t Restater::vertex(std::uint32_t index, const State& from) {
  const std::uint32_t terms =
      numbers_.emplace(terms_of(from), static_cast<std::uint32_t>(numbers_.size())).first->second;
  if (owner_[index] == terms) return index;
  if (const auto copy = copies_.find({index, terms}); copy != copies_.end()) return copy->second;
  const Vertex v = restated(given_[index], from);
  for (const double coordinate : {v.x, v.y, v.z}) {
    if (!std::isfinite(coordinate))
      throw InputError("--convention " + std::string(to_.name) + ": vertex " + std::to_string(index) +
                       " leaves binary64; use smaller coordinates or --convention gl");
  }
  if (owner_[index] == kNone) {
    owner_[index] = terms;
    scene_.vertices[index] = v;
    return index;
  }
  const auto place = static_cast<std::uint32_t>(scene_.vertices.size());
  scene_.vertices.push_back(v);
  if (const auto normal = scene_.normal(index); normal != std::array<double, 3>{}) {
    scene_.normals.resize(scene_.vertices.size());
    scene_.normals.back() = normal;
  }
  copies_.emplace(std::pair(index, terms), place);
  return place;
}

}  // namespace

std::span<const Convention> conventions() { return kConventions; }

Convention parse_convention(std::string_view text) {
  const std::size_t colon = text.find(':');
  const std::string_view order = colon == std::string_view::npos ? "" : text.substr(colon + 1);
  for (Convention convention : kConventions) {
    if (convention.name != text.substr(0, colon)) continue;
    if (colon != std::string_view::npos && order != "standard" && order != "reversed") break;
    if (colon != std::string_view::npos) convention.has_reversed_z = order == "reversed";
    return convention;
  }
  std::string names;
  for (const Convention& convention : kConventions) names += (names.empty() ? "" : ", ") + std::string(convention.name);
  throw InputError("--convention: no convention " + in_quotes(text) + "; give one of " + names +
                   ", with :standard or :reversed after it for the order of depth");
}

Scene in_convention(Scene scene, const Convention& convention) {
  if (convention.name == kConventions[0].name && !convention.has_reversed_z) return scene;
  return Restater(std::move(scene), convention).run();
}

}  // namespace halfplane
