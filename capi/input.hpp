// What callers of the C interface give, as the model has it: lines of a capture, vertices and texels in memory, names.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "halfplane.h"
#include "model/scene.hpp"

namespace halfplane::capi {

[[nodiscard]] Topology topology_of(std::string_view name);

/// What lines of a capture said.
struct Said {
  Scene scene;  ///< its clears, textures and planes
  State state;  ///< of the draws that follow
};
/// `known`: the textures that lines before have named; they are the first of Scene::textures, of a texel each.
[[nodiscard]] Said read_lines(int width, int height, std::span<const Texture> known, std::string_view lines);

struct Vertices {
  std::vector<Vertex> vertices;
  std::vector<std::array<double, 3>> normals;  ///< empty where the layout has none
};
/// `numbers` doubles each: 4, 8 or 10.
[[nodiscard]] std::vector<Vertex> read_vertices(const double* values, int numbers, std::size_t count);
[[nodiscard]] Vertices read_vertices(const halfplane_layout& layout, const void* data, std::size_t bytes,
                                     std::size_t count);

/// As halfplane_scene_texture says.
[[nodiscard]] Texture read_texture(std::string_view name, int width, int height, const std::uint8_t* rgba,
                                   std::string_view format, std::string_view mips);

/// Throws InputError for an index that is beyond the vertices.
void check_indices(std::span<const std::uint32_t> indices, std::size_t vertices, std::string_view owner);

}  // namespace halfplane::capi
