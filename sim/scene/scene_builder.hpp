// Small scenes in code, one call per triangle.
#pragma once

#include <array>
#include <cstdint>

#include "model/scene.hpp"

namespace halfplane {

/// A scene under construction: one draw per state, in the order of the calls.
class SceneBuilder {
 public:
  SceneBuilder(int width, int height, State state = window_state()) {
    scene.name = "test";
    scene.width = width;
    scene.height = height;
    scene.states.push_back(state);
    scene.commands.push_back(Clear{0, std::array<double, 4>{0, 0, 0, 255}, 1.0});
  }

  /// Window space, depth test always: every covered pixel is seen.
  static State window_state() {
    State state;
    state.space = Space::window;
    state.depth_test = DepthFunc::always;
    return state;
  }

  SceneBuilder& with_state(const State& state) {
    scene.states.push_back(state);
    return *this;
  }

  SceneBuilder& triangle(const Vertex& a, const Vertex& b, const Vertex& c) {
    const auto state = static_cast<std::uint32_t>(scene.states.size() - 1);
    auto* last = std::get_if<Draw>(&scene.commands.back());
    if (last == nullptr || last->state != state) {
      scene.commands.push_back(Draw{state, 0, Topology::triangles, scene.indices.size(), 0, 0});
      last = std::get_if<Draw>(&scene.commands.back());
    }
    for (const Vertex& v : {a, b, c}) {
      scene.indices.push_back(static_cast<std::uint32_t>(scene.vertices.size()));
      scene.vertices.push_back(v);
    }
    last->count += 3;
    return *this;
  }

  Scene scene;
};

/// A window-space vertex.
inline Vertex at(double x, double y, double z = 0.5, std::array<double, 4> rgba = {255, 255, 255, 255}) {
  Vertex v;
  v.x = x;
  v.y = y;
  v.z = z;
  v.rgba = rgba;
  return v;
}

/// A clip-space vertex.
inline Vertex clip_at(double x, double y, double z, double w, std::array<double, 4> rgba = {255, 255, 255, 255}) {
  Vertex v = at(x, y, z, rgba);
  v.w = w;
  return v;
}

}  // namespace halfplane
