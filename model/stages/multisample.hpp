// Multisample: a triangle seen from each sample of a pixel.
//
// In: the setup of a triangle, at pixel centres, and its vertices. Out: the same setup at one sample of every pixel. A
// sample lies o = (o_x, o_y) from the centre, in 2^-s pixel, the same in all pixels, so it needs one constant per edge
// and plane:
//
//   edges   e + c,  c = (low + dx o_y - dy o_x) >> s,  low: the s bits that e, as floor((E - bias) / 2^s), has dropped.
//   They are
//           same at all centres, so e + c is floor((E(o) - bias) / 2^s): exact, the edges of the triangle moved by -o
//   planes  z + d,  d = (n_x o_x + n_y o_y + 1/2) >> s,  n: the steps per pixel in a tile's precision. So interpolate
//   computes d
//           from them, with 2 halves of a tile's last place more of error: half a pixel's step along each axis, and
//           rounding of d
//
// A pixel with a covered sample is shaded once: at its centre, or if that is not covered, at its lowest-numbered
// covered sample. There a plane over w is valid; at an uncovered centre it may not be.
#pragma once

#include <vector>

#include "interpolate.hpp"
#include "tile_walk.hpp"
#include "triangle_setup.hpp"

namespace halfplane {

[[nodiscard]] inline TriangleSetup setup_at_sample(TriangleSetup setup, const SampleOffset& o, const Widths& widths) {
  for (std::size_t i = 0; i < 3; ++i)
    setup.edge[i].value +=
        sample_edge_offset(setup.edge[i].low, -EdgeValue{setup.edge[i].dy}, setup.edge[i].dx, o, widths.grid_bits);
  for (std::size_t p = 0; p < static_cast<std::size_t>(widths.planes); ++p) {
    const AttributeWidths& of = widths.of_plane(p);
    Plane& plane = setup.plane[p];
    plane.value = wrap_signed(plane_at_sample(plane, of.guard_bits(), o, widths).value, of.plane.bits);
  }
  return setup;
}

/// The triangle moved by -o: its values at pixel centres are those of the triangle at a sample.
[[nodiscard]] inline Triangle moved_to_sample(Triangle triangle, const SampleOffset& o) {
  for (SnappedVertex& v : triangle.v) {
    v.x -= o.x;
    v.y -= o.y;
  }
  return triangle;
}

/// Shading place of a pixel: -1 its centre, otherwise the number of a sample.
inline constexpr int kAtCentre = -1;

/// Offset of the shading place from the centre.
[[nodiscard]] inline SampleOffset offset_of(int place, const Widths& widths) {
  return place == kAtCentre ? SampleOffset{} : widths.sample_offset[static_cast<std::size_t>(place)];
}

/// A triangle at the centre of pixels and at each of their samples.
struct SampledSetup {
  TriangleSetup centre;
  std::vector<TriangleSetup> sample;

  SampledSetup(const TriangleSetup& setup, const Widths& widths) : centre(setup) {
    for (std::size_t k = 0; k < static_cast<std::size_t>(widths.pixel_samples); ++k)
      sample.push_back(setup_at_sample(setup, widths.sample_offset[k], widths));
  }
  [[nodiscard]] const TriangleSetup& at(int place) const {
    return place == kAtCentre ? centre : sample[static_cast<std::size_t>(place)];
  }
};

}  // namespace halfplane
