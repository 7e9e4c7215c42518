// The error of light at vertices against light at fragments: the golden's pictures of both, by the size of triangles.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "model/config.hpp"
#include "model/engines/render.hpp"
#include "model/golden/golden.hpp"
#include "model/scene.hpp"

namespace halfplane {

/// Triangles of one size.
struct PerVertexRow {
  double area = 0;              ///< minimum, pixels; the maximum is twice that. 0: below one pixel
  std::uint64_t triangles = 0;  ///< visible ones
  std::uint64_t pixels = 0;     ///< pixels of these triangles
  double max = 0, rms = 0;      ///< colour lit at vertices less lit at fragments, red, green and blue, LSB of 8 bits
};

/// Whether a draw of the scene has `shade phong`, of filled triangles.
[[nodiscard]] bool has_light_of_fragments(const Scene& scene);

/// The scene with these draws lit at their vertices, in real arithmetic, and `shade smooth`.
[[nodiscard]] Scene lit_at_vertices(const Scene& scene);

/// `rendering`: with its triangles; `fragments`, `vertices`: the golden's pictures of the scene, and lit at vertices.
[[nodiscard]] std::vector<PerVertexRow> per_vertex_rows(const Scene& scene, const Config& config,
                                                        const Rendering& rendering, const golden::Image& fragments,
                                                        const golden::Image& vertices);

// The cost in time of light at fragments against light at vertices: cycles of whole frames.

/// Cycles of the frame, on hardware that lights fragments, with the default memory.
struct PerVertexCycles {
  std::uint64_t fragments = 0;     ///< of the unchanged scene
  std::uint64_t vertices = 0;      ///< of the scene lit at its vertices, on the same hardware
  std::uint64_t without_unit = 0;  ///< likewise, on hardware with shade.unit=0
  std::vector<std::string> set;    ///< "shade.unit=1": changes of the configuration to get the unit
  std::string refused;             ///< reason without figures: no such hardware, or it refuses the scene
};

/// Runs the cycle engine on hardware of this configuration, with shade.unit and a texture unit for the scene set if
/// they are off. `progress` gets 0...1; it may be empty, and may throw to end the work.
[[nodiscard]] PerVertexCycles per_vertex_cycles(const Scene& scene, const Config& config,
                                                const std::function<void(double)>& progress = {});

}  // namespace halfplane
