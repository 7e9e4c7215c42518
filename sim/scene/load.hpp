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

/// When and from where a scene that moves is seen.
struct Moment {
  std::optional<double> time;  ///< of the animation, seconds; none: at rest
  double turn = 1;             ///< how much of the camera's orbit is done, 0...1
};

struct SceneRequest {
  std::string name;                    ///< a built-in ("teapot", "city:64") or a file: .obj, .gltf, .glb, .hpt
  int width = 0, height = 0;           ///< pixels; both 0: 640x480, or what a capture says
  std::string camera{};                ///< as `--camera` takes it; empty for the default framing
  std::uint64_t seed = 1;              ///< for the built-in scenes with something random in them
  std::string animation{};             ///< name or number of one of the file's; empty: the first
  Moment moment{};                     ///< for load_scene()
  std::vector<std::string> lights{};   ///< as `--light` takes them; empty: the file's own, or the light at the eye
  std::string transform = "binary64";  ///< as `--transform` takes it
  CullObjects leaves_out = CullObjects::none;  ///< MeshOptions::leaves_out
  bool has_tree = true;                        ///< MeshOptions::has_tree
};

/// A scene that has been read and can be seen at several moments.
struct MovingScene {
  /// Throws InputError, one line with the mend, also for a time where nothing is animated.
  std::function<Scene(const Moment&)> at;
  /// Of the animation, seconds; nothing: nothing is animated. Throws as `at`.
  std::function<std::optional<double>()> end;
  bool has_orbit = false;                  ///< the camera moves
  std::shared_ptr<const MeshWork> work{};  ///< of the last scene that was made; null: it is no mesh's
};

/// Reads what does not depend on the moment. Warnings are one line each. A size given with a capture replaces its target if
/// the capture is all in clip space (a scissor or viewport in it keeps its pixels). Throws InputError, one line with the mend.
[[nodiscard]] MovingScene open_scene(const SceneRequest& request, std::vector<std::string>& warnings);

/// open_scene(), at the request's moment.
[[nodiscard]] Scene load_scene(const SceneRequest& request, std::vector<std::string>& warnings);

}  // namespace halfplane
