// The glTF reader on hostile input, either container. Everything after "%bin" is the contents of every external buffer.
// Properties: no crash, no undefined behaviour; a mesh that is returned keeps Mesh's invariants and makes a Scene with
// the file's cameras; an InputError is one line that begins with the file's name or the camera option.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <string_view>

#include "model/config.hpp"
#include "sim/scene/gltf.hpp"
#include "sim/scene/mesh_scene.hpp"

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

void check_mesh(const halfplane::Mesh& mesh) {
  std::size_t triangles = 0, indices = 0;  // triangles and indices of the parts so far
  for (const auto& part : mesh.parts) {
    std::size_t& named = part.topology == halfplane::Topology::triangles ? triangles : indices;
    require(part.first == named && part.object < mesh.objects.size());
    named += part.count;
    require(!part.sampler || part.sampler->texture < mesh.textures.size());
  }
  require(triangles == mesh.triangles.size() && indices == mesh.indices.size() && triangles + indices > 0);
  for (const std::uint32_t index : mesh.indices) require(index < mesh.vertices.size());
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t index : triangle) require(index < mesh.vertices.size());
  }
  for (const auto& vertex : mesh.vertices) {
    for (const double number : vertex.position) require(std::abs(number) <= halfplane::kLargestCoordinate);
    for (const double number : vertex.normal) require(std::abs(number) < 1.001);
    for (const double number : vertex.rgba) require(number >= 0 && number <= 255);
    require(std::isfinite(vertex.u) && std::isfinite(vertex.v));
  }
}

void check_scene(const halfplane::Scene& scene) {
  validate(scene);
  for (const auto& vertex : scene.vertices) {
    for (const double number : {vertex.x, vertex.y, vertex.z, vertex.w}) require(std::isfinite(number));
    for (const double number : vertex.rgba) require(number >= 0 && number <= 255);
  }
}

// One line with a mend.
void check_message(std::string_view message, std::string_view start) {
  require(message.substr(0, start.size()) == start && message.size() < 700);
  require(message.find('\n') == std::string_view::npos && message.find("; ") != std::string_view::npos);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace halfplane;
  const std::string_view input(reinterpret_cast<const char*>(data), size);
  const std::size_t split = input.find("%bin");
  const auto source = [&](const std::string&) {
    return split == std::string_view::npos ? std::nullopt : std::optional(std::string(input.substr(split + 4)));
  };
  std::vector<std::string> warnings;
  GltfModel model;
  try {
    // Few triangles, so that the time goes into many inputs.
    model = parse_gltf(std::string(input.substr(0, split)), "fuzz.gltf", source, warnings, 5000);
  } catch (const InputError& error) {
    check_message(error.what(), "fuzz.gltf:");
    return 0;
  }
  check_mesh(model.mesh);
  for (const std::string& warning : warnings) require(warning.find('\n') == std::string::npos);
  for (std::size_t i = 0; i <= std::min<std::size_t>(model.cameras.size(), 4); ++i) {
    try {
      const CameraRequest own = i == 0 ? CameraRequest() : model.cameras[i - 1].request;
      check_scene(mesh_scene(model.mesh, own, 64, 48));
    } catch (const InputError& error) {
      check_message(error.what(), "--camera:");
    }
  }
  return 0;
}
