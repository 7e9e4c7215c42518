// What the judge of fragments (fragment_judge.hpp) found: the figures of coverage, planes and surfaces.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "coverage.hpp"
#include "model/attributes.hpp"
#include "surface_errors.hpp"

namespace halfplane {

// The planes that compare and stress judge: all of model/attributes.hpp.

/// Plane i of TappedFragment::plane.
struct JudgedPlane {
  std::string_view name;
  int bits = 0;           ///< of a code
  bool is_depth = false;  ///< its bound is depth_error_bound() or line_depth_error_bound(); for all others 1 LSB
  bool is_color = false;  ///< a channel of the stored colour
};

/// All interpolated planes.
[[nodiscard]] inline std::vector<JudgedPlane> judged_planes(const Config& config) {
  std::vector<JudgedPlane> planes;
  for (const Attribute& a : attributes_of(config))
    for (int i = 0; i < a.planes; ++i)
      planes.push_back(
          {a.part[static_cast<std::size_t>(i)], a.bits, a.stored == StoredAs::depth, a.stored == StoredAs::color});
  return planes;
}

/// The codes of judged_planes()[plane] at the vertices.
[[nodiscard]] inline std::array<std::uint32_t, 3> plane_codes(const Triangle& triangle, std::size_t plane) {
  return {triangle.v[0].code[plane], triangle.v[1].code[plane], triangle.v[2].code[plane]};
}

/// The largest distances of one plane from the exact value, LSB.
struct PlaneVerdict {
  JudgedPlane plane;
  double worst = 0, worst_of_lines = 0;  ///< codes; lines and points separately, with possibly another bound
  double worst_unrounded = 0;            ///< triangles, before the final rounding
};

/// The samples of surfaces nearest to their bounds, or beyond them.
struct SurfaceVerdict {
  Held color, light, coordinate, level, filter, fog_factor, fog;
};

struct FragmentVerdict {
  std::uint64_t fragments = 0;
  SurfaceVerdict surfaces;
  OracleResult coverage;  ///< every sample of every primitive; a repeated fragment is a mismatch
  std::vector<PlaneVerdict> planes;
};

}  // namespace halfplane
