#include "sim/scene/load.hpp"

#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string_view>
#include <vector>

#include "model/capture/capture.hpp"
#include "model/config.hpp"
#include "model/nearest_word.hpp"
#include "sim/scene/builtin.hpp"
#include "sim/scene/camera.hpp"
#include "sim/scene/gltf.hpp"
#include "sim/scene/mesh_scene.hpp"
#include "sim/scene/obj.hpp"
#include "sim/scene/object_cull.hpp"
#include "sim/scene/text_cursor.hpp"

namespace halfplane {
namespace {

[[noreturn]] void fail_unknown(const std::string& name) {
  const std::string_view word = std::string_view(name).substr(0, name.find(':'));
  std::vector<std::string_view> words;
  std::string names;
  for (const Builtin& builtin : all_builtin_scenes()) {
    names += (names.empty() ? "" : ", ") + std::string(builtin.name);
    words.push_back(builtin.name);
  }
  throw InputError("unknown scene " + in_quotes(name) + ";" + did_you_mean(word, words) + " built in are " + names +
                   "; a file ends in .obj, .gltf, .glb or .hpt, and - is a capture on stdin");
}

std::string lower_extension(const std::string& name) {
  std::string extension = std::filesystem::path(name).extension().string();
  for (char& c : extension) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return extension;
}

constexpr std::size_t kMostStdin = std::size_t{1} << 30;  // a pipe may have no end

// Read once: some commands load a scene several times.
const std::string& stdin_text() {
  static const std::string text = [] {
    std::string all;
    std::array<char, 1 << 16> block{};
    while (const std::size_t size = std::fread(block.data(), 1, block.size(), stdin)) {
      all.append(block.data(), size);
      if (all.size() > kMostStdin)
        throw InputError("stdin: more than 2^30 bytes; give a capture, or a file in its place");
    }
    if (std::ferror(stdin) != 0)
      throw InputError("stdin cannot be read; give a capture there, or a file in place of -");
    return all;
  }();
  return text;
}

Scene load_capture(const SceneRequest& request) {
  if (!request.camera.empty()) {
    throw InputError("--camera: " + request.name + " is a capture, already projected; leave the camera out");
  }
  if (!request.lights.empty())
    throw InputError("--light: " + request.name +
                     " is a capture, whose vertices have their colours; leave the light out");
  if (parse_transform(request.transform) != TransformNumbers::binary64)
    throw InputError("--transform: " + request.name + " is a capture, already projected; leave the transform out");
  Scene scene = request.name == "-" ? read_capture(stdin_text(), "stdin") : read_capture_file(request.name);
  mark_outside_objects(scene);
  if (request.width == 0) return scene;
  for (const State& state : scene.states) {
    if (state.space == Space::window && (request.width != scene.width || request.height != scene.height)) {
      throw InputError("--size: " + request.name + " has window-space vertices made for " +
                       std::to_string(scene.width) + "x" + std::to_string(scene.height) + "; leave the size out");
    }
  }
  scene.width = request.width;
  scene.height = request.height;
  return scene;
}

/// The camera at that fraction of its orbit.
CameraRequest at_turn(CameraRequest camera, double turn) {
  if (camera.orbit) *camera.orbit *= turn;
  return camera;
}

/// For scenes without animation.
MovingScene still(const SceneRequest& request, bool has_orbit, std::function<Scene(const Moment&)> make) {
  if (!request.animation.empty())
    throw InputError("--animation: " + request.name + " has no animations; leave out --time and --animation");
  const auto at = [name = request.name, make = std::move(make)](const Moment& moment) {
    if (moment.time) throw InputError("--time: " + name + " has no animations; leave out --time and --animation");
    return make(moment);
  };
  return {at, [] { return std::optional<double>(); }, has_orbit};
}

/// A glTF scene at rest, and the bounds of its objects.
struct RestingModel {
  explicit RestingModel(GltfModel of) : model(std::move(of)), places(model.mesh) {}
  GltfModel model;
  MeshPlaces places;
};

MovingScene open_gltf(const SceneRequest& request, const CameraRequest& camera, const MeshOptions& options,
                      const std::shared_ptr<MeshWork>& work, int width, int height,
                      std::vector<std::string>& warnings) {
  const auto world = std::make_shared<const GltfWorld>(read_gltf_world(request.name, warnings));
  // Read on demand: a scene at rest needs no animation.
  const auto animation = [world, name = request.animation, known = std::make_shared<std::optional<GltfAnimation>>()] {
    if (!*known) *known = read_animation(*world->file, choose_animation(*world->file, name));
    return &**known;
  };
  // The camera is fixed while things move, for any part of the animation.
  const auto extent = [world, animation, known = std::make_shared<std::optional<Mesh>>()] {
    if (!*known) *known = extent_over_time(*world, *animation());
    return &**known;
  };
  if (!request.animation.empty()) (void)animation();
  const auto at = [=, name = request.name,
                   rest = std::make_shared<std::optional<RestingModel>>()](const Moment& moment) {
    if (!moment.time && !*rest) rest->emplace(posed(*world));
    const GltfModel moved = moment.time ? posed(*world, animation(), *moment.time) : GltfModel();
    const GltfModel& model = moment.time ? moved : (*rest)->model;
    MeshOptions own = options;
    own.work = work.get();
    if (!moment.time) own.places = &(*rest)->places;
    const CameraRequest chosen = choose_camera(model.cameras, camera);
    const bool is_framed = !(chosen.eye && chosen.target && chosen.near && chosen.far);
    Scene scene = mesh_scene(model.mesh, at_turn(chosen, moment.turn), width, height, Cull::none, own,
                             moment.time && is_framed ? extent() : nullptr);
    scene.name = name;
    return scene;
  };
  const auto end = [=] {
    return world->file->count("animations") > 0 ? std::optional(animation()->end) : std::nullopt;
  };
  return {at, end, camera.orbit.has_value(), work};
}

}  // namespace

MovingScene open_scene(const SceneRequest& request, std::vector<std::string>& warnings) {
  if (request.width < 0 || request.height < 0 || (request.width == 0) != (request.height == 0)) {
    throw InputError("--size: " + std::to_string(request.width) + "x" + std::to_string(request.height) +
                     " has no pixels; write for example --size 640x480");
  }
  const std::string extension = lower_extension(request.name);
  if (extension == ".hpt" || request.name == "-")
    return still(request, false, [scene = load_capture(request)](const Moment&) { return scene; });
  const bool given = request.width > 0;
  const int width = given ? request.width : 640, height = given ? request.height : 480;
  const bool is_gltf = extension == ".gltf" || extension == ".glb";
  if (!is_gltf && extension != ".obj" && find_builtin(request.name) == nullptr) fail_unknown(request.name);
  const CameraRequest camera = parse_camera(request.camera);  // before a long file is read
  MeshOptions options{parse_lights(request.lights), parse_transform(request.transform)};
  options.leaves_out = request.leaves_out;
  options.has_tree = request.has_tree;
  const bool has_orbit = camera.orbit.has_value();
  const auto work = std::make_shared<MeshWork>();
  if (is_gltf) return open_gltf(request, camera, options, work, width, height, warnings);
  MovingScene scene;
  if (extension == ".obj") {
    const auto placed = std::make_shared<const PlacedMesh>(read_obj_file(request.name, warnings));
    scene = still(request, has_orbit, [=, name = request.name](const Moment& moment) {
      MeshOptions own = options;
      own.work = work.get();
      own.places = &placed->places;
      Scene made = mesh_scene(placed->mesh, at_turn(camera, moment.turn), width, height, Cull::none, own);
      made.name = name;
      return made;
    });
  } else {
    const auto kept = std::make_shared<std::optional<PlacedMesh>>();
    scene = still(request, has_orbit, [=, name = request.name, seed = request.seed](const Moment& moment) {
      MeshOptions own = options;
      own.work = work.get();
      own.kept = kept.get();
      return make_builtin(name, width, height, at_turn(camera, moment.turn), seed, own);
    });
  }
  scene.work = work;
  return scene;
}

Scene load_scene(const SceneRequest& request, std::vector<std::string>& warnings) {
  return open_scene(request, warnings).at(request.moment);
}

}  // namespace halfplane
