// Fragments before the operations: coverage and planes of each against the exact oracle. A fault found here is in the
// setup, the raster or the interpolation, independent of later operations.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fragment_verdict.hpp"
#include "line_coverage.hpp"
#include "model/engines/tapped_fragment.hpp"
#include "model/golden/exact.hpp"
#include "model/packets/packets.hpp"
#include "surface_oracle.hpp"

namespace halfplane {

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
