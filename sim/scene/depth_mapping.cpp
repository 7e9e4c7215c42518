#include "sim/scene/depth_mapping.hpp"

#include <cmath>
#include <string>
#include <utility>

#include "model/config.hpp"
#include "sim/scene/convention.hpp"

namespace halfplane {
namespace {

struct Spaces {
  bool has_clip = false, has_window = false;
};

Spaces spaces_of(const Scene& scene) {
  Spaces spaces;
  for (const Command& command : scene.commands)
    if (const auto* draw = std::get_if<Draw>(&command))
      (scene.states[draw->state].space == Space::clip ? spaces.has_clip : spaces.has_window) = true;
  return spaces;
}

/// Clip z of a vertex at eye depth w, for 0...w: window z is then the mapping's d.
double mapped_clip_z(DepthMapping mapping, double w, double near, double far) {
  switch (mapping) {
    case DepthMapping::stdinf: return w - near;
    case DepthMapping::revinf: return near;
    case DepthMapping::rev: return near * (far - w) / (far - near);
    default: return far * (w - near) / (far - near);
  }
}

double eye_depth(DepthMapping mapping, double d, double near, double far) {
  return mapping == DepthMapping::w ? near + d * (far - near) : near * std::pow(far / near, d);
}

double std_depth(double z, double near, double far) { return far * (z - near) / (z * (far - near)); }

}  // namespace

Scene in_depth_mapping(Scene scene, DepthMapping mapping) {
  if (mapping == DepthMapping::projection) return scene;
  const std::string name = "depth.mapping " + std::string(depth_mapping_names()[static_cast<std::size_t>(mapping)]);
  const Spaces spaces = spaces_of(scene);
  if (spaces.has_clip && spaces.has_window)
    throw InputError(
        scene.name + ": " + name +
        " maps scenes of one space, and this one draws in clip and in window space; leave the mapping out");
  if (!spaces.has_clip && is_screen_linear(mapping)) return scene;
  if (!scene.planes)
    throw InputError(scene.name + ": " + name + " needs the near and far plane of a perspective projection; " +
                     "give `planes NEAR FAR` in a capture, or a camera without ortho");
  const auto [near, far] = *scene.planes;
  if (std::isinf(far) && mapping != DepthMapping::stdinf && mapping != DepthMapping::revinf)
    throw InputError(scene.name + ": " + name + " needs a finite far plane; use stdinf or revinf, or give far");
  for (const State& state : scene.states)
    if (!is_screen_linear(mapping) && state.depth_range != std::array{0.0, 1.0})
      throw InputError(scene.name + ": " + name + " has no depth_range but 0 1; leave the state out");

  if (!spaces.has_clip) {
    for (Vertex& v : scene.vertices) v.z = std_depth(eye_depth(mapping, v.z, near, far), near, far);
    return scene;
  }
  if (is_reversed(mapping)) {
    Convention reversed = conventions().front();
    reversed.has_reversed_z = true;
    scene = in_convention(std::move(scene), reversed);
  }
  for (State& state : scene.states) state.clip_z = ClipZ::zero_one;
  for (Vertex& v : scene.vertices) v.z = mapped_clip_z(mapping, v.w, near, far);
  return scene;
}

}  // namespace halfplane
