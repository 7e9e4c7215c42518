// Multisample: a triangle as each sample of a pixel sees it.
//
// In: the setup of a triangle, at pixel centres, and its vertices. Out: the same setup at one sample of every pixel. A sample
// lies o = (o_x, o_y) from the centre, in 2^-s pixel, the same in all pixels, so it costs one constant an edge and plane:
//
//   edges   e + c,  c = (low + dx o_y - dy o_x) >> s,  low: the s bits that e, as floor((E - bias) / 2^s), has lost. They are the
//           same at all centres, so e + c is floor((E(o) - bias) / 2^s): exact, the edges of the triangle moved by -o
//   planes  z + d,  d = (n_x o_x + n_y o_y + 1/2) >> s,  n: the steps per pixel that a tile keeps. So interpolate makes d of what it
//           has, for 2 halves of a tile's last place more of error: half a pixel's way along each axis, and the rounding of d
//
// A pixel with a covered sample is shaded once: at its centre, or where that is not covered, at its lowest-numbered covered
// sample. A perspective plane there may be read; at a centre outside it may have no meaning.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "coarse_raster.hpp"
#include "interpolate.hpp"
#include "triangle_setup.hpp"

namespace halfplane {

/// The setup of a triangle at a sample.
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

/// From the centre to there.
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
