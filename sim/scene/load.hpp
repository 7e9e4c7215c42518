// From the argument SCENE of a command to a Scene.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "model/scene.hpp"
#include "sim/scene/mesh_scene.hpp"

namespace halfplane {

/// Time and camera of one picture of an animated scene.
struct Moment {
  std::optional<double> time;  ///< of the animation, seconds; none: at rest
  double turn = 1;             ///< fraction of the camera's orbit, 0...1
};

struct SceneRequest {
  std::string name;                            ///< a built-in ("teapot", "city:64") or a file: .obj, .gltf, .glb, .hpt
  int width = 0, height = 0;                   ///< pixels; both 0: 640x480, or the size in a capture
  std::string camera{};                        ///< value of `--camera`; empty for the default framing
  std::uint64_t seed = 1;                      ///< for the built-in scenes with random parts
  std::string animation{};                     ///< name or number of an animation in the file; empty: the first
  Moment moment{};                             ///< for load_scene()
  std::vector<std::string> lights{};           ///< values of `--light`; empty: the file's own, or the light at the eye
  std::string transform = "binary64";          ///< value of `--transform`
  CullObjects leaves_out = CullObjects::none;  ///< MeshOptions::leaves_out
  bool has_tree = true;                        ///< MeshOptions::has_tree
};

/// A loaded scene that can be shown at several moments.
struct MovingScene {
  /// Throws InputError, one line with the remedy, also for a time without animation.
  std::function<Scene(const Moment&)> at;
  /// End of the animation, seconds; none: no animation. Throws as `at`.
  std::function<std::optional<double>()> end;
  bool has_orbit = false;                  ///< the camera moves
  std::shared_ptr<const MeshWork> work{};  ///< of the last scene made; null: not a mesh
};

/// Reads everything that does not depend on the moment. Warnings are one line each. A size given with a capture
/// replaces its target if the capture is all in clip space (a scissor or viewport in it keeps its pixels). Throws
/// InputError, one line with the remedy.
[[nodiscard]] MovingScene open_scene(const SceneRequest& request, std::vector<std::string>& warnings);

/// open_scene(), at the request's moment.
[[nodiscard]] Scene load_scene(const SceneRequest& request, std::vector<std::string>& warnings);

}  // namespace halfplane
