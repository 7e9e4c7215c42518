// The materials of a glTF file, and the textures of their base colours.
#pragma once

#include <functional>
#include <map>

#include "sim/scene/gltf_file.hpp"
#include "sim/scene/mesh.hpp"

namespace halfplane {

struct GltfMaterial {
  std::array<double, 4> base{1, 1, 1, 1};  ///< linear
  double metallic = 1, roughness = 1;
  std::array<double, 3> emission{};  ///< linear
  bool is_two_sided = false;
  bool is_lit = true;
  AlphaMode alpha = AlphaMode::opaque;
  double alpha_cutoff = 0.5;
  std::optional<JsonPlace> texture;   ///< an index into `textures`
  std::string uv_set = "TEXCOORD_0";  ///< the attribute of the texture coordinates
  /// u and v on the texture from a vertex's: factors of u, v and 1.
  std::array<std::array<double, 3>, 2> uv_transform{{{1, 0, 0}, {0, 1, 0}}};
};

/// Parameters for lighting, metal and roughness approximated by Blinn-Phong (docs/gltf.md).
[[nodiscard]] MeshMaterial surface_of(const GltfMaterial& material);

/// Reads the materials that primitives name. Images are decoded on first use, each once.
class GltfMaterials {
 public:
  using Warn = std::function<void(const std::string& text)>;

  /// Textures are added to `textures`.
  GltfMaterials(GltfFile& file, std::vector<Texture>& textures, Warn warn)
      : file_(file), textures_(textures), warn_(std::move(warn)) {}

  /// The material of a primitive; without one the format's default: white, back faces culled.
  [[nodiscard]] GltfMaterial of(const JsonPlace& primitive) const;
  /// The sampler of its texture; none without a texture, or if its image is of an unsupported kind (a warning).
  [[nodiscard]] std::optional<MeshSampler> sampler(const GltfMaterial& material);

 private:
  void read_base_color(const JsonPlace& shading, GltfMaterial& material) const;
  [[nodiscard]] std::uint32_t image(const JsonPlace& index);

  GltfFile& file_;
  std::vector<Texture>& textures_;
  Warn warn_;
  std::map<std::size_t, std::uint32_t> texture_of_image_;
};

}  // namespace halfplane
