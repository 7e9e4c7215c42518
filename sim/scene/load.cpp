#include "sim/scene/load.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <string_view>
#include <vector>

#include "model/capture/capture.hpp"
#include "model/config.hpp"
#include "sim/nearest_word.hpp"
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

// Read once: some commands ask for a scene more than once.
const std::string& stdin_text() {
  static const std::string text = [] {
    std::string all;
    std::array<char, 1 << 16> block{};
    while (const std::size_t size = std::fread(block.data(), 1, block.size(), stdin)) all.append(block.data(), size);
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

}  // namespace

Scene load_scene(const SceneRequest& request, std::vector<std::string>& warnings) {
  if (request.width < 0 || request.height < 0 || (request.width == 0) != (request.height == 0)) {
    throw InputError("--size: " + std::to_string(request.width) + "x" + std::to_string(request.height) +
                     " has no pixels; write for example --size 640x480");
  }
  const std::string extension = lower_extension(request.name);
  if (extension == ".hpt" || request.name == "-") return load_capture(request);
  const bool given = request.width > 0;
  const int width = given ? request.width : 640, height = given ? request.height : 480;
  if (extension == ".gltf" || extension == ".glb") {
    const CameraRequest camera = parse_camera(request.camera);  // before a long file is read
    const GltfModel model = read_gltf_file(request.name, warnings);
    Scene scene = mesh_scene(model.mesh, choose_camera(model.cameras, camera), width, height);
    scene.name = request.name;
    return scene;
  }
  if (extension != ".obj" && find_builtin(request.name) == nullptr) fail_unknown(request.name);
  const CameraRequest camera = parse_camera(request.camera);
  if (extension != ".obj") return make_builtin(request.name, width, height, camera, request.seed);
  Scene scene = mesh_scene(read_obj_file(request.name, warnings), camera, width, height);
  scene.name = request.name;
  return scene;
}

}  // namespace halfplane
