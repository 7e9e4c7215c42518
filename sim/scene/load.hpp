// The one way from what a user typed as SCENE to a Scene.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "model/scene.hpp"

namespace halfplane {

struct SceneRequest {
  std::string name;           ///< a built-in ("teapot", "city:64") or a file: .obj, .gltf, .glb, .hpt
  int width = 0, height = 0;  ///< pixels; both 0: 640x480, or what a capture says
  std::string camera{};       ///< as `--camera` takes it; empty for the default framing
  std::uint64_t seed = 1;     ///< for the built-in scenes with something random in them
};

/// Loads or makes a scene. Warnings are one line each. A size given with a capture replaces its target if the capture
/// is all in clip space (a scissor or viewport in it keeps its pixels). Throws InputError, one line with the mend.
[[nodiscard]] Scene load_scene(const SceneRequest& request, std::vector<std::string>& warnings);

}  // namespace halfplane
