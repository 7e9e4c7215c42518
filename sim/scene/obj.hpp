// Wavefront OBJ files into meshes.
//
// Read: v (with a colour after the position, 0...1 or 0...255), vt, vn, f (a, a/b, a//c, a/b/c; negative counts back),
// o, g, s, usemtl, mtllib, l, p. Other keywords are ignored. An unreadable position is an error; all other damage is a warning,
// one for each kind.
//
// tinyobjloader 2.0rc10 is not used: libFuzzer under UBSan finds undefined behaviour in it within seconds (any weight
// line, `vw`, with an index beyond int), and it accepts damaged files: NaN, "abc" and "3x4" become numbers, an index
// outside the file is a warning or ignored, a short face vanishes, and decimals are not rounded to the nearest
// binary64.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/scene/mesh.hpp"

namespace halfplane {

/// The bytes of a material library or of an image by its name next to the OBJ, or none when there is none.
using MaterialSource = std::function<std::optional<std::string>(const std::string& name)>;

/// Reads a mesh from text. `file` is the name for messages. Materials give the colours, except for faces whose corners
/// all have colours (which are not lit). Opacity (d, Tr, map_d) blends or cuts out. Corners without a normal get one
/// smoothed over the faces of their smoothing group, weighted by the angle at the corner; `s off` makes flat ones;
/// without any `s` line the whole file is one group. A missing library, material or image is a warning. Throws
/// InputError "file:line: the error; the remedy".
[[nodiscard]] Mesh parse_obj(std::string_view text, const std::string& file, const MaterialSource& materials,
                             std::vector<std::string>& warnings);

/// Reads an OBJ file; material libraries and images are searched next to it, by their whole names, then without
/// folders.
[[nodiscard]] Mesh read_obj_file(const std::string& path, std::vector<std::string>& warnings);

}  // namespace halfplane
