// Conventions: the same scene as OpenGL, Direct3D 10 or a textbook would state it. docs/conventions.md has the table
// and the sources.
#pragma once

#include <span>
#include <string_view>

#include "model/scene.hpp"

namespace halfplane {

/// In which terms the pipeline's input is stated. The colour picture is the same in each.
struct Convention {
  std::string_view name;
  PixelCenter pixel_center = PixelCenter::half;
  Origin origin = Origin::top_left;
  ClipZ clip_z = ClipZ::minus_one_one;
  FrontFace front = FrontFace::ccw;  ///< what is front unless a state says otherwise, as seen on the screen
  bool has_reversed_z = false;       ///< near is 1, far is 0; a target is cleared to 0
};

/// gl, d3d, mit3dcg and fcg, each with its own order of depth. The first one is how scenes are made.
[[nodiscard]] std::span<const Convention> conventions();

/// Reads `NAME`, `NAME:standard` or `NAME:reversed`. Throws InputError that lists what there is.
[[nodiscard]] Convention parse_convention(std::string_view text);

/// The same scene stated in another convention: vertices, viewports, scissors, winding, depth tests, depth range,
/// polygon offset and clears. `gl` leaves a scene as it is, with whatever conventions its states name. In: a scene of
/// standard depth order. Primitives keep their numbers. Throws InputError if a coordinate leaves binary64.
[[nodiscard]] Scene in_convention(Scene scene, const Convention& convention);

}  // namespace halfplane
