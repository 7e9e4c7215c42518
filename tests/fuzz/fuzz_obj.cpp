// The OBJ reader on hostile input. Everything after a line "%mtl" is the material library, whatever its name.
// Properties: no crash, no undefined behaviour; a mesh that is returned keeps Mesh's invariants and makes a Scene; an
// InputError is one line that begins with the file's name.
#include <cmath>
#include <cstdlib>
#include <string>
#include <string_view>

#include "model/config.hpp"
#include "sim/scene/mesh_scene.hpp"
#include "sim/scene/obj.hpp"

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

void check_mesh(const halfplane::Mesh& mesh) {
  std::size_t triangles = 0, indices = 0;
  for (const auto& part : mesh.parts) {
    std::size_t& covered = part.topology == halfplane::Topology::triangles ? triangles : indices;
    require(part.first == covered && part.object < mesh.objects.size());
    covered = part.first + part.count;
    require(!part.sampler || part.sampler->texture < mesh.textures.size());
  }
  require(triangles == mesh.triangles.size() && indices == mesh.indices.size() && triangles + indices > 0);
  for (const std::uint32_t index : mesh.indices) require(index < mesh.vertices.size() || index == halfplane::kRestart);
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t index : triangle) require(index < mesh.vertices.size());
  }
  for (const auto& vertex : mesh.vertices) {
    for (const double number : vertex.position) require(std::isfinite(number));
    for (const double number : vertex.normal) require(std::abs(number) < 1.001);
    for (const double number : vertex.rgba) require(number >= 0 && number <= 255);
  }
}

void check_scene(const halfplane::Scene& scene) {
  validate(scene);
  for (const auto& vertex : scene.vertices) {
    for (const double number : {vertex.x, vertex.y, vertex.z, vertex.w}) require(std::isfinite(number));
    for (const double number : vertex.rgba) require(number >= 0 && number <= 255);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view input(reinterpret_cast<const char*>(data), size);
  const std::size_t split = input.find("%mtl");
  const std::string library(split == std::string_view::npos ? "" : input.substr(split + 4));
  const auto source = [&library](const std::string&) {
    return library.empty() ? std::nullopt : std::optional<std::string>(library);
  };
  std::vector<std::string> warnings;
  try {
    const halfplane::Mesh mesh = halfplane::parse_obj(input.substr(0, split), "fuzz.obj", source, warnings);
    check_mesh(mesh);
    check_scene(halfplane::mesh_scene(mesh, {}, 64, 48));
  } catch (const halfplane::InputError& error) {
    const std::string_view message = error.what();
    require(!message.empty() && message.find('\n') == std::string_view::npos && message.size() < 600);
    require(message.find("; ") != std::string_view::npos);
  }
  for (const std::string& warning : warnings) require(warning.find('\n') == std::string::npos);
  return 0;
}
