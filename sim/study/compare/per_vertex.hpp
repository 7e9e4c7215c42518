// What light at vertices costs against light at fragments: the golden's picture of both, by the size of triangles.
#pragma once

#include <cstdint>
#include <vector>

#include "model/config.hpp"
#include "model/engines/render.hpp"
#include "model/golden/golden.hpp"
#include "model/scene.hpp"

namespace halfplane {

/// Triangles of one size.
struct PerVertexRow {
  double area = 0;              ///< the least, pixels; the most is twice that. 0: below one pixel
  std::uint64_t triangles = 0;  ///< that show
  std::uint64_t pixels = 0;     ///< of those
  double max = 0, rms = 0;      ///< colour lit at vertices less lit at fragments, red, green and blue, LSB of 8 bits
};

/// Whether a draw of the scene has `shade phong`, of filled triangles.
[[nodiscard]] bool has_light_of_fragments(const Scene& scene);

/// The scene with those draws lit at their vertices, in real arithmetic, and `shade smooth`.
[[nodiscard]] Scene lit_at_vertices(const Scene& scene);

/// `rendering`: with its triangles; `fragments`, `vertices`: the golden's pictures of the scene, and lit at vertices.
[[nodiscard]] std::vector<PerVertexRow> per_vertex_rows(const Scene& scene, const Config& config,
                                                        const Rendering& rendering, const golden::Image& fragments,
                                                        const golden::Image& vertices);

}  // namespace halfplane
