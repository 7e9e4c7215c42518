// Conventions: the same scene as OpenGL, Direct3D 10 or a textbook would state it. docs/conventions.md has the table
// and the sources.
#pragma once

#include <span>
#include <string_view>

#include "model/scene.hpp"

namespace halfplane {

/// The terms of the pipeline's input. The colour picture is the same in each.
struct Convention {
  std::string_view name;
  PixelCenter pixel_center = PixelCenter::half;
  Origin origin = Origin::top_left;
  ClipZ clip_z = ClipZ::minus_one_one;
  FrontFace front = FrontFace::ccw;  ///< default front face, as seen on the screen
  bool has_reversed_z = false;       ///< near is 1, far is 0; a target is cleared to 0
};

/// gl, d3d, mit3dcg and fcg, each with its own order of depth. Scenes are made in the first one.
[[nodiscard]] std::span<const Convention> conventions();

/// Reads `NAME`, `NAME:standard` or `NAME:reversed`. Throws InputError that lists the names.
[[nodiscard]] Convention parse_convention(std::string_view text);

/// The same scene stated in another convention: vertices, viewports, scissors, winding, depth tests, depth range,
/// polygon offset and clears. `gl` does not change a scene, with any conventions of its states. In: a scene of standard
/// depth order. Primitives keep their numbers. Throws InputError if a coordinate exceeds binary64.
[[nodiscard]] Scene in_convention(Scene scene, const Convention& convention);

}  // namespace halfplane
