// The parsed content of an OBJ file before it becomes a mesh: the interface between the reader's two halves.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "model/scene.hpp"
#include "sim/scene/mesh.hpp"
#include "sim/scene/obj.hpp"
#include "sim/scene/text_cursor.hpp"

namespace halfplane {

// Material files (.mtl): the colours of each name, its texture, and its opacity.

/// A map_Kd or map_d line: u and v on the image are scale times those of the face plus offset, v from the image's bottom up.
struct MtlTexture {
  std::string file;   ///< next to the OBJ, with /
  std::string place;  ///< of the line, for messages: "a.mtl:4"
  std::array<double, 2> scale{1, 1}, offset{0, 0};
  TextureWrap wrap = TextureWrap::repeat;
};

struct MtlMaterial {
  std::array<double, 4> rgba{};  ///< 0...255
  MeshMaterial surface{};        ///< light parameters besides that
  bool has_highlight = true;     ///< illum is 2 or more, or missing
  std::optional<MtlTexture> texture{};
  std::optional<MtlTexture> opacity_map{};  ///< map_d: alpha of the texture
  bool has_opacity = false;                 ///< d, which overrides Tr
};

using MaterialTable = std::unordered_map<std::string, MtlMaterial>;  ///< by name

/// Adds the materials of one file to `materials`: Kd (one number is a grey; clamped to 0...1), map_Kd and map_d with
/// -s, -o and -clamp, d, Tr = 1 - d; Ka, Ks, Ke likewise as Kd, Ns and illum, used with lights only. Everything else in
/// a material is skipped, unreadable lines with a warning. `file`: the name in the OBJ; images are next to it. Throws
/// InputError for UTF-16.
void parse_mtl(std::string_view text, const std::string& file, MaterialTable& materials, Warnings& warnings);

inline constexpr std::int64_t kNoIndex = -1;

/// One corner of a face: indices from 0 into the file's v, vt and vn lines; they may refer to later lines.
struct ObjCorner {
  std::int64_t position = kNoIndex, uv = kNoIndex, normal = kNoIndex;
};

struct ObjFace {
  std::size_t first = 0, count = 0;  ///< its run of ObjText::corners
  std::uint32_t line = 0;            ///< its last line in the file
  std::uint32_t material = 0;        ///< index into ObjText::material_names
  std::uint32_t object = 0;          ///< index into ObjText::object_names
  std::uint32_t smoothing = 0;       ///< smoothing group; 0 is flat
};

/// An `l` or a `p` line.
struct ObjLine {
  std::size_t first = 0, count = 0;  ///< its run of ObjText::corners
  std::uint32_t line = 0, material = 0, object = 0;
  bool is_points = false;
};

struct ObjText {
  std::string file;
  std::vector<Vec3> positions, normals;  ///< an unreadable normal is zero
  std::vector<std::array<double, 2>> uvs;
  std::vector<std::array<double, 4>> colors;  ///< as written, -1 without one; up to the last position that has one
  std::vector<ObjCorner> corners;
  std::vector<ObjFace> faces;
  std::vector<ObjLine> lines;
  std::vector<std::string> material_names{""}, object_names{""};  ///< 0: before any usemtl, o or g
  MaterialTable materials;
};

/// Reads the lines. Indices are not checked against the counts yet. Damage other than in positions is a warning.
[[nodiscard]] ObjText parse_obj_text(std::string_view text, const std::string& file, const MaterialSource& materials,
                                     std::vector<std::string>& warnings);

}  // namespace halfplane
