// Multisample: a triangle as each sample of a pixel sees it.
//
// In: the setup of a triangle, at pixel centres, and its vertices. Out: the same setup at one sample of every pixel. A sample
// lies o = (o_x, o_y) from the centre, in 2^-s pixel, the same in all pixels, so it costs one constant an edge and plane:
//
//   edges   e + c,  c = (low + dx o_y - dy o_x) >> s,  low: the s bits that e, as floor((E - bias) / 2^s), has lost. They are the
//           same at all centres, so e + c is floor((E(o) - bias) / 2^s): exact, and nothing that follows knows of samples
//   planes  z + N_x o_x + N_y o_y, of the wide gradients, before anything is narrowed: no further rounding
//
// It is bit for bit the setup of the triangle moved by -o, in the first tile of the unmoved one.
//
// A pixel with a covered sample is shaded once: at its centre, or where that is not covered, at its lowest-numbered covered
// sample. A perspective plane there may be read; at a centre outside it may have no meaning.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "coarse_raster.hpp"
#include "triangle_setup.hpp"

namespace halfplane {

/// c of the edge from `from` to `to` of a triangle of positive area.
[[nodiscard]] constexpr EdgeValue sample_edge_offset(const SnappedVertex& from, const SnappedVertex& to,
                                                     const SampleOffset& o, int grid_bits) {
  const std::int64_t half = std::int64_t{1} << (grid_bits - 1);
  const std::int64_t dx = std::int64_t{to.x} - from.x, dy = std::int64_t{to.y} - from.y;
  const std::int64_t at_centre = dx * (half - from.y) - dy * (half - from.x) - (is_top_left(from, to) ? 0 : 1);
  const std::int64_t low = at_centre & (2 * half - 1);
  return (low + dx * o.y - dy * o.x) >> grid_bits;
}

/// The setup of a triangle at a sample. `v`: its vertices in canonical order.
[[nodiscard]] inline TriangleSetup setup_at_sample(TriangleSetup setup, const std::array<SnappedVertex, 3>& v,
                                                   const SampleOffset& o, const Widths& widths) {
  for (std::size_t i = 0; i < 3; ++i)
    setup.edge[i].value += sample_edge_offset(v[i], v[(i + 1) % 3], o, widths.grid_bits);
  for (std::size_t p = 0; p < static_cast<std::size_t>(widths.planes); ++p) {
    Plane& plane = setup.plane[p];
    const std::uint64_t moved =
        static_cast<std::uint64_t>(plane.value) +
        static_cast<std::uint64_t>(plane.step_x) * static_cast<std::uint64_t>(std::int64_t{o.x}) +
        static_cast<std::uint64_t>(plane.step_y) * static_cast<std::uint64_t>(std::int64_t{o.y});
    plane.value = wrap_signed(static_cast<std::int64_t>(moved), widths.of_plane(p).plane.bits);
  }
  return setup;
}

/// The triangle moved by -o: at its pixel centres lies what the triangle has at a sample.
[[nodiscard]] inline Triangle moved_to_sample(Triangle triangle, const SampleOffset& o) {
  for (SnappedVertex& v : triangle.v) {
    v.x -= o.x;
    v.y -= o.y;
  }
  return triangle;
}

/// Where a pixel is shaded: -1 at its centre, otherwise the number of a sample.
inline constexpr int kAtCentre = -1;

/// A triangle at the centre of pixels and at each of their samples.
struct SampledSetup {
  TriangleSetup centre;
  std::vector<TriangleSetup> sample;

  SampledSetup(const Triangle& triangle, const TriangleSetup& setup, const Widths& widths) : centre(setup) {
    const auto v = canonical(triangle.v, signed_area(triangle.v[0], triangle.v[1], triangle.v[2]));
    for (std::size_t k = 0; k < static_cast<std::size_t>(widths.pixel_samples); ++k)
      sample.push_back(setup_at_sample(setup, v, widths.sample_offset[k], widths));
  }
  [[nodiscard]] const TriangleSetup& at(int place) const {
    return place == kAtCentre ? centre : sample[static_cast<std::size_t>(place)];
  }
};

}  // namespace halfplane
