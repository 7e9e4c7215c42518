// Material files (.mtl): the colours of each name, its texture, and its opacity.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>

#include "model/scene.hpp"
#include "sim/scene/mesh.hpp"
#include "sim/scene/text_cursor.hpp"

namespace halfplane {

/// A map_Kd or map_d line: u and v on the image are scale times those of the face plus offset, v from the image's bottom up.
struct MtlTexture {
  std::string file;   ///< beside the OBJ, with /
  std::string place;  ///< of the line, for messages: "a.mtl:4"
  std::array<double, 2> scale{1, 1}, offset{0, 0};
  TextureWrap wrap = TextureWrap::repeat;
};

struct MtlMaterial {
  std::array<double, 4> rgba{};  ///< 0...255
  MeshMaterial surface{};        ///< what lights meet beside that
  bool has_highlight = true;     ///< illum is 2 or more, or not said
  std::optional<MtlTexture> texture{};
  std::optional<MtlTexture> opacity_map{};  ///< map_d: alpha of the texture
  bool has_opacity = false;                 ///< d, which overrules Tr
};

using MaterialTable = std::unordered_map<std::string, MtlMaterial>;  ///< by name

/// Adds the materials of one file to `materials`: Kd (one number is a grey; clamped to 0...1), map_Kd and map_d with -s, -o and
/// -clamp, d, Tr = 1 - d; Ka, Ks, Ke likewise as Kd, Ns and illum, which only lights meet. All else in a material is passed
/// over, and lines that cannot be read with a warning. `file`: as the OBJ names it; images are beside it. Throws InputError for
/// UTF-16.
void parse_mtl(std::string_view text, const std::string& file, MaterialTable& materials, Warnings& warnings);

}  // namespace halfplane
