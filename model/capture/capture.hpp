// Captures: the text format for a whole scene, exact to the bit. docs/capture.md is its reference.
#pragma once

#include <iosfwd>
#include <string>
#include <string_view>

#include "../scene.hpp"

namespace halfplane {

/// The scene that `text` describes. `file_name` becomes Scene::name and begins every message. Linear in the size of
/// the text, in time and in memory. Throws InputError: "file:line: the error; the remedy".
[[nodiscard]] Scene read_capture(std::string_view text, std::string_view file_name);

/// The same for a file or a pipe. Throws InputError, also when the file cannot be read.
[[nodiscard]] Scene read_capture_file(const std::string& path);

/// Writes a capture that reads back as the same scene, bit for bit, if `scene` is in the reader's form: objects[0] is
/// unnamed and no two objects share a name, states are distinct and in the order of their first use, the indices of the
/// draws are consecutive without gaps, two neighbouring lists of triangles differ in state or object. Another scene
/// reads back in that form, with the same picture. Draws of less than one triangle are left out. The caller checks the
/// stream. Throws InputError for an invalid scene.
void write_capture(const Scene& scene, std::ostream& out);

/// Whether two scenes are the same input, every number bit for bit. Scene::name and Draw::line are ignored: they serve
/// messages only.
[[nodiscard]] bool same_scene(const Scene& a, const Scene& b);

}  // namespace halfplane
