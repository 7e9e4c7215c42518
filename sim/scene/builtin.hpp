// The built-in scenes, made in code: nothing to download, the same on every machine.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "model/scene.hpp"
#include "sim/scene/camera.hpp"
#include "sim/scene/mesh_scene.hpp"

namespace halfplane {

struct Builtin {
  std::string_view name;
  std::string_view description;  ///< one line for `halfplane scenes`
  std::string_view size;         ///< unit of N in "name:N"; empty when there is no N
  int default_size, min_size, max_size;
  bool has_camera;  ///< false: made in clip space, without a camera
};

/// The scenes that are pictures: small enough for every engine at any preset, including the RTL.
[[nodiscard]] std::span<const Builtin> builtin_scenes();

/// The workloads for timing: up to a million primitives.
[[nodiscard]] std::span<const Builtin> work_scenes();

/// Both, pictures first: the order in which `halfplane scenes` prints them.
[[nodiscard]] std::span<const Builtin> all_builtin_scenes();

/// The built-in named by `name` ("city" or "city:64"); null if there is none. N is ignored.
[[nodiscard]] const Builtin* find_builtin(std::string_view name);

/// Makes "name" or "name:N". Missing parts of the camera come from the scene. The seed changes `city`, `slivers`,
/// `blocks`, `scratches`, `dust`, `objects` and `hidden`; the others are always the same. Throws InputError for an
/// unknown name, a bad N, or a camera, light or transform for a scene without one.
[[nodiscard]] Scene make_builtin(std::string_view name, int width, int height, const CameraRequest& camera,
                                 std::uint64_t seed, const MeshOptions& options = {});

}  // namespace halfplane
