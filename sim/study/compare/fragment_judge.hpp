// Fragments before the operations: coverage and planes of each against the exact oracle. A fault found here is in the
// setup, the raster or the interpolation, independent of later operations.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "model/attributes.hpp"
#include "model/engines/tapped_fragment.hpp"
#include "model/golden/exact.hpp"
#include "model/packets/packets.hpp"
#include "sim/study/compare/coverage.hpp"
#include "sim/study/compare/surface_oracle.hpp"

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

class FragmentJudge {
 public:
  FragmentJudge(const Scene& scene, const Config& config, FillRule rule = FillRule::top_left);
  FragmentJudge(const Scene&, const Config&&,
                FillRule = FillRule::top_left) = delete;  // must outlive the judge

  /// The next fragment in program order.
  void add(const TappedFragment& fragment);

  /// After the last one; `rendering`: the result of the engine that made them.
  [[nodiscard]] FragmentVerdict finish(const Rendering& rendering);

 private:
  void add_to_triangle(const TappedFragment& fragment);
  void add_to_line(const TappedFragment& fragment);
  void begin_triangle(const TappedFragment& fragment);
  void finish_triangle();
  /// The correct shading place of a pixel: 0 its centre, otherwise 1 + a sample.
  [[nodiscard]] std::size_t shaded_place(int x, int y) const;

  const Scene& scene_;
  const Config& config_;
  const Widths widths_;
  const FillRule rule_;
  FragmentVerdict verdict_;
  std::vector<CoverageLog> logs_;               // of each sample of a pixel
  std::vector<PixelLog> pixels_;                // likewise
  std::uint64_t repeated_ = 0;                  // samples
  std::uint64_t misplaced_ = 0;                 // samples with a colour from a wrong place
  std::optional<std::uint32_t> item_;           // number of the current triangle
  std::vector<exact::TriangleOracle> oracles_;  // of the triangle at the centre, at each of several samples
  std::vector<SurfaceOracle> surfaces_;         // likewise, if it has a surface
  std::vector<std::map<std::pair<int, int>, TileMask>> tiles_;  // by sample: by tile row, column
};

/// One line for every bound that a fragment breaks; empty when all hold.
[[nodiscard]] std::vector<std::string> broken_fragment_bounds(const FragmentVerdict& verdict, const Config& config);

}  // namespace halfplane
