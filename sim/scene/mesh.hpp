// An indexed mesh in world space of triangles, lines and points: the common form of OBJ and glTF files and the built-in models.
#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "model/light.hpp"
#include "model/scene.hpp"
#include "sim/scene/vec3.hpp"

namespace halfplane {

/// Limit of coordinates, so that no product of a few of them exceeds binary64.
inline constexpr double kLargestCoordinate = 1e30;

struct MeshVertex {
  Vec3 position{};                                 ///< right-handed, +y up
  Vec3 normal{};                                   ///< length 1, or zero if no face gives a direction
  std::array<double, 4> rgba{255, 255, 255, 255};  ///< 0...255
  double u = 0, v = 0;
  std::uint32_t material = 0;  ///< index into Mesh::materials
  bool operator==(const MeshVertex&) const = default;
};

/// Light parameters besides a vertex's colour, which is the diffuse one. 0...1; linear in a linear mesh.
struct MeshMaterial {
  double diffuse = 1;                              ///< factor of the colour
  double mirrored = 0;                             ///< fraction of the colour added to `specular`: of a metal
  std::optional<std::array<double, 3>> ambient{};  ///< none: the colour
  std::array<double, 3> specular{}, emission{};
  double shininess = 0;  ///< exponent of N.H
  bool is_two_sided = true;
  bool has_header_light = true;  ///< false: without lights of its own it is shown unlit
  bool operator==(const MeshMaterial&) const = default;
};

/// A texture and its sampling.
struct MeshSampler {
  std::uint32_t texture = 0;  ///< index into Mesh::textures
  TextureMin min = TextureMin::linear_mipmap_linear;
  TextureMag mag = TextureMag::linear;
  std::array<TextureWrap, 2> wrap{};  ///< along u and v
  auto operator<=>(const MeshSampler&) const = default;
};

/// Treatment of a material's opacity.
enum class AlphaMode : std::uint8_t { opaque, mask, blend };

/// A run of triangles, or of indices of lines or points, that belong to one object.
struct MeshPart {
  std::uint32_t object = 0;  ///< index into Mesh::objects
  std::size_t first = 0;     ///< first of its triangles; other topologies: first of its entries in Mesh::indices
  std::size_t count = 0;     ///< number of them
  std::uint32_t line = 0;    ///< line of its first face in the file, 0 for none
  bool two_sided = true;     ///< false: its back faces are culled
  Topology topology = Topology::triangles;
  std::optional<MeshSampler> sampler{};  ///< for triangles
  AlphaMode alpha = AlphaMode::opaque;
  double alpha_cutoff = 0.5;  ///< for `mask`: parts with less opacity are not drawn
};

/// Invariants (kept by every maker): indices < vertices.size(), material numbers < materials.size() (or kRestart in
/// Mesh::indices), all numbers finite, parts cover all triangles in order, textures pass validate().
struct Mesh {
  std::vector<MeshVertex> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< counter-clockwise from outside, as far as the source knows
  std::vector<std::uint32_t> indices;                   ///< for parts that are lines or points
  std::vector<MeshPart> parts;
  std::vector<std::string> objects;
  std::vector<Texture> textures;
  std::vector<MeshMaterial> materials{1};
  std::vector<Light> lights;  ///< the file's own, in world space
  bool lit = true;            ///< colours are materials, to be shaded by the header light; false: they are shown unlit
  bool is_linear = false;     ///< light is summed in linear components, of which colours are the sRGB codes
};

}  // namespace halfplane
