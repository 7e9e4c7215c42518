// What an OBJ file says, before it is turned into a mesh: the reader's two halves meet here.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "sim/scene/mtl.hpp"
#include "sim/scene/obj.hpp"

namespace halfplane {

inline constexpr std::int64_t kNoIndex = -1;

/// One corner of a face: indices from 0 into the file's v, vt and vn lines; they may point at lines still to come.
struct ObjCorner {
  std::int64_t position = kNoIndex, uv = kNoIndex, normal = kNoIndex;
};

struct ObjFace {
  std::size_t first = 0, count = 0;  ///< its run of ObjText::corners
  std::uint32_t line = 0;            ///< where it ends in the file
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
  std::vector<Vec3> positions, normals;  ///< a normal that cannot be read is zero
  std::vector<std::array<double, 2>> uvs;
  std::vector<std::array<double, 4>> colors;  ///< as written, -1 without one; of positions up to the last that has one
  std::vector<ObjCorner> corners;
  std::vector<ObjFace> faces;
  std::vector<ObjLine> lines;
  std::vector<std::string> material_names{""}, object_names{""};  ///< 0: what comes before any usemtl, o or g
  MaterialTable materials;
};

/// Reads the lines. Indices are not checked against the counts yet. What is damaged beside positions is a warning.
[[nodiscard]] ObjText parse_obj_text(std::string_view text, const std::string& file, const MaterialSource& materials,
                                     std::vector<std::string>& warnings);

}  // namespace halfplane
