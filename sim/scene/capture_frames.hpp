// The frames of a capture, separated by its `frame` lines, each as a scene of its own.
#pragma once

#include <cstddef>
#include <vector>

#include "model/scene.hpp"

namespace halfplane {

/// Commands from `first` to before `end`, without the line that ends them.
struct FrameCommands {
  std::size_t first = 0, end = 0;
};

/// A frame ends at each `frame` line, and the last one at the end of the scene, if something is drawn or cleared after
/// the last line.
[[nodiscard]] std::vector<FrameCommands> frames_of(const Scene& scene);

/// One frame, with the vertices and textures that it uses. Its primitives count from 0.
[[nodiscard]] Scene frame_scene(const Scene& scene, const FrameCommands& frame);

/// Whether a frame depends on the picture that it is drawn on: it does not begin with clears of all buffers that it
/// uses, on the whole target.
[[nodiscard]] bool goes_on(const Scene& scene, const FrameCommands& frame);

}  // namespace halfplane
